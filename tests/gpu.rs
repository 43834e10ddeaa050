//! Drawing on a graphics processor shows what the CPU shows.
#![cfg(feature = "gpu")]

use glam::DVec3;
use terrell::color::Coloring;
use terrell::film::{Film, Samples};
use terrell::geodesic::{Celerity, Event};
use terrell::light::DopplerAt;
use terrell::plan::{MOST_GAMMA, MOST_GAMMA_ON_GPU, Method, is_worth_a_gpu, not_on_gpu};
use terrell::raster::gpu::{Gpu, GpuError, Uncut, shaders};
use terrell::relativity::{ApparentMap, Motion};
use terrell::render::{Options, Raster, RenderError, render, render_again};
use terrell::scene::{Aim, Body, EmissionLaw, Material, Paint, Projection, Scene, Speed, View};
use terrell::scene::{builtin_scene, builtin_scenes, shapes};
use terrell::tone::{Development, Tone};

/// Plain checks, without any device.
#[test]
fn shaders_are_valid() {
    for (name, source) in shaders() {
        let module = naga::front::wgsl::parse_str(&source)
            .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string_with_path(&source, name)));
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string_with_path(&source, name)));
    }
}

fn shipped(name: &str) -> Scene {
    builtin_scene(name).unwrap().scene()
}

/// By CPU and GPU.
fn both(scene: &Scene, options: &Options) -> [Film; 2] {
    let camera = scene.camera().unwrap();
    [Raster::Cpu, Raster::Wgpu].map(|raster| {
        let options = Options { raster, ..options.clone() };
        render(scene, &camera, &options, |_| ()).unwrap_or_else(|e| panic!("{}: {e}", scene.name)).0
    })
}

/// How two films differ.
#[derive(Clone, Copy, Debug, Default)]
struct Difference {
    /// Pixels that see the same triangle as all around them.
    clear: usize,
    /// Of these, those that see another by the GPU.
    other: usize,
    /// Pixels that by the GPU see what no pixel around sees by the CPU.
    beyond: usize,
    /// Greatest relative errors where both see the same triangle.
    distance: f64,
    doppler: f64,
    color: f64,
}

/// A pixel and those around it.
fn around(film: &Film, i: usize) -> Vec<usize> {
    let (width, height) = (film.width as usize, film.height as usize);
    let (x, y) = (i % width, i / width);
    let columns = x.saturating_sub(1)..(x + 2).min(width);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    rows.flat_map(|y| columns.clone().map(move |x| y * width + x)).collect()
}

fn sees(film: &Film, i: usize) -> (i32, i32) {
    (film.body[i], film.face[i])
}

/// Light of pixels beside which something else is seen: of each, the brightest around.
fn outlines(film: &Film) -> f64 {
    let light = |i: usize| film.color[i].iter().map(|v| f64::from(*v)).sum::<f64>();
    let brightest = |i: usize| {
        let around = around(film, i);
        let clear = around.iter().all(|j| sees(film, *j) == sees(film, i));
        if clear { 0.0 } else { around.into_iter().map(light).fold(0.0, f64::max) }
    };
    (0..film.color.len()).map(brightest).sum()
}

impl Difference {
    /// The worse of two.
    fn with(self, other: Self) -> Self {
        Self {
            clear: self.clear + other.clear,
            other: self.other + other.other,
            beyond: self.beyond + other.beyond,
            distance: self.distance.max(other.distance),
            doppler: self.doppler.max(other.doppler),
            color: self.color.max(other.color),
        }
    }

