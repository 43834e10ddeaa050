//! Traced light against closed forms: shadows to a millionth of a radian, furnaces, mirrors in motion, luminous bodies as
//! lamps, light from everywhere.

mod common;
#[path = "common/scene_json.rs"]
mod scene_json;

use common::{Random, cases, reference, vec3};
use glam::{DAffine3, DQuat, DVec2, DVec3};
use serde_json::Value;
use terrell::color::Coloring;
use terrell::film::Film;
use terrell::geodesic::{Celerity, Event};
use terrell::plan::Method;
use terrell::relativity::Motion;
use terrell::render::{Options, Report, render};
use terrell::scene::{
    Aim, Body, Gloss, Light, LightKind, Material, Mesh, Paint, Picture, Scene, Sky, SkyTexture, Surface,
    View, builtin_scene, parse_scene, shapes,
};
use terrell::spectrum::{Shape, Spectrum, luminance};
use terrell::trace::Paths;

fn traced(scene: &Scene, coloring: Coloring, samples: u32, bounces: u32) -> (Film, Report) {
    let paths = Paths { bounces, seed: 7 };
    let options = Options { method: Method::Trace, coloring, samples, paths, ..Options::default() };
    render(scene, &scene.camera().unwrap(), &options, |_| ()).unwrap()
}

/// Around a corner of a shadow, as large a part of every circle is lit, however small: the reference counted it at 2·10⁻⁴
/// rad, and here it is counted at 10⁻⁶, where a corner that is off by that would have all of it, none, or half.
#[test]
fn shadow_corners() {
    let cases = cases();
    let mut corners_seen = 0;
    for row in cases["shadow_corners"]["rows"].as_array().unwrap() {
        let name = row["scene"].as_str().unwrap();
        let json: Value = serde_json::from_str(
            &std::fs::read_to_string(reference(&format!("scenes/{name}.json"))).unwrap(),
        )
        .unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = scene_json::write_scene(&json, folder.path()).unwrap();
        let scene = parse_scene(&std::fs::read_to_string(&path).unwrap(), &path).unwrap();
        for corner in row["corners"].as_array().unwrap() {
            if corner["visible_shadow_corner"] != true {
                continue;
            }
            let mut scene = scene.clone();
            scene.view.aim = Aim::Forward(vec3(&corner["n"]));
            let side = 96;
            scene.view.size = [side; 2];
            // The circle is 40 pixels wide.
            scene.view.fov_deg = Some((1e-6 * f64::from(side) / 40.0).to_degrees());
            let (film, _) = traced(&scene, Coloring::Flat, 1, 0);
            let count = 960;
            let lit = (0..count)
                .filter(|i| {
                    let angle = std::f64::consts::TAU * f64::from(*i) / f64::from(count);
                    let at = DVec2::splat(48.0) + 40.0 * DVec2::from_angle(angle);
                    film.color[at.y as usize * side as usize + at.x as usize][0] > 0.0
                })
                .count();
            let fraction = lit as f64 / f64::from(count);
            let expected = corner["lit_fraction_nearby"].as_f64().unwrap();
            // Edges are counted to one in 48 there, and to a pixel of 251 around here; there may be two.
            assert!((fraction - expected).abs() < 2.0 / 48.0, "{name} {corner}: {fraction}");
            corners_seen += 1;
        }
    }
    assert!(corners_seen >= 6, "{corners_seen}");
}

fn material(color: [f32; 3], emission: [f32; 3], gloss: Gloss) -> Material {
    Material { base_color: color, emission, surface: Surface::Lit, gloss, ..Material::default() }
}

fn of(mut mesh: Mesh, material: Material) -> Mesh {
    mesh.paint = Paint::Uniform([1.0; 3]);
    mesh.clay = false;
    mesh.material = Vec::new();
    mesh.materials = vec![material];
    mesh
}

fn moving(beta: DVec3, origin: Event<terrell::geodesic::World>) -> Motion {
    Motion { celerity: Celerity::from_beta(beta).unwrap(), origin }
}

