//! Where ways to compute fail, and that the planner does not go there.

mod common;
#[path = "common/program.rs"]
mod program;

use common::{points, vec3};
use glam::{DAffine3, DVec3};
use program::{bad, good};
use serde_json::Value;
use std::f64::consts::FRAC_PI_2;
use terrell::color::Coloring;
use terrell::film::Film;
use terrell::geodesic::{Celerity, Event, Real, Wide};
use terrell::measure::stability::{Map, Planner, Resolution, SHEETS, conditioning, seen};
use terrell::plan::{MOST_GAMMA, Method, cheapest, lacks_digits};
use terrell::relativity::Motion;
use terrell::render::{Options, render};
use terrell::scene::{Aim, Body, Projection, Scene, Speed, View, builtin_scene, shapes};

/// A sheet's maps, coarsely, none of which fails where the planner goes: that is what they are for.
fn sheet(name: &str) -> Vec<Map> {
    let sheet = SHEETS.iter().find(|sheet| sheet.name == name).unwrap();
    let maps = sheet.maps(Resolution::Quick);
    for map in &maps {
        let cells = map.x.len() * map.y.len();
        assert!(map.errors.len() == cells && map.planner.len() == cells, "{}", map.name);
        assert!(map.sheet == name && !map.words.is_empty(), "{}", map.name);
        assert_eq!(map.faults(), Vec::<String>::new(), "{}", map.name);
    }
    maps
}

fn map<'a>(maps: &'a [Map], name: &str) -> &'a Map {
    maps.iter().find(|map| map.name == name).unwrap_or_else(|| panic!("{name}"))
}

/// What errors are measured against is what 60-digit arithmetic finds, as well as its file can be read.
#[test]
fn the_reference_is_that_of_sixty_digits() {
    for row in points() {
        let event = |key: &str| {
            let v: Vec<f64> = row[key].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
            Event::new(v[0], v[1], v[2], v[3])
        };
        let motion = Motion { celerity: Celerity::new(vec3(&row["u"])).unwrap(), origin: event("A") };
        let (observer, x_rest) = (event("O"), vec3(&row["x_rest"]));
        let found = seen(&motion, observer, x_rest);
        let (r, doppler) = (row["r"].as_f64().unwrap(), row["D"].as_f64().unwrap());
        let position = DVec3::from_array(found.position.map(Wide::value));
        // The file's numbers are read to a unit in the last place: fourteen that go in, times the conditioning, and what is
        // compared, which is rounded once more.
        let condition = row["condition"].as_f64().unwrap();
        let rounding = (14.0 * condition + 2.5) * f64::EPSILON;
        assert!(
            (position - vec3(&row["apparent"])).length() <= 3f64.sqrt() * rounding * r,
            "{}",
            row["kind"]
        );
        assert!((found.distance.value() / r - 1.0).abs() <= rounding);
        assert!((found.doppler.value() / doppler - 1.0).abs() <= rounding);
        // It is a quotient of small changes, and the other one takes the worst of both signs.
        let own = conditioning(&motion, observer, x_rest);
        assert!((own / condition - 1.0).abs() < 0.01, "{}: {own} {condition}", row["kind"]);
    }
}

#[test]
fn formulas_fail_as_they_are_printed_and_the_map_does_not() {
    let maps = sheet("place");
    assert_eq!(maps.len(), 12);
    for quantity in ["direction", "distance", "doppler"] {
        let of = |way: &str| map(&maps, &format!("{quantity}_{way}"));
        assert!(of("printed_f32").failures() > of("printed_f64").failures());
        assert!(of("printed_f64").failures() > 0 && of("map_f64").failures() == 0);
        // What tests/apparent_map.rs promises, everywhere.
        for (way, promise) in [("map_f64", 5e-16), ("map_f32", 3e-7)] {
            let map = of(way);
            let promise = if quantity == "doppler" { 2.0 * promise } else { promise };
            for (cell, error) in map.errors.iter().enumerate() {
                let conditioning = map.conditioning.as_ref().unwrap()[cell];
                assert!(*error <= promise * conditioning, "{} {cell}: {error:e} {conditioning}", map.name);
            }
        }
    }
}

