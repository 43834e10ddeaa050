use super::drawing::DrawingFlags;
use super::look::LookFlags;
use super::report::{ReportFlags, check_target};
use super::values::{number, range};
use super::{Fault, summary};
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use terrell::drawing::{Overlay, Shot};
use terrell::film::Film;
use terrell::picture::{self, FrameFolder, Movie, MovieFormat};
use terrell::render::{Options, render_again};
use terrell::scene::{Animation, Camera, Pace, STANDARD_BETA, Scene, Speed};

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

/// One scene seen by one camera a frame.
struct Panel {
    scene: Scene,
    cameras: Vec<Camera>,
    overlay: Option<Overlay>,
}

/// A scene on its way to frames: side by side what is to be seen side by side.
struct Take {
    panels: Vec<Panel>,
    animation: Animation,
}

impl Animate {
    pub fn run(self) -> Result<(), Fault> {
        let start = Instant::now();
        let options = self.look.options()?;
        let takes = self.scenes.iter().map(|scene| self.take(scene)).collect::<Result<Vec<_>, _>>()?;
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
        self.report.check(&output)?;
        let fps = takes[0].animation.fps;
        let mut shooting = Shooting {
            takes: &takes,
            options: &options,
            size,
            bar: progress_bar(takes.iter().map(|t| t.animation.frames as usize).sum(), self.report.quiet),
            stop: stopped_by_user()?,
            tally: Tally::default(),
            notes: Vec::new(),
        };
        match target {
            Target::Movie(format) => shooting.shoot_movie(&output, format, fps)?,
            Target::Folder => shooting.shoot_folder(&output)?,
        }
        shooting.bar.finish_and_clear();
        let Shooting { tally, stop, notes, .. } = shooting;
        let stopped = stop.load(Ordering::Relaxed);
        let whole = start.elapsed();
        let done =
            Done { takes: &takes, options: &options, output: &output, size, tally, whole, stopped, notes };
        let summary = done.summary();
        self.report.finish(Vec::new(), &summary)?;
        self.report.tell(&done.line(), &summary)?;
        if stopped {
            // As a shell says of what was ended by Ctrl-C.
            std::process::exit(130);
        }
        Ok(())
    }

    fn take(&self, source: &str) -> Result<Take, Fault> {
        let speed = match self.look.scene.velocity.speed()? {
            Some(Speed::Along(0.0)) => Some(Speed::Along(STANDARD_BETA)),
            speed => speed,
        };
        let scene = self.look.scene.open(source, speed, |view| self.look.set_lens(view))?;
        let animation = self.animation(&scene)?;
        let cameras = animation.cameras(&scene)?;
        let panel = |scene: Scene, cameras: Vec<Camera>| -> Result<Panel, Fault> {
            let overlay = self.drawing.overlay(&scene)?;
            Ok(Panel { scene, cameras, overlay })
        };
        let mut panels = Vec::new();
        if self.beside_standard {
            let (standard, slow) = animation.standard(&scene)?;
            panels.push(panel(standard, slow)?);
        }
        panels.push(panel(scene, cameras)?);
        Ok(Take { panels, animation })
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

impl Take {
    fn name(&self) -> &str {
        &self.panels[0].scene.name
    }

    /// Of a whole frame.
    fn size(&self) -> [u32; 2] {
        let size = self.panels[0].scene.view.size;
        [size[0] * self.panels.len() as u32, size[1]]
    }
}

/// A bar with the time left, on a terminal only.
fn progress_bar(frames: usize, quiet: bool) -> ProgressBar {
    let shown = !quiet && std::io::stderr().is_terminal();
    let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(frames as u64), target);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} frames, {per_sec}, {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// Set by the first Ctrl-C; the second ends the program at once.
fn stopped_by_user() -> Result<Arc<AtomicBool>, Fault> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = stop.clone();
    ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    })?;
    Ok(stop)
}

