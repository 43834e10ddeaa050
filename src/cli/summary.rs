//! What is said of scenes, cameras and what was made of them: values of `--json`, notes, and words for people.

use serde_json::{Value, json};
use terrell::color::Coloring;
use terrell::film::Film;
use terrell::geodesic::{Event, Sense, Tetrad, World};
use terrell::light::{DopplerAt, Shading, TableInfo, has_shadows};
use terrell::plan::{Method, has_reflections, is_of_polygons, lacks_digits};
use terrell::relativity::ApparentMap;
use terrell::render::{Options, Raster, Report};
use terrell::scene::{Body, Camera, Light, Scene, Spacetime, Stance};
use terrell::tone::Development;
use terrell::trace::{Count, Traced};

/// Relative γ of every body and the camera.
pub fn gammas(scene: &Scene, camera: &Camera) -> Vec<f64> {
    let gamma = |body: &Body| ApparentMap::new(&body.motion, &camera.observer).gamma();
    scene.bodies.iter().map(gamma).collect()
}

/// "1 body, γ 2.29", "3 bodies, γ up to 7.1".
pub fn bodies_in_words(gammas: &[f64]) -> String {
    let fastest = gammas.iter().copied().fold(1.0, f64::max);
    let fastest = if fastest < 1e6 { format!("{fastest:.4}") } else { format!("{fastest:e}") };
    match gammas.len() {
        1 => format!("1 body, γ {fastest}"),
        n => format!("{n} bodies, γ up to {fastest}"),
    }
}

fn event(e: Event<World>) -> Value {
    let p = e.position();
    json!([e.t(), p.x, p.y, p.z])
}

/// How a camera is there, where that is not its velocity.
pub fn stance(scene: &Scene) -> Value {
    match scene.view.stance {
        Stance::Moving => Value::Null,
        Stance::Zamo => json!("zamo"),
        Stance::Circular(Sense::Prograde) => json!("circular"),
        Stance::Circular(Sense::Retrograde) => json!("retrograde"),
        Stance::Rain => json!("rain"),
        Stance::Infinity { inclination_deg, azimuth_deg, height } => {
            json!({ "inclination_deg": inclination_deg, "azimuth_deg": azimuth_deg, "height": height })
        }
    }
}

pub fn camera(camera: &Camera) -> Value {
    let axes = camera.observer.axes();
    json!({
        "projection": camera.lens.projection().to_string(),
        "size": [camera.lens.width(), camera.lens.height()],
        "event": event(camera.observer.event()),
        "celerity": camera.observer.celerity().vector().to_array(),
        "right": axes[0].to_array(),
        "up": axes[1].to_array(),
        "forward": axes[2].to_array(),
    })
}

pub fn bodies(scene: &Scene, camera: &Camera) -> Value {
    let body = |(body, gamma): (&Body, f64)| {
        json!({
            "name": body.name,
            "triangles": body.mesh.triangles.len(),
            "celerity": body.motion.celerity.vector().to_array(),
            "origin": event(body.motion.origin),
            "gamma_relative_to_camera": gamma,
        })
    };
    scene.bodies.iter().zip(gammas(scene, camera)).map(body).collect()
}

pub fn lights(scene: &Scene) -> Value {
    let light = |light: &Light| {
        json!({
            "name": light.name,
            "kind": light.kind.to_string(),
            "color": light.color,
            "spectrum": light.spectrum.shape.describe(),
            "strength": light.strength,
            "celerity": light.motion.celerity.vector().to_array(),
        })
    };
    scene.lights.iter().map(light).collect()
}

/// The tables of colours under a shift: of what, what is assumed outside the visible, and how exact.
pub fn spectra(tables: &[TableInfo]) -> Value {
    let table = |table: &TableInfo| {
        json!({
            "spectrum": table.spectrum,
            "beyond_visible": table.beyond.to_string(),
            "nodes": table.nodes,
            "greatest_error": table.error,
        })
    };
    tables.iter().map(table).collect()
}

/// Tables that are not as good as usual.
pub fn table_notes(shading: &Shading) -> Vec<String> {
    let bad = shading.tables().iter().filter(|table| table.error > 0.02);
    let note = |table: &TableInfo| {
        format!(
            "colours of the {} are good to {:.0} % only where they are dark or change fast",
            table.spectrum,
            100.0 * table.error
        )
    };
    bad.map(note).collect()
}

/// "flat", or what there is besides.
pub fn spacetime(scene: &Scene) -> Value {
    match scene.spacetime {
        Spacetime::Flat => json!("flat"),
        Spacetime::Kerr(hole) => json!({
            "metric": "kerr",
            "mass": hole.mass(),
            "spin": hole.spin() / hole.mass(),
            "horizon": hole.horizon(),
        }),
    }
}

