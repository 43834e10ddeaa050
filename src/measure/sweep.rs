use super::displacement::{Displacement, beyond_faces, edge_displacement, f32_displacement, in_f32};
use super::{Comparison, Corners, Figures, FlipError, Perceived, Reference, Times, flip, interleaved};
use crate::apparent::ApparentMesh;
use crate::color::Coloring;
use crate::film::{Film, Samples};
use crate::light::{DopplerAt, Shading, ShadingError};
use crate::picture::pixels_srgb;
use crate::plan::Method;
use crate::raster::shade_again;
use crate::relativity::ApparentMap;
use crate::render::{Options, Prepared, Raster, RenderError, SeenBody, cut, drawables, pieces, render_again};
use crate::scene::{Body, Camera, Scene};
use crate::tone::Development;
use crate::trace::{Look, Paths, Tracer};
use std::time::{Duration, Instant};

/// A way to draw a scene, one of those a sweep compares.
#[derive(Clone, Debug)]
pub struct SweepWay {
    /// What it is a variant of: "exact", "apparent" and so on.
    pub series: &'static str,
    /// How it is drawn.
    pub options: Options,
    /// What becomes of vertices.
    pub vertices: Vertices,
}

/// What becomes of the vertices of apparent shading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Vertices {
    /// They are mapped in f64, and edges are cut to the tolerance.
    #[default]
    Cut,
    /// They are mapped in f64, and nothing is cut.
    Linear,
    /// They are cut in f64, then mapped in f32: what f32 alone does to a picture. Nobody would draw so, and its time
    /// tells nothing.
    CutF32,
}

/// What a way makes of a scene.
#[derive(Clone, Debug)]
pub struct SweepPoint {
    /// The way.
    pub way: SweepWay,
    /// What it made, or why it made nothing.
    pub measured: Result<Measured, String>,
}

/// What was measured of one way.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Triangles drawn.
    pub pieces: usize,
    /// What is done once a scene, in one run.
    pub preparation: Duration,
    /// What is done for every picture; none where that tells nothing.
    pub frame: Option<Times>,
    /// How far edges are drawn from where they are seen, if edges are drawn.
    pub edges: Option<Displacement>,
    /// How far pixels lie outside of what they show.
    pub beyond: Displacement,
    /// Against rays along the same lines of sight.
    pub seen: Figures,
    /// Against rays with many samples: of light alone.
    pub light: Figures,
    /// Likewise, as an eye sees it.
    pub perceived: Perceived,
}

impl Measured {
    /// Pixels that see another body or another face than rays do.
    pub fn wrong_pixels(&self) -> usize {
        let all = [&self.seen.silhouette, &self.seen.edges];
        all.into_iter().flatten().map(|disagreement| disagreement.pixels).sum()
    }
}

impl SweepPoint {
    /// The worst displacement there is, pixels: of edges, or of pixels beyond what they show, whichever is greater; where
    /// vertices are in f32, of these alone. None if nothing was drawn.
    pub fn displacement(&self) -> Option<f64> {
        let measured = self.measured.as_ref().ok()?;
        let edges = measured.edges.map_or(0.0, |edges| edges.worst);
        let of_pictures = self.way.vertices != Vertices::CutF32;
        Some(if of_pictures { edges.max(measured.beyond.worst) } else { edges })
    }
}

/// Why a sweep could not be made.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The scene cannot be traced.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Pictures that cannot be compared.
    #[error(transparent)]
    Flip(#[from] FlipError),
}

/// One scene, drawn in several ways.
pub struct Sweep<'a> {
    /// What is drawn.
    pub scene: &'a Scene,
    /// From where.
    pub camera: &'a Camera,
    /// How.
    pub ways: Vec<SweepWay>,
    /// Samples of a pixel of what light is compared with.
    pub reference_samples: u32,
    /// How often each is timed.
    pub repeats: u32,
}