    fn of([cpu, gpu]: &[Film; 2]) -> Self {
        let mut difference = Self::default();
        for i in 0..cpu.body.len() {
            let around: Vec<_> = around(cpu, i).into_iter().map(|j| sees(cpu, j)).collect();
            difference.beyond += usize::from(!around.contains(&sees(gpu, i)));
            if around.iter().any(|other| *other != sees(cpu, i)) {
                continue;
            }
            difference.clear += 1;
            if sees(cpu, i) != sees(gpu, i) {
                difference.other += 1;
                continue;
            }
            let relative = |a: f32, b: f32, of: f32| f64::from((a - b).abs() / of.max(1e-30));
            let brightest = cpu.color[i].iter().fold(0.0f32, |m, v| m.max(v.abs()));
            for k in 0..3 {
                let off = relative(gpu.color[i][k], cpu.color[i][k], brightest);
                difference.color = difference.color.max(off);
            }
            let off = |gpu: &[f32], cpu: &[f32]| relative(gpu[i], cpu[i], cpu[i]);
            difference.distance = difference.distance.max(off(&gpu.distance, &cpu.distance));
            difference.doppler = difference.doppler.max(off(&gpu.doppler, &cpu.doppler));
        }
        difference
    }
}

/// Exact shading by CPU and GPU, whatever the plan says.
fn drawn_anyway(scene: &Scene, coloring: Coloring) -> [Film; 2] {
    let camera = scene.camera().unwrap();
    let options = Options { coloring, ..Options::default() };
    let prepared = options.prepare(scene, [&camera]).unwrap();
    let shading = prepared.shading.seen_by(&camera.observer);
    let maps: Vec<_> = scene.bodies.iter().map(|b| ApparentMap::new(&b.motion, &camera.observer)).collect();
    let body = |(body, map)| Uncut { body, mesh: &scene.bodies[body].mesh, map };
    let bodies: Vec<_> = maps.iter().enumerate().map(body).collect();
    let [mut cpu, mut gpu] = [Film::new(0, 0), Film::new(0, 0)];
    render_again(scene, &camera, &options, &prepared, &mut cpu, |_| ()).unwrap();
    Gpu::shared().unwrap().draw_uncut(&bodies, &camera.lens, &Samples::new(1), &shading, &mut gpu).unwrap();
    [cpu, gpu]
}

/// What a graphics processor draws of what ships.
fn luminous() -> Vec<Scene> {
    let is_drawn = |scene: &Scene| {
        let camera = scene.camera().unwrap();
        !scene.spacetime.is_curved()
            && not_on_gpu(scene, &[&camera], Method::Exact, Coloring::Spectral, DopplerAt::Pixel).is_none()
    };
    builtin_scenes().iter().map(|s| s.scene()).filter(is_drawn).collect()
}

const LENSES: [Projection; 3] = [Projection::Pinhole, Projection::Fisheye, Projection::Panorama];

fn at(scene: &Scene, projection: Projection, speed: f64) -> Option<Scene> {
    let mut scene = scene.clone();
    scene.view.size = [321, 181];
    scene.view.projection = projection;
    scene.view.fov_deg = (projection == Projection::Pinhole).then_some(70.0);
    scene.set_speed(Speed::Along(speed)).unwrap();
    scene.camera().is_ok().then_some(scene)
}

/// What a film's colour, distance and Doppler factor may be off by, relative, where both see the same triangle.
const ACCURACY: f64 = 1e-4;

/// Checks what is the same for all: what was off, for who asks for it.
fn check(scene: &Scene, options: &Options, what: &str) -> Difference {
    let difference = Difference::of(&both(scene, options));
    let Difference { other, distance, doppler, color, .. } = difference;
    let what = format!("{} {what} {difference:?}", scene.name);
    assert_eq!(other, 0, "{what}");
    assert!(distance < ACCURACY && doppler < ACCURACY && color < ACCURACY, "{what}");
    difference
}

/// All that ships and shines by itself, before every lens, from rest to 0.9999c.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn exact_shading_of_scenes_that_ship() {
    let scenes = luminous();
    assert!(scenes.len() > 6);
    let (mut clear, mut beyond) = (0, 0);
    for (scene, projection) in scenes.iter().flat_map(|s| LENSES.map(|p| (s, p))) {
        for beta in [0.0f64, 0.5, 0.9, 0.9999] {
            // Moved for the look of it: where nothing passes, there is nothing to be abreast of.
            let speed = beta.max(1e-6);
            let Some(scene) = at(scene, projection, speed / (1.0 - speed * speed).sqrt()) else { continue };
            let difference = check(&scene, &Options::default(), &format!("{projection} {beta}"));
            clear += difference.clear;
            beyond += difference.beyond;
        }
    }
    // Thin things the size of a pixel, of which it depends on a ten-thousandth of one whether they are seen.
    assert!(clear > 2_000_000 && beyond * 50_000 < clear, "{clear} {beyond}");
}

