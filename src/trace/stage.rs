use super::beam::RAYS;
use super::directed::Directed;
use super::origin::Origin;
use super::ray::Ray;
use super::tree::Tree;
use crate::light::Facet;
use crate::relativity::{ApparentMap, Motion, RestSky};
use crate::scene::{Camera, Mesh};
use glam::DVec3;
use std::sync::Arc;
use terrell_geodesic::{FourVector, Lorentz, Rest, Wide};

/// Everything that can be hit, as one observer sees it at one moment.
pub(super) struct Stage {
    pub targets: Vec<Target>,
    /// Maps between the rest frames of bodies, by their kinds of motion: to, from.
    between: Vec<Vec<Lorentz<Rest, Rest>>>,
}

/// A body.
pub(super) struct Target {
    /// Its index in the scene.
    pub body: usize,
    pub mesh: Arc<Mesh>,
    pub tree: Arc<Tree>,
    pub map: ApparentMap,
    pub sky: RestSky,
    pub outline: Outline,
    /// Which of the kinds of motion it has.
    pub motion: usize,
}

/// A circle of the observer's sky with the whole body in it: the image of the sphere around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    axis: DVec3,
    /// Of half its opening.
    cosine: f64,
    sine: f64,
}

impl Outline {
    const EVERYWHERE: Self = Self { axis: DVec3::Z, cosine: -1.0, sine: 0.0 };

    /// Of a sphere in the rest frame. The plane that cuts its circle from the rest sky is a four-vector, and is boosted.
    fn new(map: &ApparentMap, tree: &Tree, camera: &Camera, motion: &Motion) -> Self {
        let middle = map.offset_rest(tree.centre);
        let distance = middle.length();
        let radius = tree.radius * (1.0 + 1e-9) + 1e-12 * distance;
        if radius >= distance {
            return Self::EVERYWHERE;
        }
        let sine = radius / distance;
        let cosine = (1.0 - sine * sine).sqrt();
        let axis = middle / distance;
        let observer_from_rest =
            camera.observer.observer_from_world::<Wide>() * motion.world_from_rest::<Wide>();
        let plane = (observer_from_rest * FourVector::from_parts(-cosine, axis).widened()).rounded();
        if !plane.xyz().is_finite() {
            return Self::EVERYWHERE;
        }
        // f64 leaves 10⁻¹⁶ of the circle at rest, which γ makes more of.
        let off = 1e-12 + 4e-15 * map.gamma() / plane.xyz().length();
        let half_angle = sine.atan2(-plane.t) + off;
        if half_angle.is_nan() || half_angle >= std::f64::consts::PI {
            return Self::EVERYWHERE;
        }
        let (sine, cosine) = half_angle.sin_cos();
        Self { axis: plane.xyz().normalize_or(DVec3::Z), cosine, sine }
    }

    /// Whether a circle of directions and this one may have any in common.
    #[inline]
    pub fn meets(&self, axis: DVec3, half_angle: f64) -> bool {
        // The cosine of both angles together is no less.
        let least =
            (self.cosine * (1.0 - 0.5 * half_angle * half_angle)).min(self.cosine) - self.sine * half_angle;
        self.axis.dot(axis) > least - 1e-9
    }
}