impl Sweep<'_> {
    /// Draws and measures all; `develop` says how light is shown to who compares pictures, given the reference. `done`
    /// hears of each picture timed.
    ///
    /// # Errors
    /// If the scene cannot be traced; what a single way cannot draw is said with its [point](SweepPoint).
    pub fn run(
        &self,
        options: &Options,
        develop: impl FnOnce(&Film) -> Result<Development, RenderError>,
        mut done: impl FnMut(),
    ) -> Result<Vec<SweepPoint>, SweepError> {
        let traced = Options { method: Method::Trace, doppler_at: DopplerAt::Pixel, ..options.clone() };
        let many = self.film(&Options { samples: self.reference_samples, ..traced.clone() })?;
        let one = self.film(&Options { samples: 1, ..traced.clone() })?;
        let corners = Some(Corners::traced(self.scene, self.camera, &one).map_err(RenderError::from)?);
        let development = develop(&many)?;
        let references = References {
            lines: Reference { corners, ..one.into() },
            shown: pixels_srgb(&many, &development),
            many: many.into(),
            development,
        };
        let mut film = Film::new(0, 0);
        let mut points = Vec::with_capacity(self.ways.len());
        // What a way cannot do is known before anything is timed.
        let mut timed = Vec::new();
        for (index, way) in self.ways.iter().enumerate() {
            let start = Instant::now();
            let prepared = way.options.prepare(self.scene, [self.camera]);
            let preparation = start.elapsed();
            let drawn = prepared.and_then(|made| Ok((self.draw(way, &made, &mut film)?, made)));
            let measured = match drawn {
                Ok((pieces, made)) => {
                    if way.vertices != Vertices::CutF32 {
                        timed.push((index, made));
                    }
                    Ok(self.measure(way, pieces, preparation, &film, &references)?)
                }
                Err(fault) => Err(fault.to_string()),
            };
            points.push(SweepPoint { way: way.clone(), measured });
        }
        let draw = |job: usize| {
            let (index, made) = &timed[job];
            self.draw(&self.ways[*index], made, &mut film).map(drop)
        };
        let times = interleaved(timed.len(), self.repeats, PATIENCE, draw, &mut done)?;
        for ((index, _), times) in timed.iter().zip(times) {
            if let Ok(measured) = &mut points[*index].measured {
                measured.frame = Some(times);
            }
        }
        Ok(points)
    }

    fn film(&self, options: &Options) -> Result<Film, RenderError> {
        let mut film = Film::new(0, 0);
        let prepared = options.prepare(self.scene, [self.camera])?;
        render_again(self.scene, self.camera, options, &prepared, &mut film, |_| ())?;
        Ok(film)
    }

    /// One picture; how many triangles were drawn.
    fn draw(&self, way: &SweepWay, prepared: &Prepared, film: &mut Film) -> Result<usize, RenderError> {
        if way.vertices == Vertices::Cut {
            let report = render_again(self.scene, self.camera, &way.options, prepared, film, |_| ())?;
            return Ok(report.pieces);
        }
        let bodies = self.seen(way)?;
        let shading = prepared.shading.seen_by(&self.camera.observer);
        let samples = Samples::new(way.options.samples);
        shade_again(&drawables(&bodies), &self.camera.lens, &samples, &shading, film);
        Ok(pieces(&bodies))
    }

    /// The bodies as they are drawn.
    fn seen(&self, way: &SweepWay) -> Result<Vec<SeenBody>, RenderError> {
        let Self { scene, camera, .. } = self;
        if way.vertices == Vertices::Linear {
            let uncut = |body: &Body| {
                let map = ApparentMap::new(&body.motion, &camera.observer);
                let mesh = body.mesh_seen(&camera.observer);
                let seen = ApparentMesh::linear(&mesh, &map);
                (map, mesh, seen)
            };
            return Ok(scene.bodies.iter().map(uncut).collect());
        }
        let mut bodies = cut(scene, camera, &way.options, |_| ())?;
        if way.vertices == Vertices::CutF32 {
            for (map, _, seen) in &mut bodies {
                seen.vertices.iter_mut().for_each(|vertex| *vertex = in_f32(map, *vertex));
            }
        }
        Ok(bodies)
    }

    fn measure(
        &self,
        way: &SweepWay,
        pieces: usize,
        preparation: Duration,
        film: &Film,
        references: &References,
    ) -> Result<Measured, SweepError> {
        let lens = &self.camera.lens;
        let edges = match (way.options.method, way.vertices) {
            (Method::Apparent, Vertices::CutF32) => {
                let exact = SweepWay { vertices: Vertices::Cut, ..way.clone() };
                Some(f32_displacement(&self.seen(&exact)?, lens))
            }
            (Method::Apparent, _) => Some(edge_displacement(&self.seen(way)?, lens)),
            _ => None,
        };
        let compare = |reference| Comparison::new(reference, film).expect("all are of one size").whole;
        let shown = pixels_srgb(film, &references.development);
        Ok(Measured {
            pieces,
            preparation,
            frame: None,
            edges,
            beyond: beyond_faces(self.scene, self.camera, film),
            seen: compare(&references.lines),
            light: compare(&references.many),
            perceived: flip([film.width, film.height], &references.shown, &shown)?,
        })
    }
}

