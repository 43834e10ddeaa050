//! Ray tracing: lines of sight followed back in time to what they meet.
//!
//! A line of sight is a null vector K = (−1, n) at the observer's event. Boosted into a body's rest frame, where the body
//! is a mesh that does not move, and not renormalised, it keeps one affine parameter s for all bodies: hits compare by s,
//! and D = 1/|K′ᵗ|. From what is met, the null vectors to the lights are followed in the same way, so that shadows are
//! where light *was* in the way of.
//!
//! Through curved spacetime each ray is a chain of chords, and the same holds of each of them: see
//! [`Tracer::trace_curved`].
//!
//! It finds the point of the surface otherwise than [`raster`](crate::raster) does, and knows shadows; all else is the same.
//!
//! [`Tracer::exact`] does so without following lines of sight through a hierarchy: exact shading.

mod beam;
mod bundle;
mod chord;
mod cluster;
mod curved;
mod directed;
mod edges;
mod emitters;
mod faces;
mod fronts;
mod lanes;
mod lists;
mod origin;
mod path;
mod random;
mod ray;
mod sights;
mod stage;
mod tile;
mod tree;

use crate::film::Film;
use crate::light::{SeenShading, has_shadows};
use crate::scene::{Camera, Eye, Lens, Projection, Scene};
use crate::spectrum::luminance;
use chord::Goal;
use emitters::Emitters;
use lists::Lists;
use path::{SkyAround, World};
use rayon::prelude::*;
use stage::Stage;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use terrell_geodesic::{Spacetime, Wide};
use tile::{Job, SIDE, Tile};
use tree::Tree;

pub use path::Paths;
pub use tile::Count;

/// How a scene is looked at.
#[derive(Clone, Copy, Debug)]
pub struct Look<'a> {
    /// Offsets of the samples from the pixels' corners.
    pub samples: &'a [[f64; 2]],
    /// For the camera's observer.
    pub shading: &'a SeenShading<'a>,
    /// Light of surfaces on each other.
    pub paths: Paths,
}

/// What was done.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Traced {
    /// How many rays there were.
    pub count: Count,
    /// Rays from what is seen to each light, and how many of them something stood in the way of.
    pub to_lights: Vec<[u64; 2]>,
    /// What pixels are off by, by the chance of paths and of samples, each of its own brightness: root mean square over all
    /// in which something is left to chance. None where no path was followed, or the samples cannot be halved.
    pub noise: Option<f64>,
}

fn tally(shading: &SeenShading<'_>) -> Vec<[AtomicU64; 2]> {
    (0..shading.lights()).map(|_| Default::default()).collect()
}

/// How often progress is told of.
const PASSES: usize = 32;

/// From the sums of the first half of the samples and of all: the two halves are off by as much, the one independently of
/// the other, so that their difference is what their sum is off by.
fn noise(half: &[[f32; 3]], all: &[[f32; 3]]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0);
    for (half, all) in half.iter().zip(all) {
        let [half, all] = [half, all].map(|c| f64::from(luminance(*c)));
        let off = (all - 2.0 * half) / all;
        // By rounding, where nothing is left to chance; and black is not off by a part of itself.
        if off.abs() > 1e-5 && off.is_finite() {
            sum += off * off;
            count += 1;
        }
    }
    (!half.is_empty()).then(|| (sum / f64::from(count.max(1))).sqrt())
}

/// A scene to be traced: its meshes with their hierarchies of boxes, which are the same for all moments and observers.
#[derive(Clone, Debug)]
pub struct Tracer {
    /// By body; none of those that are posed anew for every moment.
    trees: Vec<Option<Arc<Tree>>>,
    finder: Finder,
    vectors: bool,
}

/// How what a line of sight meets first is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Finder {
    /// By going through trees of boxes.
    Boxes,
    /// By lists of what may be seen in each tile.
    Lists {
        /// Whether something else will go through the trees.
        with_boxes: bool,
    },
}

/// Hierarchies of fewer triangles are built in a few milliseconds.
const FEW: usize = 1 << 15;

/// In so many pictures a hierarchy is paid for. Where little but backs is hidden, going through one takes a quarter longer than
/// lists do; where much is, a fraction of their time.
const MANY: usize = 100;

/// The same under a fisheye or a panorama, where bounds of where triangles may be seen are not had from their corners alone:
/// lists take several times as long as a hierarchy is gone through there.
const MANY_CURVED: usize = 2;

