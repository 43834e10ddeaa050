//! What is drawn on top of pictures: true curves, hidden lines, captions; and the flags.

#[path = "common/assertion.rs"]
mod assertion;

use assert_cmd::Command;
use glam::{DVec2, DVec3};
use std::sync::Arc;
use terrell::drawing::{Caption, Edges, Overlay, OverlayOptions, Shot};
use terrell::film::Film;
use terrell::geodesic::{Celerity, Event};
use terrell::picture::pixels_srgb;
use terrell::relativity::{ApparentMap, Motion};
use terrell::render::{Options, render};
use terrell::scene::{Body, Camera, Mesh, Paint, Projection, Scene, View, shapes};
use terrell::tone::Development;

const SIZE: [u32; 2] = [1280, 720];

/// A black body: what is light in its picture is drawn.
fn body(name: &str, mut mesh: Mesh, beta: DVec3, origin: Event<terrell::geodesic::World>) -> Body {
    mesh.paint = Paint::Uniform([0.0; 3]);
    let motion = Motion { celerity: Celerity::from_beta(beta).unwrap(), origin };
    Body { name: name.into(), mesh: Arc::new(mesh), motion, clip: None }
}

/// Seen from the origin, looking along y.
fn scene(bodies: Vec<Body>, fov_deg: f64) -> Scene {
    let view = View { fov_deg: Some(fov_deg), size: SIZE, ..View::default() };
    Scene::new("test", bodies, view)
}

fn drawn(scene: &Scene, options: OverlayOptions) -> (Camera, Film, Vec<u8>) {
    let camera = scene.camera().unwrap();
    let how = Options::default();
    let (film, _) = render(scene, &camera, &how, |_| ()).unwrap();
    let development = Development::default();
    let mut pixels = pixels_srgb(&film, &development);
    let (tolerance, coloring) = (how.tolerance, how.coloring);
    let shot = Shot { scene, camera: &camera, film: &film, tolerance, coloring, development };
    let notes = Overlay::new(scene, options).unwrap().draw(&mut pixels, &shot);
    assert!(notes.is_empty(), "{notes:?}");
    (camera, film, pixels)
}

fn with_edges(edges: Edges) -> OverlayOptions {
    OverlayOptions { edges: Some(edges), ..OverlayOptions::default() }
}

/// Red of a pixel, 0 to 1: how much of it a white line on black covers.
fn light(pixels: &[u8], x: usize, y: usize) -> f64 {
    f64::from(pixels[3 * (y * SIZE[0] as usize + x)]) / 255.0
}

#[test]
fn a_rod_across_the_motion_is_drawn_as_its_hyperbola() {
    // Eq. 1 for a rod at the rest-frame place (a, b): x = γ(a − β√(a² + b² + z²)), y and z as they are.
    let (beta, b, reach) = (0.9f64, 2.0, 1.5);
    let gamma = 1.0 / (1.0 - beta * beta).sqrt();
    let a = gamma * beta * b;
    let corners = [DVec3::new(a, b, -reach), DVec3::new(a, b, reach), DVec3::new(a + 3.0, b, 0.0)];
    let mesh = Mesh::new(&corners, vec![[0, 1, 2]]);
    let scene = scene(vec![body("rod", mesh, DVec3::X * beta, Event::origin())], 75.0);
    let (camera, _, pixels) = drawn(&scene, with_edges(Edges::Sharp));
    let focal = camera.lens.focal().x;
    let column = |z: f64| 640.0 + focal * gamma * (a - beta * (a * a + b * b + z * z).sqrt()) / b;
    let (mut rows, mut worst, mut bend) = (0, 0.0f64, 0.0f64);
    let chord = column(1.0);
    for y in 0..720 {
        let z = (360.0 - (y as f64 + 0.5)) * b / focal;
        if z.abs() > 1.0 {
            continue;
        }
        let expected = column(z);
        let near = (expected - 12.0) as usize..(expected + 12.0) as usize;
        let sum: f64 = near.clone().map(|x| light(&pixels, x, y)).sum();
        let moment: f64 = near.map(|x| (x as f64 + 0.5) * light(&pixels, x, y)).sum();
        assert!(sum > 1.2, "row {y}: no line");
        worst = worst.max((moment / sum - expected).abs());
        bend = bend.max((expected - chord).abs());
        rows += 1;
    }
    println!("{rows} rows, at most {worst:.3} px from the hyperbola, which bends by {bend:.1} px");
    // Lines are sampled at quarters of a pixel; the points they are drawn through are the rod's own.
    assert!(rows > 400 && worst < 0.25, "{rows} {worst}");
    assert!(bend > 40.0, "a chord would have passed");
}

