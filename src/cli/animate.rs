use super::drawing::DrawingFlags;
use super::explain::{self, ExplainFlag};
use super::look::LookFlags;
use super::progress::progress_bar;
use super::report::{ReportFlags, check_target};
use super::shooting::{Panel, Shooting, Take, Tally};
use super::values::{number, range};
use super::{Fault, stop, summary};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use terrell::picture::MovieFormat;
use terrell::plan::Method;
use terrell::render::Options;
use terrell::scene::{Animation, Camera, Pace, STANDARD_BETA, Scene, Speed};
use terrell::tone::{Development, Tone};
use terrell::trace::Traced;

/// A film of a scene
///
/// SCENE is what `terrell render` takes; several are filmed one after the other. Frames are spread evenly over the
/// camera's own clock (--time), or over where a body *appears* (--apparent, --range): then films at different
/// speeds compare frame by frame. Without either the scene's [animation] says, or else the first body that moves is
/// followed as it passes. Speed 0 is filmed as the limit of slow motion.
#[derive(Args)]
#[command(after_help = "Examples:
  terrell animate cube                                  to cube.mp4
  terrell animate cube --beta 0.99 --beside-standard    beside the same film in slow motion
  terrell animate gate gate_back -o gate.mp4            looking forward, then backward
  terrell animate statue.glb --beta 0.9 -o frames/      a folder of PNGs; again, to go on where it was stopped
  terrell animate street --apparent tram --range -20,20 --frames 240 --fps 30 -o tram.gif")]
pub struct Animate {
    /// Scenes: names, .toml files or meshes
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Film to write: .mp4, .gif, .apng, or a folder for PNGs [default: the scene's name.mp4]
    #[arg(short, long, value_name = "FILE|DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    look: LookFlags,
    /// Frames of each scene [default: the scene's, else 120]
    #[arg(long, value_name = "N")]
    frames: Option<u32>,
    /// Frames a second [default: the scene's, else 30]
    #[arg(long, value_name = "F", value_parser = number)]
    fps: Option<f64>,
    /// From and to, by the camera's own clock
    #[arg(long, value_name = "T0,T1", value_parser = range, conflicts_with_all = ["apparent", "range"])]
    time: Option<[f64; 2]>,
    /// Spread frames evenly over where this body appears along its motion
    #[arg(long, value_name = "BODY")]
    apparent: Option<String>,
    /// From and to, in lengths beyond the place where the body appears abreast
    #[arg(long, value_name = "S0,S1", value_parser = range)]
    range: Option<[f64; 2]>,
    /// Put the same film in slow motion (so nothing relativistic is left) on its left
    ///
    /// With --time everything is at the same places in both, with --apparent the body is seen at the same places.
    #[arg(long)]
    beside_standard: bool,
    #[command(flatten)]
    drawing: DrawingFlags,
    #[command(flatten)]
    explain: ExplainFlag,
    #[command(flatten)]
    report: ReportFlags,
}

/// Where a film goes.
enum Target {
    Movie(MovieFormat),
    Folder,
}

impl Target {
    fn of(path: &Path) -> Result<Self, Fault> {
        if let Some(format) = MovieFormat::of(path) {
            check_target(path)?;
            return Ok(Self::Movie(format));
        }
        match path.extension() {
            Some(ending) if !path.is_dir() && !path.to_string_lossy().ends_with('/') => Err(format!(
                "{}: unknown film format '.{}'; write to a .mp4, .gif or .apng file, or to a folder (with a / at the end) of PNGs",
                path.display(),
                ending.to_string_lossy()
            )
            .into()),
            _ if path.exists() && !path.is_dir() => {
                Err(format!("{} is there already, and is no folder", path.display()).into())
            }
            _ => Ok(Self::Folder),
        }
    }
}

/// A scene on its way to a film.
struct Staged {
    scene: Scene,
    options: Options,
    /// Why the method was chosen, if it was not asked for.
    why: Option<&'static str>,
    animation: Animation,
    cameras: Vec<Camera>,
}

impl Animate {
    pub fn run(self) -> Result<(), Fault> {
        let start = Instant::now();
        let options = self.look.options()?;
        if self.explain.is_asked() {
            if self.scenes.len() > 1 && self.report.has_json() {
                return Err("--explain with --json is for one scene at a time".into());
            }
            for scene in &self.scenes {
                let Staged { scene, options, why, cameras, .. } = self.stage(scene, &options)?;
                explain::tell(
                    &scene,
                    &cameras.iter().collect::<Vec<_>>(),
                    &options,
                    why,
                    None,
                    &self.report,
                )?;
            }
            return Ok(());
        }
        let takes =
            self.scenes.iter().map(|scene| self.take(scene, &options)).collect::<Result<Vec<_>, _>>()?;
        let size = takes[0].size();
        if let Some(take) = takes.iter().find(|take| take.size() != size) {
            let [width, height] = take.size();
            return Err(format!(
                "all scenes of a film must be of one size: '{}' is {width}x{height}, '{}' {}x{}; give --size",
                take.name(),
                takes[0].name(),
                size[0],
                size[1]
            )
            .into());
        }
        let output = self.output.clone().unwrap_or_else(|| format!("{}.mp4", takes[0].name()).into());
        let target = Target::of(&output)?;
        let read: Vec<_> = takes.iter().flat_map(|t| &t.panels).flat_map(|p| p.scene.files.clone()).collect();
        self.report.check(&output, &read)?;
        let fps = takes[0].animation.fps;
        let mut shooting = Shooting {
            takes: &takes,
            each_metered: self.look.develop.is_each(),
            size,
            bar: progress_bar(
                takes.iter().map(|t| t.animation.frames as usize).sum(),
                "frames",
                self.report.quiet,
            ),
            tally: Tally::default(),
            notes: Vec::new(),
        };
        match target {
            Target::Movie(format) => shooting.shoot_movie(&output, format, fps)?,
            Target::Folder => shooting.shoot_folder(&output)?,
        }
        shooting.bar.finish_and_clear();
        let Shooting { tally, notes, each_metered, .. } = shooting;
        let stopped = stop::is_asked();
        let whole = start.elapsed();
        let done = Done {
            takes: &takes,
            options: &options,
            output: &output,
            each_metered,
            size,
            tally,
            whole,
            stopped,
            notes,
        };
        let summary = done.summary();
        self.report.finish(Vec::new(), &read, &summary)?;
        self.report.tell(&done.line(), &summary)?;
        if stopped {
            std::process::exit(stop::STOPPED);
        }
        Ok(())
    }