/// A picture's mean of what is seen over what is expected there, and how uncertain it is.
fn mean_ratio(film: &Film, expected: impl Fn(usize) -> f64) -> (f64, f64) {
    let ratios: Vec<f64> = (0..film.body.len())
        .filter(|&i| film.body[i] >= 0)
        .map(|i| f64::from(luminance(film.color[i])) / expected(i))
        .collect();
    let n = ratios.len() as f64;
    assert!(n > 100.0, "{n}");
    let mean = ratios.iter().sum::<f64>() / n;
    let variance = ratios.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Within four standard deviations; one picture in 16 000 would fail by chance, and the seed is fixed.
fn agrees((mean, uncertain): (f64, f64), what: &str) {
    println!("{what}: {mean:.5} ± {uncertain:.5}");
    assert!((mean - 1.0).abs() < 4.0 * uncertain + 1e-6, "{what}: {mean} ± {uncertain}");
    assert!(uncertain < 0.02, "{what}: {uncertain}");
}

/// Within a closed box whose walls shine and reflect, light is everywhere the same: 1 + ρ + ρ² + … of what they give off. Seen
/// from a camera in motion in it, it goes with the power of D that is counted.
#[test]
fn white_furnace() {
    const RHO: f64 = 0.5;
    for (coloring, power) in [(Coloring::Geometry, 0), (Coloring::Flat, 3), (Coloring::Bolometric, 4)] {
        for beta in [0.0, 0.8] {
            for bounces in [1, 5] {
                let walls = of(
                    shapes::cube().placed(&DAffine3::from_scale(DVec3::new(4.0, 3.0, 2.0))),
                    material([RHO as f32; 3], [1.0; 3], Gloss::default()),
                );
                let motion = moving(DVec3::new(beta, 0.0, 0.1 * beta), Event::origin());
                let view = View { size: [96, 72], fov_deg: Some(100.0), ..View::default() };
                let scene = Scene::new("furnace", vec![Body::new("walls", walls, motion)], view);
                // One sample, at the pixel's centre, where the film's Doppler factor is.
                let (film, _) = traced(&scene, coloring, 1, bounces);
                let whole = (1.0 - RHO.powi(bounces as i32 + 1)) / (1.0 - RHO);
                let seen = mean_ratio(&film, |i| whole * f64::from(film.doppler[i]).powi(power));
                agrees(seen, &format!("{coloring} at {beta}, {bounces} reflections"));
                // Everywhere: part by part of the picture.
                for part in 0..12 {
                    let is_in = |i: usize| i % 96 / 24 + 4 * (i / 96 / 24) == part;
                    let of_part = Film {
                        body: (0..film.body.len()).map(|i| film.body[i] | -i32::from(!is_in(i))).collect(),
                        ..film.clone()
                    };
                    let (mean, uncertain) =
                        mean_ratio(&of_part, |i| whole * f64::from(film.doppler[i]).powi(power));
                    assert!((mean - 1.0).abs() < 5.0 * uncertain + 1e-6, "part {part}: {mean} ± {uncertain}");
                }
            }
        }
    }
}

/// A matt plate in motion within a luminous box at rest is lit as by light from everywhere, whose sums over the sky are tested
/// elsewhere: spectra too.
#[test]
fn light_of_a_box_is_light_from_everywhere() {
    for coloring in [Coloring::Geometry, Coloring::Flat, Coloring::Bolometric, Coloring::Spectral] {
        for beta in [DVec3::ZERO, DVec3::new(0.6, 0.0, 0.0), DVec3::new(0.0, -0.4, 0.5)] {
            let plate = of(
                shapes::plate().placed(&DAffine3::from_rotation_translation(
                    DQuat::from_rotation_x(1.2),
                    DVec3::new(0.0, 0.0, 0.0),
                )),
                material([0.9, 0.6, 0.3], [0.0; 3], Gloss::default()),
            );
            let plate = Body::new("plate", plate, moving(beta, Event::at(-5.0, DVec3::new(0.0, 5.0, 0.0))));
            let spectrum = Spectrum::of(Shape::BlackBody { kelvin: 5000.0 });
            let view = View { size: [24, 18], fov_deg: Some(4.0), ..View::default() };
            let mut scene = Scene::new("bath", vec![plate], view);
            scene.lights.push(Light {
                name: "everywhere".into(),
                kind: LightKind::Ambient,
                color: [1.0; 3],
                spectrum: spectrum.clone(),
                strength: 1.0,
                motion: Motion::at_rest(DVec3::ZERO),
            });
            let (direct, _) = traced(&scene, coloring, 1, 0);
            // The same light, where rays that leave find it.
            let (escaped, _) = traced(&scene, coloring, 40, 1);
            let lit = |film: &Film| {
                let color = |c: usize| {
                    let of_plate = film.body.iter().zip(&film.color).filter(|(b, _)| **b == 0);
                    of_plate.map(|(_, color)| f64::from(color[c])).sum::<f64>()
                };
                [color(0), color(1), color(2)]
            };
            let expected = lit(&direct);
            let close = |got: [f64; 3], what: &str| {
                let whole = expected.iter().copied().fold(0.0, f64::max);
                println!("{coloring} {beta} {what}: {got:?} {expected:?}");
                for c in 0..3 {
                    // Some 4000 paths, each off by less than what it is; tables of sums are good to 3·10⁻⁴.
                    assert!(
                        (got[c] - expected[c]).abs() < 0.03 * whole,
                        "{coloring} {beta} {what}: {got:?} {expected:?}"
                    );
                }
            };
            close(lit(&escaped), "escaping");
            scene.lights.clear();
            let luminous = Material {
                surface: Surface::Luminous,
                spectrum,
                ..material([1.0; 3], [0.0; 3], Gloss::default())
            };
            let walls = of(shapes::cube().placed(&DAffine3::from_scale(DVec3::splat(60.0))), luminous);
            scene.bodies.push(Body::new("walls", walls, Motion::at_rest(DVec3::ZERO)));
            let (walled, _) = traced(&scene, coloring, 40, 1);
            close(lit(&walled), "walls");
        }
    }
}

/// A small ball that shines lights a floor as a lamp of its radiance times its cross-section does, in motion, too: a luminous
/// body is an area light, and its light is beamed and aberrated.
#[test]
fn a_small_luminous_ball_is_a_lamp() {
    const RADIUS: f64 = 0.02;
    for beta in [DVec3::ZERO, DVec3::new(0.6, 0.0, 0.0), DVec3::new(-0.5, 0.3, 0.4)] {
        // Without shifts, a lamp in motion lights by its own distance, a body by how large it is seen: not the same.
        for coloring in [Coloring::Flat, Coloring::Bolometric] {
            let wide = shapes::plate().placed(&DAffine3::from_scale(DVec3::splat(30.0)));
            let floor = of(wide, material([0.8; 3], [0.0; 3], Gloss::default()));
            let floor = Body::new("floor", floor, Motion::at_rest(DVec3::new(0.0, 3.0, -1.0)));
            let motion = moving(beta, Event::at(-3.0, DVec3::new(0.0, 3.0, 1.0)));
            let view =
                View { size: [40, 30], aim: Aim::LookAt(DVec3::new(0.0, 3.0, -1.0)), ..View::default() };
            let mut scene = Scene::new("lamp", vec![floor], view);
            let area = std::f64::consts::PI * RADIUS * RADIUS;
            scene.lights.push(Light {
                name: "lamp".into(),
                kind: LightKind::Point { position: DVec3::ZERO },
                color: [1.0; 3],
                spectrum: Spectrum::default(),
                strength: 100.0 * area,
                motion,
            });
            let (expected, _) = traced(&scene, coloring, 64, 0);
            scene.lights.clear();
            let ball = shapes::sphere(3).placed(&DAffine3::from_scale(DVec3::splat(RADIUS)));
            let glow =
                Material { surface: Surface::Luminous, ..material([100.0; 3], [0.0; 3], Gloss::default()) };
            scene.bodies.push(Body::new("ball", of(ball, glow), motion));
            let (film, _) = traced(&scene, coloring, 64, 1);
            let ratio = {
                let ratios = |i: usize| f64::from(luminance(expected.color[i]));
                let mut floor_only = film.clone();
                for i in 0..film.body.len() {
                    if film.body[i] != 0 || expected.body[i] != 0 || ratios(i) == 0.0 {
                        floor_only.body[i] = -1;
                    }
                }
                mean_ratio(&floor_only, ratios)
            };
            println!("{coloring} {beta}: {ratio:?}");
            // The ball of triangles covers 0.4 % less than a true one; (R/d)² is 10⁻⁴.
            assert!(
                (ratio.0 - 1.0).abs() < 4.0 * ratio.1 + 0.006 && ratio.1 < 0.01,
                "{coloring} {beta}: {ratio:?}"
            );
        }
    }
}

/// In a mirror that recedes along its normal, everything is seen with ((1 − β)/(1 + β)) of its frequency; one that moves in
/// its own plane shows what one at rest does.
#[test]
fn mirrors_in_motion() {
    let silver = Gloss { reflectance: 0.0, roughness: 0.0, metallic: 1.0 };
    for (beta, expected) in [
        (DVec3::ZERO, 1.0),
        (DVec3::new(0.0, 0.5, 0.0), 1.0 / 3.0),
        (DVec3::new(0.0, -0.5, 0.0), 3.0),
        (DVec3::new(0.8, 0.0, 0.0), 1.0),
    ] {
        let wide = DAffine3::from_scale_rotation_translation(
            DVec3::splat(100.0),
            DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
            DVec3::ZERO,
        );
        let mirror = of(shapes::plate().placed(&wide), material([1.0; 3], [0.0; 3], silver));
        let mirror = Body::new("mirror", mirror, moving(beta, Event::at(-5.0, DVec3::new(0.0, 5.0, 0.0))));
        let glow = Material { surface: Surface::Luminous, ..material([1.0; 3], [0.0; 3], Gloss::default()) };
        let wall = of(shapes::plate().placed(&wide), glow);
        let wall = Body::new("wall", wall, Motion::at_rest(DVec3::new(0.0, -1.0, 0.0)));
        let view = View { size: [16, 12], fov_deg: Some(0.01), ..View::default() };
        let scene = Scene::new("mirror", vec![mirror, wall], view);
        let (film, _) = traced(&scene, Coloring::Flat, 2, 2);
        for i in 0..film.body.len() {
            assert_eq!(film.body[i], 0);
            let seen = f64::from(film.color[i][1]);
            // A field of 10⁻⁴ rad.
            assert!((seen / f64::powi(expected, 3) - 1.0).abs() < 1e-4, "{beta}: {seen} {expected}");
        }
    }
}

/// What a plane mirror shows is what would stand behind it: a cube in motion and its mirror image are seen alike, pixel by
/// pixel.
#[test]
fn a_mirror_shows_the_mirror_image() {
    let silver = Gloss { reflectance: 0.0, roughness: 0.0, metallic: 1.0 };
    let wide = DAffine3::from_scale(DVec3::splat(30.0));
    let mirror = of(shapes::plate().placed(&wide), material([1.0; 3], [0.0; 3], silver));
    let view = View {
        size: [64, 48],
        event: Event::at(0.0, DVec3::new(0.0, -6.0, 3.0)),
        aim: Aim::LookAt(DVec3::new(0.0, 0.0, -1.5)),
        fov_deg: Some(30.0),
        ..View::default()
    };
    let cube = |sign: f64| {
        // Its side along z, mirrored.
        let place = DAffine3::from_scale(DVec3::new(1.0, 1.0, sign));
        let motion =
            moving(DVec3::new(0.7, 0.2, sign * 0.3), Event::at(-7.5, DVec3::new(0.0, 0.0, sign * 1.5)));
        Body::new("cube", shapes::cube().placed(&place), motion)
    };
    let luminous = |mut body: Body| {
        let mut mesh = Mesh::clone(&body.mesh);
        mesh.materials = vec![Material { surface: Surface::Luminous, ..Material::default() }];
        body.mesh = mesh.into();
        body
    };
    for coloring in [Coloring::Flat, Coloring::Geometry] {
        let mirrored = Scene::new(
            "mirror",
            vec![Body::new("mirror", mirror.clone(), Motion::at_rest(DVec3::ZERO)), luminous(cube(1.0))],
            view.clone(),
        );
        let direct = Scene::new("direct", vec![luminous(cube(-1.0))], view.clone());
        let (mirrored, _) = traced(&mirrored, coloring, 1, 1);
        let (direct, _) = traced(&direct, coloring, 1, 0);
        let [mut same, mut differ] = [0; 2];
        for i in 0..direct.body.len() {
            if mirrored.body[i] != 0 {
                continue;
            }
            let off = (0..3).map(|c| (mirrored.color[i][c] - direct.color[i][c]).abs()).fold(0.0, f32::max);
            if off < 1e-5 {
                same += usize::from(direct.body[i] == 0);
            } else {
                differ += 1;
            }
        }
        // Those whose line of sight runs in an edge to rounding.
        assert!(same > 100 && differ <= 1, "{same} {differ}");
    }
}

/// A lamp shut up in a box lights nothing outside, and the report tells.
#[test]
fn a_lamp_inside_a_body_lights_nothing() {
    let floor = of(shapes::plate(), material([0.8; 3], [0.0; 3], Gloss::default()));
    let box_of = of(shapes::cube(), material([0.8; 3], [0.0; 3], Gloss::default()));
    let view = View {
        event: Event::at(0.0, DVec3::new(0.0, -5.0, 3.0)),
        aim: Aim::LookAt(DVec3::ZERO),
        size: [40, 30],
        ..View::default()
    };
    let mut scene = Scene::new(
        "shut",
        vec![
            Body::new("floor", floor, Motion::at_rest(DVec3::ZERO)),
            Body::new("box", box_of, Motion::at_rest(DVec3::new(0.0, 0.0, 2.0))),
        ],
        view,
    );
    scene.lights.push(Light {
        name: "lamp".into(),
        kind: LightKind::Point { position: DVec3::new(0.0, 0.0, 2.0) },
        color: [1.0; 3],
        spectrum: Spectrum::default(),
        strength: 100.0,
        motion: Motion::at_rest(DVec3::ZERO),
    });
    let (film, report) = traced(&scene, Coloring::Geometry, 1, 0);
    assert!(film.covered() > 50 && film.color.iter().all(|c| *c == [0.0; 3]));
    let rays = report.rays.unwrap();
    let count = rays.count;
    assert_eq!(rays.to_lights, [[count.shadow, count.blocked]]);
    assert!(count.shadow > 20 && count.blocked == count.shadow, "{count:?}");
    let observer = scene.camera().unwrap().observer;
    let around = |scene: &Scene| scene.body_around(&scene.lights[0], &observer).map(|b| b.name.clone());
    assert_eq!(around(&scene).as_deref(), Some("box"));
    // The lamp is seen a distance of √26 ago, when a box that is there now was elsewhere, or another was there.
    let celerity = Celerity::from_beta(DVec3::X * 0.8).unwrap();
    scene.bodies[1].motion = Motion { celerity, origin: Event::at(0.0, DVec3::new(0.0, 0.0, 2.0)) };
    assert_eq!(around(&scene), None);
    scene.bodies[1].motion.origin = Event::at(-26f64.sqrt(), DVec3::new(0.2, 0.0, 2.0));
    assert_eq!(around(&scene).as_deref(), Some("box"));
}

/// The same seed gives the same picture on any number of threads; another one gives another.
#[test]
fn chance_is_repeatable() {
    let mut scene = terrell::scene::builtin_scene("box").unwrap().scene();
    scene.view.size = [40, 24];
    let options = |seed| Options {
        method: Method::Trace,
        samples: 2,
        paths: Paths { bounces: 2, seed },
        ..Options::default()
    };
    let camera = scene.camera().unwrap();
    let film = |seed, threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| render(&scene, &camera, &options(seed), |_| ()).unwrap().0)
    };
    let one = film(1, 1);
    assert_eq!(one, film(1, 3));
    assert_ne!(one, film(2, 2));
}

