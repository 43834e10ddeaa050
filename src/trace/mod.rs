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

mod beam;
mod chord;
mod curved;
mod lanes;
mod origin;
mod packet;
mod ray;
mod stage;
mod tile;
mod tree;

use crate::film::Film;
use crate::light::SeenShading;
use crate::scene::{Camera, Eye, Lens, Scene};
use chord::Goal;
use rayon::prelude::*;
use stage::Stage;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use terrell_geodesic::{Spacetime, Wide};
use tile::{Job, SIDE, Tile};
use tree::Tree;

pub use tile::Count;

/// A scene to be traced: its meshes with their hierarchies of boxes, which are the same for all moments and observers.
#[derive(Clone, Debug)]
pub struct Tracer {
    /// By body; none of those that are posed anew for every moment.
    trees: Vec<Option<Arc<Tree>>>,
    vectors: bool,
}

impl Tracer {
    /// Builds what is needed for a scene's meshes; those that several bodies share, once.
    pub fn new(scene: &Scene) -> Self {
        let mut known: Vec<(*const crate::scene::Mesh, Arc<Tree>)> = Vec::new();
        let tree = |body: &crate::scene::Body| {
            if body.clip.is_some() {
                return None;
            }
            let mesh = Arc::as_ptr(&body.mesh);
            if let Some((_, tree)) = known.iter().find(|(m, _)| *m == mesh) {
                return Some(tree.clone());
            }
            let tree = Arc::new(Tree::new(&body.mesh));
            known.push((mesh, tree.clone()));
            Some(tree)
        };
        Self { trees: scene.bodies.iter().map(tree).collect(), vectors: true }
    }

    /// The same for any x86-64 processor, without AVX2: for measuring.
    #[must_use]
    pub fn without_vectors(self) -> Self {
        Self { vectors: false, ..self }
    }

    /// Traces what a camera sees onto a film, which is cleared first; `scene` is the one this was made of, `samples` are
    /// offsets from the pixels' corners, and `shading` is for the camera's observer.
    pub fn trace(
        &self,
        scene: &Scene,
        camera: &Camera,
        samples: &[[f64; 2]],
        shading: &SeenShading<'_>,
        film: &mut Film,
    ) -> Count {
        film.clear(camera.lens.width(), camera.lens.height());
        let stage = self.stage(scene, camera, shading);
        let world_from_observer = || camera.observer.observer_from_world::<Wide>().inverse().rounded();
        let sky = scene.sky.as_ref().map(|sky| (sky, world_from_observer()));
        let job = Job { stage: &stage, lens: &camera.lens, shading, sky, samples, vectors: self.vectors };
        film.bands(SIDE)
            .enumerate()
            .map_init(Tile::default, |tile, (index, rows)| tile.draw_band(&job, index as u32 * SIDE, rows))
            .reduce(Count::default, Count::add)
    }

    /// Only the rays, to measure how fast they are: nothing is shaded, and nothing kept.
    pub fn cast(
        &self,
        scene: &Scene,
        camera: &Camera,
        samples: &[[f64; 2]],
        shading: &SeenShading<'_>,
    ) -> Count {
        let stage = self.stage(scene, camera, shading);
        let job =
            Job { stage: &stage, lens: &camera.lens, shading, sky: None, samples, vectors: self.vectors };
        (0..camera.lens.height().div_ceil(SIDE))
            .into_par_iter()
            .map_init(Tile::default, |tile, band| tile.cast_band(&job, band * SIDE))
            .reduce(Count::default, Count::add)
    }

    /// Traces what is seen in curved spacetime, whatever its metric, onto a film, which is cleared first; `done` is told how
    /// many rows are finished, by whatever thread.
    ///
    /// A body is a rigid mesh in the spacetime's coordinates, moving uniformly in them, X = L(celerity)·X′ + origin as in
    /// flat spacetime. A ray's chords are met with its boxes, inflated by how far the ray may be from them; whether and
    /// where it goes through a triangle is then decided on the ray itself. D is the quotient of the products of wave vector
    /// and four-velocity at both ends, in the metric there. Lights are left out.
    #[expect(clippy::too_many_arguments, reason = "as many as things meet in a picture")]
    pub fn trace_curved<S: Spacetime>(
        &self,
        scene: &Scene,
        space: &S,
        eye: &Eye,
        lens: &Lens,
        samples: &[[f64; 2]],
        shading: &SeenShading<'_>,
        film: &mut Film,
        done: impl Fn(u32) + Sync,
    ) -> Count {
        film.clear(lens.width(), lens.height());
        let goals = scene.bodies.iter().enumerate().zip(&self.trees).map(|((index, body), tree)| {
            let tree = tree.clone().unwrap_or_else(|| Arc::new(Tree::new(&body.mesh)));
            Goal::new(index, &body.motion, body.mesh.clone(), tree, space.sagitta(), space.lag())
        });
        let goals: Vec<Goal> = goals.collect();
        let job = curved::Job { space, goals: &goals, eye, lens, sky: scene.sky.as_ref(), shading, samples };
        let finished = AtomicU32::new(0);
        film.bands(SIDE)
            .enumerate()
            .map_init(curved::Band::default, |band, (index, mut rows)| {
                let count = band.draw(&job, index as u32 * SIDE, &mut rows);
                let rows = (rows.body.len() / lens.width() as usize) as u32;
                done(finished.fetch_add(rows, Ordering::Relaxed) + rows);
                count
            })
            .reduce(Count::default, Count::add)
    }

    fn stage(&self, scene: &Scene, camera: &Camera, shading: &SeenShading<'_>) -> Stage {
        let bodies = scene.bodies.iter().enumerate().zip(&self.trees).map(|((index, body), tree)| {
            let mesh = body.mesh_seen(&camera.observer);
            let tree = tree.clone().unwrap_or_else(|| Arc::new(Tree::new(&mesh)));
            (index, body.motion, mesh, tree)
        });
        Stage::new(bodies.collect(), camera, shading.lights() > 0)
    }
}