/// Where a segment meets a triangle, as a part of it (Möller and Trumbore 1997).
fn hit(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (direction, ab, ac) = (to - from, b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < 1e-12 {
        return None;
    }
    let u = (from - a).dot(p) / determinant;
    let q = (from - a).cross(ab);
    let v = direction.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(q) / determinant)
}

/// Whether something at rest in its own frame stands before what is seen at `apparent`.
fn hides(map: &ApparentMap, mesh: &Mesh, apparent: DVec3) -> bool {
    let (there, _) = map.unsee(apparent);
    (0..mesh.triangles.len()).any(|t| {
        hit(map.observer_rest(), there, mesh.corners(t)).is_some_and(|at| at > 0.0 && at < 1.0 - 1e-6)
    })
}

#[test]
fn hidden_edges_are_not_drawn_and_seen_ones_are() {
    let cube = shapes::cube();
    let turned = glam::DAffine3::from_rotation_z(0.5) * glam::DAffine3::from_rotation_x(0.6);
    let big = cube.clone().placed(&turned);
    let small = cube.placed(&glam::DAffine3::from_scale(DVec3::splat(0.4)));
    // The small one passes before the large one, the other way.
    let bodies = vec![
        body("large", big, DVec3::X * 0.9, Event::new(-3.0, 0.0, 3.0, 0.0)),
        body("small", small, DVec3::new(-0.5, 0.0, 0.6), Event::new(-1.5, 0.1, 1.5, 0.1)),
    ];
    let scene = scene(bodies, 40.0);
    let (camera, film, pixels) = drawn(&scene, with_edges(Edges::Sharp));
    assert!((0..2).all(|b| film.body.contains(&b)));
    let maps: Vec<_> = scene.bodies.iter().map(|b| ApparentMap::new(&b.motion, &camera.observer)).collect();
    let (mut seen, mut hidden) = (Vec::new(), Vec::new());
    for (body, map) in scene.bodies.iter().zip(&maps) {
        let corners: Vec<DVec3> = (0..8).map(|v| body.mesh.vertex(v)).collect();
        let side = (0..8).map(|v| corners[0].distance(corners[v])).filter(|d| *d > 0.0).fold(9.0, f64::min);
        for (i, &from) in corners.iter().enumerate() {
            for &to in &corners[..i] {
                if from.distance(to) > 1.01 * side {
                    continue;
                }
                for step in 0..=2000 {
                    let apparent = map.see(from.lerp(to, f64::from(step) / 2000.0)).position;
                    let hid = scene.bodies.iter().zip(&maps).any(|(b, m)| hides(m, &b.mesh, apparent));
                    let pixel = camera.lens.pixel(apparent).unwrap();
                    if hid { hidden.push(pixel) } else { seen.push(pixel) }
                }
            }
        }
    }
    let from_seen = |p: DVec2| seen.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
    let far_hidden = hidden.iter().filter(|p| from_seen(**p) > 6.0).count();
    assert!(far_hidden > 5000, "hidden edges there are: {far_hidden}");
    let mut worst = 0.0f64;
    let mut lit = 0;
    for y in 0..720 {
        for x in 0..1280 {
            if light(&pixels, x, y) > 0.25 {
                lit += 1;
                worst = worst.max(from_seen(DVec2::new(x as f64 + 0.5, y as f64 + 0.5)));
            }
        }
    }
    println!("{lit} pixels drawn, at most {worst:.2} px from an edge that is seen");
    // Half a line is 0.7 px; its ends are round, and what hides is known to the pixel.
    assert!(lit > 2000 && worst < 2.0, "{lit} {worst}");
    let missing = seen.iter().filter(|p| {
        let (x, y) = (p.x as usize, p.y as usize);
        (x - 1..=x + 1).all(|x| (y - 1..=y + 1).all(|y| light(&pixels, x, y) < 0.25))
    });
    let missing = missing.count();
    println!("{missing} of {} points that are seen lack their line", seen.len());
    assert!(missing * 500 < seen.len(), "{missing}");
}