/// A luminous ball over a plate looks the same at any scale.
#[test]
fn scale_does_not_matter() {
    let scene = |scale: f64| {
        let sized = |mesh: Mesh| mesh.placed(&DAffine3::from_scale(DVec3::splat(scale)));
        let at = |position: DVec3| Motion::at_rest(position * scale);
        let plate = of(sized(shapes::plate()), material([0.8; 3], [0.0; 3], Gloss::default()));
        let glow = Material { surface: Surface::Luminous, ..material([1.0; 3], [0.0; 3], Gloss::default()) };
        let ball = of(sized(shapes::sphere(1)), glow);
        let view = View {
            event: Event::at(0.0, DVec3::new(0.0, -5.0, 2.0) * scale),
            aim: Aim::LookAt(DVec3::ZERO),
            size: [24, 18],
            ..View::default()
        };
        Scene::new(
            "scaled",
            vec![
                Body::new("plate", plate, at(DVec3::ZERO)),
                Body::new("ball", ball, at(DVec3::new(0.0, 0.0, 2.0))),
            ],
            view,
        )
    };
    let (whole, _) = traced(&scene(1.0), Coloring::Geometry, 4, 1);
    // Powers of two do not round.
    for exponent in [-80, -20, 60] {
        let (scaled, _) = traced(&scene(2f64.powi(exponent)), Coloring::Geometry, 4, 1);
        let off = whole.color.iter().zip(&scaled.color).map(|(a, b)| (a[1] - b[1]).abs()).fold(0.0, f32::max);
        assert!(off < 1e-5 && whole.covered() > 20, "2^{exponent}: {off}");
    }
}