#[test]
fn lines_of_sight_fail_where_shapes_are_cut_instead_or_a_note_is_made() {
    let maps = sheet("sight");
    for name in ["exact", "trace", "exact_size", "trace_size"] {
        let map = map(&maps, name);
        assert!(map.failures() > 0, "{name}");
        for cell in 0..map.errors.len() {
            let fast = map.x.values[cell % map.x.len()] > MOST_GAMMA;
            assert_eq!(map.planner[cell], if fast { Planner::Warns } else { Planner::Enters });
        }
    }
    for name in ["cut", "cut_size"] {
        assert_eq!(map(&maps, name).failures(), 0, "{name}");
        assert!(map(&maps, name).planner.contains(&Planner::Enters));
    }
}

#[test]
fn what_is_too_fast_is_told() {
    for (name, gamma, told) in [("cube", 2e5, false), ("shadow", 9e4, false), ("shadow", 2e5, true)] {
        let mut scene = builtin_scene(name).unwrap().scene();
        scene.set_speed(Speed::Along(gamma)).unwrap();
        let (method, _) = cheapest(&scene, Coloring::Spectral);
        assert_eq!(lacks_digits(&scene, method), told, "{name} {gamma}");
        assert!(!lacks_digits(&scene, Method::Apparent));
    }
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let words = ["render", "shadow", "--celerity", "2e5", "--size", "32x18", "--json", "s.json"];
    let said = good(&words, at);
    assert!(said.contains("lines of sight lose digits") && said.contains("--method apparent"), "{said}");
    let json: Value = serde_json::from_slice(&std::fs::read(at.join("s.json")).unwrap()).unwrap();
    assert!(
        json["notes"].as_array().unwrap().iter().any(|note| note.as_str().unwrap().contains("γ is above"))
    );
    let said = good(&["render", "cube", "--celerity", "2e5", "--size", "32x18"], at);
    assert!(!said.contains("lose digits: outlines"), "{said}");
    let said = good(&["render", "cube", "--celerity", "2e5", "--size", "32x18", "--method", "exact"], at);
    assert!(said.contains("lose digits: outlines"), "{said}");
}

#[test]
fn large_triangles_are_cut() {
    let maps = sheet("cutting");
    for beta in ["0.9", "0.999"] {
        assert!(map(&maps, &format!("uncut_{beta}")).failures() > 0);
        assert_eq!(map(&maps, &format!("cut_{beta}")).failures(), 0);
    }
}

#[test]
fn the_painter_fails_where_bodies_cross_and_is_not_chosen() {
    let maps = sheet("painter");
    let painter = map(&maps, "painter");
    assert!(painter.planner.iter().all(|p| *p == Planner::Avoids));
    for cell in 0..painter.errors.len() {
        let crosses = painter.x.values[cell % painter.x.len()] > 0.0;
        if painter.fails(cell) {
            assert!(crosses, "{cell}");
        }
    }
    assert!(painter.failures() > 0);
    assert_eq!(map(&maps, "z_buffer").failures(), 0);
}

#[test]
fn doppler_factors_of_vertices_fail_for_large_triangles_and_are_not_chosen() {
    let maps = sheet("vertices");
    for name in ["uncut", "cut"] {
        let map = map(&maps, name);
        assert!(map.failures() > 0 && map.planner.iter().all(|p| *p == Planner::Avoids), "{name}");
    }
    let pixels = map(&maps, "pixels");
    // f32 light, of the fourth power.
    assert!(pixels.worst(&[Planner::Enters]).unwrap() < 2e-6);
}

#[test]
fn curved_light_is_followed_accurately_enough() {
    for map in sheet("curved") {
        let worst = map.worst(&[Planner::Enters]).unwrap();
        // Ten times what is allowed in a step, over the conditioning; from near a fast hole, of which the coarse map has steps
        // a thousand times as long as pictures are made with, a quarter of a pixel over a hundred.
        let most = if map.name == "falling" { 4e-6 } else { 1e-7 };
        assert!(worst < most, "{}: {worst:e}", map.name);
        let near_horizon = ["horizon", "falling"].contains(&map.name.as_str());
        assert_eq!(map.planner.contains(&Planner::Warns), near_horizon, "{}", map.name);
    }
}