impl Finder {
    fn tree(self, mesh: &Arc<crate::scene::Mesh>) -> Arc<Tree> {
        Arc::new(match self {
            Self::Boxes => Tree::new(mesh),
            Self::Lists { with_boxes: true } => Tree::new(mesh).listed(),
            Self::Lists { with_boxes: false } => Tree::flat(mesh).listed(),
        })
    }
}

impl Tracer {
    /// Builds what is needed for a scene's meshes; those that several bodies share, once.
    pub fn new(scene: &Scene) -> Self {
        Self::with(scene, Finder::Boxes)
    }

    /// For exact shading: what a tile of pixels may see is found from where every triangle may be seen, and only for shadows
    /// are rays followed, so that without them no hierarchy is built. Only where that does not matter, because triangles are
    /// few or pictures many, it is quicker to go through one. Either way it sees just what rays see. Paths are not for it, nor
    /// is curved spacetime.
    pub fn exact(scene: &Scene, projection: Projection, pictures: usize) -> Self {
        if Self::is_listed(scene, projection, pictures) { Self::listing(scene) } else { Self::new(scene) }
    }

    /// Whether [`exact`](Self::exact) lists triangles for so many pictures of a scene.
    pub fn is_listed(scene: &Scene, projection: Projection, pictures: usize) -> bool {
        let many = if projection == Projection::Pinhole { MANY } else { MANY_CURVED };
        scene.triangle_count() >= FEW && pictures <= many
    }

    /// As [`exact`](Self::exact), however few triangles or many pictures there are.
    pub fn listing(scene: &Scene) -> Self {
        Self::with(scene, Finder::Lists { with_boxes: has_shadows(scene) })
    }

    fn with(scene: &Scene, finder: Finder) -> Self {
        let mut known: Vec<(*const crate::scene::Mesh, Arc<Tree>)> = Vec::new();
        let tree = |body: &crate::scene::Body| {
            if body.clip.is_some() {
                return None;
            }
            let mesh = Arc::as_ptr(&body.mesh);
            if let Some((_, tree)) = known.iter().find(|(m, _)| *m == mesh) {
                return Some(tree.clone());
            }
            let tree = finder.tree(&body.mesh);
            known.push((mesh, tree.clone()));
            Some(tree)
        };
        Self { trees: scene.bodies.iter().map(tree).collect(), finder, vectors: true }
    }

    /// The same for any x86-64 processor, without AVX2: for measuring.
    #[must_use]
    pub fn without_vectors(self) -> Self {
        Self { vectors: false, ..self }
    }

    /// Traces what a camera sees onto a film, which is cleared first; `scene` is the one this was made of, `samples` are
    /// offsets from the pixels' corners, and `shading` is for the camera's observer. `step` is told how many of the
    /// samples are done, and of how many.
    pub fn trace(
        &self,
        scene: &Scene,
        camera: &Camera,
        look: &Look<'_>,
        film: &mut Film,
        mut step: impl FnMut(usize, usize),
    ) -> Traced {
        let Look { samples, shading, paths } = *look;
        film.resize(camera.lens.width(), camera.lens.height());
        let follows = paths.bounces > 0;
        let stage = self.stage(scene, camera, shading.lights() > 0 || follows);
        let emitters = follows.then(|| Emitters::new(&stage.targets, shading));
        let around = scene.sky.as_ref().filter(|_| follows).map(|sky| {
            let bodies = stage.targets.iter().map(|target| &scene.bodies[target.body]);
            let world_from_rest =
                bodies.map(|body| body.motion.world_from_rest::<Wide>().rounded()).collect();
            SkyAround { sky, world_from_rest }
        });
        let sky = around.as_ref();
        let world = emitters.as_ref().map(|emitters| World { stage: &stage, shading, emitters, paths, sky });
        let lens = &camera.lens;
        let world_from_observer = || camera.observer.observer_from_world::<Wide>().inverse().rounded();
        let sky = scene.sky.as_ref().map(|sky| (sky, world_from_observer()));
        let vectors = self.vectors;
        let tally = tally(shading);
        let to_lights = &tally[..];
        let world = world.as_ref();
        let lists = self.lists(&stage, lens, samples);
        let lists = lists.as_deref();
        let job = Job { stage: &stage, lists, lens, shading, sky, samples, vectors, to_lights, world };
        let all = samples.len();
        let passes = if follows { PASSES.min(all).max(1) } else { 1 };
        let mut traced = Traced::default();
        let mut half = Vec::new();
        for pass in 0..passes {
            let range = pass * all / passes..(pass + 1) * all / passes;
            step(range.start, all);
            let count = film
                .bands(SIDE)
                .enumerate()
                .map_init(Box::<Tile>::default, |tile, (index, rows)| {
                    tile.draw_band(&job, index as u32 * SIDE, range.clone(), rows)
                })
                .reduce(Count::default, Count::with);
            traced.count = traced.count.with(count);
            if follows && 2 * range.end == all {
                half.clone_from(&film.color);
            }
        }
        traced.noise = noise(&half, &film.color);
        traced.to_lights =
            tally.iter().map(|light| light.each_ref().map(|n| n.load(Ordering::Relaxed))).collect();
        traced
    }