/// A mirror shows the sky where nothing else is: of a sky that is even, as bright as two shifts make it.
#[test]
fn mirrors_show_the_sky() {
    let silver = Gloss { metallic: 1.0, roughness: 0.0, ..Gloss::default() };
    for (coloring, power) in [(Coloring::Geometry, 0), (Coloring::Flat, 3), (Coloring::Bolometric, 4)] {
        for beta in [0.0, -0.6, 0.6] {
            let turned = DAffine3::from_rotation_x(-std::f64::consts::FRAC_PI_2);
            let wide = DAffine3::from_scale(DVec3::splat(40.0)) * turned;
            let mirror = of(shapes::plate().placed(&wide), material([1.0; 3], [0.0; 3], silver));
            let motion = moving(DVec3::Y * beta, Event::at(-5.0, DVec3::new(0.0, 5.0, 0.0)));
            let view = View { size: [24, 18], fov_deg: Some(0.01), ..View::default() };
            let mut scene = Scene::new("mirror", vec![Body::new("mirror", mirror, motion)], view);
            let white = Picture::new("white", 1, 1, vec![[255; 3]]).unwrap();
            scene.sky = Some(Sky::new(SkyTexture::picture(white)));
            let (film, _) = traced(&scene, coloring, 4, 1);
            // Light that meets what comes head-on is shifted twice by the same factor.
            let shift = (1.0 - beta) / (1.0 + beta);
            assert!(film.body.iter().all(|body| *body == 0), "{beta}");
            for color in &film.color {
                let ratio = f64::from(color[1]) / shift.powi(power);
                // A field of 10⁻⁴ rad.
                assert!((ratio - 1.0).abs() < 1e-4, "{coloring} at {beta}: {ratio}");
            }
        }
    }
}

