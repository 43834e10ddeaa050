use super::canvas::{Canvas, Ink, LIGHT, polygon, polylines};
use super::text;
use crate::relativity::ApparentMap;
use crate::scene::{Camera, Scene};
use glam::{DVec2, DVec3};
use tiny_skia::PathBuilder;

/// An arrow from the gizmo's middle.
struct Arrow {
    /// Unit vector: right, up, forward.
    direction: DVec3,
    label: String,
    ink: Ink,
}

const X: Ink = [255, 120, 110, 255];
const Y: Ink = [130, 225, 120, 255];
const Z: Ink = [125, 170, 255, 255];

/// Directions of motion less than a degree apart are drawn once.
const SAME_DIRECTION: f64 = 0.999_85;

/// The world's axes in the upper right corner, and to their left the directions of motion.
///
/// They are directions *in the camera's frame*, seen from far away: the world's axes as the camera has them when
/// its boost is taken off (for a camera at rest, simply the world's), and each body's velocity relative to the
/// camera.
pub(super) fn draw(canvas: &mut Canvas, scene: &Scene, camera: &Camera) {
    let em = canvas.em();
    let radius = 2.2 * em;
    let outer = radius + 1.1 * em;
    let middle = DVec2::new(canvas.width() - outer, outer);
    draw_arrows(canvas, axes(camera), middle, radius);
    // Often a body moves along an axis: apart, both can be read.
    draw_arrows(canvas, motions(scene, camera), middle - DVec2::X * (2.0 * radius + 1.5 * em), radius);
}

fn draw_arrows(canvas: &mut Canvas, mut arrows: Vec<Arrow>, middle: DVec2, radius: f64) {
    // What points away is drawn first.
    arrows.sort_by(|a, b| b.direction.z.total_cmp(&a.direction.z));
    let sum: DVec2 = arrows.iter().map(|arrow| flat(arrow.direction)).sum();
    // Where the others are not.
    let beside = (-sum).normalize_or(DVec2::new(-1.0, 1.0).normalize());
    let mut places: Vec<DVec2> = Vec::new();
    for arrow in &arrows {
        let outward = draw_arrow(canvas, arrow, middle, radius, beside);
        let em = canvas.em();
        let mut place =
            middle + (radius * flat(arrow.direction).length() + 0.55 * em).max(0.9 * em) * outward;
        // Arrows seen foreshortened end near to each other; their letters do not.
        const APART: f64 = 0.85;
        if let Some(other) = places.iter().find(|other| other.distance(place) < APART * em) {
            place = *other + APART * em * (place - *other).normalize_or(DVec2::X);
        }
        places.push(place);
        let width = text::width(&arrow.label, em);
        // Within the picture, also where a name is long.
        let left = (place.x - 0.5 * width).min(canvas.width() - 0.3 * em - width);
        text::write(canvas, &arrow.label, em, DVec2::new(left, place.y + 0.3 * em), arrow.ink);
    }
}

/// On the picture, whose y goes down.
fn flat(direction: DVec3) -> DVec2 {
    DVec2::new(direction.x, -direction.y)
}

fn axes(camera: &Camera) -> Vec<Arrow> {
    let [right, up, forward] = camera.observer.axes();
    let axis = |(v, label, ink): (DVec3, &str, Ink)| Arrow {
        direction: DVec3::new(right.dot(v), up.dot(v), forward.dot(v)),
        label: label.to_owned(),
        ink,
    };
    [(DVec3::X, "x", X), (DVec3::Y, "y", Y), (DVec3::Z, "z", Z)].map(axis).into()
}

fn motions(scene: &Scene, camera: &Camera) -> Vec<Arrow> {
    let mut motions: Vec<(DVec3, &str)> = Vec::new();
    for body in &scene.bodies {
        let map = ApparentMap::new(&body.motion, &camera.observer);
        let direction = map.axis_observer();
        if map.speed() > 0.0 && !motions.iter().any(|(other, _)| other.dot(direction) > SAME_DIRECTION) {
            motions.push((direction, &body.name));
        }
    }
    let one = motions.len() == 1;
    let arrow = |(direction, name): (DVec3, &str)| {
        let label = if one { "v".to_owned() } else { format!("v {name}") };
        Arrow { direction, label, ink: LIGHT }
    };
    motions.into_iter().map(arrow).collect()
}

