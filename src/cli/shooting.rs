use super::{Fault, stop, summary};
use indicatif::ProgressBar;
use std::path::Path;
use std::time::{Duration, Instant};
use terrell::drawing::{Overlay, Shot};
use terrell::film::Film;
use terrell::picture::{self, FrameFolder, Movie, MovieFormat};
use terrell::render::{Options, Prepared, render_again};
use terrell::scene::{Animation, Camera, Scene};
use terrell::tone::Development;
use terrell::trace::{Count, Traced};

/// Columns between pictures that stand side by side, and their grey.
const GAP: u32 = 2;
const GAP_COLOR: u8 = 96;

/// One scene seen by one camera a frame.
pub struct Panel {
    pub scene: Scene,
    pub cameras: Vec<Camera>,
    pub overlay: Option<Overlay>,
    /// Made once for all frames.
    pub prepared: Prepared,
    pub development: Development,
}

/// A scene on its way to frames: side by side what is to be seen side by side.
pub struct Take {
    /// How it is drawn, by a method that is right for it.
    pub options: Options,
    pub panels: Vec<Panel>,
    pub animation: Animation,
}

impl Take {
    pub fn name(&self) -> &str {
        &self.panels[0].scene.name
    }

    /// Of a whole frame.
    pub fn size(&self) -> [u32; 2] {
        let size = self.panels[0].scene.view.size;
        let panels = self.panels.len() as u32;
        [size[0] * panels + GAP * (panels - 1), size[1]]
    }
}

/// What it took.
#[derive(Default)]
pub struct Tally {
    pub drawn: usize,
    pub kept: usize,
    pub changed: usize,
    pub surplus: usize,
    pub pieces: usize,
    /// What graphics processor drew, if one did.
    pub gpu: Option<String>,
    /// Pictures that show something, all of it black.
    pub dark: usize,
    /// Pictures with rays that have no right colour.
    pub flagged: usize,
    /// All rays, where they are followed.
    pub rays: Option<Count>,
    /// The greatest noise of a picture.
    pub noise: Option<f64>,
    /// Of the take that is shot, in its last panel: rays to each light, and those of them that are blocked.
    to_lights: Vec<[u64; 2]>,
    pub mapping: Duration,
    pub shading: Duration,
    pub coloring: Duration,
    pub encoding: Duration,
}

/// A frame that waits to be written.
struct Frame {
    index: usize,
    shows: String,
    rgb: Vec<u8>,
}

/// Scenes on their way to a film.
pub struct Shooting<'a> {
    pub takes: &'a [Take],
    /// Whether every frame is metered by itself.
    pub each_metered: bool,
    pub size: [u32; 2],
    pub bar: ProgressBar,
    pub tally: Tally,
    pub notes: Vec<String>,
}

impl Shooting<'_> {
    pub fn shoot_movie(&mut self, output: &Path, format: MovieFormat, fps: f64) -> Result<(), Fault> {
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
            return Err(if self.tally.drawn == 0 && stop::is_asked() {
                "stopped before the first frame".into()
            } else {
                fault
            });
        }
        Ok(written?.finish()?)
    }

    pub fn shoot_folder(&mut self, output: &Path) -> Result<(), Fault> {
        let mut folder = FrameFolder::open(output)?;
        let count = self.takes.iter().map(|t| t.animation.frames as usize).sum();
        self.tally.surplus = folder.shorten(count)?;
        let folder = std::sync::Mutex::new(folder);
        let size = self.size;
        let mut changed = 0;
        let opened = || folder.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        self.all(&|index, shows| opened().is_finished(index, shows), &mut |frame: &Frame| {
            changed += usize::from(opened().is_there(frame.index));
            Ok(opened().push(frame.index, &frame.shows, size, &frame.rgb)?)
        })?;
        self.tally.changed = changed;
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
            let look = format!("{} {:?} {}", env!("CARGO_PKG_VERSION"), take.options, self.each_metered);
            let scenes =
                take.panels.iter().map(|p| (p.scene.fingerprint().with_value(&p.development), &p.overlay));
            let looks: Vec<_> = scenes
                .map(|(scene, overlay)| {
                    scene.with_value(&look).with_value(&overlay.as_ref().map(Overlay::options))
                })
                .collect();
            for i in 0..take.animation.frames as usize {
                if stop::is_asked() {
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
            let to_lights = std::mem::take(&mut self.tally.to_lights);
            if let Some(Panel { scene, cameras, .. }) = take.panels.last() {
                let dark = summary::dark_lights(&to_lights, scene, &cameras[0].observer);
                self.notes.extend(dark.into_iter().map(|light| light.told));
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
        let film_width = take.panels[0].scene.view.size[0] as usize;
        for (panel, film) in take.panels.iter().zip(films) {
            let Panel { scene, cameras, overlay, prepared, development } = panel;
            let report = render_again(scene, &cameras[i], &take.options, prepared, film, |_| ())?;
            if let Some(rays) = report.rays.as_ref().filter(|_| pictures.len() + 1 == take.panels.len()) {
                self.tally.to_lights.resize(rays.to_lights.len(), [0; 2]);
                for (all, of_frame) in self.tally.to_lights.iter_mut().zip(&rays.to_lights) {
                    *all = [all[0] + of_frame[0], all[1] + of_frame[1]];
                }
            }
            if let Some(Traced { count, noise, .. }) = report.rays {
                self.tally.flagged += usize::from(count.failed() + count.impossible > 0);
                self.tally.rays = Some(self.tally.rays.unwrap_or_default().with(count));
                self.tally.noise =
                    noise.map(|noise| noise.max(self.tally.noise.unwrap_or(0.0))).or(self.tally.noise);
            }
            if let Some(note) = summary::gpu_note(&report).filter(|note| !self.notes.contains(note)) {
                self.notes.push(note);
            }
            self.tally.pieces += report.pieces;
            self.tally.gpu = report.gpu.or(self.tally.gpu.take());
            self.tally.mapping += report.subdivision;
            self.tally.shading += report.shading;
            let start = Instant::now();
            let mut development = *development;
            if self.each_metered {
                development.ev = development.tone.metered(film.color.iter().copied());
            }
            let dark = summary::is_dark(film, &development);
            self.tally.dark += usize::from(dark && film.covered() > 0);
            let mut pixels = picture::pixels_srgb(film, &development);
            if let Some(overlay) = overlay {
                let tolerance = take.options.tolerance;
                let coloring = prepared.shading.coloring();
                let shot = Shot { scene, camera: &cameras[i], film, tolerance, coloring, development };
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
        let row = 3 * film_width;
        let gap = [GAP_COLOR; 3 * GAP as usize];
        let mut frame = Vec::with_capacity(3 * self.size[0] as usize * self.size[1] as usize);
        for y in 0..self.size[1] as usize {
            for (k, picture) in pictures.iter().enumerate() {
                if k > 0 {
                    frame.extend(gap);
                }
                frame.extend_from_slice(&picture[y * row..(y + 1) * row]);
            }
        }
        Ok(frame)
    }
}
