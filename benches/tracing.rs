//! How fast rays are: millions a second on one core, from the camera and to a lamp, with and without AVX2, on the gate
//! and on spheres of triangles, one of which has a hole in it, all moving at 0.9c.
//!
//! `cargo bench --bench tracing`, or `-- NAME` for that mesh alone, as for a profile; with `-- --dump DIR` it writes the
//! meshes and the rays for other programs instead (see benches/peers/embree.cpp).

#[path = "common/turns.rs"]
mod turns;

use glam::{DVec2, DVec3};
use std::path::Path;
use std::time::Instant;
use terrell::color::Coloring;
use terrell::film::{Film, Samples};
use terrell::geodesic::{Celerity, Event, Tetrad};
use terrell::light::{Facet, SeenShading, Shading};
use terrell::relativity::{ApparentMap, Motion};
use terrell::scene::{Body, Camera, Lens, Light, LightKind, Mesh, Projection, Scene, View, shapes};
use terrell::spectrum::Spectrum;
use terrell::trace::{Look, Paths, Tracer};
use turns::median_seconds;

const REPEATS: usize = 15;

/// A ball of radius 1 of n × 2n rectangles, cut in two.
fn sphere(n: usize) -> Mesh {
    let mut vertices = Vec::new();
    for i in 0..=n {
        let theta = std::f64::consts::PI * i as f64 / n as f64;
        for j in 0..2 * n {
            let phi = std::f64::consts::PI * j as f64 / n as f64;
            vertices.push(DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()));
        }
    }
    let at = |i: usize, j: usize| (i * 2 * n + j % (2 * n)) as u32;
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..2 * n {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Mesh::new(&vertices, triangles)
}