/// As far as single precision is said to be enough, and beyond, where only what is seen of a triangle is still right: prints
/// what is off.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn the_greatest_gamma() {
    let gammas = [10.0, 1e2, MOST_GAMMA_ON_GPU * 0.999, 1e4, MOST_GAMMA * 0.999];
    for gamma in gammas {
        let mut worst = Difference::default();
        for (scene, projection) in luminous().iter().flat_map(|s| LENSES.map(|p| (s, p))) {
            let Some(scene) = at(scene, projection, f64::sqrt(gamma * gamma - 1.0)) else { continue };
            for coloring in [Coloring::Spectral, Coloring::Flat] {
                let difference = Difference::of(&drawn_anyway(&scene, coloring));
                let Difference { other, distance, doppler, color, .. } = difference;
                let what = format!("{} {projection} {gamma} {coloring} {difference:?}", scene.name);
                assert!(gamma > MOST_GAMMA_ON_GPU || other == 0, "{what}");
                assert!(distance < ACCURACY && doppler < ACCURACY && color < ACCURACY, "{what}");
                worst = worst.with(difference);
            }
        }
        println!("γ {gamma:8.2e} {worst:?}");
    }
}

/// Cut shapes, a pinhole's moved by the shader.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn apparent_shading() {
    for name in ["cube", "lattice", "street"] {
        for projection in LENSES {
            for speed in [1e-6, 2.0, 20.0] {
                let Some(scene) = at(&shipped(name), projection, speed) else { continue };
                let options = Options { method: Method::Apparent, ..Options::default() };
                check(&scene, &options, &format!("{projection} {speed}"));
            }
        }
    }
}

/// All colours there are, of spectra and without.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn colorings() {
    for name in ["hot", "street"] {
        for coloring in Coloring::ALL {
            let Some(scene) = at(&shipped(name), Projection::Pinhole, 2.0) else { continue };
            let options = Options { coloring, ..Options::default() };
            check(&scene, &options, &coloring.to_string());
        }
    }
}

/// Samples beside the middle, averaged.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn samples() {
    let Some(scene) = at(&shipped("lattice"), Projection::Pinhole, 2.0) else { panic!("lattice") };
    for method in [Method::Exact, Method::Apparent] {
        let films = both(&scene, &Options { samples: 9, method, ..Options::default() });
        let [cpu, gpu] = &films;
        let off =
            |i: usize| (0..3).map(|k| f64::from((cpu.color[i][k] - gpu.color[i][k]).abs())).sum::<f64>();
        let whole: f64 = cpu.color.iter().flatten().map(|v| f64::from(*v)).sum();
        let difference: f64 = (0..cpu.color.len()).map(off).sum();
        // Uncut, a sample of an outline's pixels now and then. A pinhole's polygons are drawn by what the device has of places
        // within a pixel, to a 256th: so much of either side of what lies on an outline.
        let most = if method == Method::Exact { 1e-3 * whole } else { 2.0 / 256.0 * outlines(cpu) };
        assert!(difference < most, "{method} {difference} {most} {whole}");
        assert_eq!(Difference::of(&films).other, 0);
    }
}

/// A mesh around the camera, of triangles that cross the camera's plane, with no cracks; and paint of vertices, and laws of
/// emission.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn around_the_camera() {
    let mut ball = shapes::sphere(3);
    ball.paint =
        Paint::Vertices((0..ball.vertex_count()).map(|i| [0.2, 0.5, (i % 7) as f32 / 7.0]).collect());
    for law in [EmissionLaw::Cosine { power: 1.5 }, EmissionLaw::LimbDarkening { coefficients: [0.5, 0.2] }] {
        ball.materials = vec![Material { law, ..Material::default() }];
        ball.normals = Vec::new();
        let celerity = Celerity::new(DVec3::new(1.5, -0.4, 0.3)).unwrap();
        let motion = Motion { celerity, origin: Event::new(0.0, 0.1, 0.2, -0.1) };
        let view = View { size: [321, 181], ..View::default() };
        let scene = Scene::new("ball", vec![Body::new("ball", ball.clone(), motion)], view);
        for projection in LENSES {
            let mut scene = scene.clone();
            scene.view.projection = projection;
            let [cpu, gpu] = both(&scene, &Options::default());
            assert_eq!(cpu.covered(), gpu.covered(), "{projection}");
            check(&scene, &Options::default(), &format!("{projection}"));
        }
    }
}