/// Who hovers a hundredth of its radius above the horizon sees the sky in a small cone overhead, and no ray of it is lost;
/// a millionth above, f64 has no digits for them, and pixels say so.
#[test]
fn the_sky_from_just_outside_the_horizon() {
    let folder = tempfile::tempdir().unwrap();
    let lost = |height: f64| {
        let radius = 2.0 * (1.0 + height);
        // The cone that is left of the sky is as narrow as the root of the height.
        let field = 170.0 * height.sqrt();
        let scene = format!(
            "[spacetime]\nmetric = \"schwarzschild\"\n[sky]\ntexture = \"stars\"\n[camera]\nposition = [{radius}, 0, 0]\nforward = [1, 0, 0]\nfov_deg = {field}\nsize = [24, 16]\n"
        );
        std::fs::write(folder.path().join("s.toml"), scene).unwrap();
        good(&["render", "s.toml", "--json", "s.json", "--color", "geometry"], folder.path());
        let json: Value =
            serde_json::from_slice(&std::fs::read(folder.path().join("s.json")).unwrap()).unwrap();
        let rays = &json["rays"];
        let failed = rays["failed"].as_object().unwrap().values().map(|n| n.as_u64().unwrap()).sum::<u64>();
        (failed, rays["from_sky"].as_u64().unwrap())
    };
    for height in [0.3, 0.1, 0.03, 0.01, 0.002] {
        let (failed, sky) = lost(height);
        assert!(failed == 0 && sky > 10, "{height}: {failed} {sky}");
    }
    assert!(lost(5e-6).0 > 10);
}

#[test]
fn the_chart_is_drawn_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::create_dir(at.join("maps")).unwrap();
    let said = good(&["chart", "--stability", "--quick", "-o", "maps/s"], at);
    assert!(said.contains("cells fail") && !said.contains("note:"), "{said}");
    for sheet in SHEETS {
        let svg = std::fs::read_to_string(at.join(format!("maps/s_{}.svg", sheet.name))).unwrap();
        assert!(svg.contains(sheet.title) && svg.contains("taken"), "{}", sheet.name);
        assert!(program::pixels(at.join(format!("maps/s_{}.png", sheet.name))).width() > 500);
    }
    let json: Value = serde_json::from_slice(&std::fs::read(at.join("maps/s.json")).unwrap()).unwrap();
    let maps = json["maps"].as_array().unwrap();
    assert!(maps.len() > 20);
    assert!(maps.iter().all(|map| map["failing_cells_the_planner_enters"].as_array().unwrap().is_empty()));
    let csv = std::fs::read_to_string(at.join("maps/s.csv")).unwrap();
    let size = |axis: &Value| axis["values"].as_array().unwrap().len();
    assert_eq!(csv.lines().count(), 1 + maps.iter().map(|m| size(&m["x"]) * size(&m["y"])).sum::<usize>());
    assert!(bad(&["chart", "--stability", "-o", "s.pdf"], at).contains(".pdf"));
    assert!(bad(&["chart", "--stability", "--geodesics"], at).contains("--geodesics"));
}

/// A poster before a wall, at whose back the camera looks as they pass: depth is squeezed by 2γ, and what is nearer is seen all
/// the same, though f32 cannot tell.
#[test]
fn what_lies_before_hides_what_is_behind_at_any_speed() {
    for gamma in [2.0f64, 1e3, 1e5, 1e6, 1e7, 1e8] {
        let celerity = Celerity::new(DVec3::X * (gamma - 1.0).sqrt() * (gamma + 1.0).sqrt()).unwrap();
        let motion = Motion { celerity, origin: Event::at(-4.0, DVec3::Y * 4.0) };
        let facing_back = DAffine3::from_rotation_y(FRAC_PI_2);
        let plate = |size: f64, before: f64| {
            let place = DAffine3::from_translation(DVec3::X * -before) * facing_back;
            shapes::plate().placed(&(place * DAffine3::from_scale(DVec3::splat(size))))
        };
        for projection in [Projection::Pinhole, Projection::Panorama] {
            let view = View { aim: Aim::Forward(DVec3::Y), projection, size: [160, 80], ..View::default() };
            let seen = |bodies: Vec<Body>| {
                let scene = Scene::new("posted", bodies, view.clone());
                let options = Options { method: Method::Apparent, ..Options::default() };
                render(&scene, &scene.camera().unwrap(), &options, |_| ()).unwrap().0
            };
            let poster = || Body::new("poster", plate(0.7, 1e-3), motion);
            let (alone, both) =
                (seen(vec![poster()]), seen(vec![Body::new("wall", plate(1.0, 0.0), motion), poster()]));
            let of = |film: &Film, body| film.body.iter().map(|b| *b == body).collect::<Vec<_>>();
            let differ = of(&alone, 0).iter().zip(of(&both, 1)).filter(|(a, b)| **a != *b).count();
            assert_eq!(differ, 0, "{gamma:e} {projection:?}");
            assert!(
                alone.covered() > 50 && both.covered() > alone.covered() + 50,
                "{gamma:e} {projection:?}"
            );
        }
    }
}
