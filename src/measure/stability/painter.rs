//! The painter's algorithm where bodies reach into each other.

use super::map::cells;
use super::{Axis, Map, Planner, Resolution};
use crate::color::Coloring;
use crate::film::Film;
use crate::measure::{Comparison, Reference};
use crate::plan::Method;
use crate::relativity::Motion;
use crate::render::{Options, Raster, render};
use crate::scene::{Aim, Body, Mesh, Scene, View};
use glam::{DQuat, DVec3};
use terrell_geodesic::{Celerity, Event};

/// How much of a plank is beyond the other, which it goes through; below 0, short of it.
const DEPTHS: [f64; 11] = [-0.2, -0.1, -0.05, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5];
const BETAS: [f64; 9] = [0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.99, 0.999];

/// A plank, turned.
fn plank(turn: DQuat, middle: DVec3) -> Mesh {
    let side = |i: usize, bit: usize| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
    let size = DVec3::new(LENGTH, 0.1, 1.2);
    let corners: Vec<DVec3> =
        (0..8).map(|i| middle + turn * (size * DVec3::new(side(i, 0), side(i, 1), side(i, 2)))).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh::new(&corners, faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect())
}

const LENGTH: f64 = 3.0;

/// Two planks in one motion, seen as they pass: an X from above, if one is far enough in the other.
fn scene(depth: f64, beta: f64) -> Option<Scene> {
    let turns = [0.6, -0.6].map(|angle| DQuat::from_rotation_z(angle) * DQuat::from_rotation_x(0.3));
    let celerity = Celerity::from_beta(beta * DVec3::X).ok()?;
    let motion = Motion { celerity, origin: Event::at(-4.0, 4.0 * DVec3::Y) };
    // The second's end is so far beyond the first's middle.
    let places = [DVec3::ZERO, turns[1] * DVec3::X * LENGTH * (0.5 - depth)];
    let bodies = (0..2).map(|i| Body::new(["one", "two"][i], plank(turns[i], places[i]), motion)).collect();
    let view = View { aim: Aim::Forward(DVec3::Y), size: [320, 240], ..View::default() };
    Some(Scene::new("planks", bodies, view))
}

/// Of the pixels that see a body, the share of those that see another one than rays do, more than a pixel off: by the
/// painter, and by the z-buffer.
fn shares(depth: f64, beta: f64) -> Option<[f64; 2]> {
    let scene = scene(depth, beta)?;
    let camera = scene.camera().ok()?;
    let draw = |method, raster| -> Option<Film> {
        let options = Options { method, raster, coloring: Coloring::Geometry, ..Options::default() };
        render(&scene, &camera, &options, |_| ()).ok().map(|(film, _)| film)
    };
    let exact = draw(Method::Exact, Raster::Cpu)?;
    let covered = exact.covered().max(1) as f64;
    let reference = Reference::from(exact);
    let share = |raster| {
        let film = draw(Method::Apparent, raster)?;
        let silhouette = Comparison::new(&reference, &film).ok()?.whole.silhouette?;
        Some(silhouette.beyond as f64 / covered)
    };
    Some([share(Raster::Skia)?, share(Raster::Cpu)?])
}

/// What is done with each of the scenes, by the raster that is usual for polygons or by another.
fn planned(depths: &[f64], betas: &[f64], usual: bool) -> Vec<Planner> {
    cells(depths, betas, |depth, beta| match scene(*depth, *beta) {
        Some(scene) if usual => Planner::of(&scene, Method::Apparent),
        _ => Planner::Avoids,
    })
}

pub(super) fn maps(resolution: Resolution) -> Vec<Map> {
    let (depths, betas) = (resolution.some(&DEPTHS, 4), resolution.some(&BETAS, 3));
    let shares = |depth: &f64, beta: &f64| shares(*depth, *beta).unwrap_or([f64::INFINITY; 2]);
    let cells = cells(&depths, &betas, shares);
    let usual = Options::default().raster;
    [
        (
            "painter",
            "Painter's algorithm",
            Raster::Skia,
            "Fails as soon as bodies reach into each other: there is no order for two triangles that cross. Never taken by itself, only for --raster skia.",
        ),
        (
            "z_buffer",
            "z-buffer",
            Raster::Cpu,
            "Compares pixel by pixel, and fails nowhere; taken wherever shapes are cut.",
        ),
    ]
    .into_iter()
    .enumerate()
    .map(|(way, (name, title, raster, words))| Map {
        sheet: "painter",
        name: name.to_owned(),
        title: title.to_owned(),
        x: Axis::of("part of a plank beyond the other", depths.clone()),
        y: Axis::of("β", betas.clone()),
        quantity: "share of pixels that see the wrong body",
        // One in a thousand.
        tolerance: 1e-3,
        errors: cells.iter().map(|shares| shares[way]).collect(),
        conditioning: None,
        planner: planned(&depths, &betas, raster == usual),
        words: words.to_owned(),
    })
    .collect()
}
