//! Lines of sight through triangles at rest, and triangles moved to where they are seen, at high γ.

use super::map::{cells, number};
use super::outline::Outline;
use super::place::GAMMAS;
use super::{Axis, Map, Planner, Resolution};
use crate::color::Coloring;
use crate::film::{Film, Samples};
use crate::light::Shading;
use crate::plan::{MOST_GAMMA, Method, cheapest, lacks_digits};
use crate::relativity::{ApparentMap, Motion};
use crate::render::{Options, render};
use crate::scene::{Aim, Body, Camera, Light, LightKind, Mesh, Scene, View};
use crate::spectrum::Spectrum;
use crate::trace::{Look, Paths, Tracer};
use glam::{DVec2, DVec3};
use terrell_geodesic::{Celerity, Event};

/// Angles of the line of sight to the motion, degrees: 0 follows what recedes.
const ANGLES: [f64; 13] = [0.0, 0.001, 0.1, 2.0, 10.0, 30.0, 60.0, 90.0, 120.0, 150.0, 178.0, 179.9, 180.0];

/// Sizes of the triangle, pixels.
const SIZES: [f64; 8] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 120.0, 300.0];

/// Those of all angles: a triangle of rays, and one that is cut.
const RAYED: f64 = 20.0;
const CUT: f64 = 300.0;

/// That of all sizes.
const ANGLE: f64 = 30.0;

/// Corners of the triangle, in its size, and how far away they appear.
const CORNERS: [([f64; 2], f64); 3] = [([0.03, 0.11], 9.8), ([0.98, 0.21], 10.3), ([0.37, 0.97], 10.1)];

/// Pixels beside it.
const MARGIN: f64 = 4.0;

/// A moving triangle before a camera at rest.
struct Setting {
    scene: Scene,
    camera: Camera,
    outline: Outline,
}

fn lamp() -> Light {
    Light {
        name: "lamp".to_owned(),
        kind: LightKind::Point { position: DVec3::ZERO },
        color: [1.0; 3],
        spectrum: Spectrum::default(),
        strength: 1.0,
        motion: Motion::at_rest(DVec3::new(3.0, -4.0, 5.0)),
    }
}

fn setting(gamma: f64, degrees: f64, size: f64) -> Option<Setting> {
    let side = size + 2.0 * MARGIN;
    let axis = DVec3::new(0.36, 0.48, 0.8);
    let beside = DVec3::new(-0.8, 0.6, 0.0);
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let forward = cosine * axis + sine * beside;
    let celerity = Celerity::from_gamma(gamma, axis).ok()?;
    // Pixels as wide as of 720 over 60°.
    let field = 2.0 * (30f64.to_radians().tan() * side / 720.0).atan();
    let view = View {
        aim: Aim::Forward(forward),
        up: axis.cross(beside),
        fov_deg: Some(field.to_degrees()),
        size: [side as u32; 2],
        ..View::default()
    };
    let motion = Motion { celerity, origin: Event::at(-10.0, 10.0 * forward) };
    let mut scene = Scene::new("triangle", Vec::new(), view);
    let camera = scene.camera().ok()?;
    let map = ApparentMap::new(&motion, &camera.observer);
    let corners = CORNERS.map(|(pixel, distance)| {
        let pixel = MARGIN + size * DVec2::from_array(pixel);
        let direction = camera.lens.direction(pixel).unwrap_or(DVec3::Z);
        map.unsee(direction.normalize() * distance).0
    });
    let outline = Outline::new(&motion, &camera, corners)?;
    scene.bodies.push(Body::new("triangle", Mesh::new(&corners, vec![[0, 1, 2]]), motion));
    Some(Setting { scene, camera, outline })
}

/// Error of the outline by rays: by lists of what may be seen where, or through boxes.
fn by_rays(setting: &Setting, make: fn(&Scene) -> Tracer, samples: &[[f64; 2]]) -> f64 {
    let Setting { scene, camera, outline } = setting;
    let Ok(shading) = Shading::within(scene, 0.0, Coloring::Geometry) else { return f64::INFINITY };
    let shading = shading.seen_by(&camera.observer);
    let tracer = make(scene);
    let error = |sample: &[f64; 2]| {
        let mut film = Film::new(0, 0);
        let look = Look { samples: std::slice::from_ref(sample), shading: &shading, paths: Paths::default() };
        tracer.trace(scene, camera, &look, &mut film, |_, _| ());
        outline.error(&film, *sample)
    };
    samples.iter().map(error).fold(0.0, f64::max)
}

