//! Scenes in curved spacetime, against closed forms, reference values and brute force.

mod common;
#[path = "common/program.rs"]
mod program;

use glam::{DMat3, DVec2, DVec3};
use program::{bad, good, pixels};
use std::path::Path;
use terrell::color::Coloring;
use terrell::film::{FAILED, Film, HOLE, IMPOSSIBLE, NOTHING, Samples};
use terrell::geodesic::{Accuracy, Curved, KerrSchild, Ray, Spacetime as _};
use terrell::plan::{Method, cheapest};
use terrell::render::{Options, Report, render};
use terrell::scene::{Scene, Spacetime, parse_scene, shapes};
use terrell::trace::{Look, Paths, Tracer};

fn scene(text: &str) -> Scene {
    parse_scene(text, Path::new("s.toml")).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn traced(scene: &Scene) -> (Film, Report) {
    let options = Options { method: Method::Trace, ..Options::default() };
    render(scene, &scene.camera().unwrap(), &options, |_| ()).unwrap()
}

/// A cube out of the way: a scene has a body.
const AWAY: &str = "[[body]]\nname = \"away\"\nmesh = \"cube\"\nscale = 0.001\nposition = [0, 0, 900]\n";

/// Along the middle row of a fisheye whose axis points to the hole, where it is seen and where not.
fn shadow_is_a_disc_of(half_angle: f64, camera: &str) {
    let size = 241;
    let text = format!(
        "[spacetime]\nmetric = \"schwarzschild\"\n[camera]\n{camera}look_at = [0, 0, 0]\nprojection = \"fisheye\"\nfov_deg = {}\nsize = [{size}, 3]\n[sky]\ntexture = \"checker\"\n{AWAY}",
        240.0 * 3.0 / f64::from(size)
    );
    let scene = scene(&text);
    let (film, report) = traced(&scene);
    assert_eq!(report.rays.unwrap().count.failed(), 0);
    let lens = scene.camera().unwrap().lens;
    for x in 0..size {
        let direction = lens.direction(DVec2::new(f64::from(x) + 0.5, 1.5)).unwrap();
        let angle = direction.normalize().dot(DVec3::Z).acos();
        // Rays are right to 1e-8, which is more by what they wind around the photon sphere.
        if (angle - half_angle).abs() > 1e-6 {
            let expected = if angle < half_angle { HOLE } else { NOTHING };
            assert_eq!(film.body[(size + x) as usize], expected, "{camera}{angle} {half_angle}");
        }
    }
}

#[test]
fn the_shadow_is_as_large_as_known() {
    for r in [2.5, 4.0, 10.0, 30.0f64] {
        // J. L. Synge (1966): sin²ψ = 27 M² (1 − 2M/r)/r², more than half the sky within r = 3M.
        let sine = (27.0 * (1.0 - 2.0 / r)).sqrt() / r;
        let angle = if r < 3.0 { std::f64::consts::PI - sine.asin() } else { sine.asin() };
        shadow_is_a_disc_of(angle, &format!("position = [0, {}, 0]\n", -r));
    }
    // Falling in from rest at infinity; an independent reference.
    for (r, angle) in [(4.0, 0.532_433_732_719_803_4), (10.0, 0.302_364_306_827_126_9)] {
        shadow_is_a_disc_of(angle, &format!("observer = \"rain\"\nposition = [0, {}, 0]\n", -r));
    }
}

/// From infinity in the equatorial plane, the shadow ends at the impact parameters of the two circular photon orbits
/// (J. M. Bardeen 1973): L/E of the orbit at r is −(r³ − 3r² + a²r + a²)/(a(r − 1)).
#[test]
fn from_infinity_the_shadow_of_a_rotating_hole_is_as_wide_as_known() {
    let a = 0.9f64;
    let orbit = |sign: f64| 2.0 * (1.0 + (2.0 / 3.0 * (-sign * a).acos()).cos());
    let impact = |r: f64| -(r.powi(3) - 3.0 * r * r + a * a * r + a * a) / (a * (r - 1.0));
    let range = [-impact(orbit(1.0)), -impact(orbit(-1.0))];
    for azimuth_deg in [0, 70] {
        let text = format!(
            "[spacetime]\nmetric = \"kerr\"\nmass = 2\nspin = 0.9\n[camera]\nat_infinity = {{ inclination_deg = 90, azimuth_deg = {azimuth_deg}, height = 0.11764705882352941 }}\nsize = [1201, 3]\n{AWAY}"
        );
        let (film, report) = traced(&scene(&text));
        assert_eq!(report.rays.unwrap().count.failed(), 0);
        for x in 0..1201 {
            let alpha = (f64::from(x) - 600.0) * (2.0 / 51.0) / 2.0;
            if range.iter().all(|end| (alpha - end).abs() > 1e-6) {
                let expected = if range[0] < alpha && alpha < range[1] { HOLE } else { NOTHING };
                assert_eq!(film.body[1201 + x as usize], expected, "{alpha} {range:?}");
            }
        }
    }
}

/// A ball exactly behind the hole is seen as a ring; its angle is of an independent reference (r = 30 M, both).
#[test]
fn what_is_behind_the_hole_is_a_ring() {
    let size = 801;
    let text = format!(
        "[spacetime]\nmetric = \"schwarzschild\"\n[camera]\nposition = [0, -30, 0]\nprojection = \"fisheye\"\nfov_deg = 40\nsize = [{size}, 3]\n[[body]]\nmesh = \"globe\"\nscale = 0.5\nposition = [0, 30, 0]\n"
    );
    let mut scene = scene(&text);
    // A field over the height of a square.
    scene.view.fov_deg = Some(40.0 * 3.0 / f64::from(size));
    let (film, _) = traced(&scene);
    let lens = scene.camera().unwrap().lens;
    let angles: Vec<f64> = (size / 2..size)
        .filter(|x| film.body[(size + x) as usize] == 0)
        .map(|x| lens.direction(DVec2::new(x as f64 + 0.5, 1.5)).unwrap().normalize().dot(DVec3::Z).acos())
        .collect();
    assert!(angles.len() > 5, "{}", angles.len());
    let middle = 0.5 * (angles[0] + angles[angles.len() - 1]);
    // Half a pixel either end, and β²/(8θ) of a ring from a ball of the angle β.
    let pixel = 40f64.to_radians() / f64::from(size);
    assert!((middle - 0.310_122_118_199_359_6).abs() < 0.6 * pixel, "{middle}");
    // The left is as the right: one ring.
    let left = (0..size / 2).filter(|x| film.body[(size + x) as usize] == 0).count();
    assert!(left.abs_diff(angles.len()) <= 1);
}

/// A large plane through (0, −4, 0), seen from (0, −10, 0) at rest and in motion.
#[test]
fn shifts_are_those_of_the_metric() {
    let wall =
        |mesh: &str| format!("[[body]]\nmesh = \"{mesh}\"\nscale = [2, 0.5, 2]\nposition = [0, -4.25, 0]\n");
    let camera = "[camera]\nposition = [0, -10, 0]\nsize = [3, 3]\nfov_deg = 100\n";
    let text = format!(
        "[spacetime]\nmetric = \"schwarzschild\"\n[sky]\ntexture = \"stars\"\n{camera}{}",
        wall("cube")
    );
    let (film, _) = traced(&scene(&text));
    // The near side of the cube is at r = 4.5 where the middle pixel looks; the film has 24 bits.
    let expected = ((1.0 - 2.0 / 4.5f64) / (1.0 - 2.0 / 10.0)).sqrt();
    assert_eq!(film.body[4], 0);
    assert!((f64::from(film.doppler[4]) / expected - 1.0).abs() < 1e-7, "{} {expected}", film.doppler[4]);
    // The corners see the sky, shifted to the blue.
    let expected = 1.0 / (1.0 - 2.0 / 10.0f64).sqrt();
    assert_eq!(film.body[0], NOTHING);
    assert!((f64::from(film.doppler[0]) / expected - 1.0).abs() < 1e-7, "{}", film.doppler[0]);
    // Radial light in coordinates of the outgoing chart: dr/dt = 1 on the way out, so s, with E = √(1 − 2M/r) at the
    // camera, is Δr/E.
    let expected = 5.5 / (1.0 - 2.0 / 10.0f64).sqrt();
    assert!((f64::from(film.distance[4]) / expected - 1.0).abs() < 1e-6, "{} {expected}", film.distance[4]);
}

/// The sky of flat spacetime is shifted as by a moving camera: D = γ(1 + β cos θ).
#[test]
fn the_sky_of_flat_spacetime_is_aberrated_and_shifted() {
    let text = format!(
        "[camera]\nforward = [1, 0, 0]\nvelocity = [0.6, 0, 0]\nprojection = \"panorama\"\nsize = [36, 18]\n[sky]\ntexture = \"checker\"\n{AWAY}"
    );
    let scene = scene(&text);
    assert_eq!(cheapest(&scene, Coloring::Spectral), (Method::Exact, "nothing casts shadows"));
    let (film, _) = traced(&scene);
    let lens = scene.camera().unwrap().lens;
    for (i, doppler) in film.doppler.iter().enumerate() {
        let at = DVec2::new((i % 36) as f64 + 0.5, (i / 36) as f64 + 0.5);
        // By the observer's angle: 1/(γ(1 − β cos θ)).
        let expected = 1.0 / (1.25 * (1.0 - 0.6 * lens.direction(at).unwrap().z));
        assert!((f64::from(*doppler) / expected - 1.0).abs() < 1e-6, "{doppler} {expected}");
    }
}

/// Without mass worth the name it is the picture of flat spacetime, whatever moves.
#[test]
fn a_hole_of_no_mass_is_not_there() {
    let body = "[[body]]\nmesh = \"globe\"\nposition = [1, 8, 0]\nvelocity = [0.3, -0.4, 0.2]\n[[body]]\nmesh = \"lattice\"\nscale = 0.5\nposition = [-2, 9, 1]\nvelocity = [0, 0.8, 0]\n";
    for camera in [
        "look_at = [0, 8, 0]\nfov_deg = 50\n",
        "look_at = [0, 8, 0]\nup = [0, 1, 3]\nvelocity = [0.5, -0.3, -0.6]\nprojection = \"fisheye\"\nfov_deg = 60\n",
    ] {
        let rest = format!(
            "[camera]\nposition = [1, -3, 0.5]\n{camera}size = [160, 120]\n[sky]\ntexture = \"checker\"\n{body}"
        );
        let flat = traced(&scene(&rest)).0;
        let hole = "[spacetime]\nmetric = \"kerr\"\nmass = 1e-9\nspin = 0.7\n";
        let (curved, report) = traced(&scene(&format!("{hole}{rest}")));
        assert_eq!(report.rays.unwrap().count.failed(), 0);
        let other = (0..flat.body.len()).filter(|&i| flat.body[i] != curved.body[i]).count();
        // Outlines that a pixel's centre is within 1e-8 of.
        assert!(other <= 2, "{other}");
        let mut seen = 0;
        for i in (0..flat.body.len()).filter(|&i| flat.body[i] == curved.body[i]) {
            let close = |a: f32, b: f32| (a - b).abs() <= 1e-6 * a.abs();
            assert!(close(flat.doppler[i], curved.doppler[i]), "{} {}", flat.doppler[i], curved.doppler[i]);
            assert!(
                close(flat.distance[i], curved.distance[i]),
                "{} {}",
                flat.distance[i],
                curved.distance[i]
            );
            seen += usize::from(flat.body[i] >= 0);
            let dark = flat.color[i].iter().chain(&curved.color[i]).fold(0.0f32, |a, b| a.max(*b));
            // Footprints on a sky's squares are taken otherwise.
            if flat.body[i] >= 0 && flat.face[i] == curved.face[i] {
                let off = (0..3).map(|k| (flat.color[i][k] - curved.color[i][k]).abs()).fold(0.0, f32::max);
                assert!(off <= 1e-4 * dark, "{:?} {:?}", flat.color[i], curved.color[i]);
            }
        }
        assert!(seen > 500, "{seen}");
    }
}

/// A mesh near the hole, met by brute force: all triangles, chords a hundred times as fine. And met the same however
/// coarse the chords are: hits are on the rays.
#[test]
fn meshes_near_the_hole_are_met_where_brute_force_meets_them() {
    let text = "[spacetime]\nmetric = \"kerr\"\nspin = 0.9\n[camera]\nposition = [0, -12, 2]\nlook_at = [0, 0, 0]\nfov_deg = 60\nsize = [64, 48]\n[[body]]\nmesh = \"globe\"\nscale = 1.5\nposition = [1, 6, 1]\n[[body]]\nmesh = \"cube\"\nposition = [4, -1, 0]\nvelocity = [0, 0.4, 0.3]\n";
    let mut scene = scene(text);
    scene.bodies[0].mesh = shapes::sphere(3).placed(&glam::DAffine3::from_scale(DVec3::splat(2.0))).into();
    let camera = scene.camera().unwrap();
    let eye = scene.eye(&camera).unwrap().unwrap();
    let Spacetime::Kerr(hole) = scene.spacetime else { panic!() };
    let shading = terrell::light::Shading::new(&scene, [&camera.observer], Coloring::Flat).unwrap();
    let tracer = Tracer::new(&scene);
    let trace = |accuracy: Accuracy| {
        let (mut film, space) = (Film::new(0, 0), Curved::new(hole).with(accuracy));
        let (shading, samples) = (shading.seen_by(&camera.observer), Samples::new(1));
        let look = Look { samples: samples.offsets(), shading: &shading, paths: Paths::default() };
        tracer.trace_curved(&scene, &space, &eye, &camera.lens, &look, &mut film, |_| ());
        film
    };
    let usual = trace(Accuracy::new(1e-10, 0.05));
    let coarse = trace(Accuracy::new(1e-10, 0.5));
    let fine = Curved::new(hole).with(Accuracy::new(1e-10, 5e-4));
    let mut met = [0; 2];
    let (mut other, mut elsewhere) = (0, 0);
    for i in 0..usual.body.len() {
        // Steps of 1e-10 are the same in both; all that differs is rounding.
        elsewhere += usize::from(usual.body[i] != coarse.body[i] || usual.face[i] != coarse.face[i]);
        if usual.face[i] == coarse.face[i] {
            assert!((usual.distance[i] - coarse.distance[i]).abs() <= 3e-7 * usual.distance[i]);
        }
        let at = DVec2::new((i % 64) as f64 + 0.5, (i / 64) as f64 + 0.5);
        let (start, k) = eye.ray(&camera.lens, at).unwrap();
        let brute = brute(&scene, fine.ray(start, k));
        if brute.map_or(usual.body[i] < 0, |(_, body, face)| {
            body as i32 == usual.body[i] && face as i32 == usual.face[i]
        }) {
            if let Some((s, body, _)) = brute {
                met[body] += 1;
                // A chord is off by 5e-4, and on slanting faces that is ten times as far along the ray.
                assert!((s - f64::from(usual.distance[i])).abs() < 1e-2, "{s} {}", usual.distance[i]);
            }
        } else {
            other += 1;
        }
    }
    assert!(met[0] > 100 && met[1] > 20, "{met:?}");
    // Pixels whose ray passes an edge within the sagitta: of some thousand.
    assert!(other <= 6 && elsewhere == 0, "{other} {elsewhere}");
}

/// The nearest of all triangles on a chain of chords.
fn brute(scene: &Scene, ray: impl Ray) -> Option<(f64, usize, usize)> {
    for piece in ray {
        let mut nearest: Option<(f64, usize, usize)> = None;
        for (index, body) in scene.bodies.iter().enumerate() {
            let rest_from_world = body.motion.world_from_rest::<f64>().inverse();
            let start = (rest_from_world * (piece.start - body.motion.origin)).xyz();
            let direction = (rest_from_world * piece.direction).xyz();
            for face in 0..body.mesh.triangles.len() {
                let [a, b, c] = body.mesh.corners(face);
                let solved = DMat3::from_cols(b - a, c - a, -direction).inverse() * (start - a);
                let inside = solved.x >= 0.0 && solved.y >= 0.0 && solved.x + solved.y <= 1.0;
                let s = piece.from + solved.z;
                if inside && (0.0..=piece.length).contains(&solved.z) && nearest.is_none_or(|n| s < n.0) {
                    nearest = Some((s, index, face));
                }
            }
        }
        if nearest.is_some() {
            return nearest;
        }
    }
    None
}

/// A closed surface around the hole and camera has no cracks: no ray gets out.
#[test]
fn surfaces_have_no_cracks() {
    let text = "[spacetime]\nmetric = \"kerr\"\nspin = 0.9\n[camera]\nposition = [0, -8, 1]\nprojection = \"panorama\"\nsize = [200, 100]\n[[body]]\nmesh = \"globe\"\n";
    let mut scene = scene(text);
    scene.bodies[0].mesh = shapes::sphere(4).placed(&glam::DAffine3::from_scale(DVec3::splat(12.0))).into();
    let (film, report) = traced(&scene);
    let count = report.rays.unwrap().count;
    assert_eq!((count.sky, count.failed(), count.impossible), (0, 0, 0), "{count:?}");
    assert!(count.hole > 100 && film.body.iter().all(|b| [0, HOLE].contains(b)));
}

#[test]
fn what_cannot_rest_is_flagged_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[spacetime]\nmetric = \"kerr\"\nspin = 0.95\n[camera]\nposition = [0, -9, 1]\nlook_at = [0, 0, 0]\nfov_deg = 40\nsize = [96, 64]\n[[body]]\nname = \"crossing\"\nmesh = \"cube\"\nposition = [-1.6, -0.9, 0]\n";
    let (film, report) = traced(&scene(text));
    let count = report.rays.unwrap().count;
    let flagged = film.body.iter().filter(|b| **b == IMPOSSIBLE).count();
    assert!(flagged > 20 && flagged as u64 == count.impossible, "{flagged} {count:?}");
    assert!(film.body.contains(&0), "what is outside of the ergosphere is seen");
    assert_eq!(count.primary, count.bodies + count.sky + count.hole + count.impossible + count.failed());
    std::fs::write(folder.path().join("s.toml"), text).unwrap();
    let said = good(&["render", "s.toml", "--color", "flat", "--json", "s.json"], folder.path());
    for part in
        ["Kerr spacetime", "rays into the hole", "faster than light", "'crossing' reaches into the horizon"]
    {
        assert!(said.contains(part), "{said}");
    }
    let json = std::fs::read_to_string(folder.path().join("s.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["rays"]["from_impossible"], count.impossible);
    assert_eq!(json["spacetime"]["spin"], 0.95);
    // Magenta at any exposure, as many pixels.
    let magenta = |p: &&image::Rgb<u8>| p.0 == [255, 0, 255];
    assert_eq!(pixels(folder.path().join("s.png")).pixels().filter(magenta).count(), flagged);
}

/// Near the horizon, falling or carried around, within the ergosphere or above it, and however fast the hole rotates: none is
/// given up, and most of what falls sees is the sky.
#[test]
fn near_fast_holes_no_ray_is_lost() {
    for (spin, above) in
        [(0.0, 0.002), (0.9, 0.01), (0.95, 0.02), (0.99, 0.09), (0.998, 0.05), (1.0, 0.2), (-1.0, 0.1)]
    {
        let hole = KerrSchild::new(1.0, spin).unwrap();
        let r = hole.horizon() * (1.0 + above);
        for (observer, y) in [("rain", r.hypot(spin)), ("zamo", r.hypot(spin)), ("rain", 0.0), ("zamo", 0.0)]
        {
            let z = if y == 0.0 { r } else { 0.0 };
            let scene = scene(&format!(
                "[spacetime]\nmetric = \"kerr\"\nspin = {spin}\n[camera]\nposition = [0, {y}, {z}]\nobserver = \"{observer}\"\nforward = [1, 0, 0]\nup = [0, 1, 1]\nprojection = \"panorama\"\nsize = [32, 16]\n[sky]\ntexture = \"checker\"\n"
            ));
            let count = traced(&scene).1.rays.unwrap().count;
            assert_eq!(count.failed(), 0, "a = {spin}, {above} above, {observer}");
            assert!(observer == "zamo" || count.sky > 256, "a = {spin}, {above} above: {count:?}");
        }
    }
}

/// Rays that are given up are flagged, never black.
#[test]
fn rays_that_fail_are_flagged() {
    let scene = scene(&format!(
        "[spacetime]\nmetric = \"kerr\"\nspin = 0.9\n[camera]\nposition = [0, -9, 0]\nsize = [32, 24]\n{AWAY}"
    ));
    let camera = scene.camera().unwrap();
    let eye = scene.eye(&camera).unwrap().unwrap();
    let shading = terrell::light::Shading::new(&scene, [&camera.observer], Coloring::Flat).unwrap();
    let hole = KerrSchild::new(1.0, 0.9).unwrap();
    let space = Curved::new(hole).with(Accuracy { steps: 8, ..Accuracy::new(1e-8, 0.05) });
    let mut film = Film::new(0, 0);
    let (shading, samples) = (shading.seen_by(&camera.observer), Samples::new(1));
    let look = Look { samples: samples.offsets(), shading: &shading, paths: Paths::default() };
    let count =
        Tracer::new(&scene).trace_curved(&scene, &space, &eye, &camera.lens, &look, &mut film, |_| ());
    let failed = film.body.iter().filter(|b| **b == FAILED).count();
    let count = count.count;
    assert!(failed > 0 && failed as u64 == count.step_limit, "{count:?}");
    for (body, color) in film.body.iter().zip(&film.color) {
        assert_eq!(*body == FAILED, *color == [1.0, 0.0, 1.0]);
    }
}

#[test]
fn the_users_mistakes_are_explained() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let kerr = "[spacetime]\nmetric = \"kerr\"\nspin = 0.9\n";
    let cube = "[[body]]\nmesh = \"cube\"\nposition = [0, 9, 0]\nvelocity = [0, 0, 0.1]\n";
    let refused = |text: String, parts: &[&str]| {
        std::fs::write(at.join("s.toml"), &text).unwrap();
        let message = bad(&["render", "s.toml"], at);
        for part in parts {
            assert!(message.contains(part), "{text}\n→ {message}\nlacks {part}");
        }
        assert!(!at.join("s.png").exists());
    };
    refused(format!("[spacetime]\nmetric = \"ker\"\n{cube}"), &["s.toml:2", "'kerr'"]);
    refused(
        format!("[spacetime]\nmetric = \"kerr\"\nspin = 1.1\n{cube}"),
        &["s.toml:3", "naked singularity"],
    );
    refused(format!("[spacetime]\nmetric = \"kerr\"\n{cube}"), &["spin"]);
    refused(format!("{kerr}mass = -1\n{cube}"), &["s.toml:4", "mass"]);
    refused(format!("{kerr}mss = 1\n{cube}"), &["'mss'", "'mass'"]);
    refused(format!("[spacetime]\nmetric = \"schwarzschild\"\nspin = 0.1\n{cube}"), &["no spin"]);
    refused(format!("[spacetime]\nmetric = \"flat\"\nmass = 1\n{cube}"), &["no mass"]);
    let camera = |keys: &str| format!("{kerr}[camera]\n{keys}\n{cube}");
    refused(camera("position = [1.2, 0, 0]"), &["s.toml:5", "inside a horizon"]);
    refused(camera("position = [1.8, 0, 0]"), &["s.toml:5", "ergosphere", "\"zamo\"", "\"rain\""]);
    refused(camera("position = [0, -9, 0]\nvelocity = [0, 0.99, 0]"), &["slower than light"]);
    refused(camera("position = [0, -9, 1]\nobserver = \"circular\""), &["equatorial"]);
    refused(camera("position = [0, -9, 0]\nobserver = \"zammo\""), &["'zamo'"]);
    refused(camera("position = [0, -9, 0]\nobserver = \"zamo\"\nbeta = 0.1"), &["velocity"]);
    refused(camera("position = [0, -9, 0]\nnearest = \"cube\""), &["s.toml:6", "time"]);
    refused(camera("at_infinity = { inclination_deg = 200, height = 9 }"), &["inclination"]);
    refused(camera("at_infinity = { inclination_deg = 80, height = 0 }"), &["height"]);
    refused(camera("at_infinity = { inclination_deg = 80, height = 9 }\nfov_deg = 50"), &["fov_deg"]);
    refused(
        camera("at_infinity = { inclination_deg = 80, height = 9 }\nposition = [1, 2, 3]"),
        &["at_infinity"],
    );
    refused(
        format!("{kerr}[camera]\nposition = [0, -9, 0]\n{cube}[[light]]\nkind = \"ambient\"\n"),
        &["light1", "shine"],
    );
    refused(format!("[camera]\nobserver = \"zamo\"\n{cube}"), &["flat spacetime"]);
    refused(format!("[sky]\ntexture = \"chequer\"\n{cube}"), &["s.toml:2", "checker"]);
    refused(format!("[sky]\ntexture = \"none.png\"\n{cube}"), &["s.toml:2", "none.png"]);
    std::fs::write(at.join("s.toml"), camera("position = [0, -9, 0]\nsize = [16, 9]")).unwrap();
    for (words, part) in [
        (&["render", "s.toml", "--method", "apparent"][..], "--method apparent"),
        (&["render", "s.toml", "--raster", "skia"], "--raster skia"),
        (&["render", "s.toml", "--doppler", "vertex"], "--doppler vertex"),
        (&["render", "s.toml", "--edges"], "--edges"),
        (&["render", "s.toml", "--axes"], "--axes"),
        (&["render", "s.toml", "--scale-bar"], "--scale-bar"),
        (&["render", "s.toml", "--when", "nearest cube"], "time"),
        (&["transform", "s.toml"], "curved spacetime"),
        (&["animate", "s.toml"], "--time"),
        (&["animate", "s.toml", "--time", "0,1", "--beside-standard"], "--beside-standard"),
    ] {
        let message = bad(words, at);
        assert!(message.contains(part), "{words:?}: {message}");
    }
    assert_eq!(std::fs::read_dir(at).unwrap().count(), 1, "nothing is left behind");
}

#[test]
fn every_way_to_look_gives_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    image::RgbImage::from_fn(8, 4, |x, y| image::Rgb([(x * 30) as u8, (y * 60) as u8, 99]))
        .save(at.join("sky.png"))
        .unwrap();
    let scene = |camera: &str, sky: &str| {
        format!(
            "[spacetime]\nmetric = \"kerr\"\nspin = 0.9\n[camera]\n{camera}size = [32, 18]\n[sky]\n{sky}[[body]]\nmesh = \"globe\"\nposition = [2, 9, 1]\nmaterial = \"a\"\n[material.a]\nlaw = \"lambert\"\n"
        )
    };
    let near = "position = [6, 0, 0]\nlook_at = [0, 0, 0]\n";
    let skies = [
        "texture = \"stars\"\nspectrum = { blackbody_k = 4000 }\n",
        "texture = \"sky.png\"\nstrength = 2\nrotation = { axis = [1, 0, 0], angle_deg = 30 }\n",
    ];
    let looks = [
        "observer = \"static\"\n",
        "observer = \"zamo\"\n",
        "observer = \"circular\"\n",
        "observer = \"retrograde\"\n",
        "observer = \"rain\"\n",
        "celerity = [0.2, 0.1, 0]\n",
    ];
    let infinity = "at_infinity = { inclination_deg = 0, azimuth_deg = 20, height = 20 }\n".to_owned();
    let cameras = looks.map(|look| format!("{near}{look}"));
    for (i, camera) in cameras.iter().chain([&infinity]).enumerate() {
        std::fs::write(at.join("s.toml"), scene(camera, skies[i % 2])).unwrap();
        for color in ["spectral", "flat", "bolometric", "geometry", "doppler"] {
            good(&["render", "s.toml", "--color", color, "--samples", "2", "-q"], at);
            let seen: std::collections::HashSet<_> = pixels(at.join("s.png")).pixels().copied().collect();
            assert!(seen.len() > 3, "{camera} {color}");
        }
    }
    good(&["animate", "s.toml", "--time", "0,1", "--frames", "2", "-o", "s.apng", "--caption", "{time}"], at);
}