/// What takes longer than that in all is timed less often.
const PATIENCE: Duration = Duration::from_secs(3);

/// What films are compared with.
struct References {
    /// Rays along the same lines of sight.
    lines: Reference,
    /// Rays with many samples.
    many: Reference,
    /// The latter, developed.
    shown: Vec<u8>,
    development: Development,
}

impl Corners {
    /// What rays through the corners of pixels see, of a film of what those through their centres see.
    ///
    /// # Errors
    /// If a spectrum cannot be.
    pub fn traced(scene: &Scene, camera: &Camera, centres: &Film) -> Result<Self, ShadingError> {
        // Whatever it is, it is asked what it is only.
        let shading = Shading::new(scene, [&camera.observer], Coloring::Doppler)?;
        let (shading, tracer) = (shading.seen_by(&camera.observer), Tracer::new(scene));
        let films = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|corner| {
            let mut film = Film::new(0, 0);
            let look = Look { samples: &[corner], shading: &shading, paths: Paths::default() };
            tracer.trace(scene, camera, &look, &mut film, |_, _| ());
            film
        });
        Ok(Self::new(centres, &films))
    }
}

/// The ways a sweep usually compares: exact shading and rays with these samples a pixel; apparent shading at these
/// tolerances; the other rasters, and the Doppler factor at vertices, at `few` of them; without cuts; with vertices in
/// f32.
pub fn usual_ways(options: &Options, tolerances: &[f64], few: &[f64], samples: &[u32]) -> Vec<SweepWay> {
    let way = |series, options, vertices| SweepWay { series, options, vertices };
    let mut ways = Vec::new();
    for (series, method) in [("exact", Method::Exact), ("trace", Method::Trace)] {
        for &samples in samples {
            let options = Options { method, samples, doppler_at: DopplerAt::Pixel, ..options.clone() };
            ways.push(way(series, options, Vertices::Cut));
        }
    }
    for &samples in samples {
        let raster = Raster::Wgpu;
        let options = Options { raster, samples, doppler_at: DopplerAt::Pixel, ..options.clone() };
        ways.push(way(ON_GPU[0], Options { method: Method::Exact, ..options }, Vertices::Cut));
    }
    let apparent = Options { method: Method::Apparent, samples: 1, ..options.clone() };
    for (series, raster) in RASTERS {
        for &tolerance in if raster == Raster::Cpu { tolerances } else { few } {
            ways.push(way(series, Options { tolerance, raster, ..apparent.clone() }, Vertices::Cut));
        }
    }
    ways.push(way("uncut", apparent.clone(), Vertices::Linear));
    for &tolerance in few {
        let at_vertices = Options { tolerance, doppler_at: DopplerAt::Vertex, ..apparent.clone() };
        ways.push(way("D at vertices", at_vertices, Vertices::Cut));
    }
    let finest = tolerances.iter().copied().fold(f64::INFINITY, f64::min);
    if finest.is_finite() {
        ways.push(way("f32 vertices", Options { tolerance: finest, ..apparent }, Vertices::CutF32));
    }
    ways
}

/// Series that need a graphics processor.
pub const ON_GPU: [&str; 2] = ["GPU exact", "GPU apparent"];

/// What cut triangles are drawn by, each a series.
const RASTERS: [(&str, Raster); 3] =
    [("apparent", Raster::Cpu), ("painter", Raster::Skia), (ON_GPU[1], Raster::Wgpu)];

/// The names of all series there are, in their order.
pub fn series_names() -> Vec<&'static str> {
    let mut names: Vec<&str> =
        usual_ways(&Options::default(), &[1.0], &[1.0], &[1]).iter().map(|way| way.series).collect();
    names.dedup();
    names
}