/// What is told of noise is what two pictures by other chances differ by, pixel by pixel.
#[test]
fn noise_is_what_pictures_differ_by() {
    let mut scene = builtin_scene("box").unwrap().scene();
    scene.view.size = [160, 90];
    let camera = scene.camera().unwrap();
    let by = |seed: u64, samples: u32| {
        let paths = Paths { bounces: 4, seed };
        let coloring = Coloring::Geometry;
        let options = Options { method: Method::Trace, coloring, samples, paths, ..Options::default() };
        let (film, report) = render(&scene, &camera, &options, |_| ()).unwrap();
        let light: Vec<f64> = film.color.iter().map(|c| f64::from(luminance(*c))).collect();
        (light, report.rays.unwrap().noise.unwrap())
    };
    let [(a, told), (b, _)] = [by(1, 32), by(2, 32)];
    let off = a.iter().zip(&b).filter(|(a, b)| a != b).map(|(a, b)| ((a - b) / (a + b)).powi(2) * 2.0);
    let (sum, count) = off.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    let differ = f64::sqrt(sum / count);
    let (_, finer) = by(1, 128);
    println!("told {told}, {finer} of four times the samples; they differ by {differ}");
    // What is told has the steps of outlines in it, which both pictures have alike.
    assert!((told / differ - 1.0).abs() < 0.2, "{told} {differ}");
    // Half as much, but for a few bright pixels.
    assert!(finer < told / 1.4, "{told} {finer}");
}

