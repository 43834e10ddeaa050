//! A file a lesson.

mod bending;
mod cube;
mod doppler;
mod fields;
mod gate;
mod lattice;
mod lights;
mod observer;
mod rods;
mod searchlight;
mod seeing;
mod shadows;
mod speed;
mod sphere;
mod telescopes;

use super::lecture::Lecture;
use super::plate::{Shot, TeachError};
use crate::relativity::{ApparentMap, Motion};
use crate::scene::{Scene, Speed, builtin_scene, did_you_mean, parse_scene};
use glam::DVec3;
use std::path::Path;
use terrell_geodesic::{Celerity, Event, Tetrad};

/// Something to learn.
#[derive(Clone, Copy, Debug)]
pub struct Lesson {
    /// As it is called in commands.
    pub name: &'static str,
    /// As it is called on its page.
    pub title: &'static str,
    /// What it is about, in a line.
    pub about: &'static str,
    /// Where it is from: "the paper" is Nollert, Kraus and Ruder (2000).
    pub source: &'static str,
    make: fn() -> Result<Lecture, TeachError>,
}

static LESSONS: [Lesson; 15] = [
    Lesson {
        name: "seeing",
        title: "Seeing is not measuring",
        about: "where things are, where they look to be, and why the two differ",
        source: "The paper, section 2.1; G. Gamow, Mr Tompkins in Wonderland (1940)",
        make: seeing::lecture,
    },
    Lesson {
        name: "rods",
        title: "Rods become hyperbolas",
        about: "the map from a point to where it is seen, and what it does to straight lines",
        source: "The paper, Eqs. 1 and 2",
        make: rods::lecture,
    },
    Lesson {
        name: "lattice",
        title: "The lattice",
        about: "a whole grid of rods and balls, coming, passing and going, at four speeds",
        source: "The paper, Fig. 1",
        make: lattice::lecture,
    },
    Lesson {
        name: "observer",
        title: "The intelligent observer",
        about: "from the picture back to the true shape",
        source: "The paper, section 2.1.2",
        make: observer::lecture,
    },
    Lesson {
        name: "cube",
        title: "The cube that seems to turn",
        about: "a shear that looks like a turn by arcsin β, and when it does not",
        source: "The paper, Figs. 2, 4 and 5; J. Terrell, Phys. Rev. 116 (1959) 1041",
        make: cube::lecture,
    },
    Lesson {
        name: "gate",
        title: "The gate",
        about: "flying through it at 0.99c, forward and looking back",
        source: "The paper, Fig. 3",
        make: gate::lecture,
    },
    Lesson {
        name: "sphere",
        title: "The sphere stays round",
        about: "why the outline of a fast sphere is a circle",
        source: "R. Penrose, Proc. Camb. Phil. Soc. 55 (1959) 137",
        make: sphere::lecture,
    },
    Lesson {
        name: "fields",
        title: "Fields of view",
        about: "which distortion is the camera’s, and which relativity’s",
        source: "The paper, section 2.1",
        make: fields::lecture,
    },
    Lesson {
        name: "doppler",
        title: "Doppler: one factor, two angles",
        about: "which angle belongs into which formula, and what becomes of colours",
        source: "The paper, Eqs. 3 and 4",
        make: doppler::lecture,
    },
    Lesson {
        name: "searchlight",
        title: "The searchlight",
        about: "why what comes is bright and what goes is dark, and what a screen can show of it",
        source: "The paper, Eq. 5",
        make: searchlight::lecture,
    },
    Lesson {
        name: "lights",
        title: "Lights and aberration",
        about: "where a distant light shines from on what moves",
        source: "The paper, section 2.2.3",
        make: lights::lecture,
    },
    Lesson {
        name: "shadows",
        title: "Shadows need rays",
        about: "shadows that are late, seen twice, and faster than light",
        source: "The paper, section 2.2.4",
        make: shadows::lecture,
    },
    Lesson {
        name: "speed",
        title: "Speed against accuracy",
        about: "what a picture costs, how far off it is, and where formulas fail",
        source: "The paper, sections 2.2.4 and 4; measured here",
        make: speed::lecture,
    },
    Lesson {
        name: "telescopes",
        title: "The telescope that would see it",
        about: "why such pictures are computed, and what is seen of things that fast all the same",
        source: "The paper, Table 1, worked out anew; J. A. Biretta et al., ApJ 520 (1999) 621",
        make: telescopes::lecture,
    },
    Lesson {
        name: "bending",
        title: "Light bends",
        about: "a first look at curved spacetime: rays as short straight pieces",
        source: "The paper, section 3 and Fig. 6",
        make: bending::lecture,
    },
];

/// All lessons, in the order of the course.
pub fn lessons() -> &'static [Lesson] {
    &LESSONS
}

/// There is no lesson of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no lesson '{name}'; {hint}")]
pub struct NoSuchLesson {
    /// What was asked for.
    pub name: String,
    /// The nearest name, or all there are.
    pub hint: String,
}

/// A lesson by its name.
///
/// # Errors
/// If there is none of that name.
pub fn lesson(name: &str) -> Result<&'static Lesson, NoSuchLesson> {
    LESSONS.iter().find(|lesson| lesson.name == name).ok_or_else(|| NoSuchLesson {
        name: name.to_owned(),
        hint: did_you_mean(name, LESSONS.iter().map(|lesson| lesson.name)),
    })
}

impl Lesson {
    /// Works it out.
    ///
    /// # Errors
    /// If one of its scenes cannot be.
    pub fn lecture(&self) -> Result<Lecture, TeachError> {
        (self.make)()
    }
}

/// What an observer at rest sees of a body that moves along x, whose origin is where the observer is at that moment:
/// offsets from the observer are the body's own coordinates.
fn passing(beta: f64) -> Result<ApparentMap, TeachError> {
    let motion = Motion { celerity: Celerity::from_beta(DVec3::X * beta)?, origin: Event::origin() };
    Ok(ApparentMap::new(&motion, &Tetrad::of_world(Event::origin())))
}

/// A whole number, as people write it.
fn whole(value: f64) -> String {
    crate::drawing::number::fixed(value, 0)
}

/// A scene that ships, at another speed.
fn shipped(name: &str, beta: f64) -> Result<Shot, TeachError> {
    let mut scene = builtin_scene(name)?.scene();
    set_beta(&mut scene, beta)?;
    Ok(Shot::new(scene))
}

/// A scene of a lesson's own, at a speed.
fn own(toml: &str, beta: f64) -> Result<Shot, TeachError> {
    let mut scene = parse_scene(toml, Path::new("lesson.toml"))?;
    set_beta(&mut scene, beta)?;
    Ok(Shot::new(scene))
}

fn set_beta(scene: &mut Scene, beta: f64) -> Result<(), TeachError> {
    scene.set_speed(Speed::Along(Celerity::from_beta(DVec3::X * beta)?.magnitude()))?;
    // Nothing is ever abreast that does not move.
    if beta == 0.0 {
        scene.view.nearest = None;
    }
    Ok(())
}
