use super::passing;
use crate::scene::builtin_scene;
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, Shot, TeachError};
use glam::DVec3;

/// How far away the sphere’s middle is in its rest frame, in radii.
const AWAY: f64 = 3.0;

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "A fast sphere is measured to be flattened to 1/γ of its length. It is not seen so: its outline is a circle at every speed. R. Penrose showed \
         it in 1959. The rays that graze the sphere form a circular cone around its middle *in the sphere’s frame*; aberration, which takes \
         directions of one observer to those of another, takes every circle of the sky to a circle.",
    );
    l.plates([Plate::shot(
        "four",
        "Spheres at rest, at 0.5c, 0.9c and 0.99c, rising, all abreast: of one size, ever more turned.",
        Shot::new(builtin_scene("sphere")?.scene()),
    )]);
    l.text(
        "The chequer tells them apart: it is turned by arcsin β, as the cube of another lesson. A circle on the *sky* is meant. On a flat picture away from its \
         middle a circle of the sky is an ellipse, moving or not: that is the camera’s doing, and the subject of the lesson on fields of view.",
    );
    l.heading("Measured");
    l.text(
        "A sphere of radius 1 at a distance of 3, abreast in its own frame. A hundred rays that graze it are aberrated; listed is how far they are from one \
         circle at most, how wide that is, and how far the sphere’s middle is seen from the circle’s. The middle is not in the middle: aberration \
         crowds directions together towards where the sphere comes from, so that half of the cone is seen narrower than the other.",
    );
    let mut rows = Vec::new();
    for beta in [0.0, 0.5, 0.9, 0.99] {
        let Outline { radius, spread, off_middle } = outline(beta)?;
        rows.push([
            format!("{beta}"),
            l.digits(format!("off the circle at {beta}, radians"), spread, 1),
            l.fixed(format!("radius of the circle at {beta}, degrees"), radius.to_degrees(), 3),
            l.fixed(format!("middle off the circle’s at {beta}, degrees"), off_middle.to_degrees(), 3),
        ]);
    }
    l.table(["β", "off a circle (rad)", "its radius (°)", "middle is off by (°)"], rows);
    l.attempt("terrell render sphere --color geometry --samples 9", "the first picture, larger");
    l.attempt("terrell render sphere --color doppler --legend", "how far each is shifted");
    let radius = l.fixed("answer: radius at rest, degrees", outline(0.0)?.radius.to_degrees(), 2);
    l.ask(
        "How large does a resting sphere of radius 1 look whose middle is 3 away: is its angular radius arctan(1/3) or arcsin(1/3)?",
        format!("arcsin(1/3) = {radius}°: lines of sight graze it, and meet its radius at a right angle."),
    );
    Ok(lecture)
}

/// The circle as which a sphere is seen.
struct Outline {
    /// Angular.
    radius: f64,
    /// How far rays are from it, radians.
    spread: f64,
    /// How far the sphere's middle is seen from the circle's.
    off_middle: f64,
}

fn outline(beta: f64) -> Result<Outline, TeachError> {
    let map = passing(beta)?;
    let (sine, middle) = (1.0 / AWAY, DVec3::Y);
    let cosine = (1.0 - sine * sine).sqrt();
    let seen: Vec<DVec3> = (0..100)
        .map(|i| {
            let (s, c) = (std::f64::consts::TAU * f64::from(i) / 100.0).sin_cos();
            // Where the ray touches is as far along it as the cosine says.
            let grazing = middle * cosine + (DVec3::X * c + DVec3::Z * s) * sine;
            map.see(grazing * (AWAY * cosine)).position.normalize()
        })
        .collect();
    // Three of them make a circle.
    let axis = (seen[33] - seen[0]).cross(seen[67] - seen[0]).normalize();
    let axis = if axis.dot(seen[0]) < 0.0 { -axis } else { axis };
    let angle = |n: DVec3| axis.cross(n).length().atan2(axis.dot(n));
    let radius = angle(seen[0]);
    let spread = seen.iter().map(|n| (angle(*n) - radius).abs()).fold(0.0, f64::max);
    let off_middle = angle(map.see(middle * AWAY).position.normalize());
    Ok(Outline { radius, spread, off_middle })
}
