//! How fast rays are: millions a second on one core, from the camera and to a lamp, with and without AVX2, on the gate
//! and on spheres of triangles, all moving at 0.9c.
//!
//! `cargo bench --bench tracing`

use glam::DVec3;
use std::time::Instant;
use terrell::color::Coloring;
use terrell::film::{Film, Samples};
use terrell::geodesic::{Celerity, Event, Tetrad};
use terrell::light::Shading;
use terrell::relativity::Motion;
use terrell::scene::{Body, Camera, Lens, Light, LightKind, Mesh, Projection, Scene, View, shapes};
use terrell::spectrum::Spectrum;
use terrell::trace::{Look, Paths, Tracer};

const REPEATS: usize = 7;

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

fn median_seconds(mut run: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..REPEATS)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[REPEATS / 2]
}

fn main() {
    let lens = Lens::new(Projection::Pinhole, 45.0, 1280, 720).unwrap();
    let celerity = Celerity::from_beta(DVec3::X * 0.9).unwrap();
    let motion = Motion { celerity, origin: Event::new(-3.0, 0.0, 3.0, 0.0) };
    let observer = Tetrad::new(Event::origin(), Celerity::at_rest(), DVec3::Y, DVec3::Z).unwrap();
    let camera = Camera { observer, lens };
    let samples = Samples::new(1);
    let lamp = Light {
        name: "lamp".into(),
        kind: LightKind::Point { position: DVec3::new(1.0, -1.0, 2.0) },
        color: [1.0; 3],
        spectrum: Spectrum::default(),
        strength: 1.0,
        motion: Motion::at_rest(DVec3::ZERO),
    };
    println!("one thread, 1280x720 rays, median of {REPEATS}; M rays/s");
    println!(
        "{:>10} {:>10} | {:>9} {:>9} {:>8} | {:>9} {:>9} | {:>10}",
        "triangles", "build ms", "primary", "base", "hit", "shadow", "base", "picture ms"
    );
    for (name, mesh) in [
        ("cube", shapes::cube()),
        ("gate", shapes::gate()),
        ("", sphere(16)),
        ("", sphere(158)),
        ("", sphere(500)),
    ] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| {
            let label = if name.is_empty() { mesh.triangles.len().to_string() } else { name.to_owned() };
            let mut scene = Scene::new("s", vec![Body::new("m", mesh.clone(), motion)], View::default());
            let start = Instant::now();
            let tracer = Tracer::new(&scene);
            let build = start.elapsed().as_secs_f64() * 1e3;
            let base = tracer.clone().without_vectors();
            let luminous = Shading::new(&scene, [&observer], Coloring::Geometry).unwrap();
            scene.lights.push(lamp.clone());
            let lit = Shading::new(&scene, [&observer], Coloring::Geometry).unwrap();
            let (luminous, lit) = (luminous.seen_by(&observer), lit.seen_by(&observer));
            let mut primary = [0.0; 2];
            let mut shadow = [0.0; 2];
            for (i, tracer) in [&tracer, &base].into_iter().enumerate() {
                let count = tracer.cast(&scene, &camera, samples.offsets(), &luminous).primary as f64;
                let seconds = median_seconds(|| {
                    tracer.cast(&scene, &camera, samples.offsets(), &luminous);
                });
                primary[i] = count / seconds * 1e-6;
                let count = tracer.cast(&scene, &camera, samples.offsets(), &lit).shadow as f64;
                let both = median_seconds(|| {
                    tracer.cast(&scene, &camera, samples.offsets(), &lit);
                });
                shadow[i] = count / (both - seconds) * 1e-6;
            }
            let mut film = Film::new(0, 0);
            let look = Look { samples: samples.offsets(), shading: &luminous, paths: Paths::default() };
            let picture = median_seconds(|| {
                tracer.trace(&scene, &camera, &look, &mut film, |_, _| ());
            });
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
