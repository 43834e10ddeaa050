use super::Fault;
use super::drawing::{self, DrawingFlags};
use super::explain::{self, ExplainFlag};
use super::look::{LookFlags, MomentFlags};
use super::progress::progress_bar;
use super::report::{ReportFlags, check_target};
use super::summary;
use super::values::vector;
use clap::Args;
use glam::DVec3;
use indicatif::ProgressBar;
use serde_json::json;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use terrell::color::Coloring;
use terrell::detectors;
use terrell::drawing::Shot;
use terrell::exposure::Exposure;
use terrell::film::{Film, HOLE};
use terrell::light::Shading;
use terrell::picture::{self, Format};
use terrell::render::{Options, Report, Step, render_again};
use terrell::scene::{Camera, Scene};
use terrell::tone::Development;
use terrell::transform::TransformError;

/// One picture of a scene
///
/// SCENE is the name of a scene that ships (see `terrell scenes`), a TOML file, or a mesh (.obj, .gltf, .glb),
/// which is framed so that it is seen whole as it passes, abreast.
#[derive(Args)]
#[command(after_help = "Examples:
  terrell render cube
  terrell render cube --beta 0 -o rest.png
  terrell render statue.glb --beta 0.99 --size 1920x1080 --samples 9
  terrell render gate --camera panorama --size 2000x1000 --color doppler
  terrell render lattice --edges --axes --scale-bar --caption \"β = {beta}, γ = {gamma}\"
  terrell render lattice --beta 0.99 --color doppler --detectors
  terrell render cube --color geometry --detectors=2,1.5,-1
  terrell render shadow --explain
  terrell render street --when \"nearest tram\" -o street.exr --json street.json")]
pub struct Render {
    /// Scene: a name, a .toml file or a mesh
    scene: String,
    /// Picture to write, .png or .exr [default: the scene's name.png]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    moment: MomentFlags,
    /// Draw the apparent shapes themselves, as one solid thing, from another place: right, up and ahead of the camera, whose
    /// frame's detectors have recorded them; without a place all of it is seen from the right, above and behind
    #[arg(long, value_name = "RIGHT,UP,AHEAD", value_parser = vector, num_args = 0..=1, require_equals = true)]
    detectors: Option<Option<DVec3>>,
    #[command(flatten)]
    drawing: DrawingFlags,
    #[command(flatten)]
    explain: ExplainFlag,
    #[command(flatten)]
    report: ReportFlags,
}

impl Render {
    pub fn run(mut self) -> Result<(), Fault> {
        let start = Instant::now();
        let mut options = self.look.options()?;
        let mut scene = self.look.open(&self.scene, &self.moment)?;
        // What its colours stand for, where the picture is of shapes in the colours they are seen in.
        let mut shown = None;
        if let Some(from) = self.detectors {
            let coloring = self.look.coloring_of_shapes()?;
            scene = self.recorded(&scene, from, coloring)?;
            options.coloring = Coloring::Geometry;
            shown = Some(coloring);
        }
        let why = self.look.choose(&mut options, &scene)?;
        let camera = scene.camera()?;
        // Better known before the work than after.
        scene.eye(&camera)?;
        scene.notes.extend(summary::scene_notes(&scene, &options));
        if self.explain.is_asked() {
            return explain::tell(&scene, &[&camera], &options, why, None, &self.report);
        }
        let output = self.output.clone().unwrap_or_else(|| format!("{}.png", scene.name).into());
        Format::of(&output)?;
        check_target(&output)?;
        self.report.check(&output, &scene.files)?;
        let overlay = self.drawing.overlay(&scene)?;
        drawing::check_format(&overlay, &output)?;
        let read = start.elapsed();
        let mut progress = Progress::new(self.report.quiet);
        let coloring = options.coloring;
        let mut film = Film::new(0, 0);
        let prepared = options.prepare(&scene, [&camera])?;
        let tables = start.elapsed() - read;
        scene.notes.extend(summary::table_notes(&prepared.shading));
        let report =
            render_again(&scene, &camera, &options, &prepared, &mut film, |step| progress.show(&scene, step));
        progress.finish();
        let report = report?;
        scene.notes.extend(summary::gpu_note(&report));
        let to_lights = report.rays.as_ref().map_or(&[][..], |rays| &rays.to_lights);
        let dark = summary::dark_lights(to_lights, &scene, &camera.observer);
        summary::check_shut_in(&dark)?;
        let is_dark_told = !dark.is_empty();
        scene.notes.extend(dark.into_iter().map(|light| light.told));
        let exposure = match shown {
            // What is asked for has been done to the light itself.
            Some(_) => Exposure::Fixed(0.0),
            None => self.look.develop.exposure(coloring, &scene),
        };
        let tone = self.look.develop.tone(coloring);
        let development = exposure.of_picture(tone, &scene, &camera, &options, &film)?;
        options.coloring = shown.unwrap_or(coloring);
        let before_writing = start.elapsed();
        let picture = match &overlay {
            Some(overlay) => {
                let tolerance = options.tolerance;
                let shot = Shot {
                    scene: &scene,
                    camera: &camera,
                    film: &film,
                    tolerance,
                    coloring: options.coloring,
                    development,
                };
                let (picture, notes) = drawing::prepare(overlay, &shot, &output)?;
                scene.notes.extend(notes);
                picture
            }
            None => picture::prepare_picture(&film, &development, &output)?,
        };
        let times = Times { read, tables, write: start.elapsed() - before_writing, whole: start.elapsed() };
        let done = Done {
            scene: &scene,
            camera: &camera,
            options: &options,
            film: &film,
            shading: &prepared.shading,
            why,
            development,
            report,
            is_dark_told,
            output,
            times,
        };
        let summary = done.summary();
        self.report.finish(vec![picture], &scene.files, &summary)?;
        self.report.tell(&done.line(), &summary)
    }
}

