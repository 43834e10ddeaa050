use super::Fault;
use super::look::{ColorFlag, SceneFlags};
use super::report::{ReportFlags, check_target};
use super::values::{number, when};
use super::{source, summary};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use terrell::export::{self, Format};
use terrell::geodesic::Tetrad;
use terrell::scene::{Camera, Scene, View};
use terrell::transform::{Axes, Options, Report, TransformError, transform};

/// The apparent shape of a scene, as a mesh for other programs
///
/// SCENE is as in `terrell render`. Every body is moved to where the camera sees it and cut until flat triangles are
/// that shape everywhere to the tolerance; nothing is left out. GLB (.glb) has everything, the Doppler factor as
/// _DOPPLER at every vertex; OBJ (.obj) comes with an MTL file and pictures beside it; PLY (.ply) has colours and
/// Doppler factors at vertices; POV-Ray (.pov) gets a complete scene with the camera, to be rendered at once.
#[derive(Args)]
#[command(after_help = "Examples:
  terrell transform cube -o cube.glb
  terrell transform statue.glb --beta 0.9 -o seen.obj
  terrell transform gate --frame camera --color doppler -o gate.ply
  terrell transform lattice -o lattice.pov; povray lattice.pov +W1280 +H720 +A0.01
  terrell transform cube --animation --frames 48 --time -3,3 -o passing.glb")]
pub struct Transform {
    /// Scene: a name, a .toml file or a mesh
    scene: String,
    /// File to write, .glb, .obj, .ply or .pov [default: the scene's name_seen.glb]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    look: SceneFlags,
    /// World time; a moving camera goes along its world line. With --animation the first and the last moment, T0,T1,
    /// on the camera's own clock, which agrees with the world's at the event the scene gives
    #[arg(long, value_name = "T|T0,T1", value_parser = moments)]
    time: Option<Moments>,
    /// The moment at which a body appears abreast: "nearest BODY"
    #[arg(long, value_name = "\"nearest BODY\"", value_parser = when, conflicts_with_all = ["time", "animation"])]
    when: Option<String>,
    /// Largest distance between the triangles and the exact shape, in the scene's lengths; cost grows as 1/tolerance
    /// [default: 3e-4 of each body]
    #[arg(long, value_name = "LENGTH", value_parser = number)]
    tolerance: Option<f64>,
    /// Axes of what is written
    #[arg(long, value_enum, default_value = "world")]
    frame: FrameFlag,
    /// What the colours are
    #[arg(long, value_enum, default_value = "geometry")]
    color: ColorFlag,
    /// EV of colours that are as seen (light times two to its power) [default: so that the brightest are white]
    #[arg(long, value_name = "EV", value_parser = number)]
    exposure: Option<f64>,
    /// Write how the shape changes, as an animation (.glb only)
    #[arg(long, requires = "time")]
    animation: bool,
    /// Frames of the animation
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1000), default_value = "24", requires = "animation")]
    frames: u32,
    /// Frames a second
    #[arg(long, value_name = "F", value_parser = number, default_value = "24", requires = "animation")]
    fps: f64,
    #[command(flatten)]
    report: ReportFlags,
}

#[derive(Clone, Copy, ValueEnum)]
enum FrameFlag {
    /// The scene's own: at rest everything is where it was
    World,
    /// x right, y up, the camera at the origin looking along −z
    Camera,
}

/// One moment, or the first and the last of many.
#[derive(Clone, Copy)]
enum Moments {
    At(f64),
    Range(f64, f64),
}

fn moments(text: &str) -> Result<Moments, String> {
    match text.split_once(',') {
        None => number(text).map(Moments::At),
        Some((first, last)) => {
            let (first, last) = (number(first)?, number(last)?);
            if first >= last {
                return Err(format!("{first} is not before {last}"));
            }
            Ok(Moments::Range(first, last))
        }
    }
}

