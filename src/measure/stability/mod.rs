//! Where each way to compute something fails: maps of measured errors, and whether the planner goes there.
//!
//! Nothing in them is known beforehand: every cell runs what pictures are made with, and compares it with arithmetic of 32
//! digits, closed forms, or another integrator in other coordinates. What the planner does in a cell is asked of it, too.

mod curved;
mod cutting;
mod map;
mod outline;
mod painter;
mod place;
mod sight;
mod vertices;
mod wide;

pub use map::{Axis, Map, Planner};
pub use wide::{Seen, conditioning, seen};

/// A quarter of a pixel of a usual picture (60° over 720 pixels), as an angle: what edges are drawn to.
pub const QUARTER_PIXEL: f64 = 4e-4;

/// How many cells maps have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolution {
    /// As many as are worth looking at.
    Usual,
    /// As few as tell whether there is anything wrong.
    Quick,
}

impl Resolution {
    /// Every one of a list, or few of them, the first and the last included.
    fn some<T: Copy>(self, all: &[T], few: usize) -> Vec<T> {
        match self {
            Self::Usual => all.to_vec(),
            Self::Quick if all.len() <= few => all.to_vec(),
            Self::Quick => (0..few).map(|i| all[i * (all.len() - 1) / (few - 1)]).collect(),
        }
    }
}

/// A sheet of maps that belong together.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    /// What it is called.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    measure: fn(Resolution) -> Vec<Map>,
}

/// All there are.
pub const SHEETS: &[Sheet] = &[
    Sheet { name: "place", title: "Where a point is seen, and its Doppler factor", measure: place::maps },
    Sheet { name: "sight", title: "Lines of sight, and cut shapes, at high γ", measure: sight::maps },
    Sheet { name: "cutting", title: "Triangles moved to where they are seen", measure: cutting::maps },
    Sheet { name: "painter", title: "Bodies that reach into each other", measure: painter::maps },
    Sheet { name: "vertices", title: "Light from Doppler factors of vertices", measure: vertices::maps },
    Sheet { name: "curved", title: "Curved light", measure: curved::maps },
];

impl Sheet {
    /// Measures its maps.
    pub fn maps(&self, resolution: Resolution) -> Vec<Map> {
        (self.measure)(resolution)
    }
}