/// Nothing to be seen, and a picture in parts.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn nothing_and_much() {
    let mut scene = shipped("cube");
    scene.view.aim = Aim::Forward(DVec3::new(0.0, -1.0, 0.0));
    scene.view.size = [64, 48];
    assert_eq!(both(&scene, &Options::default())[1].covered(), 0);
    let mut scene = shipped("lattice");
    scene.view.size = [2500, 2100];
    let difference = check(&scene, &Options::default(), "large");
    assert!(difference.beyond < 10, "{difference:?}");
}

/// Fields of which a whole picture is a few roundings of a unit vector wide.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn narrow_fields() {
    for (name, fov) in [("lattice", 0.5), ("lattice", 1e-3), ("gate", 0.05), ("gate", 1e-5)] {
        for speed in [1e-6, 2.0, 500.0] {
            let mut scene = shipped(name);
            scene.set_speed(Speed::Along(speed)).unwrap();
            scene.view.size = [160, 90];
            scene.view.fov_deg = Some(fov);
            if scene.camera().is_err() {
                continue;
            }
            for method in [Method::Exact, Method::Apparent] {
                check(&scene, &Options { method, ..Options::default() }, &format!("{method} {fov} {speed}"));
            }
        }
    }
}

/// Two runs are one to the bit.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn runs_are_alike() {
    let Some(scene) = at(&shipped("street"), Projection::Pinhole, 2.0) else { panic!("street") };
    for method in [Method::Exact, Method::Apparent] {
        let options = Options { method, raster: Raster::Wgpu, ..Options::default() };
        let camera = scene.camera().unwrap();
        let [one, other] = [(), ()].map(|()| render(&scene, &camera, &options, |_| ()).unwrap().0);
        assert_eq!(one, other);
    }
}

/// What the device develops is what the CPU makes of the same film, but for a code at a rounding.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn pictures_developed_on_the_device() {
    let Some(scene) = at(&shipped("hot"), Projection::Pinhole, 2.0) else { panic!("hot") };
    let camera = scene.camera().unwrap();
    let gpu = Gpu::shared().unwrap();
    let options = Options { raster: Raster::Wgpu, ..Options::default() };
    let prepared = options.prepare(&scene, [&camera]).unwrap();
    let shading = prepared.shading.seen_by(&camera.observer);
    let maps: Vec<_> = scene.bodies.iter().map(|b| ApparentMap::new(&b.motion, &camera.observer)).collect();
    let body = |(body, map)| Uncut { body, mesh: &scene.bodies[body].mesh, map };
    let bodies: Vec<_> = maps.iter().enumerate().map(body).collect();
    let samples = Samples::new(2);
    let mut film = Film::new(0, 0);
    gpu.draw_uncut(&bodies, &camera.lens, &samples, &shading, &mut film).unwrap();
    for tone in Tone::ALL {
        let development = Development { ev: tone.metered(film.color.iter().copied()), tone };
        let there = gpu.picture_uncut(&bodies, &camera.lens, &samples, &shading, &development).unwrap();
        let here = terrell::picture::pixels_srgb(&film, &development);
        assert_eq!(there.len(), here.len());
        let most = there.iter().zip(&here).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(most <= Some(1), "{tone} {most:?}");
        assert!(here.iter().filter(|v| **v > 100).count() > 1000);
    }
}

