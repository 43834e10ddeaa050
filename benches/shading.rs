//! Cost of exact and of apparent shading, the latter stage by stage, beside a linear pass (the same z-buffer over the same
//! apparent vertices without cutting), and of rays: spheres of 1 k, 100 k and 1 M triangles at β = 0.9, 1280×720, tolerance ¼ px.
//!
//! `cargo bench --bench shading`; ratios of one run are the result, not the rates. `-- NAME` is for that mesh alone, and
//! nothing else, as for a profile.

#[path = "common/turns.rs"]
mod turns;

use glam::DVec3;
use terrell::apparent::{ApparentMesh, Field, Subdivision};
use terrell::color::Coloring;
use terrell::film::Film;
use terrell::film::Samples;
use terrell::geodesic::{Celerity, Event, Tetrad};
use terrell::light::Shading;
use terrell::raster::{Drawable, paint, shade, shade_again};
use terrell::relativity::{ApparentMap, Motion, Points, PointsMut};
use terrell::scene::{Body, Camera, Lens, Light, LightKind, Material, Mesh, Projection, Scene, View, shapes};
use terrell::spectrum::Spectrum;
use terrell::trace::{Look, Paths, Tracer};
use turns::median_seconds;

const REPEATS: usize = 15;

fn median_ms(mut run: impl FnMut()) -> f64 {
    medians_ms([&mut run])[0]
}