/// What it took.
#[derive(Default)]
struct Tally {
    drawn: usize,
    kept: usize,
    changed: usize,
    surplus: usize,
    pieces: usize,
    mapping: Duration,
    shading: Duration,
    coloring: Duration,
    encoding: Duration,
}

/// A frame that waits to be written.
struct Frame {
    index: usize,
    shows: String,
    rgb: Vec<u8>,
}

struct Shooting<'a> {
    takes: &'a [Take],
    options: &'a Options,
    size: [u32; 2],
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
    tally: Tally,
    notes: Vec<String>,
}

impl Shooting<'_> {
    fn shoot_movie(&mut self, output: &Path, format: MovieFormat, fps: f64) -> Result<(), Fault> {
        // What a container refuses is the user's mistake; what happens while it is written may be the system's.
        Movie::new(format, std::io::Cursor::new(Vec::new()), self.size[0], self.size[1], fps)?;
        let [width, height] = self.size;
        let mut fault: Option<Fault> = None;
        let written = picture::prepare(output, |to| {
            let mut shoot = || -> Result<(), Fault> {
                let mut movie = Movie::new(format, &mut *to, width, height, fps)?;
                self.all(&|_, _| false, &mut |frame| Ok(movie.push(&frame.rgb)?))?;
                movie.finish()?;
                Ok(())
            };
            shoot().map_err(|e| {
                fault = Some(e);
                std::io::Error::other("not finished")
            })
        });
        if let Some(fault) = fault {
            return Err(if self.tally.drawn == 0 && self.stop.load(Ordering::Relaxed) {
                "stopped before the first frame".into()
            } else {
                fault
            });
        }
        Ok(written?.finish()?)
    }

    fn shoot_folder(&mut self, output: &Path) -> Result<(), Fault> {
        let mut folder = FrameFolder::open(output)?;
        let count = self.takes.iter().map(|t| t.animation.frames as usize).sum();
        self.tally.surplus = folder.shorten(count)?;
        let folder = std::sync::Mutex::new(folder);
        let size = self.size;
        let mut there = Vec::new();
        let opened = || folder.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        there.extend((0..count).map(|index| opened().is_there(index)));
        self.all(&|index, shows| opened().is_finished(index, shows), &mut |frame: &Frame| {
            Ok(opened().push(frame.index, &frame.shows, size, &frame.rgb)?)
        })?;
        self.tally.changed = there.iter().filter(|t| **t).count() - self.tally.kept;
        Ok(())
    }

    /// Draws all frames that are not finished, and writes each while the next is drawn.
    fn all(
        &mut self,
        finished: &dyn Fn(usize, &str) -> bool,
        write: &mut (dyn FnMut(&Frame) -> Result<(), Fault> + Send),
    ) -> Result<(), Fault> {
        let mut waiting: Option<Frame> = None;
        let mut films: Vec<Film> = Vec::new();
        let mut index = 0;
        for take in self.takes {
            let look = format!("{} {:?}", env!("CARGO_PKG_VERSION"), self.options);
            let scenes = take.panels.iter().map(|p| (p.scene.fingerprint(), &p.overlay));
            let looks: Vec<_> = scenes
                .map(|(scene, overlay)| {
                    scene.with_value(&look).with_value(&overlay.as_ref().map(Overlay::options))
                })
                .collect();
            for i in 0..take.animation.frames as usize {
                if self.stop.load(Ordering::Relaxed) {
                    break;
                }
                let shows = |(panel, look): (&Panel, &terrell::scene::Fingerprint)| {
                    look.with_value(&panel.cameras[i]).to_string()
                };
                let shows: Vec<_> = take.panels.iter().zip(&looks).map(shows).collect();
                let shows = shows.join(" ");
                if finished(index, &shows) {
                    self.tally.kept += 1;
                } else {
                    let last = waiting.take();
                    let (drawn, written) = rayon::join(
                        || self.frame(take, i, &mut films),
                        || {
                            let start = Instant::now();
                            last.as_ref().map_or(Ok(()), &mut *write).map(|()| start.elapsed())
                        },
                    );
                    self.tally.encoding += written?;
                    waiting = Some(Frame { index, shows, rgb: drawn? });
                    self.tally.drawn += 1;
                }
                self.bar.inc(1);
                index += 1;
            }
        }
        if let Some(frame) = waiting {
            let start = Instant::now();
            write(&frame)?;
            self.tally.encoding += start.elapsed();
        }
        Ok(())
    }

    /// Pixels of a frame, panels side by side.
    fn frame(&mut self, take: &Take, i: usize, films: &mut Vec<Film>) -> Result<Vec<u8>, Fault> {
        films.resize_with(take.panels.len(), || Film::new(0, 0));
        let mut pictures = Vec::new();
        for (panel, film) in take.panels.iter().zip(films) {
            let Panel { scene, cameras, overlay } = panel;
            let report = render_again(scene, &cameras[i], self.options, film, |_| ())?;
            self.tally.pieces += report.pieces;
            self.tally.mapping += report.subdivision;
            self.tally.shading += report.shading;
            let start = Instant::now();
            let mut pixels = picture::pixels_srgb(film);
            if let Some(overlay) = overlay {
                let tolerance = self.options.tolerance;
                let shot = Shot { scene, camera: &cameras[i], film, tolerance };
                for note in overlay.draw(&mut pixels, &shot) {
                    if !self.notes.contains(&note) {
                        self.notes.push(note);
                    }
                }
            }
            pictures.push(pixels);
            self.tally.coloring += start.elapsed();
        }
        if pictures.len() == 1 {
            return Ok(pictures.swap_remove(0));
        }
        let row = 3 * self.size[0] as usize / pictures.len();
        let line = |y: usize| pictures.iter().flat_map(move |p| &p[y * row..(y + 1) * row]);
        Ok((0..self.size[1] as usize).flat_map(line).copied().collect())
    }
}

