//! Doppler factors worked out at vertices and interpolated between, against those of every pixel.

use super::{Axis, Map, Planner, Resolution};
use crate::apparent::{ApparentMesh, Field, Subdivision};
use crate::color::Coloring;
use crate::film::{Film, Samples};
use crate::light::{DopplerAt, Shading};
use crate::raster::{Drawable, shade};
use crate::relativity::{ApparentMap, Motion};
use crate::render::Options;
use crate::scene::{Aim, Body, Mesh, Scene, View};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::iter::zip;
use terrell_geodesic::{Celerity, Event};

/// How large the triangle looks, degrees.
const ANGLES: [f64; 12] = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0, 15.0, 25.0, 40.0, 60.0, 80.0];
const BETAS: [f64; 11] = [0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.99, 0.999];

/// The greatest relative error of the light of all wavelengths together, D⁴, over a triangle that is seen so large, abreast:
/// of one that is not cut, and of one that is.
fn errors(degrees: f64, beta: f64) -> [f64; 2] {
    let failed = [f64::INFINITY; 2];
    let Ok(celerity) = Celerity::from_beta(beta * DVec3::new(0.6, 0.0, 0.8)) else { return failed };
    let motion = Motion { celerity, origin: Event::at(-10.0, 10.0 * DVec3::Y) };
    const SIDE: f64 = 200.0;
    let view = View {
        aim: Aim::Forward(DVec3::Y),
        fov_deg: Some(degrees),
        size: [SIDE as u32; 2],
        ..View::default()
    };
    let mut scene = Scene::new("triangle", Vec::new(), view);
    let Ok(camera) = scene.camera() else { return failed };
    let map = ApparentMap::new(&motion, &camera.observer);
    // As large as the picture.
    let corner = |x: f64, y: f64| {
        let direction = camera.lens.direction(DVec2::new(x, y) * SIDE).unwrap_or(DVec3::Z);
        map.unsee(direction.normalize() * 10.0).0
    };
    let corners = [corner(0.02, 0.05), corner(0.98, 0.3), corner(0.3, 0.98)];
    scene.bodies.push(Body::new("triangle", Mesh::new(&corners, vec![[0, 1, 2]]), motion));
    let Ok(shading) = Shading::within(&scene, celerity.rapidity(), Coloring::Bolometric) else {
        return failed;
    };
    let mesh = &scene.bodies[0].mesh;
    let draw = |seen: &ApparentMesh, at: DopplerAt| -> Film {
        let drawable = Drawable { body: 0, mesh, map: &map, seen };
        let shading = shading.clone().with_doppler_at(at);
        shade(&[drawable], &camera.lens, &Samples::new(1), &shading.seen_by(&camera.observer))
    };
    let error = |seen: &ApparentMesh| {
        let [vertices, pixels] = [DopplerAt::Vertex, DopplerAt::Pixel].map(|at| draw(seen, at));
        let relative = |(a, b): (&[f32; 3], &[f32; 3])| (f64::from(a[0]) / f64::from(b[0]) - 1.0).abs();
        let seen = |((_, b), body): &((&[f32; 3], &[f32; 3]), &i32)| **body >= 0 && b[0] > 0.0;
        let all =
            zip(zip(&vertices.color, &pixels.color), &pixels.body).filter(seen).map(|(c, _)| relative(c));
        all.reduce(f64::max).unwrap_or(f64::INFINITY)
    };
    let how = Subdivision { tolerance: Options::default().tolerance, ..Subdivision::default() };
    let cut = ApparentMesh::new(mesh, &map, &Field::new(&camera.lens), &how);
    [error(&ApparentMesh::linear(mesh, &map)), cut.map_or(f64::INFINITY, |seen| error(&seen))]
}

pub(super) fn maps(resolution: Resolution) -> Vec<Map> {
    let (angles, betas) = (resolution.some(&ANGLES, 4), resolution.some(&BETAS, 4));
    let cells: Vec<[f64; 2]> = (0..angles.len() * betas.len())
        .into_par_iter()
        .map(|cell| errors(angles[cell % angles.len()], betas[cell / angles.len()]))
        .collect();
    let planner = match Options::default().doppler_at {
        DopplerAt::Vertex => Planner::Enters,
        DopplerAt::Pixel => Planner::Avoids,
    };
    [
        (
            "uncut",
            "the mesh's own triangles",
            "Fails where triangles look larger than some degrees and are fast: D⁴ is no straight line.",
        ),
        (
            "cut",
            "cut to ¼ px",
            "Cutting helps, but is for outlines: it stops where those are straight, whatever the light does.",
        ),
    ]
    .into_iter()
    .enumerate()
    .map(|(way, (name, title, what))| Map {
        sheet: "vertices",
        name: name.to_owned(),
        title: format!("D at vertices, {title}"),
        x: Axis::of("size of the triangle, degrees", angles.clone()),
        y: Axis::of("β", betas.clone()),
        quantity: "greatest relative error of the light (D⁴)",
        // A step of eight bits near white.
        tolerance: 0.01,
        errors: cells.iter().map(|errors| errors[way]).collect(),
        conditioning: None,
        planner: vec![planner; cells.len()],
        words: format!(
            "{what} D is worked out in every pixel unless --doppler vertex asks for the paper's way."
        ),
    })
    .collect()
}