/// Returns where its label goes: for an arrow along the line of sight, `beside`.
fn draw_arrow(canvas: &mut Canvas, arrow: &Arrow, middle: DVec2, radius: f64, beside: DVec2) -> DVec2 {
    let (em, line) = (canvas.em(), 1.5 * canvas.line());
    let flat = flat(arrow.direction);
    let tip = middle + radius * flat;
    let mut outward = flat.normalize_or(beside);
    let head = 0.5 * em;
    if radius * flat.length() > 1.5 * head {
        let neck = tip - head * outward;
        if let Some(path) = polylines([&[middle, neck][..]]) {
            canvas.stroke_shaded(&path, line, arrow.ink);
        }
        let side = 0.45 * head * outward.perp();
        if let Some(path) = polygon(&[tip, neck + side, neck - side]) {
            canvas.fill(&path, arrow.ink);
        }
    } else {
        outward = beside;
        // Along the line of sight: the point of an arrow that comes, the feathers of one that goes.
        let ring = 0.32 * em;
        let mut path = PathBuilder::new();
        path.push_circle(middle.x as f32, middle.y as f32, ring as f32);
        if arrow.direction.z < 0.0 {
            path.push_circle(middle.x as f32, middle.y as f32, (0.25 * ring) as f32);
        } else {
            for side in [DVec2::new(1.0, 1.0), DVec2::new(1.0, -1.0)] {
                let [from, to] = [-1.0, 1.0].map(|s| middle + s * ring * 0.7 * side);
                path.move_to(from.x as f32, from.y as f32);
                path.line_to(to.x as f32, to.y as f32);
            }
        }
        if let Some(path) = path.finish() {
            canvas.stroke_shaded(&path, line, arrow.ink);
        }
    }
    outward
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesic::Celerity;
    use crate::scene::{Aim, builtin_scenes};

    #[test]
    fn axes_are_the_camera_s_and_motion_is_relative_to_it() {
        // The cube's camera looks along y, z up: x to the right, y away.
        let mut scene = builtin_scenes()[0].scene();
        let is = |arrow: &Arrow, label: &str, direction: DVec3| {
            assert_eq!(arrow.label, label);
            assert!((arrow.direction - direction).length() < 1e-12, "{label}: {}", arrow.direction);
        };
        let all = |scene: &Scene| -> Vec<Arrow> {
            let camera = scene.camera().unwrap();
            axes(&camera).into_iter().chain(motions(scene, &camera)).collect()
        };
        let drawn = all(&scene);
        assert_eq!(drawn.len(), 4);
        for (arrow, (label, direction)) in
            drawn.iter().zip([("x", DVec3::X), ("y", DVec3::Z), ("z", DVec3::Y), ("v", DVec3::X)])
        {
            is(arrow, label, direction);
        }
        // At rest in a moving camera, the cube comes the other way.
        scene.view.celerity = Celerity::new(DVec3::X).unwrap();
        scene.view.aim = Aim::Forward(DVec3::X);
        scene.bodies[0].motion.celerity = Celerity::at_rest();
        scene.view.nearest = None;
        let drawn = all(&scene);
        is(&drawn[0], "x", DVec3::Z);
        is(&drawn[3], "v", DVec3::NEG_Z);
        // Two ways to move are told apart by name; nothing that moves has no arrow.
        let mut other = scene.bodies[0].clone();
        other.name = "other".into();
        other.motion.celerity = Celerity::new(DVec3::Z * 3.0).unwrap();
        scene.bodies.push(other);
        let labels =
            |scene: &Scene| -> Vec<String> { all(scene).into_iter().skip(3).map(|a| a.label).collect() };
        assert_eq!(labels(&scene), ["v cube", "v other"]);
        scene.view.celerity = Celerity::at_rest();
        scene.bodies.pop();
        assert!(labels(&scene).is_empty());
    }
}
