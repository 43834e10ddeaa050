//! Scene → plan, and what is told of it.

#[path = "common/program.rs"]
#[allow(dead_code)]
mod program;

use program::{bad, good};
use terrell::color::Coloring;
use terrell::explanation::Explanation;
use terrell::light::DopplerAt;
use terrell::plan::{Method, cheapest, is_of_polygons, is_worth_a_gpu, not_on_gpu};
use terrell::render::{Options, Raster};
use terrell::scene::{Camera, Scene, Speed, builtin_scenes};

fn shipped(name: &str) -> Scene {
    builtin_scenes().iter().find(|s| s.name == name).unwrap().scene()
}

/// No more than a scene needs: by what it contains and what of it is to be seen.
#[test]
fn plans() {
    const PLAIN: &str = "nothing casts shadows";
    const SHADOWS: &str = "shadows need rays from what is seen only";
    const DOPPLER: &str = "the Doppler factor needs no light";
    const LIT: Option<&str> = Some("what lights shine on is drawn on the CPU");
    const RAYS: Option<&str> = Some("rays are traced on the CPU");
    for (name, coloring, method, why, not_on_gpu_because) in [
        ("cube", Coloring::Spectral, Method::Exact, PLAIN, None),
        ("gate", Coloring::Spectral, Method::Exact, PLAIN, None),
        ("lattice", Coloring::Geometry, Method::Exact, PLAIN, None),
        ("street", Coloring::Flat, Method::Exact, PLAIN, None),
        ("shadow", Coloring::Spectral, Method::Exact, SHADOWS, LIT),
        ("sunlit", Coloring::Spectral, Method::Exact, SHADOWS, LIT),
        ("shadow", Coloring::Doppler, Method::Exact, DOPPLER, None),
        ("box", Coloring::Spectral, Method::Trace, "surfaces light each other", RAYS),
        ("box", Coloring::Doppler, Method::Exact, DOPPLER, None),
        ("blackhole", Coloring::Spectral, Method::Trace, "spacetime is curved", RAYS),
        ("blackhole", Coloring::Doppler, Method::Trace, "spacetime is curved", RAYS),
    ] {
        let scene = shipped(name);
        assert_eq!(cheapest(&scene, coloring), (method, why), "{name} {coloring}");
        let camera = scene.camera().unwrap();
        let gpu = not_on_gpu(&scene, &[&camera], method, coloring, DopplerAt::Pixel);
        assert_eq!(gpu, not_on_gpu_because, "{name} {coloring}");
    }
    // Beyond what lines of sight have digits for.
    for (name, gamma, expected) in
        [("cube", 9e4, Method::Exact), ("cube", 2e5, Method::Apparent), ("shadow", 2e5, Method::Exact)]
    {
        let mut scene = shipped(name);
        scene.set_speed(Speed::Along(gamma)).unwrap();
        assert_eq!(cheapest(&scene, Coloring::Spectral).0, expected, "{name} {gamma}");
    }
    assert!(!is_of_polygons(&shipped("shadow")) && is_of_polygons(&shipped("gate")));
}

/// A graphics processor is opened where there is much to draw: many pictures, large ones, or many samples.
#[test]
fn size_decides_about_devices() {
    let mut scene = shipped("gate");
    scene.view.size = [1280, 720];
    let camera = scene.camera().unwrap();
    for (pictures, samples, is_worth) in [(1, 1, false), (30, 1, false), (60, 1, true), (1, 64, true)] {
        let cameras: Vec<&Camera> = vec![&camera; pictures];
        assert_eq!(is_worth_a_gpu(&cameras, samples), is_worth, "{pictures} {samples}");
    }
}

/// What is taken is right; what is said to be wrong is what the method lacks; and size decides how triangles are found.
#[test]
fn explanations_agree_with_plans() {
    for scene in builtin_scenes() {
        let scene = scene.scene();
        for coloring in [Coloring::Spectral, Coloring::Doppler] {
            let (method, _) = cheapest(&scene, coloring);
            let options = Options { method, coloring, ..Options::default() };
            let told = Explanation::new(&scene, &[&scene.camera().unwrap()], &options);
            let is_right = |name: &str| told.methods.iter().find(|v| v.name == name).unwrap().is_right;
            assert!(is_right(&method.to_string()), "{}: {told}", scene.name);
            // Rays show everything.
            assert!(is_right("trace"), "{}: {told}", scene.name);
            let of_polygons = is_of_polygons(&scene)
                || (coloring == Coloring::Doppler && !scene.spacetime.is_curved() && scene.sky.is_none());
            assert_eq!(is_right("apparent"), of_polygons, "{}: {told}", scene.name);
            assert_eq!(told.device, "the CPU");
        }
    }
    let mut scene = shipped("gate");
    let mesh = std::sync::Arc::make_mut(&mut scene.bodies[0].mesh);
    let one = mesh.clone();
    while mesh.triangles.len() < 1 << 15 {
        mesh.append(one.clone());
    }
    let camera = scene.camera().unwrap();
    let exact = |pictures: usize| {
        let told = Explanation::new(&scene, &vec![&camera; pictures], &Options::default());
        told.methods[0].reason.clone()
    };
    assert!(exact(100).contains("lists") && exact(101).contains("boxes"));
    // It was not asked for, so it is not looked for.
    let cpu = Options { raster: Raster::Cpu, ..Options::default() };
    let told = Explanation::new(&scene, &[&camera], &cpu);
    assert_eq!(told.devices[1].reason, "not asked for");
}

#[test]
fn the_command_explains_and_draws_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let told = good(&["render", "shadow", "--explain"], here);
    assert!(told.starts_with("shadow: method exact on the CPU (shadows need rays"), "{told}");
    for part in ["  > exact", "no: it has no shadows", "no: what lights shine on is drawn on the CPU"] {
        assert!(told.contains(part), "{told}");
    }
    assert!(
        good(&["render", "gate", "--method", "trace", "--explain"], here)
            .contains("trace on the CPU (asked for)")
    );
    let film = good(&["animate", "cube", "gate", "--frames", "9", "--explain"], here);
    assert!(film.contains("9 pictures of") && film.contains("gate: method exact"), "{film}");
    assert_eq!(std::fs::read_dir(here).unwrap().count(), 0);
    let told: serde_json::Value =
        serde_json::from_str(&good(&["render", "box", "--explain", "-q", "--json", "-"], here)).unwrap();
    assert_eq!(told["method"], "trace");
    assert_eq!(told["methods"][0]["is_right"], false);
    let message = bad(&["render", "blackhole", "--method", "exact", "--explain"], here);
    assert!(message.contains("curved spacetime"), "{message}");
}
