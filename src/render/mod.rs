//! A scene to a film: what every caller does.

mod device;

use crate::apparent::{ApparentMesh, Field, Subdivision, TooManyPieces};
use crate::color::Coloring;
use crate::film::{Film, Samples};
use crate::light::{DopplerAt, SeenShading, Shading, ShadingError};
use crate::plan::Method;
#[cfg(feature = "gpu")]
use crate::raster::gpu::{Gpu, GpuError, Uncut};
use crate::raster::{Drawable, TooManyToPaint, paint, shade_again};
use crate::relativity::ApparentMap;
use crate::scene::{Camera, Eye, EyeError, Mesh, Projection, Scene, Spacetime, SpacetimeError};
use crate::trace::{Look, Paths, Traced, Tracer};
use device::Device;
pub use device::{OnCpu, has_gpu};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};
use terrell_geodesic::{Accuracy, Curved, KerrSchild};

/// How to draw.
#[derive(Clone, Debug)]
pub struct Options {
    /// How what a pixel sees is found.
    pub method: Method,
    /// Largest distance in pixels between a drawn edge and its exact image; usually ¼. Time and memory grow
    /// as 1/tolerance for large faces.
    pub tolerance: f64,
    /// The most triangles all bodies together may be cut into, where they are.
    pub most_pieces: usize,
    /// Samples a pixel.
    pub samples: u32,
    /// What a pixel shows.
    pub coloring: Coloring,
    /// Where the Doppler factor is worked out.
    pub doppler_at: DopplerAt,
    /// What decides which triangle a pixel sees.
    pub raster: Raster,
    /// How light of surfaces on each other is followed, where rays are traced.
    pub paths: Paths,
}

/// What decides which triangle a pixel sees; all else is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Raster {
    /// The CPU; polygons by a z-buffer, see [`shade_again`].
    #[default]
    Cpu,
    /// The painter's algorithm by tiny-skia, which has its limits; see [`paint`]. For apparent shading.
    Skia,
    /// A graphics processor; see [`crate::raster`]. For exact and apparent shading of what shines by itself.
    Wgpu,
    /// A graphics processor where there is one that is more than a program on the CPU, which can draw the scene, and enough
    /// to be drawn; else, and if it fails, the CPU.
    Auto,
}

