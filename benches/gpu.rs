//! Frame times of exact and apparent shading on a graphics processor, beside the CPU's: globes of 1 k, 100 k and 1 M triangles
//! and scenes that ship, at β = 0.9, with one and nine samples a pixel.
//!
//! `cargo bench --bench gpu` says which device it is; on a software driver the figures say nothing of graphics
//! processors.

#[path = "common/turns.rs"]
mod turns;

use glam::DVec3;
use std::time::Instant;
use terrell::film::Film;
use terrell::geodesic::{Celerity, Event};
use terrell::plan::Method;
use terrell::raster::gpu::Gpu;
use terrell::relativity::Motion;
use terrell::render::{Options, Raster, render_again};
use terrell::scene::{Aim, Body, Mesh, Scene, View, builtin_scene};
use turns::median_seconds;

const REPEATS: usize = 7;

/// Rings of a globe, twice as many around as from pole to pole: 4 n² triangles, less the poles.
fn globe(latitudes: u32) -> Scene {
    let around = 2 * latitudes;
    let angle = |i: u32, n: u32| f64::from(i) * std::f64::consts::TAU / f64::from(n);
    let vertex = |i: u32, j: u32| {
        let ((polar, height), (y, x)) = (angle(i, around).sin_cos(), angle(j, around).sin_cos());
        DVec3::new(polar * x, polar * y, height)
    };
    let vertices: Vec<_> = (0..=latitudes).flat_map(|i| (0..around).map(move |j| vertex(i, j))).collect();
    let at = |i: u32, j: u32| i * around + j % around;
    let square = |i: u32, j: u32| {
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    };
    let triangles = (0..latitudes).flat_map(|i| (0..around).flat_map(move |j| square(i, j))).collect();
    let celerity = Celerity::from_beta(DVec3::X * 0.9).expect("slower than light");
    let motion = Motion { celerity, origin: Event::at(0.0, DVec3::Y * 4.0) };
    let view = View { aim: Aim::Forward(DVec3::Y), ..View::default() };
    Scene::new("globe", vec![Body::new("globe", Mesh::new(&vertices, triangles), motion)], view)
}

/// Median milliseconds of a frame, what is done once a scene aside.
fn frame_ms(scene: &Scene, options: &Options) -> f64 {
    let camera = scene.camera().expect("there is a camera");
    let prepared = options.prepare(scene, [&camera]).unwrap_or_else(|e| panic!("{e}"));
    let mut film = Film::new(0, 0);
    let mut draw =
        || _ = render_again(scene, &camera, options, &prepared, &mut film, |_| ()).expect("it is drawn");
    1e3 * median_seconds(REPEATS, [&mut draw])[0]
}

fn main() {
    let start = Instant::now();
    match Gpu::shared() {
        Ok(gpu) => println!("{}, opened in {:.0} ms", gpu.name(), start.elapsed().as_secs_f64() * 1e3),
        Err(e) => return println!("{e}"),
    }
    let mut scenes: Vec<_> = [16, 158, 500].map(globe).into();
    scenes.extend(["gate", "lattice", "street"].map(|name| builtin_scene(name).expect("it ships").scene()));
    println!("ms a frame                              exact: GPU    CPU   apparent: GPU    CPU");
    for scene in &mut scenes {
        let triangles = scene.triangle_count();
        for (size, samples) in [([1280, 720], 1), ([1280, 720], 9), ([3840, 2160], 1)] {
            scene.view.size = size;
            let ms =
                |method, raster| frame_ms(scene, &Options { method, raster, samples, ..Options::default() });
            let [exact, apparent] = [Method::Exact, Method::Apparent]
                .map(|method| [Raster::Wgpu, Raster::Cpu].map(|raster| ms(method, raster)));
            println!(
                "{:8} {triangles:8} {:4}x{:<4} x{samples}          {:8.1} {:8.1}      {:8.1} {:8.1}",
                scene.name, size[0], size[1], exact[0], exact[1], apparent[0], apparent[1]
            );
        }
    }
}