    /// A scene and its cameras, before anything is made of them.
    fn stage(&self, source: &str, options: &Options) -> Result<Staged, Fault> {
        let speed = match self.look.scene.velocity.speed()? {
            Some(Speed::Along(0.0)) => Some(Speed::Along(STANDARD_BETA)),
            speed => speed,
        };
        let mut scene = self.look.scene.open(source, speed, |view| self.look.set_lens(view))?;
        let mut options = options.clone();
        let why = self.look.choose(&mut options, &scene)?;
        scene.notes.extend(summary::scene_notes(&scene, &options));
        let animation = self.animation(&scene)?;
        if scene.spacetime.is_curved() {
            if self.beside_standard {
                let why = "--beside-standard compares with slow motion, which a black hole does not have; leave it out";
                return Err(why.into());
            }
            if let Pace::Apparent { .. } = animation.pace {
                let why = "in curved spacetime frames go by the camera's clock: give --time T0,T1, or time in the scene's [animation]";
                return Err(why.into());
            }
        }
        let cameras = animation.cameras(&scene)?;
        for camera in &cameras {
            scene.eye(camera)?;
        }
        Ok(Staged { scene, options, why, animation, cameras })
    }

    fn take(&self, source: &str, options: &Options) -> Result<Take, Fault> {
        let Staged { scene, options, animation, cameras, .. } = self.stage(source, options)?;
        let panel = |mut scene: Scene, cameras: Vec<Camera>| -> Result<Panel, Fault> {
            let overlay = self.drawing.overlay(&scene)?;
            let prepared = options.prepare(&scene, &cameras)?;
            scene.notes.extend(summary::table_notes(&prepared.shading));
            let develop = &self.look.develop;
            let tone = develop.tone(options.coloring);
            let exposure = develop.exposure(options.coloring, &scene);
            let development = match develop.is_each() {
                // Every frame's own.
                true => Development { ev: 0.0, tone },
                false => exposure.of_film(tone, &scene, &cameras, &options)?,
            };
            Ok(Panel { scene, cameras, overlay, prepared, development })
        };
        let mut panels = Vec::new();
        if self.beside_standard {
            let (standard, slow) = animation.standard(&scene)?;
            panels.push(panel(standard, slow)?);
        }
        panels.push(panel(scene, cameras)?);
        Ok(Take { options, panels, animation })
    }