/// How many rays there were.
pub fn rays(traced: &Traced, scene: &Scene) -> Value {
    let Traced { count, noise, to_lights } = traced;
    let Count { primary, shadow, blocked, path, bodies, sky, hole, impossible, .. } = *count;
    if !scene.spacetime.is_curved() {
        return json!({
            "from_camera": primary,
            "to_lights": shadow,
            "to_lights_blocked": blocked,
            "to_each_light": (!to_lights.is_empty()).then(|| to_lights.iter().map(|[asked, blocked]| json!({ "rays": asked, "blocked": blocked })).collect::<Vec<_>>()),
            "of_paths": path,
            "noise": noise,
        });
    }
    json!({
        "from_camera": primary,
        "from_bodies": bodies,
        "from_sky": sky,
        "from_hole": hole,
        "from_impossible": impossible,
        "failed": { "step_limit": count.step_limit, "drift": count.drifted, "not_a_number": count.singular },
    })
}

/// A light of which nothing reaches what is seen.
pub struct DarkLight {
    /// Whether a body lets nothing of it out, which is a mistake.
    pub shut_in: bool,
    /// For people to read.
    pub told: String,
}

/// The user's mistake, if one of them is shut in.
pub fn check_shut_in(dark: &[DarkLight]) -> Result<(), String> {
    match dark.iter().find(|light| light.shut_in) {
        Some(light) => Err(format!("{}; move it or take it away", light.told)),
        None => Ok(()),
    }
}

/// Lights of which nothing reaches what is seen, by how many rays to each there were and were blocked.
pub fn dark_lights(to_lights: &[[u64; 2]], scene: &Scene, observer: &Tetrad) -> Vec<DarkLight> {
    let dark =
        |([asked, blocked], light): &(&[u64; 2], &Light)| asked == blocked && light.kind.casts_shadows();
    let tell = |([asked, _], light): (&[u64; 2], &Light)| {
        let rays = count_in_words(*asked);
        let around = scene.body_around(light, observer);
        let why = match around {
            Some(body) => {
                format!("it is inside '{}', which lets no light out", body.name)
            }
            None if *asked == 0 => "it shines from behind, or elsewhere".to_owned(),
            None => format!("all {rays} rays to it are blocked"),
        };
        let told = format!("the light '{}' reaches nothing of what is seen: {why}", light.name);
        DarkLight { shut_in: around.is_some(), told }
    };
    to_lights.iter().zip(&scene.lights).filter(dark).map(tell).collect()
}

/// Rays that show nothing, for people to read.
pub fn ray_notes(count: &Count) -> Vec<String> {
    let mut notes = Vec::new();
    if count.hole > 0 {
        notes.push(format!("rays into the hole: {}; failed: {}", count_in_words(count.hole), count.failed()));
    }
    if count.failed() > 0 {
        notes.push(format!(
            "{} rays could not be followed (step limit {}, drift {}, not a number {}); where they begin is magenta",
            count.failed(),
            count.step_limit,
            count.drifted,
            count.singular
        ));
    }
    if count.impossible > 0 {
        notes.push(format!(
            "{} rays meet a body where it would move faster than light, as what rests in an ergosphere; there the picture is magenta",
            count_in_words(count.impossible)
        ));
    }
    notes
}

/// Whether a scene is too fast for the method it is drawn by, for people to read.
pub fn digit_note(scene: &Scene, method: Method) -> Option<String> {
    let remedy = if is_of_polygons(scene) { "" } else { ", but not the shadows, mirrors and skies" };
    let note = || {
        format!(
            "γ is above 10⁵, where lines of sight lose digits: outlines are off, by pixels from some 10⁶ on; --method apparent keeps them{remedy}"
        )
    };
    lacks_digits(scene, method).then(note)
}

/// What of a scene a picture by these options does not show, or not to all digits.
pub fn scene_notes(scene: &Scene, options: &Options) -> Vec<String> {
    let mut notes = light_notes(scene, options);
    notes.extend(digit_note(scene, options.method));
    notes.extend(scene.horizon_notes());
    notes
}

/// What is not drawn of a scene's light, for people to read.
fn light_notes(scene: &Scene, options: &Options) -> Vec<String> {
    let colored = options.coloring != Coloring::Doppler;
    let unlit = colored && scene.lights.is_empty() && !has_reflections(scene);
    if unlit && scene.bodies.iter().flat_map(|b| &b.mesh.materials).any(|m| m.is_lit(false)) {
        return vec!["some surfaces only reflect, and nothing lights them".to_owned()];
    }
    if options.method != Method::Apparent {
        let alone = colored && has_reflections(scene) && options.paths.bounces == 0;
        let follows = if options.method == Method::Exact { "--method trace" } else { "--bounces 4" };
        let note = || format!("light of surfaces on each other is not followed; {follows} follows it");
        return alone.then(note).into_iter().collect();
    }
    let sky = scene.sky.is_some().then(|| "the sky is not there".to_owned());
    let notes = shadow_note(scene, options.coloring).into_iter().chain(sky);
    let method = if has_reflections(scene) { Method::Trace } else { Method::Exact };
    notes.map(|note| format!("{note}; --method {method} has what is missing")).collect()
}