/// Error of the outline of the triangle moved to where it is seen and cut.
fn by_cutting(setting: &Setting) -> f64 {
    let options = Options { method: Method::Apparent, coloring: Coloring::Geometry, ..Options::default() };
    match render(&setting.scene, &setting.camera, &options, |_| ()) {
        Ok((film, _)) => setting.outline.error(&film, [0.5; 2]),
        Err(_) => f64::INFINITY,
    }
}

/// What the planner does where a method of these is in question, with and without a lamp.
fn planner(setting: &Setting, methods: &[Method]) -> Planner {
    let lit = Scene { lights: vec![lamp()], ..setting.scene.clone() };
    let of = |scene: &Scene| {
        let (method, _) = cheapest(scene, Coloring::Spectral);
        match methods.contains(&method) {
            false => Planner::Avoids,
            true if lacks_digits(scene, method) => Planner::Warns,
            true => Planner::Enters,
        }
    };
    match [of(&setting.scene), of(&lit)] {
        all if all.contains(&Planner::Enters) => Planner::Enters,
        all if all.contains(&Planner::Warns) => Planner::Warns,
        _ => Planner::Avoids,
    }
}

/// So many samples that some hundreds lie near the outline of a triangle of a size.
fn samples(size: f64, resolution: Resolution) -> Samples {
    let near = if resolution == Resolution::Quick { 100.0 } else { 400.0 };
    Samples::new((near / (3.0 * size)).ceil() as u32)
}

/// One of the ways, in one setting.
fn measured(way: usize, [gamma, degrees, size]: [f64; 3], resolution: Resolution) -> (f64, Planner) {
    let Some(setting) = setting(gamma, degrees, size) else { return (f64::INFINITY, Planner::Enters) };
    let samples = samples(size, resolution);
    match way {
        0 => (
            by_rays(&setting, Tracer::listing, samples.offsets()),
            planner(&setting, &[Method::Exact, Method::Trace]),
        ),
        1 => (
            by_rays(&setting, Tracer::new, samples.offsets()),
            planner(&setting, &[Method::Exact, Method::Trace]),
        ),
        _ => (by_cutting(&setting), planner(&setting, &[Method::Apparent])),
    }
}

pub(super) fn maps(resolution: Resolution) -> Vec<Map> {
    let gammas = resolution.some(&GAMMAS, 7);
    let (angles, sizes) = (resolution.some(&ANGLES, 4), resolution.some(&SIZES, 3));
    let most = number(MOST_GAMMA);
    let lit = format!(
        "above γ = {most} the planner cuts shapes; what needs rays for shadows or mirrors is drawn all the same, and a note says that it is off"
    );
    let cut = format!("taken by itself above γ = {most}, where lines of sight have lost their digits");
    let angle = Axis::of("line of sight to the motion, degrees", angles.clone());
    let size = Axis::of("size of the triangle, px", sizes.clone());
    [
        (0, "exact", "Exact shading, a triangle of 20 px", &angle, &lit),
        (1, "trace", "Ray tracing, a triangle of 20 px", &angle, &lit),
        (2, "cut", "Cut to ¼ px, a triangle of 300 px", &angle, &cut),
        (0, "exact_size", "Exact shading, 30° from the motion", &size, &lit),
        (1, "trace_size", "Ray tracing, 30° from the motion", &size, &lit),
        (2, "cut_size", "Cut to ¼ px, 30° from the motion", &size, &cut),
    ]
    .into_iter()
    .map(|(way, name, title, y, done)| {
        let fixed = if way == 2 { CUT } else { RAYED };
        let cells = cells(&gammas, &y.values, |gamma, value| {
            let (degrees, size) = if name.ends_with("_size") { (ANGLE, *value) } else { (*value, fixed) };
            measured(way, [*gamma, degrees, size], resolution)
        });
        let (errors, planner) = cells.into_iter().unzip();
        let map = Map {
            sheet: "sight",
            name: name.to_owned(),
            title: title.to_owned(),
            x: Axis::of("γ", gammas.clone()),
            y: y.clone(),
            quantity: "error of the outline, px",
            tolerance: 0.25,
            errors,
            conditioning: None,
            planner,
            words: String::new(),
        };
        let failing = (0..map.errors.len()).filter(|&cell| map.fails(cell));
        let what = match failing.map(|cell| gammas[cell % gammas.len()]).reduce(f64::min) {
            Some(gamma) => format!("Fails from γ = {} on", number(gamma)),
            None => "Fails nowhere".to_owned(),
        };
        Map { words: format!("{what}; {done}."), ..map }
    })
    .collect()
}