impl Target {
    /// The triangle of a leaf, from the observer in the rest frame.
    #[inline]
    pub fn facet(&self, leaf: u32) -> Facet<'_> {
        let leaf = self.tree.leaf(leaf);
        let [a, b, c] = &leaf.corners;
        let map = &self.map;
        let corners = [map.offset_rest(*a), map.offset_rest(*b), map.offset_rest(*c)];
        Facet::new(&self.mesh, leaf.face as usize, corners)
    }

    /// A line of sight in the rest frame, with the same affine parameter.
    #[inline]
    pub fn rest_direction(&self, v: DVec3, length: f64) -> DVec3 {
        self.map.rotate_back(self.sky.boosted_direction(v, length))
    }

    /// Of all lines of sight together: their directions in the rest frame, and the Doppler factors of what they meet there. With
    /// AVX2 if `vectors` and there is such.
    pub fn boost(&self, lines: &[[f64; RAYS]; 4], rest: &mut Directed, vectors: bool) {
        #[cfg(target_arch = "x86_64")]
        if vectors && crate::processor::has_avx2() {
            // SAFETY: the processor has both.
            unsafe { self.boost_avx2(lines, rest) };
            return;
        }
        let _ = vectors;
        self.boost_with(lines, rest);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn boost_avx2(&self, lines: &[[f64; RAYS]; 4], rest: &mut Directed) {
        self.boost_with(lines, rest);
    }

    /// In loops of plain arithmetic, which compilers make vectors of.
    #[inline(always)]
    fn boost_with(&self, [length, x, y, z]: &[[f64; RAYS]; 4], rest: &mut Directed) {
        let axis = self.sky.axis();
        // What is added along the motion.
        let mut more = [0.0; RAYS];
        for (i, (more, doppler)) in more.iter_mut().zip(&mut rest.dopplers).enumerate() {
            let along = x[i] * axis.x + y[i] * axis.y + z[i] * axis.z;
            let across =
                [y[i] * axis.z - z[i] * axis.y, z[i] * axis.x - x[i] * axis.z, x[i] * axis.y - y[i] * axis.x];
            let across = across[0] * across[0] + across[1] * across[1] + across[2] * across[2];
            let boosted = self.sky.boosted_parts(along, across, length[i]);
            *more = boosted.along - along;
            *doppler = length[i] / boosted.length;
        }
        let axes = self.map.axes();
        for (k, rest) in rest.directions.iter_mut().enumerate() {
            let row = axes.row(k);
            for i in 0..RAYS {
                rest[i] = row.x * (x[i] + more[i] * axis.x)
                    + row.y * (y[i] + more[i] * axis.y)
                    + row.z * (z[i] + more[i] * axis.z);
            }
        }
    }
}

impl Stage {
    /// Of bodies with their meshes and the trees of those; `lit` if ways from body to body will be asked for.
    pub fn new(bodies: Vec<(usize, Motion, Arc<Mesh>, Arc<Tree>)>, camera: &Camera, lit: bool) -> Self {
        let mut motions: Vec<Motion> = Vec::new();
        let mut targets = Vec::with_capacity(bodies.len());
        for (body, motion, mesh, tree) in bodies {
            let kind = motions.iter().position(|m| m.celerity == motion.celerity).unwrap_or_else(|| {
                motions.push(motion);
                motions.len() - 1
            });
            let map = ApparentMap::new(&motion, &camera.observer);
            let outline = Outline::new(&map, &tree, camera, &motion);
            targets.push(Target { body, mesh, tree, sky: map.rest_sky(), map, outline, motion: kind });
        }
        let between = |to: &Motion| {
            let rest_from_world = to.world_from_rest::<Wide>().inverse();
            motions.iter().map(|from| (rest_from_world * from.world_from_rest::<Wide>()).rounded()).collect()
        };
        let between = if lit { motions.iter().map(between).collect() } else { Vec::new() };
        Self { targets, between }
    }

    /// From the rest frame of one target to that of another, both by their indices.
    pub fn between(&self, to: usize, from: usize) -> Lorentz<Rest, Rest> {
        self.between[self.targets[to].motion][self.targets[from].motion]
    }

    /// A way in the rest frame of a target.
    #[inline]
    pub fn ray<'a>(&self, way: &Way, index: usize, target: &'a Target) -> Ray<'a> {
        let receiver = &self.targets[way.from];
        let (at, back) = if target.motion == receiver.motion {
            // The same frame up to where its origin is.
            (way.event.xyz(), way.back.xyz())
        } else {
            let map = &self.between[target.motion][receiver.motion];
            ((*map * way.event).xyz(), (*map * way.back).xyz())
        };
        let close = CLOSE * (at.length() + 1.0 / target.tree.scale) / back.length();
        Ray {
            origin: Origin::at(&target.map, at),
            direction: back,
            range: [close, way.far],
            but: (index == way.from).then_some(way.face),
        }
    }
}

/// A way from a point of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Way {
    /// Index of the target the triangle is of.
    pub from: usize,
    /// Number of the triangle in the mesh.
    pub face: u32,
    /// From the observer's event, in the target's rest frame.
    pub event: FourVector<Rest>,
    /// A null vector of that frame into the past, along the way.
    pub back: FourVector<Rest>,
    /// Where it ends, in units of that vector.
    pub far: f64,
}

/// Nearer to where a ray begins, of the distance from the observer and the size of what may be hit, it is the surface
/// itself: its points are good to a few 10⁻¹⁶ of either, by one over the sine at which it is seen.
pub(super) const CLOSE: f64 = 1e-11;