/// As [`light_notes`], where nothing can be traced.
pub fn shadow_note(scene: &Scene, coloring: Coloring) -> Option<String> {
    if coloring == Coloring::Doppler {
        None
    } else if has_reflections(scene) {
        Some("shadows, and light of surfaces on each other, are not there".to_owned())
    } else {
        has_shadows(scene).then(|| "the lights' shadows are not there".to_owned())
    }
}

/// "the CPU", or what graphics processor.
pub fn device(gpu: Option<&str>) -> String {
    gpu.map_or_else(|| "the CPU".to_owned(), |name| format!("the GPU ({name})"))
}

/// Why the CPU drew where it was not meant to, for people to read.
pub fn gpu_note(report: &Report) -> Option<String> {
    report.gpu_fault.as_ref().map(|fault| format!("{fault}; drawn on the CPU instead"))
}

/// What drew it, and why: "apparent shading on the CPU, 12 triangles cut into 96 for 0.25 px".
pub fn method_in_words(options: &Options, report: &Report, why: Option<&str>) -> String {
    let why = why.map_or_else(String::new, |why| format!(" ({why})"));
    let device = device(report.gpu.as_deref());
    match (&report.rays, options.raster) {
        _ if report.gpu.is_some() && options.method == Method::Exact => {
            format!("exact shading on {device}{why}, {} triangles", report.triangles)
        }
        (Some(rays), _) => {
            let Count { primary, shadow, path, .. } = rays.count;
            let mut words = match options.method {
                Method::Exact => format!("exact shading on the CPU{why}, {} triangles", report.triangles),
                _ => format!(
                    "ray tracing on the CPU{why}, {} triangles, {} rays",
                    report.triangles,
                    count_in_words(primary)
                ),
            };
            if shadow > 0 {
                words.push_str(&format!(", {} rays to lights", count_in_words(shadow)));
            }
            if options.paths.bounces > 0 {
                let bounces = options.paths.bounces;
                let s = if bounces == 1 { "" } else { "s" };
                words.push_str(&format!(", {} of paths of {bounces} reflection{s}", count_in_words(path)));
            }
            if let Some(noise) = rays.noise {
                words.push_str(&format!(", noise {:.2} %", 100.0 * noise));
            }
            words
        }
        (None, raster) => format!(
            "apparent shading on {device}{why}{}, {} triangles cut into {} for {} px",
            if raster == Raster::Skia { " (painted back to front)" } else { "" },
            report.triangles,
            report.pieces,
            options.tolerance,
        ),
    }
}

/// "921 600", "3.7 million".
fn count_in_words(count: u64) -> String {
    match count {
        0..1_000_000 => count.to_string(),
        _ => format!("{:.1} million", count as f64 * 1e-6),
    }
}

/// Whether all of a film is black in a PNG.
pub fn is_dark(film: &Film, development: &Development) -> bool {
    let least = 1.5e-4 / development.ev.exp2();
    !film.color.as_flattened().iter().any(|v| *v >= least)
}

/// What to try where all is black.
pub fn dark_note(coloring: Coloring) -> &'static str {
    match coloring {
        Coloring::Geometry => "all of it is too dark to be seen; try another --exposure",
        _ => "all of it is too dark to be seen; try --color geometry or doppler, or another --exposure",
    }
}

/// "spectral colour, +1.25 EV, filmic".
pub fn colors_in_words(coloring: Coloring, development: &Development) -> String {
    let plain = *development == Development::default();
    let exposed =
        if plain { String::new() } else { format!(" at {:+.2} EV, {}", development.ev, development.tone) };
    format!("{coloring} colour{exposed}")
}

pub fn doppler_at(doppler_at: DopplerAt) -> &'static str {
    match doppler_at {
        DopplerAt::Pixel => "pixel",
        DopplerAt::Vertex => "vertex",
    }
}

pub fn raster(raster: Raster, gpu: bool) -> &'static str {
    match raster {
        Raster::Skia => "skia",
        Raster::Wgpu => "wgpu",
        Raster::Auto if gpu => "wgpu",
        Raster::Auto | Raster::Cpu => "cpu",
    }
}

/// The most memory the program has held so far, bytes, where the system tells.
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