#[test]
fn lines_are_split_at_the_seam_and_end_with_the_sky() {
    // All around the camera: every projection draws, and no line crosses the whole picture.
    let ball = shapes::sphere(1);
    for (projection, fov) in
        [(Projection::Panorama, 360.0), (Projection::Fisheye, 360.0), (Projection::Pinhole, 120.0)]
    {
        let mut scene =
            scene(vec![body("ball", ball.clone(), DVec3::X * 0.6, Event::new(0.0, 0.1, 0.1, 0.0))], fov);
        scene.view.projection = projection;
        let (camera, _, pixels) = drawn(&scene, with_edges(Edges::All));
        let map = ApparentMap::new(&scene.bodies[0].motion, &camera.observer);
        let lit = (0..720 * 1280).filter(|i| light(&pixels, i % 1280, i / 1280) > 0.5);
        let mut count = 0;
        for i in lit {
            count += 1;
            let at = DVec2::new((i % 1280) as f64 + 0.5, (i / 1280) as f64 + 0.5);
            let Some(direction) = camera.lens.direction(at) else { continue };
            let sight = map.offset_rest(map.unsee(direction.normalize()).0).normalize();
            // Three pixels of ½°, in a rest sky that aberration stretches twofold.
            let near = (0..ball.triangles.len()).any(|face| {
                let corners = ball.corners(face).map(|c| map.offset_rest(c).normalize());
                (0..3).any(|i| {
                    let (a, b) = (corners[i], corners[(i + 1) % 3]);
                    let middle = (a + b).normalize();
                    a.cross(b).normalize().dot(sight).abs() < 0.05 && middle.dot(sight) > middle.dot(a) - 0.05
                })
            });
            assert!(near, "{projection}: a line at {at} where no edge is");
        }
        assert!(count > 5000, "{projection}: {count}");
    }
}

#[test]
fn a_caption_keeps_within_the_picture_and_off_the_middle() {
    let scene =
        scene(vec![body("cube", shapes::cube(), DVec3::X * 0.9, Event::new(0.0, 0.0, 1e6, 0.0))], 40.0);
    for text in ["γ = {gamma}", &"a very long line, ".repeat(30), &"many\n".repeat(100)] {
        let caption = Some(Caption::parse(text).unwrap());
        let (.., pixels) = drawn(&scene, OverlayOptions { caption, ..OverlayOptions::default() });
        let lit: Vec<_> =
            (0..720 * 1280).filter(|i| pixels[3 * i] > 20).map(|i| (i % 1280, i / 1280)).collect();
        assert!(lit.len() > 50, "{text}");
        assert!(lit.iter().all(|(x, y)| (15..1265).contains(x) && (15..708).contains(y)), "{text}");
    }
}

fn refused(arguments: &[&str], parts: &[&str]) {
    assertion::refused(assertion::folder().path(), arguments, parts);
}

#[test]
fn what_cannot_be_drawn_is_refused_before_the_work() {
    refused(&["render", "cube", "--caption", "v = {v}"], &["{v}", "{beta}", "{time:.2}"]);
    refused(&["render", "cube", "--caption", "{beta"], &["'{'", "{{"]);
    refused(&["render", "cube", "--edges", "round"], &["round", "sharp", "all"]);
    refused(&["render", "cube", "--camera", "panorama", "--scale-bar"], &["panorama", "scale bar"]);
    for flag in [&["--edges"][..], &["--axes"], &["--scale-bar"], &["--caption", "a"]] {
        refused(&[&["render", "cube", "-o", "a.exr"], flag].concat(), &["a.exr", ".png", "--edges"]);
    }
}

#[test]
fn flags_draw_on_the_picture_and_change_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |flags: &[&str]| -> (Vec<u8>, String) {
        let base = ["render", "cube", "-o", "a.png", "--size", "320x180"];
        let arguments = [&base, flags].concat();
        let run =
            Command::cargo_bin("terrell").unwrap().current_dir(&folder).args(arguments).assert().success();
        let line = String::from_utf8(run.get_output().stdout.clone()).unwrap();
        (image::open(folder.path().join("a.png")).unwrap().to_rgb8().into_raw(), line)
    };
    let (plain, _) = draw(&[]);
    let changed = |pixels: &[u8]| -> Vec<(usize, usize)> {
        let differ = plain.chunks(3).zip(pixels.chunks(3)).enumerate().filter(|(_, (a, b))| a != b);
        differ.map(|(i, _)| (i % 320, i / 320)).collect()
    };
    for (flags, within) in [
        (&["--edges"][..], 90..240),
        (&["--edges", "all"], 90..240),
        (&["--axes"], 200..320),
        (&["--scale-bar"], 200..320),
        (&["--caption", "-β {{= {beta:.2}", "--caption", "second"], 0..160),
    ] {
        let (pixels, line) = draw(flags);
        assert!(line.lines().count() == 1, "{line}");
        let at = changed(&pixels);
        assert!(at.len() > 60, "{flags:?}: {}", at.len());
        assert!(at.iter().all(|(x, _)| within.contains(x)), "{flags:?}");
    }
    assert!(changed(&draw(&["--edges", "all"]).0).len() > changed(&draw(&["--edges", "sharp"]).0).len());
    // Nothing to measure: the picture comes without it, and says so.
    let (pixels, line) = draw(&["--time", "1000", "--scale-bar"]);
    assert!(line.contains("note: no scale bar"), "{line}");
    assert!(pixels.iter().all(|p| *p == 0));
}