/// Why a scene could not be drawn.
#[derive(Clone, Debug, thiserror::Error)]
pub enum RenderError {
    /// The bodies would be cut into more pieces than allowed.
    #[error(transparent)]
    Pieces(#[from] TooManyPieces),
    /// More pieces than can be painted.
    #[error(transparent)]
    Paint(#[from] TooManyToPaint),
    /// A spectrum that cannot be.
    #[error(transparent)]
    Shading(#[from] ShadingError),
    /// A camera that cannot be there.
    #[error(transparent)]
    Eye(#[from] EyeError),
    /// Something that there is not in the scene's spacetime.
    #[error(transparent)]
    Spacetime(#[from] SpacetimeError),
    /// A graphics processor that did not draw.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// What a graphics processor is not for.
    #[error("{0}; leave out what asks for a graphics processor (--raster wgpu)")]
    NotOnGpu(&'static str),
    /// Polygons in curved spacetime.
    #[error("in curved spacetime only rays show what is seen; ask for the method trace, or auto")]
    OnlyRays,
}

impl Default for Options {
    fn default() -> Self {
        let Subdivision { tolerance, most } = Subdivision::default();
        Self {
            method: Method::default(),
            tolerance,
            most_pieces: most,
            samples: 1,
            coloring: Coloring::default(),
            doppler_at: DopplerAt::default(),
            raster: Raster::Cpu,
            paths: Paths::default(),
        }
    }
}

impl Options {
    /// What is the same for all of these cameras' pictures of a scene: to be made once.
    ///
    /// # Errors
    /// If a spectrum cannot be, or the scene's spacetime has no such scene or is not drawn so.
    pub fn prepare<'a>(
        &self,
        scene: &Scene,
        cameras: impl IntoIterator<Item = &'a Camera>,
    ) -> Result<Prepared, RenderError> {
        scene.check_spacetime()?;
        if scene.spacetime.is_curved() && self.method != Method::Trace {
            return Err(RenderError::OnlyRays);
        }
        let cameras: Vec<_> = cameras.into_iter().collect();
        let observers = cameras.iter().map(|c| &c.observer);
        let shading = Shading::new(scene, observers, self.coloring)?.with_doppler_at(self.doppler_at);
        let gpu = self.gpu(scene, &cameras)?;
        let projection = cameras.first().map_or(Projection::Pinhole, |camera| camera.lens.projection());
        let prepared =
            Prepared { shading, tracer: OnceLock::new(), projection, pictures: cameras.len(), gpu };
        if prepared.gpu.is_none() {
            prepared.tracer(scene, self.method);
        }
        Ok(prepared)
    }
}

/// What is the same for all pictures of a scene.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// How its surfaces shine and are lit.
    pub shading: Shading,
    /// Its meshes as lines of sight are followed through them, once they are.
    tracer: OnceLock<Tracer>,
    projection: Projection,
    pictures: usize,
    gpu: Option<Device>,
}

impl Prepared {
    /// What follows lines of sight, if something does.
    fn tracer(&self, scene: &Scene, method: Method) -> Option<&Tracer> {
        match method {
            Method::Exact => {
                Some(self.tracer.get_or_init(|| Tracer::exact(scene, self.projection, self.pictures)))
            }
            Method::Trace => Some(self.tracer.get_or_init(|| Tracer::new(scene))),
            Method::Apparent => None,
        }
    }
}

/// What was done and what it took.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Triangles of the meshes.
    pub triangles: usize,
    /// Triangles drawn, after cutting.
    pub pieces: usize,
    /// Time for mapping and cutting.
    pub subdivision: Duration,
    /// Time for drawing.
    pub shading: Duration,
    /// Rays, where they were traced.
    pub rays: Option<Traced>,
    /// The graphics processor that drew, if one did.
    pub gpu: Option<String>,
    /// Why one that was to draw did not, so that the CPU did.
    pub gpu_fault: Option<String>,
}

/// A step of [`render`], for showing progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The body of this index is moved to where it is seen, and cut.
    Cutting(usize),
    /// Everything is drawn.
    Drawing,
    /// Of rows that take long, so many are drawn.
    Rows {
        /// Rows that are.
        done: u32,
        /// All rows.
        of: u32,
    },
    /// Rays are traced, for so many samples of a pixel so far.
    Tracing {
        /// How many are done.
        done: usize,
        /// How many there are.
        of: usize,
    },
}

/// The spacetime around a hole, followed as pictures need it: rays to 10⁻⁸ (see [`Accuracy`]), in chords as long as they can
/// be without much to look for around them.
pub fn around(hole: KerrSchild) -> Curved<KerrSchild> {
    Curved::new(hole).with(Accuracy::new(1e-8, SAGITTA * hole.mass()))
}

/// As [`around`], for who looks from somewhere: from near the horizon light that comes from outside is followed to less. Its
/// wave vector is large there and becomes small on the way out, and errors of its beginning do not; they grow like one over
/// the square of [`tortoise_slope`](KerrSchild::tortoise_slope), which is the height above the horizon in parts of its radius
/// where nothing rotates, and less around fast holes. Where that is less than some 3·10⁻⁵, f64 has too few digits, rays
/// drift, and are flagged.
pub fn around_seen_from(hole: KerrSchild, eye: &Eye) -> Curved<KerrSchild> {
    let usual = around(hole);
    let Eye::Near(frame) = eye else { return usual };
    let slope = hole.tortoise_slope(hole.radius(frame.event().position().to_array()));
    let part = (10.0 * slope * slope).clamp(1e-5, 1.0);
    let Accuracy { tolerance, sagitta, drift, .. } = usual.accuracy();
    // Drift grows as errors do, and matters no more than elsewhere.
    usual.with(Accuracy { drift, ..Accuracy::new(part * tolerance, sagitta) })
}

/// ε of chords, in masses: where rays are cheapest; hits are exact whatever it is.
const SAGITTA: f64 = 0.05;

/// Draws a scene: exactly, every triangle tested where it may be seen; by apparent shading, every body moved to where the
/// camera sees it (Nollert et al. 2000, Eq. 1), cut until flat triangles show it to the pixel, and drawn by a z-buffer or a
/// painter; or by tracing rays.
///
/// # Errors
/// If the bodies would be cut into more pieces than allowed, or than can be painted, or a spectrum cannot be; in curved
/// spacetime, if nobody can be where the camera is, or something in the scene cannot be.
pub fn render(
    scene: &Scene,
    camera: &Camera,
    options: &Options,
    step: impl FnMut(Step) + Send,
) -> Result<(Film, Report), RenderError> {
    let mut film = Film::new(0, 0);
    let prepared = options.prepare(scene, [camera])?;
    let report = render_again(scene, camera, options, &prepared, &mut film, step)?;
    Ok((film, report))
}

/// As [`render`], on a film used before, with what was [prepared](Options::prepare) before by the same options.
///
/// # Errors
/// As [`render`].
pub fn render_again(
    scene: &Scene,
    camera: &Camera,
    options: &Options,
    prepared: &Prepared,
    film: &mut Film,
    step: impl FnMut(Step) + Send,
) -> Result<Report, RenderError> {
    let shot = Shot { scene, camera, options, prepared, samples: Samples::new(options.samples) };
    #[cfg(feature = "gpu")]
    let mut step = step;
    #[cfg(feature = "gpu")]
    let fault = match &prepared.gpu {
        None => None,
        Some(gpu) => match shot.draw_on(gpu, film, &mut step) {
            Err(RenderError::Gpu(fault)) if options.raster == Raster::Auto => Some(fault.to_string()),
            done => return done,
        },
    };
    #[cfg(not(feature = "gpu"))]
    let fault = None;
    let report = match prepared.tracer(scene, options.method) {
        Some(tracer) => shot.follow(tracer, film, step),
        None => shot.polygons(film, step),
    }?;
    Ok(Report { gpu_fault: fault, ..report })
}

/// A picture to be drawn.
struct Shot<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    options: &'a Options,
    prepared: &'a Prepared,
    samples: Samples,
}

impl Shot<'_> {
    /// By lines of sight.
    fn follow(
        &self,
        tracer: &Tracer,
        film: &mut Film,
        mut step: impl FnMut(Step) + Send,
    ) -> Result<Report, RenderError> {
        let Self { scene, camera, options, .. } = self;
        let shading = &self.prepared.shading.seen_by(&camera.observer);
        let triangles = scene.triangle_count();
        let start = Instant::now();
        let paths = if options.method == Method::Exact { Paths::default() } else { options.paths };
        let look = Look { samples: self.samples.offsets(), shading, paths };
        let rays = if let (Spacetime::Kerr(hole), Some(eye)) = (&scene.spacetime, scene.eye(camera)?) {
            let space = around_seen_from(*hole, &eye);
            let step = Mutex::new(step);
            let of = camera.lens.height();
            // A panic of another thread is told by that thread.
            let done = |done| step.lock().unwrap_or_else(PoisonError::into_inner)(Step::Rows { done, of });
            tracer.trace_curved(scene, &space, &eye, &camera.lens, &look, film, done)
        } else {
            tracer.trace(scene, camera, &look, film, |done, of| step(Step::Tracing { done, of }))
        };
        let shading = start.elapsed();
        Ok(Report { triangles, pieces: triangles, shading, rays: Some(rays), ..Report::default() })
    }