impl Render {
    /// The scene's apparent shapes, for a picture from aside; a caption tells of the scene itself.
    fn recorded(&mut self, scene: &Scene, from: Option<DVec3>, coloring: Coloring) -> Result<Scene, Fault> {
        if scene.spacetime.is_curved() {
            return Err(format!("--detectors: {}", TransformError::Curved).into());
        }
        scene.check_spacetime()?;
        let camera = scene.camera()?;
        self.drawing.fill_caption(scene, &camera, coloring)?;
        let ev = match self.look.develop.exposure(coloring, scene) {
            Exposure::Fixed(ev) if coloring.is_beamed() => Some(ev),
            _ => None,
        };
        let mut recorded = detectors::seen_from(scene, &camera, from, coloring, ev)?;
        let bodies = summary::bodies_in_words(&summary::gammas(scene, &camera));
        let [x, y, z] = recorded.view.event.position().to_array();
        recorded.notes.push(format!(
            "apparent shapes of {bodies}, as detectors of the camera's frame have them, seen from {x:.4} right, {y:.4} up, {:.4} ahead of it",
            -z
        ));
        if !scene.lights.is_empty() && coloring == Coloring::Geometry {
            recorded.notes.push("shapes are in their surfaces' own colours, unlit".into());
        } else {
            recorded.notes.extend(summary::shadow_note(scene, coloring));
        }
        Ok(recorded)
    }
}

/// What is going on, on a terminal only: a line, or, where something is counted that takes long, a bar.
struct Progress {
    shown: bool,
    terminal: bool,
    start: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    fn new(quiet: bool) -> Self {
        let terminal = !quiet && std::io::stderr().is_terminal();
        Self { shown: false, terminal, start: Instant::now(), bar: None }
    }

    fn show(&mut self, scene: &Scene, step: Step) {
        if !self.terminal {
            return;
        }
        let what = match step {
            Step::Cutting(body) => format!(
                "moving '{}' to where it is seen ({} of {})",
                scene.bodies[body].name,
                body + 1,
                scene.bodies.len()
            ),
            Step::Drawing => "drawing".to_owned(),
            Step::Tracing { of: 1, .. } => "tracing".to_owned(),
            Step::Rows { done, of } => return self.count(done as usize, of as usize, "rows"),
            Step::Tracing { done, of } => return self.count(done, of, "samples of every pixel"),
        };
        eprint!("\r\x1b[K{what} … {:.1} s", self.start.elapsed().as_secs_f64());
        self.shown = true;
    }

