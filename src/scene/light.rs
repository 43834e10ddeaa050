use crate::relativity::Motion;
use glam::DVec3;

/// A lamp that a file brings. So far it is only known of: surfaces shine by themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    /// What the file calls it.
    pub name: String,
    /// Of what kind it is, and where, in its rest frame.
    pub kind: LampKind,
    /// Linear sRGB colour.
    pub color: [f32; 3],
    /// Candela, or lux where it is at infinity, as the file says it.
    pub intensity: f32,
    /// How it moves.
    pub motion: Motion,
}

/// Kinds of [`Lamp`]s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LampKind {
    /// At infinity: its light goes this way.
    Distant {
        /// Unit vector.
        direction: DVec3,
    },
    /// It shines in all directions.
    Point {
        /// Where.
        position: DVec3,
    },
    /// It shines into a cone.
    Spot {
        /// Where.
        position: DVec3,
        /// The cone's axis, a unit vector.
        direction: DVec3,
        /// Angles from the axis, radians, where it begins to darken and where it is dark.
        cone: [f32; 2],
    },
}