impl Transform {
    pub fn run(self) -> Result<(), Fault> {
        let start = Instant::now();
        if let Some(tolerance) = self.tolerance.filter(|t| *t <= 0.0) {
            return Err(format!("--tolerance {tolerance} is not above 0").into());
        }
        if let Some(ev) = self.exposure.filter(|ev| ev.abs() > 100.0) {
            return Err(format!("--exposure {ev:e} is no EV between -100 and 100").into());
        }
        if self.exposure.is_some() && !self.color.coloring().is_beamed() {
            return Err("--exposure is for colours as seen: add --color spectral, flat or bolometric".into());
        }
        if self.fps <= 0.0 {
            return Err(format!("--fps {} is not above 0", self.fps).into());
        }
        let mut scene = self.scene()?;
        if scene.spacetime.is_curved() {
            // Before anything is asked of the camera, which is another there.
            return Err(TransformError::Curved.into());
        }
        scene.check_spacetime()?;
        scene.notes.extend(self.notes(&scene));
        let camera = scene.camera()?;
        let output = self.output.clone().unwrap_or_else(|| format!("{}_seen.glb", scene.name).into());
        if Format::of(&output)? != Format::Glb && self.animation {
            return Err(export::ExportError::Still(output).into());
        }
        check_target(&output)?;
        self.report.check(&output, &scene.files)?;
        let (observers, times) = self.observers(&scene, &camera)?;
        let options = Options {
            tolerance: self.tolerance,
            axes: match self.frame {
                FrameFlag::World => Axes::World,
                FrameFlag::Camera => Axes::Camera,
            },
            coloring: self.color.coloring(),
            ev: self.exposure.map(|ev| ev as f32),
            ..Options::default()
        };
        let camera = Camera { observer: observers[0], ..camera };
        let reading = start.elapsed();
        let (mut model, report) = transform(&scene, &camera, &observers, &times, &options)?;
        let mut done = Done {
            scene: &scene,
            camera: &camera,
            options: &options,
            report,
            output,
            files: Vec::new(),
            reading,
        };
        model.extras = done.extras();
        let files = export::prepare(&model, &done.output)?;
        done.files = files.iter().rev().map(|file| file.path().to_owned()).collect();
        let whole = start.elapsed();
        let summary = done.summary(whole);
        self.report.finish(files, &scene.files, &summary)?;
        self.report.tell(&done.line(times.len(), whole, model.eye.is_none()), &summary)
    }

    /// What of colours as seen is not written.
    fn notes(&self, scene: &Scene) -> Vec<String> {
        let coloring = self.color.coloring();
        let mut notes = Vec::new();
        if !coloring.is_beamed() {
            return notes;
        }
        notes.extend(summary::shadow_note(scene, coloring));
        if !scene.lights.is_empty() {
            notes.push(
                "light is taken at the vertices: where a lamp is near, give what it lights more of them"
                    .into(),
            );
        }
        let is_pov = self.output.as_ref().is_some_and(|path| matches!(Format::of(path), Ok(Format::Pov)));
        if is_pov && scene.bodies.iter().any(|b| b.mesh.materials.iter().any(|m| m.is_textured())) {
            notes.push(
                "POV-Ray shows pictures as they are, without what is seen at the vertices; a .glb has both"
                    .into(),
            );
        }
        notes
    }

    /// The scene, with what the flags say over what it says itself.
    fn scene(&self) -> Result<Scene, Fault> {
        let mut scene = self.look.open(&self.scene, self.look.velocity.speed()?, |_| ())?;
        let mut time = None;
        match self.time {
            Some(Moments::At(_)) if self.animation => {
                return Err("--animation needs two times: --time T0,T1".into());
            }
            Some(Moments::Range(..)) if !self.animation => {
                return Err("--time with two times is for --animation; give one, or add --animation".into());
            }
            Some(Moments::At(at)) => time = Some(at),
            Some(Moments::Range(..)) => scene.view.nearest = None,
            None => {}
        }
        source::set_moment(&mut scene, time, self.when.as_deref())?;
        Ok(scene)
    }

