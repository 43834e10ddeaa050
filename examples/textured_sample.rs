//! Writes a textured glTF sample of the kind people download: a ringed globe before a brick wall, a chequered knot beside
//! it, four nodes with a picture each, some 70 000 triangles. To try with it:
//!
//! ```sh
//! cargo run --release --example textured_sample -- sample.glb
//! cargo run --release -- render sample.glb --beta 0.9
//! ```

use glam::{DVec2, DVec3};
use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use terrell::geodesic::{Celerity, Event};
use terrell::relativity::Motion;
use terrell::scene::{Aim, Body, Material, Mesh, Paint, Picture, Scene, Texture, View};
use terrell::{export, transform};

/// A surface over (u, v) from 0 to 1, in a grid, with a picture on it.
fn surface(
    name: &str,
    [columns, rows]: [u32; 2],
    at: impl Fn(f64, f64) -> DVec3,
    texel: impl Fn(f64, f64) -> [u8; 3],
) -> Body {
    const SIDE: u32 = 512;
    let node = |i: u32, n: u32| f64::from(i) / f64::from(n);
    let grid: Vec<DVec2> = (0..=rows)
        .flat_map(|j| (0..=columns).map(move |i| DVec2::new(node(i, columns), node(j, rows))))
        .collect();
    let corner = |i: u32, j: u32| j * (columns + 1) + i;
    let cell = |k: u32| {
        let (i, j) = (k % columns, k / columns);
        let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| corner(i + x, j + y));
        [[a, b, c], [a, c, d]]
    };
    let vertices: Vec<DVec3> = grid.iter().map(|p| at(p.x, p.y)).collect();
    let texels = (0..SIDE * SIDE).map(|k| texel(node(k % SIDE, SIDE), node(k / SIDE, SIDE))).collect();
    let picture = Picture::new(name, SIDE, SIDE, texels).expect("as many texels as it has places");
    let material = Material {
        name: name.to_owned(),
        base_texture: Some(Texture::of(Arc::new(picture))),
        ..Material::default()
    };
    let mesh = Mesh {
        uv: grid.iter().map(|p| [p.x as f32, p.y as f32]).collect(),
        paint: Paint::Uniform([1.0; 3]),
        materials: vec![material],
        ..Mesh::new(&vertices, (0..columns * rows).flat_map(cell).collect())
    };
    let motion = Motion { celerity: Celerity::at_rest(), origin: Event::origin() };
    Body { name: name.to_owned(), mesh: Arc::new(mesh), motion, clip: None }
}

fn checks(u: f64, v: f64, [columns, rows]: [f64; 2], colors: [[u8; 3]; 2]) -> [u8; 3] {
    colors[((u * columns).floor() + (v * rows).floor()) as usize % 2]
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).unwrap_or_else(|| "sample.glb".into());
    let around = |angle: f64| DVec3::new(angle.cos(), 0.0, -angle.sin());
    let globe = surface(
        "globe",
        [160, 80],
        |u, v| around(TAU * u) * (PI * v).sin() + DVec3::Y * (PI * v).cos(),
        |u, v| {
            let land = (TAU * 2.0 * u).sin() * (TAU * v).cos() + 0.7 * (TAU * (3.0 * u + v)).sin();
            let line = (24.0 * u).fract() < 0.04 || (12.0 * v).fract() < 0.05;
            if line {
                [240; 3]
            } else if land > 0.2 {
                [60, 140, 50]
            } else {
                [25, 60, 160]
            }
        },
    );
    let ring = surface(
        "ring",
        [240, 4],
        |u, v| {
            let flat = around(TAU * u) * (1.35 + 0.6 * v);
            DVec3::new(flat.x, 0.3 * flat.x - 0.35 * flat.z, flat.z)
        },
        |u, v| checks(u, v, [40.0, 4.0], [[230, 200, 150], [150, 110, 70]]),
    );
    // A trefoil.
    let centre = |t: f64| {
        DVec3::new(t.sin() + 2.0 * (2.0 * t).sin(), t.cos() - 2.0 * (2.0 * t).cos(), -(3.0 * t).sin()) * 0.4
    };
    let knot = surface(
        "knot",
        [480, 40],
        |u, v| {
            let t = TAU * u;
            let along = (centre(t + 1e-4) - centre(t - 1e-4)).normalize();
            let out = (centre(t) - centre(t).dot(along) * along).normalize();
            let side = along.cross(out);
            DVec3::new(3.4, 0.0, 0.0) + centre(t) + 0.2 * ((TAU * v).cos() * out + (TAU * v).sin() * side)
        },
        |u, v| checks(u, v, [60.0, 6.0], [[235, 235, 225], [120, 20, 30]]),
    );
    let wall = surface(
        "wall",
        [32, 16],
        |u, v| DVec3::new(10.0 * u - 3.5, 2.5 - 5.0 * v, -2.5),
        |u, v| {
            let row = (16.0 * v).floor();
            let joint = (16.0 * v).fract() < 0.12 || (16.0 * u + 0.5 * (row % 2.0)).fract() < 0.06;
            if joint { [190, 185, 175] } else { [150, 60, 40] }
        },
    );
    // As it is: seen at rest, where it is.
    let bodies = vec![globe, ring, knot, wall];
    let view = View {
        event: Event::at(0.0, DVec3::new(1.5, 0.0, 9.0)),
        aim: Aim::Forward(-DVec3::Z),
        up: DVec3::Y,
        ..View::default()
    };
    let scene = Scene::new("sample", bodies, view);
    let camera = scene.camera()?;
    let options = transform::Options::default();
    let (mut model, report) = transform::transform(&scene, &camera, &[camera.observer], &[0.0], &options)?;
    model.eye = None;
    export::write(&model, path.as_ref())?;
    println!("{}: {} triangles", path.display(), report.triangles);
    Ok(())
}