    fn count(&mut self, done: usize, of: usize, what: &str) {
        self.clear();
        self.bar.get_or_insert_with(|| progress_bar(of, what, false)).set_position(done as u64);
    }

    fn clear(&mut self) {
        if std::mem::take(&mut self.shown) {
            eprint!("\r\x1b[K");
        }
    }

    /// When it is done.
    fn finish(mut self) {
        self.clear();
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

struct Times {
    read: Duration,
    tables: Duration,
    write: Duration,
    whole: Duration,
}

/// What there is to report.
struct Done<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    options: &'a Options,
    film: &'a Film,
    shading: &'a Shading,
    why: Option<&'static str>,
    development: Development,
    report: Report,
    /// Whether the notes say of a light that it reaches nothing.
    is_dark_told: bool,
    output: PathBuf,
    times: Times,
}

impl Done<'_> {
    fn line(&self) -> String {
        let bodies = summary::bodies_in_words(&summary::gammas(self.scene, self.camera));
        let mut line = format!(
            "{}: {}x{} {}, {}, {bodies}: {}, {}, {:.0} ms\n",
            self.output.display(),
            self.film.width,
            self.film.height,
            self.camera.lens.projection(),
            self.scene.spacetime,
            summary::method_in_words(self.options, &self.report, self.why),
            match Format::of(&self.output) {
                // The light as it is.
                Ok(Format::Exr) => format!("{} colour", self.options.coloring),
                _ => summary::colors_in_words(self.options.coloring, &self.development),
            },
            1e3 * self.times.whole.as_secs_f64()
        );
        if self.film.covered() == 0 && self.scene.sky.is_none() {
            line.push_str("note: nothing is in the picture; try --camera panorama, another --time or --when \"nearest BODY\"\n");
        }
        let is_hole = self.film.body.iter().all(|body| *body == HOLE);
        if (self.film.covered() > 0 || self.scene.sky.is_some())
            && !self.is_dark_told
            && !is_hole
            && summary::is_dark(self.film, &self.development)
        {
            line.push_str(&format!("note: {}\n", summary::dark_note(self.options.coloring)));
        }
        for note in self.report.rays.iter().flat_map(|rays| summary::ray_notes(&rays.count)) {
            line.push_str(&format!("note: {note}\n"));
        }
        for note in &self.scene.notes {
            line.push_str(&format!("note: {note}\n"));
        }
        line
    }

    fn summary(&self) -> serde_json::Value {
        let Self { scene, camera, options, film, shading, why, development, report, output, times, .. } =
            self;
        let doppler = film.doppler.iter().zip(&film.body).filter(|(_, b)| **b >= 0).map(|(d, _)| [*d, *d]);
        json!({
            "terrell": env!("CARGO_PKG_VERSION"),
            "scene": scene.name,
            "output": output,
            "spacetime": summary::spacetime(scene),
            "method": options.method.to_string(),
            "method_because": why,
            "raster": summary::raster(options.raster, report.gpu.is_some()),
            "gpu": report.gpu,
            "threads": rayon::current_num_threads(),
            "color": options.coloring.to_string(),
            "doppler_at": summary::doppler_at(options.doppler_at),
            "exposure_ev": development.ev,
            "tone": development.tone.to_string(),
            "spectra": summary::spectra(shading.tables()),
            "tolerance_px": options.tolerance,
            "samples": options.samples,
            "camera": summary::camera(camera),
            "observer": summary::stance(scene),
            "bodies": summary::bodies(scene, camera),
            "lights": summary::lights(scene),
            "sky": scene.sky.as_ref().map(|sky| sky.texture.describe()),
            "triangles": report.triangles,
            "pieces": report.pieces,
            "rays": report.rays.as_ref().map(|rays| summary::rays(rays, scene)),
            "pixels_covered": film.covered(),
            "doppler_range": doppler.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]),
            "seconds": {
                "reading": times.read.as_secs_f64(),
                "tables_of_colors": times.tables.as_secs_f64(),
                "mapping_and_cutting": report.subdivision.as_secs_f64(),
                "shading": report.shading.as_secs_f64(),
                "writing": times.write.as_secs_f64(),
                "whole": times.whole.as_secs_f64(),
            },
            "peak_memory_bytes": summary::peak_memory_bytes(),
            "notes": scene.notes,
        })
    }
}