    fn animation(&self, scene: &Scene) -> Result<Animation, Fault> {
        let own = match &scene.animation {
            Some(animation) => Ok(animation.clone()),
            None => Animation::usual(scene),
        };
        let mut animation = match (own, self.time) {
            (Err(_), Some(time)) => Animation { frames: 120, fps: 30.0, pace: Pace::Clock(time), path: None },
            (own, _) => own?,
        };
        if let Some(time) = self.time {
            animation.pace = Pace::Clock(time);
        }
        if self.apparent.is_some() || self.range.is_some() {
            let (body, range) = match animation.pace {
                Pace::Apparent { body, range } => (Some(body), Some(range)),
                Pace::Clock(_) => (None, None),
            };
            let body = self.apparent.clone().or(body).or_else(|| scene.followed().map(|b| b.name.clone()));
            animation.pace = Pace::Apparent {
                body: body.ok_or("nothing moves, so there is nothing --range could be measured by")?,
                range: self.range.or(range).ok_or("--apparent needs a --range: from and to, as in -10,10")?,
            };
        }
        animation.frames = self.frames.unwrap_or(animation.frames);
        animation.fps = self.fps.unwrap_or(animation.fps);
        if animation.fps <= 0.0 {
            return Err(format!("--fps {} is not above 0", animation.fps).into());
        }
        Ok(animation)
    }
}

/// What there is to report.
struct Done<'a> {
    takes: &'a [Take],
    options: &'a Options,
    output: &'a Path,
    each_metered: bool,
    size: [u32; 2],
    tally: Tally,
    whole: Duration,
    stopped: bool,
    notes: Vec<String>,
}