    /// The camera at every moment, and the second at which each is shown.
    fn observers(&self, scene: &Scene, camera: &Camera) -> Result<(Vec<Tetrad>, Vec<f64>), Fault> {
        let Some(Moments::Range(first, last)) = self.time else {
            return Ok((vec![camera.observer], vec![0.0]));
        };
        let steps = f64::from(self.frames - 1);
        let path = scene.animation.as_ref().and_then(|a| a.path.as_ref());
        let moment = |i: u32| {
            let clock = first + (last - first) * f64::from(i) / steps;
            match path {
                Some(path) => path.view(&scene.view, clock),
                None => View {
                    event: camera.observer.later(clock - camera.observer.event().t()).event(),
                    nearest: None,
                    ..scene.view.clone()
                },
            }
        };
        let at = |i| Ok(Scene { view: moment(i), ..scene.clone() }.camera()?.observer);
        let observers: Result<Vec<_>, Fault> = (0..self.frames).map(at).collect();
        Ok((observers?, (0..self.frames).map(|i| f64::from(i) / self.fps).collect()))
    }
}

/// What there is to report.
struct Done<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    options: &'a Options,
    report: Report,
    output: PathBuf,
    files: Vec<PathBuf>,
    reading: Duration,
}

impl Done<'_> {
    fn line(&self, frames: usize, whole: Duration, no_eye: bool) -> String {
        let bodies = summary::bodies_in_words(&summary::gammas(self.scene, self.camera));
        let usual = if self.options.tolerance.is_none() { " (3e-4 of each body)" } else { "" };
        let frames = if frames > 1 { format!(", {frames} frames") } else { String::new() };
        let exposed = match self.options.coloring.is_beamed() {
            true => format!(" at {:+.2} EV", self.report.ev),
            false => String::new(),
        };
        let mut line = format!(
            "{}: flat spacetime, {bodies}{frames}: {} triangles cut into {} with {} vertices for {:.3e}{usual}, {} colour{exposed}, {:.0} ms\n",
            self.output.display(),
            self.report.triangles,
            self.report.pieces,
            self.report.vertices,
            self.report.tolerance,
            self.options.coloring,
            1e3 * whole.as_secs_f64()
        );
        if no_eye {
            line.push_str("note: no camera is written; other programs have no fisheye or panorama alike\n");
        }
        for note in &self.scene.notes {
            line.push_str(&format!("note: {note}\n"));
        }
        line
    }

    fn axes(&self) -> &'static str {
        match self.options.axes {
            Axes::World => "world",
            Axes::Camera => "camera",
        }
    }

    /// For those who find the mesh alone.
    fn extras(&self) -> serde_json::Map<String, Value> {
        let own = json!({
            "scene": self.scene.name,
            "spacetime": "flat",
            "frame": self.axes(),
            "color": self.options.coloring.to_string(),
            "exposure_ev": self.report.ev,
            "tolerance": self.report.tolerance,
            "camera": summary::camera(self.camera),
            "bodies": summary::bodies(self.scene, self.camera),
        });
        [("terrell".to_owned(), own)].into_iter().collect()
    }

    fn summary(&self, whole: Duration) -> Value {
        json!({
            "terrell": env!("CARGO_PKG_VERSION"),
            "scene": self.scene.name,
            "output": self.output,
            "files": self.files,
            "spacetime": "flat",
            "frame": self.axes(),
            "color": self.options.coloring.to_string(),
            "exposure_ev": self.report.ev,
            "tolerance": self.report.tolerance,
            "camera": summary::camera(self.camera),
            "bodies": summary::bodies(self.scene, self.camera),
            "triangles": self.report.triangles,
            "pieces": self.report.pieces,
            "vertices": self.report.vertices,
            "lights": summary::lights(self.scene),
            "spectra": summary::spectra(&self.report.tables),
            "doppler_range": self.report.doppler,
            "threads": rayon::current_num_threads(),
            "peak_memory_bytes": summary::peak_memory_bytes(),
            "seconds": {
                "reading": self.reading.as_secs_f64(),
                "mapping_and_cutting": self.report.subdivision.as_secs_f64(),
                "writing": (whole.saturating_sub(self.reading + self.report.subdivision)).as_secs_f64(),
                "whole": whole.as_secs_f64(),
            },
            "notes": self.scene.notes,
        })
    }
}