/// NAME.mesh: three corners a triangle. NAME.primary, NAME.shadow: origin, direction and length of every ray, tile by tile.
/// All f32, in the rest frame.
fn write_rays(
    folder: &Path,
    name: &str,
    scene: &Scene,
    camera: &Camera,
    tracer: &Tracer,
    luminous: &SeenShading<'_>,
    lit: &SeenShading<'_>,
) -> std::io::Result<()> {
    let bytes = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let vector = |v: DVec3| v.as_vec3().to_array();
    let mesh = &scene.bodies[0].mesh;
    let corners: Vec<f32> =
        (0..mesh.triangles.len()).flat_map(|t| mesh.corners(t)).flat_map(vector).collect();
    std::fs::write(folder.join(format!("{name}.mesh")), bytes(&corners))?;
    let samples = Samples::new(1);
    let mut film = Film::new(0, 0);
    let look = Look { samples: samples.offsets(), shading: luminous, paths: Paths::default() };
    tracer.trace(scene, camera, &look, &mut film, |_, _| ());
    let map = ApparentMap::new(&scene.bodies[0].motion, &camera.observer);
    let (sky, eye) = (map.rest_sky(), map.observer_rest());
    let [mut primary, mut shadow] = [vec![], vec![]];
    let lens = &camera.lens;
    for (top, left) in
        (0..lens.height()).step_by(8).flat_map(|y| (0..lens.width()).step_by(8).map(move |x| (y, x)))
    {
        for (y, x) in (top..top + 8).flat_map(|y| (left..left + 8).map(move |x| (y, x))) {
            let v = lens.direction(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).unwrap();
            let v_rest = map.rotate_back(sky.boosted_direction(v, v.length()));
            primary.extend(vector(eye).into_iter().chain(vector(v_rest)).chain([f32::INFINITY]));
            let i = (y * lens.width() + x) as usize;
            if film.body[i] < 0 {
                continue;
            }
            let facet =
                Facet::new(mesh, film.face[i] as usize, mesh.corners(film.face[i] as usize).map(|c| c - eye));
            let normal = facet.normal();
            let at = v_rest * (normal.dot(facet.corners()[0]) / normal.dot(v_rest));
            if let Some(approach) = lit.approach(0, 0, &facet.point(at)) {
                shadow.extend(vector(eye + at).into_iter().chain(vector(approach.back.xyz())).chain([1.0]));
            }
        }
    }
    std::fs::write(folder.join(format!("{name}.primary")), bytes(&primary))?;
    std::fs::write(folder.join(format!("{name}.shadow")), bytes(&shadow))
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let dump = arguments.iter().position(|a| a == "--dump").map(|i| Path::new(&arguments[i + 1]).to_owned());
    let lens = Lens::new(Projection::Pinhole, 45.0, 1280, 720).unwrap();
    let celerity = Celerity::from_beta(DVec3::X * 0.9).unwrap();
    let motion = Motion { celerity, origin: Event::new(-3.0, 0.0, 3.0, 0.0) };
    let observer = Tetrad::new(Event::origin(), Celerity::at_rest(), DVec3::Y, DVec3::Z).unwrap();
    let camera = Camera { observer, lens };
    let samples = Samples::new(1);
    let lamp = Light {
        name: "lamp".into(),
        // At rest beside the body, near where the camera is then, so that nearly all that is seen faces it.
        kind: LightKind::Point {
            position: ApparentMap::new(&motion, &observer).observer_rest() + DVec3::new(0.3, -0.2, 0.4),
        },
        color: [1.0; 3],
        spectrum: Spectrum::default(),
        strength: 1.0,
        motion,
    };
    // Not closed, which makes rays to lamps slower.
    let mut open = sphere(158);
    open.triangles.pop();
    println!("one thread, 1280x720 rays, median of {REPEATS}, in turns; M rays/s");
    println!(
        "{:>10} {:>10} | {:>9} {:>9} {:>8} | {:>9} {:>9} | {:>10}",
        "triangles", "build ms", "primary", "base", "hit", "shadow", "base", "picture ms"
    );
    for (name, mesh) in [
        ("cube", shapes::cube()),
        ("gate", shapes::gate()),
        ("", sphere(16)),
        ("", sphere(158)),
        ("open", open),
        ("", sphere(500)),
    ] {
        let label = if name.is_empty() { mesh.triangles.len().to_string() } else { name.to_owned() };
        if dump.is_none() && arguments[1..].iter().any(|a| !a.starts_with('-') && *a != label) {
            continue;
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| {
            let mut scene = Scene::new("s", vec![Body::new("m", mesh.clone(), motion)], View::default());
            let start = Instant::now();
            let tracer = Tracer::new(&scene);
            let build = start.elapsed().as_secs_f64() * 1e3;
            let base = tracer.clone().without_vectors();
            let luminous = Shading::new(&scene, [&observer], Coloring::Geometry).unwrap();
            scene.lights.push(lamp.clone());
            let lit = Shading::new(&scene, [&observer], Coloring::Geometry).unwrap();
            let (luminous, lit) = (luminous.seen_by(&observer), lit.seen_by(&observer));
            if let Some(folder) = &dump {
                write_rays(folder, &label, &scene, &camera, &tracer, &luminous, &lit).unwrap();
                return;
            }
            let cast = |tracer: &Tracer, shading: &SeenShading<'_>| {
                tracer.cast(&scene, &camera, samples.offsets(), shading)
            };
            let count = cast(&tracer, &lit);
            let mut film = Film::new(0, 0);
            let look = Look { samples: samples.offsets(), shading: &luminous, paths: Paths::default() };
            let [seconds, base_seconds, both, base_both, picture] = median_seconds(
                REPEATS,
                [
                    &mut || _ = cast(&tracer, &luminous),
                    &mut || _ = cast(&base, &luminous),
                    &mut || _ = cast(&tracer, &lit),
                    &mut || _ = cast(&base, &lit),
                    &mut || _ = tracer.trace(&scene, &camera, &look, &mut film, |_, _| ()),
                ],
            );
            let rates = |count: u64, seconds: [f64; 2]| seconds.map(|s| count as f64 / s * 1e-6);
            let primary = rates(count.primary, [seconds, base_seconds]);
            let shadow = rates(count.shadow, [both - seconds, base_both - base_seconds]);
            println!(
                "{label:>10} {build:>10.0} | {:>9.1} {:>9.1} {:>7.0}% | {:>9.1} {:>9.1} | {:>10.1}",
                primary[0],
                primary[1],
                100.0 * film.covered() as f64 / film.body.len() as f64,
                shadow[0],
                shadow[1],
                1e3 * picture
            );
        });
    }
}