fn sphere(latitudes: u32) -> Mesh {
    // Rings of a globe, twice as many around as from pole to pole: 4 n² triangles, less the poles.
    let around = 2 * latitudes;
    let mut vertices = Vec::new();
    for i in 0..=latitudes {
        for j in 0..around {
            let (theta, phi) = (
                f64::from(i) * std::f64::consts::PI / f64::from(latitudes),
                f64::from(j) * std::f64::consts::TAU / f64::from(around),
            );
            vertices.push(DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..latitudes {
        for j in 0..around {
            let at = |i: u32, j: u32| i * around + j % around;
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Mesh {
        materials: vec![Material { one_sided: true, ..Material::default() }],
        ..Mesh::new(&vertices, triangles)
    }
}

/// Milliseconds of each, in turns.
fn medians_ms<const N: usize>(runs: [&mut dyn FnMut(); N]) -> [f64; N] {
    median_seconds(REPEATS, runs).map(|seconds| 1e3 * seconds)
}

/// The vertices alone, halved until every thread has some.
fn map_alone(map: &ApparentMap, rest: Points<'_, f64>, seen: PointsMut<'_, f64>) {
    if rest.x.len() < 1 << 14 {
        return map.see_all(rest, seen);
    }
    let half = rest.x.len() / 2;
    let ((x, x2), (y, y2), (z, z2)) = (rest.x.split_at(half), rest.y.split_at(half), rest.z.split_at(half));
    let (first, second) = (Points { x, y, z }, Points { x: x2, y: y2, z: z2 });
    let ((x, x2), (y, y2)) = (seen.x.split_at_mut(half), seen.y.split_at_mut(half));
    let ((z, z2), (distance, distance2)) = (seen.z.split_at_mut(half), seen.distance.split_at_mut(half));
    let (doppler, doppler2) = seen.doppler.split_at_mut(half);
    rayon::join(
        || map_alone(map, first, PointsMut { x, y, z, distance, doppler }),
        || map_alone(map, second, PointsMut { x: x2, y: y2, z: z2, distance: distance2, doppler: doppler2 }),
    );
}

fn main() {
    let lens = Lens::new(Projection::Pinhole, 45.0, 1280, 720).unwrap();
    let field = Field::new(&lens);
    let celerity = Celerity::from_beta(DVec3::X * 0.9).unwrap();
    let motion = Motion { celerity, origin: Event::new(-3.0, 0.0, 3.0, 0.0) };
    let observer = Tetrad::new(Event::origin(), Celerity::at_rest(), DVec3::Y, DVec3::Z).unwrap();
    let map = ApparentMap::new(&motion, &observer);
    let how = Subdivision::default();
    let samples = Samples::new(1);
    let all = std::thread::available_parallelism().map_or(1, usize::from);

    println!(
        "ms, median of {REPEATS}, in turns; 'linear' is map + the same z-buffer without cutting; 'once', what is done once a film"
    );
    println!(
        "{:>10} {:>7} {:>9} | {:>7} {:>9} {:>8} {:>8} | {:>8} {:>7} {:>7} {:>6} | {:>7} {:>7} {:>7} {:>7} | {:>7} {:>7}",
        "triangles",
        "threads",
        "pieces",
        "map",
        "map+cut",
        "z-buffer",
        "whole",
        "linear",
        "Mtri/s",
        "Mpx/s",
        "hit",
        "exact",
        "/linear",
        "whole/",
        "once",
        "trace",
        "once"
    );
    let meshes = [
        ("cube", shapes::cube()),
        ("gate", shapes::gate()),
        ("", sphere(16)),
        ("", sphere(158)),
        ("", sphere(500)),
    ];
    let label = |name: &str, mesh: &Mesh| {
        if name.is_empty() { mesh.triangles.len().to_string() } else { name.to_owned() }
    };
    let only = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    for (name, mesh) in
        meshes.iter().filter(|(name, mesh)| only.as_ref().is_none_or(|o| label(name, mesh) == *o))
    {
        for threads in [1, all] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let cut = || ApparentMesh::new(mesh, &map, &field, &how).unwrap();
                let scene = Scene::new("s", vec![Body::new("m", mesh.clone(), motion)], View::default());
                let shading = Shading::new(&scene, [&observer], Coloring::Geometry).unwrap();
                let shading = shading.seen_by(&observer);
                let film = std::cell::RefCell::new(Film::new(lens.width(), lens.height()));
                let draw = |seen: &ApparentMesh| {
                    let bodies = [Drawable { body: 0, mesh, map: &map, seen }];
                    shade_again(&bodies, &lens, &samples, &shading, &mut film.borrow_mut());
                };
                let mut points: [Vec<f64>; 5] = std::array::from_fn(|_| vec![0.0; mesh.vertex_count()]);
                let seen = cut();
                draw(&seen);
                let pixels = film.borrow().body.len() as f64;
                let hit = film.borrow().covered() as f64 / pixels;
                let [exact_once, trace_once] = [|s: &Scene| Tracer::exact(s, Projection::Pinhole, 1), Tracer::new]
                    .map(|make: fn(&Scene) -> Tracer| median_ms(|| drop(make(&scene))));
                let (exact, tracer) = (Tracer::exact(&scene, Projection::Pinhole, 1), Tracer::new(&scene));
                let look = Look { samples: samples.offsets(), shading: &shading, paths: Paths::default() };
                let camera = Camera { observer, lens };
                let follow = |tracer: &Tracer| {
                    tracer.trace(&scene, &camera, &look, &mut film.borrow_mut(), |_, _| ());
                };
                let [map_ms, cut_ms, draw_ms, whole, linear, exact_ms, trace_ms] = medians_ms([
                    &mut || {
                        let [x, y, z, distance, doppler] = &mut points;
                        let rest = Points { x: &mesh.x, y: &mesh.y, z: &mesh.z };
                        map_alone(&map, rest, PointsMut { x, y, z, distance, doppler });
                    },
                    &mut || drop(std::hint::black_box(cut())),
                    &mut || draw(&seen),
                    &mut || draw(&cut()),
                    &mut || draw(&ApparentMesh::linear(mesh, &map)),
                    &mut || follow(&exact),
                    &mut || follow(&tracer),
                ]);
                println!(
                    "{:>10} {threads:>7} {:>9} | {map_ms:>7.2} {cut_ms:>9.2} {draw_ms:>8.2} {whole:>8.2} | {linear:>8.2} {:>7.1} {:>7.1} {:>5.0}% | {:>7.2} {:>7.2} {:>7.2} {:>7.2} | {:>7.2} {:>7.2}",
                    label(name, mesh),
                    seen.triangles.len(),
                    mesh.triangles.len() as f64 / linear / 1e3,
                    pixels / linear / 1e3,
                    100.0 * hit,
                    exact_ms,
                    exact_ms / linear,
                    whole / exact_ms,
                    exact_once,
                    trace_ms,
                    trace_once,
                );
            });
        }
    }

    if only.is_some() {
        return;
    }

    println!(
        "\nms, median of {REPEATS}: which triangle a pixel sees, by z-buffer and by painter, on a new film"
    );
    println!(
        "{:>10} {:>7} {:>9} | {:>8} {:>8} {:>6}",
        "triangles", "threads", "pieces", "z-buffer", "painter", "ratio"
    );
    for (name, mesh) in &meshes {
        let seen = ApparentMesh::new(mesh, &map, &field, &how).unwrap();
        let scene = Scene::new("s", vec![Body::new("m", mesh.clone(), motion)], View::default());
        let shading = Shading::new(&scene, [&observer], Coloring::Geometry).unwrap();
        let shading = &shading.seen_by(&observer);
        for threads in [1, all] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let bodies = [Drawable { body: 0, mesh, map: &map, seen: &seen }];
                let shaded = median_ms(|| drop(shade(&bodies, &lens, &samples, shading)));
                let painted = median_ms(|| drop(paint(&bodies, &lens, &samples, shading).unwrap()));
                println!(
                    "{:>10} {threads:>7} {:>9} | {shaded:>8.2} {painted:>8.2} {:>6.2}",
                    label(name, mesh),
                    seen.triangles.len(),
                    painted / shaded,
                );
            });
        }
    }

    println!(
        "\nms of drawing, median of {REPEATS}, one thread, by what a pixel shows; a sphere of 100 k triangles"
    );
    println!("{:>34} {:>8} {:>8} {:>14}", "", "ms", "ratio", "tables, ms");
    let mesh = sphere(158);
    let seen = ApparentMesh::new(&mesh, &map, &field, &how).unwrap();
    let bodies = [Drawable { body: 0, mesh: &mesh, map: &map, seen: &seen }];
    let dark = Scene::new("s", vec![Body::new("m", mesh.clone(), motion)], View::default());
    let light = |kind| Light {
        name: "light".into(),
        kind,
        color: [1.0; 3],
        spectrum: Spectrum::default(),
        strength: 3.0,
        motion: Motion::at_rest(DVec3::ZERO),
    };
    let distant = LightKind::Distant { direction: DVec3::new(0.3, 0.8, -0.5).normalize() };
    let [lit, near, bath] = [distant, LightKind::Point { position: DVec3::ZERO }, LightKind::Ambient]
        .map(|kind| Scene { lights: vec![light(kind)], ..dark.clone() });
    let ways = [
        ("geometry", &dark, Coloring::Geometry),
        ("doppler", &dark, Coloring::Doppler),
        ("flat", &dark, Coloring::Flat),
        ("spectral", &dark, Coloring::Spectral),
        ("geometry, a distant light", &lit, Coloring::Geometry),
        ("spectral, a distant light", &lit, Coloring::Spectral),
        ("spectral, a lamp", &near, Coloring::Spectral),
        ("spectral, ambient light", &bath, Coloring::Spectral),
    ];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let mut film = Film::new(lens.width(), lens.height());
        let mut plain = None;
        for (name, scene, coloring) in ways {
            let tables = median_ms(|| drop(Shading::new(scene, [&observer], coloring).unwrap()));
            let shading = Shading::new(scene, [&observer], coloring).unwrap();
            let shading = shading.seen_by(&observer);
            let ms = median_ms(|| shade_again(&bodies, &lens, &samples, &shading, &mut film));
            let plain = *plain.get_or_insert(ms);
            let more = 1e6 * (ms - plain) / film.covered() as f64;
            println!("{name:>34} {ms:>8.2} {:>8.2} {tables:>14.2}   {more:+.0} ns a pixel", ms / plain);
        }
    });
}