/// What closed meshes keep light from is the same if a hole is torn into them where nobody looks, which takes away all that
/// may be left out because they are closed.
#[test]
fn closed_meshes_cast_the_shadows_of_open_ones() {
    let mut random = Random(11);
    // Tetrahedra through each other, turned inside out or not, some with normals that lean far over.
    let mut soup = |count: u32, smooth: bool| {
        let mut mesh = Mesh::default();
        for i in 0..count {
            let middle = random.point(1.0);
            let corners = [0; 4].map(|_| middle + random.point(0.5));
            let mut triangles = vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
            triangles.iter_mut().for_each(|t| t.rotate_left(i as usize % 3));
            let mut solid = Mesh::new(&corners, triangles);
            if smooth {
                let outward = corners.map(|c| (c - corners.iter().sum::<DVec3>() / 4.0).normalize());
                solid.normals = outward.map(|n| n.as_vec3().to_array()).to_vec();
            }
            mesh.append(solid);
        }
        of(mesh, material([0.8; 3], [0.0; 3], Gloss::default()))
    };
    let [first, second] = [soup(60, true), soup(40, false)];
    let middle = |mesh: &Mesh, of: u32| (0..4).map(|i| mesh.vertex(4 * of + i)).sum::<DVec3>() / 4.0;
    let solids = [false, true].map(|inside_out| {
        let is_so = |of: &u32| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| first.vertex(4 * of + i));
            ((b - a).cross(c - a).dot(d - a) < 0.0) == inside_out
        };
        middle(&first, (1..60).find(is_so).unwrap())
    });
    let torn = |mesh: &Mesh| {
        let middle = middle(mesh, 0);
        let mut crumb =
            Mesh::new(&[DVec3::ZERO, DVec3::X, DVec3::Y].map(|c| middle + 1e-6 * c), vec![[0, 1, 2]]);
        if !mesh.normals.is_empty() {
            crumb.normals = vec![[0.0, 0.0, 1.0]; 3];
        }
        let mut torn = mesh.clone();
        torn.append(crumb);
        torn
    };
    let lamp = |name: &str, kind, motion| Light {
        name: name.into(),
        kind,
        color: [1.0; 3],
        spectrum: Spectrum::default(),
        strength: 20.0,
        motion,
    };
    let mut stopped = [0, 0];
    for beta in [0.0, 0.6, 0.95] {
        let motions = [
            moving(DVec3::X * beta, Event::new(-5.0, 0.0, 0.0, 0.0)),
            moving(DVec3::new(0.0, 0.1, -0.3), Event::new(-5.0, 0.7, 1.8, 0.3)),
        ];
        // Outside of all, among them, and within such of both kinds, at rest.
        let (front, above) = (DVec3::new(0.0, -5.0, 1.0), DVec3::new(1.0, -3.5, 3.0));
        let among = DVec3::new(-0.6, -0.2, 0.4);
        let places = [(above, front), (among, front), (above, among)];
        let within = solids.into_iter().flat_map(|within| [(within, front), (above, within)]);
        for (at, eye) in places.into_iter().chain(within) {
            let near = LightKind::Point { position: at };
            let lights = vec![
                lamp("still", near, Motion::at_rest(DVec3::ZERO)),
                lamp("quick", near, moving(DVec3::Z * 0.7, Event::new(-5.0, 0.0, 0.0, 0.0))),
                lamp("far", LightKind::Distant { direction: DVec3::new(0.3, 0.8, -0.4) }, motions[0]),
            ];
            let seen = |meshes: [Mesh; 2]| {
                let bodies = meshes.into_iter().zip(motions).zip(["first", "second"]);
                let bodies = bodies.map(|((mesh, motion), name)| Body::new(name, mesh, motion)).collect();
                let view = View {
                    event: Event::at(0.0, eye),
                    aim: Aim::LookAt(DVec3::splat(0.3)),
                    size: [160, 120],
                    ..View::default()
                };
                let mut scene = Scene::new("soup", bodies, view);
                scene.lights.clone_from(&lights);
                traced(&scene, Coloring::Geometry, 1, 0)
            };
            let (film, report) = seen([first.clone(), second.clone()]);
            let (of_torn, report_of_torn) = seen([torn(&first), torn(&second)]);
            let counts = [report, report_of_torn].map(|report| report.rays.unwrap().to_lights);
            assert_eq!(counts[0], counts[1], "{beta} {at} {eye}");
            assert!(film == of_torn, "{beta} {at} {eye}");
            for [asked, blocked] in &counts[0] {
                stopped = [stopped[0] + asked, stopped[1] + blocked];
            }
        }
    }
    let [asked, blocked] = stopped;
    assert!(blocked > 10_000 && asked > blocked + 10_000, "{asked} {blocked}");
}