    /// By polygons.
    fn polygons(&self, film: &mut Film, step: impl FnMut(Step) + Send) -> Result<Report, RenderError> {
        self.cut_and_draw(step, |bodies, shading| {
            match self.options.raster {
                Raster::Skia => *film = paint(bodies, &self.camera.lens, &self.samples, shading)?,
                _ => shade_again(bodies, &self.camera.lens, &self.samples, shading, film),
            }
            Ok(())
        })
    }

    /// Moves bodies to where they are seen, cuts them, and has them drawn.
    fn cut_and_draw(
        &self,
        mut step: impl FnMut(Step),
        draw: impl FnOnce(&[Drawable<'_>], &SeenShading<'_>) -> Result<(), RenderError>,
    ) -> Result<Report, RenderError> {
        let Self { scene, camera, options, .. } = self;
        let shading = &self.prepared.shading.seen_by(&camera.observer);
        let start = Instant::now();
        let seen = cut(scene, camera, options, |body| step(Step::Cutting(body)))?;
        let cut = Instant::now();
        step(Step::Drawing);
        draw(&drawables(&seen), shading)?;
        let (subdivision, shading) = (cut - start, cut.elapsed());
        let (triangles, pieces) = (scene.triangle_count(), pieces(&seen));
        Ok(Report { triangles, pieces, subdivision, shading, ..Report::default() })
    }

    /// On a graphics processor.
    #[cfg(feature = "gpu")]
    fn draw_on(&self, gpu: &Gpu, film: &mut Film, mut step: impl FnMut(Step)) -> Result<Report, RenderError> {
        let Self { scene, camera, samples, .. } = self;
        let name = Some(gpu.name().to_owned());
        if self.options.method == Method::Apparent {
            let report = self.cut_and_draw(step, |bodies, shading| {
                Ok(gpu.draw(bodies, &camera.lens, samples, shading, film)?)
            })?;
            return Ok(Report { gpu: name, ..report });
        }
        let shading = &self.prepared.shading.seen_by(&camera.observer);
        let start = Instant::now();
        step(Step::Drawing);
        let bodies = scene
            .bodies
            .iter()
            .map(|body| (ApparentMap::new(&body.motion, &camera.observer), body.mesh_seen(&camera.observer)));
        let bodies: Vec<_> = bodies.collect();
        let uncut = bodies.iter().enumerate().map(|(body, (map, mesh))| Uncut { body, mesh, map });
        gpu.draw_uncut(&uncut.collect::<Vec<_>>(), &camera.lens, samples, shading, film)?;
        let triangles = scene.triangle_count();
        Ok(Report { triangles, pieces: triangles, shading: start.elapsed(), gpu: name, ..Report::default() })
    }
}

/// A body as it is drawn: the map it is seen through, its mesh at rest, and that as it is seen.
pub type SeenBody = (ApparentMap, Arc<Mesh>, ApparentMesh);

/// Every body moved to where it is seen, and cut; `begin` hears of each before.
pub(crate) fn cut(
    scene: &Scene,
    camera: &Camera,
    options: &Options,
    mut begin: impl FnMut(usize),
) -> Result<Vec<SeenBody>, RenderError> {
    let field = Field::new(&camera.lens);
    let mut seen: Vec<SeenBody> = Vec::with_capacity(scene.bodies.len());
    for (index, body) in scene.bodies.iter().enumerate() {
        begin(index);
        let map = ApparentMap::new(&body.motion, &camera.observer);
        // What is not cut is drawn however much it is, and may be more than allowed already.
        let left = options.most_pieces.saturating_sub(pieces(&seen));
        let how = Subdivision { tolerance: options.tolerance, most: left };
        let fault = |e| TooManyPieces { most: options.most_pieces, ..e };
        let mesh = body.mesh_seen(&camera.observer);
        let apparent = ApparentMesh::new(&mesh, &map, &field, &how).map_err(fault)?;
        seen.push((map, mesh, apparent));
    }
    Ok(seen)
}

/// How many triangles they are drawn as.
pub(crate) fn pieces(seen: &[SeenBody]) -> usize {
    seen.iter().map(|(_, _, seen)| seen.triangles.len()).sum()
}

/// All bodies of a scene, as they are drawn.
pub(crate) fn drawables(seen: &[SeenBody]) -> Vec<Drawable<'_>> {
    let drawable = |(body, (map, mesh, seen))| Drawable { body, mesh, map, seen };
    seen.iter().map(|(map, mesh, seen)| (map, &**mesh, seen)).enumerate().map(drawable).collect()
}
