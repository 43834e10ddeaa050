//! Triangles moved to where they are seen: as they are, and cut.

use super::map::cells;
use super::outline::Outline;
use super::{Axis, Map, Planner, Resolution};
use crate::apparent::{ApparentMesh, Field, Subdivision};
use crate::color::Coloring;
use crate::film::Samples;
use crate::light::Shading;
use crate::plan::Method;
use crate::raster::{Drawable, shade};
use crate::relativity::{ApparentMap, Motion};
use crate::render::Options;
use crate::scene::{Aim, Body, Mesh, Scene, View};
use glam::DVec3;
use terrell_geodesic::{Celerity, Event};

/// Edges of the triangle, and how far away its middle appears.
const SIZES: [f64; 13] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
const DISTANCES: [f64; 10] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
const SPEEDS: [f64; 2] = [0.9, 0.999];

/// A triangle that faces a camera it passes, in its rest frame, seen abreast; and its corners.
fn scene(size: f64, distance: f64, beta: f64) -> Option<(Scene, [DVec3; 3])> {
    let axis = DVec3::new(0.6, 0.0, 0.8);
    let celerity = Celerity::from_beta(beta * axis).ok()?;
    let forward = DVec3::Y;
    let motion = Motion { celerity, origin: Event::at(-distance, distance * forward) };
    // 360 of 720 pixels over 60°.
    let fov_deg = Some(2.0 * (0.5 * 30f64.to_radians().tan()).atan().to_degrees());
    let view = View { aim: Aim::Forward(forward), fov_deg, size: [360; 2], ..View::default() };
    // As wide as it is deep, turned to where it is seen from, so that at rest it would face the camera.
    let toward = ApparentMap::new(&motion, &terrell_geodesic::Tetrad::of_world(Event::origin()));
    let n = toward.offset_rest(DVec3::ZERO).normalize();
    let right = n.any_orthonormal_vector();
    let up = n.cross(right);
    let corner = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        size / 3f64.sqrt() * (cosine * right + sine * up)
    };
    let corners = [corner(10.0), corner(130.0), corner(250.0)];
    let body = Body::new("triangle", Mesh::new(&corners, vec![[0, 1, 2]]), motion);
    Some((Scene::new("triangle", vec![body], view), corners))
}

/// The error of such a triangle's outline, uncut and cut.
fn errors(size: f64, distance: f64, beta: f64) -> [f64; 2] {
    let failed = [f64::INFINITY; 2];
    let Some((scene, corners)) = scene(size, distance, beta) else { return failed };
    let motion = scene.bodies[0].motion;
    let (Ok(camera), Ok(shading)) = (scene.camera(), Shading::within(&scene, 0.0, Coloring::Geometry)) else {
        return failed;
    };
    let Some(outline) = Outline::new(&motion, &camera, corners) else { return failed };
    let (mesh, map) = (&scene.bodies[0].mesh, ApparentMap::new(&motion, &camera.observer));
    let error = |seen: &ApparentMesh| {
        let drawable = Drawable { body: 0, mesh, map: &map, seen };
        let film = shade(&[drawable], &camera.lens, &Samples::new(1), &shading.seen_by(&camera.observer));
        outline.error(&film, [0.5; 2])
    };
    let how = Subdivision { tolerance: Options::default().tolerance, ..Subdivision::default() };
    let cut = ApparentMesh::new(mesh, &map, &Field::new(&camera.lens), &how);
    [error(&ApparentMesh::linear(mesh, &map)), cut.map_or(f64::INFINITY, |seen| error(&seen))]
}

pub(super) fn maps(resolution: Resolution) -> Vec<Map> {
    let (sizes, distances) = (resolution.some(&SIZES, 4), resolution.some(&DISTANCES, 3));
    let mut maps = Vec::new();
    for beta in SPEEDS {
        let planned = cells(&sizes, &distances, |size, distance| match scene(*size, *distance, beta) {
            Some((scene, _)) => Planner::of(&scene, Method::Apparent),
            None => Planner::Avoids,
        });
        let cells = cells(&sizes, &distances, |size, distance| errors(*size, *distance, beta));
        for (way, (name, title, is_cut, words)) in [
            (
                "uncut",
                "uncut",
                false,
                "Fails where a triangle looks large, whatever its size and distance by themselves. No method draws so what moves.",
            ),
            (
                "cut",
                "cut to ¼ px",
                true,
                "Edges stay within the tolerance asked for, near and far; taken for γ above 10⁵, or where cutting is asked for.",
            ),
        ]
        .into_iter()
        .enumerate()
        {
            maps.push(Map {
                sheet: "cutting",
                name: format!("{name}_{beta}"),
                title: format!("{beta}c, {title}"),
                x: Axis::of("edge of the triangle, lengths", sizes.clone()),
                y: Axis::of("apparent distance, lengths", distances.clone()),
                quantity: "error of the outline, px",
                tolerance: 0.25,
                errors: cells.iter().map(|errors| errors[way]).collect(),
                conditioning: None,
                planner: if is_cut { planned.clone() } else { vec![Planner::Avoids; cells.len()] },
                words: words.to_owned(),
            });
        }
    }
    maps
}