/// A device that is lost is an error, not a panic.
#[test]
#[ignore = "needs a Vulkan driver, such as Debian's mesa-vulkan-drivers"]
fn lost_devices() {
    let Some(scene) = at(&shipped("cube"), Projection::Pinhole, 2.0) else { panic!("cube") };
    let camera = scene.camera().unwrap();
    let gpu = Gpu::open().unwrap();
    let prepared = Options::default().prepare(&scene, [&camera]).unwrap();
    let shading = prepared.shading.seen_by(&camera.observer);
    let map = ApparentMap::new(&scene.bodies[0].motion, &camera.observer);
    let bodies = [Uncut { body: 0, mesh: &scene.bodies[0].mesh, map: &map }];
    let mut film = Film::new(0, 0);
    let mut draw = || gpu.draw_uncut(&bodies, &camera.lens, &Samples::new(1), &shading, &mut film);
    assert_eq!(draw(), Ok(()));
    gpu.close();
    assert!(matches!(draw(), Err(GpuError::Lost { .. })));
}

/// Scene → plan: what a graphics processor does not have is not asked of it.
#[test]
fn plans() {
    let of = |name: &str, method, coloring| {
        let scene = shipped(name);
        not_on_gpu(&scene, &[&scene.camera().unwrap()], method, coloring, DopplerAt::Pixel)
    };
    assert_eq!(of("cube", Method::Exact, Coloring::Spectral), None);
    assert_eq!(of("street", Method::Apparent, Coloring::Flat), None);
    assert_eq!(of("cube", Method::Trace, Coloring::Spectral), Some("rays are traced on the CPU"));
    assert!(of("sunlit", Method::Exact, Coloring::Spectral).unwrap().contains("lights"));
    assert_eq!(of("sunlit", Method::Exact, Coloring::Doppler), None);
    let mut fast = shipped("cube");
    fast.set_speed(Speed::Along(MOST_GAMMA_ON_GPU * 1.1)).unwrap();
    let camera = fast.camera().unwrap();
    let why = not_on_gpu(&fast, &[&camera], Method::Exact, Coloring::Spectral, DopplerAt::Pixel);
    assert_eq!(why, Some("γ is too large for single precision"));
    // A picture is not worth the way, a long film is.
    assert!(!is_worth_a_gpu(&[&camera], 1) && is_worth_a_gpu(&[&camera; 120], 1));
    let wgpu = Options { raster: Raster::Wgpu, ..Options::default() };
    assert!(matches!(wgpu.prepare(&shipped("sunlit"), [&camera]), Err(RenderError::NotOnGpu(_))));
}

/// The command: asked for what it cannot have, it says so on one line, and writes nothing.
#[test]
fn what_cannot_be_had_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("terrell").unwrap();
        // Without any driver, wherever this runs.
        command.env("VK_DRIVER_FILES", "/nowhere").env("VK_ICD_FILENAMES", "/nowhere");
        command.current_dir(&folder).args(args).args(["--size", "64x36"]).output().unwrap()
    };
    for (args, why) in [
        (&["render", "sunlit", "--raster", "wgpu"][..], "lights"),
        (&["render", "blackhole", "--raster", "wgpu"], "curved"),
        (&["render", "box", "--raster", "wgpu"], "surfaces light each other"),
        (&["render", "cube", "--raster", "wgpu", "--method", "trace"], "rays"),
        (&["render", "cube", "--raster", "wgpu", "--gamma", "2e3", "--method", "exact"], "γ"),
    ] {
        let out = run(args);
        let error = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(2), "{args:?} {error}");
        assert!(error.contains(why) && error.lines().count() == 1, "{args:?} {error}");
    }
    assert!(std::fs::read_dir(&folder).unwrap().next().is_none());
    // By itself it draws without.
    let out = run(&["render", "cube", "--json", "-"]);
    assert!(out.status.success());
    let json: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
    assert_eq!((&json["raster"], &json["gpu"]), (&"cpu".into(), &serde_json::Value::Null));
    #[cfg(target_os = "linux")]
    {
        let out = run(&["render", "cube", "--raster", "wgpu"]);
        let error = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(2), "{error}");
        assert!(error.contains("no graphics processor"), "{error}");
    }
}
