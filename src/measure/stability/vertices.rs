//! Doppler factors worked out at vertices and interpolated between, against those of every pixel.

use super::map::cells;
use super::wide::dot;
use super::{Axis, Map, Planner, Resolution};
use crate::apparent::{ApparentMesh, Field, Subdivision};
use crate::color::Coloring;
use crate::film::{Film, Samples};
use crate::light::{DopplerAt, Shading};
use crate::raster::{Drawable, shade};
use crate::relativity::{ApparentMap, Motion};
use crate::render::Options;
use crate::scene::{Aim, Body, Mesh, Paint, Scene, View};
use crate::spectrum::luminance;
use glam::{DVec2, DVec3};
use terrell_geodesic::{Celerity, Event, Real, Wide};

/// How large the triangle looks, degrees.
const ANGLES: [f64; 12] = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0, 15.0, 25.0, 40.0, 60.0, 80.0];
const BETAS: [f64; 11] = [0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.99, 0.999];

/// D in a direction, of 32 digits, rounded: 1/(γ + u·n) for n towards what is seen.
fn exact(celerity: Celerity, direction: DVec3) -> f64 {
    let [u, v] = [celerity.vector(), direction].map(|v| v.to_array().map(Wide::from));
    let length = dot(v, v).sqrt();
    let gamma = (Wide::from(1.0) + dot(u, u)).sqrt();
    (length / (gamma * length + dot(u, v))).value()
}

/// The greatest relative error of the light of all wavelengths together, D⁴, over a triangle that is seen so large, abreast:
/// from D at the vertices of one that is not cut, and of one that is, and from D in every pixel.
fn errors(degrees: f64, beta: f64) -> [f64; 3] {
    let failed = [f64::INFINITY; 3];
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
    // Of light that is not shifted.
    let unshifted = luminance(Paint::CLAY);
    let world = |v: DVec3| {
        let [right, up, forward] = camera.observer.axes();
        v.x * right + v.y * up + v.z * forward
    };
    let error = |seen: &ApparentMesh, at: DopplerAt| {
        let film = draw(seen, at);
        let relative = |i: usize| {
            let pixel = DVec2::new((i % film.width as usize) as f64, (i / film.width as usize) as f64) + 0.5;
            let doppler = exact(celerity, world(camera.lens.direction(pixel).unwrap_or(DVec3::Z)));
            (f64::from(film.color[i][0]) / (f64::from(unshifted) * doppler.powi(4)) - 1.0).abs()
        };
        let seen = (0..film.body.len()).filter(|i| film.body[*i] >= 0);
        seen.map(relative).reduce(f64::max).unwrap_or(f64::INFINITY)
    };
    let how = Subdivision { tolerance: Options::default().tolerance, ..Subdivision::default() };
    let cut = ApparentMesh::new(mesh, &map, &Field::new(&camera.lens), &how);
    let Ok(cut) = cut else { return failed };
    let whole = ApparentMesh::linear(mesh, &map);
    [
        error(&whole, DopplerAt::Vertex),
        error(&cut, DopplerAt::Vertex),
        error(&whole, DopplerAt::Pixel).max(error(&cut, DopplerAt::Pixel)),
    ]
}

pub(super) fn maps(resolution: Resolution) -> Vec<Map> {
    let (angles, betas) = (resolution.some(&ANGLES, 4), resolution.some(&BETAS, 4));
    let cells = cells(&angles, &betas, |angle, beta| errors(*angle, *beta));
    let usual = Options::default().doppler_at;
    [
        (
            "uncut",
            "D at the mesh's own vertices",
            DopplerAt::Vertex,
            "Fails where triangles look larger than some degrees and are fast: D⁴ is no straight line. Taken only for --doppler vertex.",
        ),
        (
            "cut",
            "D at vertices, cut to ¼ px",
            DopplerAt::Vertex,
            "Cutting helps, but is for outlines: it stops where those are straight, whatever the light does. Taken only for --doppler vertex.",
        ),
        ("pixels", "D in every pixel", DopplerAt::Pixel, "Fails nowhere; taken unless --doppler vertex asks for the paper's way."),
    ]
    .into_iter()
    .enumerate()
    .map(|(way, (name, title, at, words))| Map {
        sheet: "vertices",
        name: name.to_owned(),
        title: title.to_owned(),
        x: Axis::of("size of the triangle, degrees", angles.clone()),
        y: Axis::of("β", betas.clone()),
        quantity: "greatest relative error of D⁴",
        // A step of eight bits near white.
        tolerance: 0.01,
        errors: cells.iter().map(|errors| errors[way]).collect(),
        conditioning: None,
        planner: vec![if at == usual { Planner::Enters } else { Planner::Avoids }; cells.len()],
        words: words.to_owned(),
    })
    .collect()
}
