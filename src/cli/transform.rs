use super::Fault;
use super::look::ColorFlag;
use super::render::{check_target, is_still};
use super::source;
use super::values::{number, size, when};
use super::velocity::VelocityFlags;
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use terrell::color::Coloring;
use terrell::export::{self, Format};
use terrell::geodesic::{Event, Tetrad, World};
use terrell::picture::{self, Pending};
use terrell::relativity::ApparentMap;
use terrell::scene::{Body, Camera, Scene, View};
use terrell::transform::{Axes, Options, Report, transform};

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
    velocity: VelocityFlags,
    /// World time; a moving camera goes along its world line. With --animation the first and the last moment, T0,T1,
    /// on the camera's own clock, which agrees with the world's at the event the scene gives
    #[arg(long, value_name = "T|T0,T1", value_parser = moments)]
    time: Option<Moments>,
    /// The moment at which a body appears abreast: "nearest BODY"
    #[arg(long, value_name = "\"nearest BODY\"", value_parser = when, conflicts_with_all = ["time", "animation"])]
    when: Option<String>,
    /// Seconds of a file's own animation that pass in a unit of time; 0 stops it
    #[arg(long, value_name = "R", value_parser = number)]
    animation_rate: Option<f64>,
    /// Pixels of the camera that is written along
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Its vertical field of view in degrees
    #[arg(long, value_name = "DEG", value_parser = number)]
    fov: Option<f64>,
    /// Largest distance between the triangles and the exact shape, in the scene's lengths; cost grows as 1/tolerance
    /// [default: a thousandth of the largest body]
    #[arg(long, value_name = "LENGTH", value_parser = number)]
    tolerance: Option<f64>,
    /// Axes of what is written
    #[arg(long, value_enum, default_value = "world")]
    frame: FrameFlag,
    /// What the colours are
    #[arg(long, value_enum, default_value = "geometry")]
    color: ColorFlag,
    /// Write how the shape changes, as an animation (.glb only)
    #[arg(long, requires = "time")]
    animation: bool,
    /// Frames of the animation
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1000), default_value = "24", requires = "animation")]
    frames: u32,
    /// Frames a second
    #[arg(long, value_name = "F", value_parser = number, default_value = "24", requires = "animation")]
    fps: f64,
    /// Write what was done, with times and counts, as JSON; - for standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Say nothing unless something is wrong
    #[arg(short, long)]
    quiet: bool,
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
        if self.fps <= 0.0 {
            return Err(format!("--fps {} is not above 0", self.fps).into());
        }
        let scene = self.scene()?;
        let camera = scene.camera()?;
        let output = self.output.clone().unwrap_or_else(|| format!("{}_seen.glb", scene.name).into());
        if Format::of(&output)? != Format::Glb && self.animation {
            return Err(export::ExportError::Still(output).into());
        }
        for path in [Some(&output), self.json.as_ref()].into_iter().flatten() {
            check_target(path)?;
        }
        let same =
            |a: &Path, b: &Path| a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
        if same(&output, self.scene.as_ref()) {
            return Err(format!("{} is what is read; write to another file", output.display()).into());
        }
        let (observers, times) = self.observers(&scene, &camera)?;
        let options = Options {
            tolerance: self.tolerance,
            axes: match self.frame {
                FrameFlag::World => Axes::World,
                FrameFlag::Camera => Axes::Camera,
            },
            coloring: match self.color {
                ColorFlag::Geometry => Coloring::Geometry,
                ColorFlag::Doppler => Coloring::Doppler,
            },
            ..Options::default()
        };
        let camera = Camera { observer: observers[0], ..camera };
        let (mut model, report) = transform(&scene, &camera, &observers, &times, &options)?;
        let mut done =
            Done { scene: &scene, camera: &camera, options: &options, report, output, files: Vec::new() };
        model.extras = done.extras();
        let mut files = export::prepare(&model, &done.output)?;
        done.files = files.iter().rev().map(|file| file.path().to_owned()).collect();
        let whole = start.elapsed();
        let json_to_stdout = self.json.as_deref() == Some(Path::new("-"));
        if let Some(path) = self.json.as_ref().filter(|_| !json_to_stdout) {
            // All or none.
            let json = picture::prepare(path, |to| writeln!(to, "{:#}", done.summary(whole)))?;
            let plain = json.path().is_file() || !json.path().exists();
            if plain && done.files.iter().any(|file| file == json.path()) {
                return Err(format!("{} cannot be both the mesh and the JSON", path.display()).into());
            }
            files.push(json);
        }
        files.into_iter().try_for_each(Pending::finish)?;
        if json_to_stdout {
            writeln!(std::io::stdout(), "{:#}", done.summary(whole))?;
        }
        if !self.quiet {
            let line = done.line(times.len(), whole, model.eye.is_none());
            if json_to_stdout { eprint!("{line}") } else { std::io::stdout().write_all(line.as_bytes())? }
        }
        Ok(())
    }

    fn set_lens(&self, view: &mut View) {
        view.fov_deg = self.fov.or(view.fov_deg);
        view.size = self.size.unwrap_or(view.size);
    }

    /// The scene, with what the flags say over what it says itself.
    fn scene(&self) -> Result<Scene, Fault> {
        let mut scene = source::open(&self.scene, self.velocity.speed()?, self.animation_rate, |view| {
            self.set_lens(view)
        })?;
        match self.time {
            Some(Moments::At(_)) if self.animation => {
                return Err("--animation needs two times: --time T0,T1".into());
            }
            Some(Moments::Range(..)) if !self.animation => {
                return Err("--time with two times is for --animation; give one, or add --animation".into());
            }
            Some(Moments::At(time)) => scene.view.set_time(time)?,
            Some(Moments::Range(..)) => scene.view.nearest = None,
            None => {}
        }
        if let Some(body) = &self.when {
            scene.view.nearest = Some(body.clone());
        }
        if scene.view.nearest.is_some() && self.when.is_none() && is_still(&scene) {
            // The scene's own moment has no meaning at rest; its time does.
            scene.view.nearest = None;
        }
        Ok(scene)
    }

    /// The camera at every moment, and the second at which each is shown.
    fn observers(&self, scene: &Scene, camera: &Camera) -> Result<(Vec<Tetrad>, Vec<f64>), Fault> {
        let Some(Moments::Range(first, last)) = self.time else {
            return Ok((vec![camera.observer], vec![0.0]));
        };
        let steps = f64::from(self.frames - 1);
        let moment = |i: u32| {
            let clock = first + (last - first) * f64::from(i) / steps;
            let mut view = scene.view.clone();
            view.event = camera.observer.later(clock - camera.observer.event().t()).event();
            view.nearest = None;
            view
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
}

fn event(e: Event<World>) -> Value {
    let p = e.position();
    json!([e.t(), p.x, p.y, p.z])
}

impl Done<'_> {
    /// Relative γ of every body and the camera.
    fn gammas(&self) -> Vec<f64> {
        let gamma = |body: &Body| ApparentMap::new(&body.motion, &self.camera.observer).gamma();
        self.scene.bodies.iter().map(gamma).collect()
    }

    fn line(&self, frames: usize, whole: Duration, no_eye: bool) -> String {
        let gammas = self.gammas();
        let fastest = gammas.iter().copied().fold(1.0, f64::max);
        let bodies = match gammas.len() {
            1 => format!("1 body, γ {fastest:.4}"),
            n => format!("{n} bodies, γ up to {fastest:.4}"),
        };
        let usual = if self.options.tolerance.is_none() { " (a thousandth of the largest body)" } else { "" };
        let frames = if frames > 1 { format!(", {frames} frames") } else { String::new() };
        let mut line = format!(
            "{}: flat spacetime, {bodies}{frames}: {} triangles cut into {} with {} vertices for {:.3e}{usual}, {:.0} ms\n",
            self.output.display(),
            self.report.triangles,
            self.report.pieces,
            self.report.vertices,
            self.report.tolerance,
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

    fn bodies(&self) -> Vec<Value> {
        let body = |(body, gamma): (&Body, f64)| {
            json!({
                "name": body.name,
                "triangles": body.mesh.triangles.len(),
                "celerity": body.motion.celerity.vector().to_array(),
                "origin": event(body.motion.origin),
                "gamma_relative_to_camera": gamma,
            })
        };
        self.scene.bodies.iter().zip(self.gammas()).map(body).collect()
    }

    /// For those who find the mesh alone.
    fn extras(&self) -> serde_json::Map<String, Value> {
        let observer = &self.camera.observer;
        let own = json!({
            "scene": self.scene.name,
            "spacetime": "flat",
            "frame": self.axes(),
            "tolerance": self.report.tolerance,
            "camera": { "event": event(observer.event()), "celerity": observer.celerity().vector().to_array() },
            "bodies": self.bodies(),
        });
        [("terrell".to_owned(), own)].into_iter().collect()
    }

    fn summary(&self, whole: Duration) -> Value {
        let observer = &self.camera.observer;
        let axes = observer.axes();
        json!({
            "terrell": env!("CARGO_PKG_VERSION"),
            "scene": self.scene.name,
            "output": self.output,
            "files": self.files,
            "spacetime": "flat",
            "frame": self.axes(),
            "color": match self.options.coloring { Coloring::Geometry => "geometry", Coloring::Doppler => "doppler" },
            "tolerance": self.report.tolerance,
            "camera": {
                "event": event(observer.event()),
                "celerity": observer.celerity().vector().to_array(),
                "right": axes[0].to_array(),
                "up": axes[1].to_array(),
                "forward": axes[2].to_array(),
            },
            "bodies": self.bodies(),
            "triangles": self.report.triangles,
            "pieces": self.report.pieces,
            "vertices": self.report.vertices,
            "doppler_range": self.report.doppler,
            "seconds": {
                "mapping_and_cutting": self.report.subdivision.as_secs_f64(),
                "whole": whole.as_secs_f64(),
            },
            "notes": self.scene.notes,
        })
    }
}