    /// Only the rays, to measure how fast they are: nothing is shaded, and nothing kept.
    pub fn cast(
        &self,
        scene: &Scene,
        camera: &Camera,
        samples: &[[f64; 2]],
        shading: &SeenShading<'_>,
    ) -> Count {
        let stage = self.stage(scene, camera, shading.lights() > 0);
        let lens = &camera.lens;
        let vectors = self.vectors;
        let tally = tally(shading);
        let to_lights = &tally[..];
        let lists = self.lists(&stage, lens, samples);
        let lists = lists.as_deref();
        let (sky, world) = (None, None);
        let job = Job { stage: &stage, lists, lens, shading, sky, samples, vectors, to_lights, world };
        (0..camera.lens.height().div_ceil(SIDE))
            .into_par_iter()
            .map_init(Box::<Tile>::default, |tile, band| tile.cast_band(&job, band * SIDE))
            .reduce(Count::default, Count::with)
    }

    /// Traces what is seen in curved spacetime, whatever its metric, onto a film, which is cleared first; `done` is told how
    /// many rows are finished, by whatever thread.
    ///
    /// A body is a rigid mesh in the spacetime's coordinates, moving uniformly in them, X = L(celerity)·X′ + origin as in
    /// flat spacetime. A ray's chords are met with its boxes, inflated by how far the ray may be from them; whether and
    /// where it goes through a triangle is then decided on the ray itself. D is the quotient of the products of wave vector
    /// and four-velocity at both ends, in the metric there. Lights and light of
    /// surfaces on each other are left out.
    #[expect(clippy::too_many_arguments, reason = "as many as things meet in a picture")]
    pub fn trace_curved<S: Spacetime>(
        &self,
        scene: &Scene,
        space: &S,
        eye: &Eye,
        lens: &Lens,
        look: &Look<'_>,
        film: &mut Film,
        done: impl Fn(u32) + Sync,
    ) -> Traced {
        let Look { samples, shading, .. } = *look;
        film.resize(lens.width(), lens.height());
        let goals = scene.bodies.iter().enumerate().zip(&self.trees).map(|((index, body), tree)| {
            let tree = tree.clone().unwrap_or_else(|| Arc::new(Tree::new(&body.mesh)));
            Goal::new(index, &body.motion, body.mesh.clone(), tree, space.sagitta(), space.lag())
        });
        let goals: Vec<Goal> = goals.collect();
        let job = curved::Job { space, goals: &goals, eye, lens, sky: scene.sky.as_ref(), shading, samples };
        let finished = AtomicU32::new(0);
        let count = film
            .bands(SIDE)
            .enumerate()
            .map_init(curved::Band::default, |band, (index, mut rows)| {
                rows.clear();
                let count = band.draw(&job, index as u32 * SIDE, &mut rows);
                let rows = (rows.body.len() / lens.width() as usize) as u32;
                done(finished.fetch_add(rows, Ordering::Relaxed) + rows);
                count
            })
            .reduce(Count::default, Count::with);
        Traced { count, ..Traced::default() }
    }

    /// Where triangles may be seen, if that is how they are found.
    fn lists(&self, stage: &Stage, lens: &Lens, samples: &[[f64; 2]]) -> Option<Vec<Lists>> {
        let range = |k: usize| {
            let values = samples.iter().map(|s| s[k]);
            [values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max)]
        };
        let [x, y] = [range(0), range(1)];
        let lists =
            || stage.targets.iter().map(|t| Lists::new(t, lens, [[x[0], y[0]], [x[1], y[1]]])).collect();
        (self.finder != Finder::Boxes).then(lists)
    }

    fn stage(&self, scene: &Scene, camera: &Camera, lit: bool) -> Stage {
        let bodies = scene.bodies.iter().enumerate().zip(&self.trees).map(|((index, body), tree)| {
            let mesh = body.mesh_seen(&camera.observer);
            let tree = tree.clone().unwrap_or_else(|| self.finder.tree(&mesh));
            (index, body.motion, mesh, tree)
        });
        Stage::new(bodies.collect(), camera, lit)
    }
}