/// What there is to report.
struct Done<'a> {
    takes: &'a [Take],
    options: &'a Options,
    output: &'a Path,
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

    fn line(&self) -> String {
        let tally = &self.tally;
        let take = &self.takes[0];
        let panel = take.panels.last().expect("a take has a panel");
        let bodies = summary::bodies_in_words(&summary::gammas(&panel.scene, &panel.cameras[0]));
        let mut line = format!(
            "{}: {} frames of {}x{} {}, {} a second, flat spacetime, {bodies}: apparent shading on the CPU, {:.1} ms a frame ({:.0} % of the work for writing)\n",
            self.output.display(),
            tally.drawn,
            self.size[0],
            self.size[1],
            panel.cameras[0].lens.projection(),
            take.animation.fps,
            1e3 * self.whole.as_secs_f64() / tally.drawn.max(1) as f64,
            100.0 * self.encoder_share(),
        );
        let mut note = |text: String| line.push_str(&format!("note: {text}\n"));
        if self.stopped {
            note(format!("stopped: {} of {} frames are there", tally.drawn + tally.kept, self.frames()));
        }
        if tally.kept > 0 {
            note(format!("{} frames were there already", tally.kept));
        }
        if tally.changed > 0 {
            note(format!("the scene has changed since: {} frames were drawn anew", tally.changed));
        }
        if tally.surplus > 0 {
            note(format!("{} frames of a longer film were taken away", tally.surplus));
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
                "frames": take.animation.frames,
                "pace": pace,
                "first_camera": summary::camera(first),
                "last_camera": summary::camera(last),
                "bodies": summary::bodies(&panel.scene, first),
                "beside_standard": take.panels.len() > 1,
                "notes": panel.scene.notes,
            })
        };
        json!({
            "terrell": env!("CARGO_PKG_VERSION"),
            "output": self.output,
            "spacetime": "flat",
            "method": "apparent",
            "raster": summary::raster(self.options.raster),
            "threads": rayon::current_num_threads(),
            "color": summary::color(self.options.coloring),
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
            "pieces": tally.pieces,
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