impl Done<'_> {
    fn frames(&self) -> usize {
        self.takes.iter().map(|t| t.animation.frames as usize).sum()
    }

    /// Of the time threads worked, the part that was spent on writing.
    fn encoder_share(&self) -> f64 {
        let Tally { mapping, shading, coloring, encoding, .. } = self.tally;
        let all = mapping + shading + coloring + encoding;
        if all.is_zero() { 0.0 } else { encoding.as_secs_f64() / all.as_secs_f64() }
    }

    fn colors_in_words(&self) -> String {
        let coloring = self.options.coloring;
        let panels = || self.takes.iter().filter_map(|take| take.panels.last());
        let tone = panels().next().map_or(Tone::Linear, |panel| panel.development.tone);
        if self.each_metered {
            return format!("{coloring} colour, every frame at an EV of its own, {tone}");
        }
        // Scenes one after the other have exposures of their own.
        let words = panels().map(|panel| summary::colors_in_words(coloring, &panel.development));
        let mut all: Vec<String> = words.collect();
        all.dedup();
        all.join(", then ")
    }

    /// The exposure, where there is one for all frames.
    fn ev(&self, panel: &Panel) -> Option<f32> {
        (!self.each_metered).then_some(panel.development.ev)
    }

    fn line(&self) -> String {
        let frames = |count: usize| format!("{count} frame{}", if count == 1 { "" } else { "s" });
        let tally = &self.tally;
        let take = &self.takes[0];
        let panel = take.panels.last().expect("a take has a panel");
        let bodies = summary::bodies_in_words(&summary::gammas(&panel.scene, &panel.cameras[0]));
        let took = match tally.drawn {
            0 => String::new(),
            drawn => format!(
                ", {:.1} ms a frame ({:.0} % of the work for writing)",
                1e3 * self.whole.as_secs_f64() / drawn as f64,
                100.0 * self.encoder_share()
            ),
        };
        let mut line = format!(
            "{}: {} of {}x{} {}, {} a second, {}, {bodies}: {} on {}, {}{}\n",
            self.output.display(),
            frames(tally.drawn),
            self.size[0],
            self.size[1],
            panel.cameras[0].lens.projection(),
            take.animation.fps,
            panel.scene.spacetime,
            match take.options.method {
                Method::Exact => "exact shading",
                Method::Apparent => "apparent shading",
                Method::Trace => "ray tracing",
            },
            summary::device(tally.gpu.as_deref()),
            self.colors_in_words(),
            took,
        );
        let noise = tally.noise.map(|noise| format!("the noisiest frame has {:.2} %", 100.0 * noise));
        let mut note = |text: String| line.push_str(&format!("note: {text}\n"));
        if self.stopped {
            note(format!("stopped: {} of {} frames are there", tally.drawn + tally.kept, self.frames()));
        }
        if tally.dark > 0 {
            note(format!("in {} {}", frames(tally.dark), summary::dark_note(self.options.coloring)));
        }
        if tally.kept > 0 {
            note(format!("{} there already", frames(tally.kept)));
        }
        if tally.changed > 0 {
            note(format!("the scene has changed since: {} drawn anew", frames(tally.changed)));
        }
        if tally.surplus > 0 {
            note(format!("{} of a longer film taken away", frames(tally.surplus)));
        }
        noise.into_iter().for_each(&mut note);
        if tally.flagged > 0 {
            note(format!("magenta in {}", frames(tally.flagged)));
            tally.rays.iter().flat_map(summary::ray_notes).for_each(&mut note);
        }
        let scenes = self.takes.iter().flat_map(|t| t.panels.last()).flat_map(|p| &p.scene.notes);
        scenes.chain(&self.notes).for_each(|n| note(n.clone()));
        line
    }

    fn summary(&self) -> serde_json::Value {
        let tally = &self.tally;
        let take = |take: &Take| {
            let panel = take.panels.last().expect("a take has a panel");
            let (first, last) = (&panel.cameras[0], &panel.cameras[panel.cameras.len() - 1]);
            let pace = match &take.animation.pace {
                Pace::Clock(range) => json!({ "camera_clock": range }),
                Pace::Apparent { body, range } => json!({ "apparent": body, "range": range }),
            };
            json!({
                "scene": panel.scene.name,
                "method": take.options.method.to_string(),
                "frames": take.animation.frames,
                "pace": pace,
                "first_camera": summary::camera(first),
                "last_camera": summary::camera(last),
                "bodies": summary::bodies(&panel.scene, first),
                "beside_standard": take.panels.len() > 1,
                "exposure_ev": take.panels.iter().map(|p| self.ev(p)).collect::<Vec<_>>(),
                "lights": summary::lights(&panel.scene),
                "spectra": summary::spectra(panel.prepared.shading.tables()),
                "notes": panel.scene.notes,
            })
        };
        json!({
            "terrell": env!("CARGO_PKG_VERSION"),
            "output": self.output,
            "spacetime": summary::spacetime(&self.takes[0].panels[0].scene),
            "raster": summary::raster(self.options.raster, tally.gpu.is_some()),
            "gpu": tally.gpu,
            "threads": rayon::current_num_threads(),
            "color": self.options.coloring.to_string(),
            "doppler_at": summary::doppler_at(self.options.doppler_at),
            "tone": self.takes[0].panels[0].development.tone.to_string(),
            "tolerance_px": self.options.tolerance,
            "samples": self.options.samples,
            "size": self.size,
            "fps": self.takes[0].animation.fps,
            "takes": self.takes.iter().map(take).collect::<Vec<_>>(),
            "frames": self.frames(),
            "frames_drawn": tally.drawn,
            "frames_kept": tally.kept,
            "frames_changed": tally.changed,
            "stopped": self.stopped,
            "frames_flagged": tally.flagged,
            "rays": tally.rays.map(|count| {
                let (to_lights, noise) = (Vec::new(), tally.noise);
                summary::rays(&Traced { count, to_lights, noise }, &self.takes[0].panels[0].scene)
            }),
            "pieces": tally.pieces,
            "notes": self.notes,
            "seconds": {
                "mapping_and_cutting": tally.mapping.as_secs_f64(),
                "shading": tally.shading.as_secs_f64(),
                "coloring": tally.coloring.as_secs_f64(),
                "writing": tally.encoding.as_secs_f64(),
                "whole": self.whole.as_secs_f64(),
                "a_frame": self.whole.as_secs_f64() / tally.drawn.max(1) as f64,
            },
            "encoder_share": self.encoder_share(),
            "peak_memory_bytes": summary::peak_memory_bytes(),
        })
    }
}
