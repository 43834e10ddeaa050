//! Where bent rays meet bodies.

use super::ray::Slabs;
use super::tree::{Leaf, Part, Tree};
use crate::relativity::Motion;
use crate::scene::Mesh;
use glam::DVec3;
use std::ops::ControlFlow;
use std::sync::Arc;
use terrell_geodesic::{Event, FourVector, Lorentz, Ray, Rest, Segment, World};

/// A body in curved spacetime, as it can be hit: a rigid mesh in coordinates that move uniformly.
pub(super) struct Goal {
    /// Its index in the scene.
    pub body: usize,
    pub mesh: Arc<Mesh>,
    pub tree: Arc<Tree>,
    origin: Event<World>,
    rest_from_world: Lorentz<Rest, World>,
    world_from_rest: Lorentz<World, Rest>,
    /// How far an exact ray may be from its chord, in the body's coordinates.
    margin: f64,
}

/// What of a body a ray meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// Affine parameter of the ray.
    pub s: f64,
    /// Number of the triangle in the tree.
    pub leaf: usize,
}

/// A chord in a body's coordinates, on its way through the sphere around the body.
struct Chord {
    start: DVec3,
    direction: DVec3,
    /// Where it may hit, from `start` on.
    range: [f64; 2],
    /// Between these the ray itself is looked at: it is on the chord there.
    ends: [f64; 2],
    margin: f64,
}

/// How far outside of a triangle a point counts as within, in parts of it: rounding, so that neighbours leave no cracks.
const RIM: f64 = 1e-10;

impl Goal {
    /// `sagitta` and `lag` are those of the spacetime's segments.
    pub fn new(
        body: usize,
        motion: &Motion,
        mesh: Arc<Mesh>,
        tree: Arc<Tree>,
        sagitta: f64,
        lag: f64,
    ) -> Self {
        let world_from_rest = motion.world_from_rest::<f64>();
        let celerity = &motion.celerity;
        // A displacement of (lag, sagitta), boosted.
        let margin = celerity.gamma() * sagitta + celerity.magnitude() * lag;
        let rest_from_world = world_from_rest.inverse();
        Self { body, mesh, tree, origin: motion.origin, rest_from_world, world_from_rest, margin }
    }

    /// An event's place in the body's coordinates.
    pub fn place(&self, event: Event<World>) -> DVec3 {
        (self.rest_from_world * (event - self.origin)).xyz()
    }

    /// A vector's space part in the body's coordinates.
    pub fn direction(&self, vector: FourVector<World>) -> DVec3 {
        (self.rest_from_world * vector).xyz()
    }

    /// Along the world lines of the body's points; of no particular length.
    pub fn along(&self) -> FourVector<World> {
        self.world_from_rest * FourVector::new(1.0, 0.0, 0.0, 0.0)
    }

    /// The nearest meeting of a ray and the body on a piece of it, the one handed out last, before `nearest`.
    pub fn meet(
        &self,
        piece: &Segment,
        ray: &impl Ray,
        nearest: f64,
        stack: &mut Vec<Part>,
    ) -> Option<Meeting> {
        let chord = self.chord(piece)?;
        let mut found: Option<Meeting> = None;
        // Triangles whose boxes, inflated by the margin, the chord meets.
        let tree = &*self.tree;
        let place = (chord.start - tree.centre) * tree.scale;
        let slack = chord.margin * tree.scale + 4.0 * f64::EPSILON * place.abs().max_element();
        let slabs = Slabs::new(place, slack, chord.direction * tree.scale);
        let mut most = nearest - piece.from;
        let [from, to] = chord.range;
        slabs.visit(tree, stack, [from, to.min(most)], |leaf| {
            let at = self.strike(&chord, piece, ray, &tree.leaf(leaf));
            let Some(at) = at.filter(|at| *at < most && piece.from + at > 0.0) else {
                return ControlFlow::Continue(None);
            };
            found = Some(Meeting { s: piece.from + at, leaf: leaf as usize });
            most = at;
            ControlFlow::Continue(Some(to.min(most)))
        });
        found
    }

    /// What of a piece lies within the sphere around the body, if anything does.
    fn chord(&self, piece: &Segment) -> Option<Chord> {
        let (start, direction) = (self.place(piece.start), self.direction(piece.direction));
        let exact = piece.length == f64::INFINITY;
        let margin = if exact { 0.0 } else { self.margin };
        let (square, way) = (direction.length_squared(), self.tree.centre - start);
        let middle = way.dot(direction) / square;
        let off = (way - direction * middle).length_squared();
        let rounding = 1e-12 * way.length();
        let reach = self.tree.radius + margin + rounding;
        if off.is_nan() || off > reach * reach {
            return None;
        }
        let half = ((reach * reach - off) / square).sqrt();
        let range = [(middle - half).max(0.0), (middle + half).min(piece.length)];
        let ends = if exact { range } else { [0.0, piece.length] };
        (range[0] <= range[1]).then_some(Chord { start, direction, range, ends, margin })
    }

    /// Where the ray itself first goes through a triangle, on the piece that has this chord, from its start on.
    ///
    /// The chord's ends are on the ray, so where they lie on different sides of the triangle's plane the ray goes through
    /// it, once, as it bends one way only; where both lie on one side, near it, it may do so twice.
    fn strike(&self, chord: &Chord, piece: &Segment, ray: &impl Ray, leaf: &Leaf) -> Option<f64> {
        let [a, b, c] = leaf.corners;
        let normal = (b - a).cross(c - a);
        let size = normal.length();
        if size.is_nan() || size == 0.0 {
            return None;
        }
        let unit = normal / size;
        let height = |at: f64| unit.dot(chord.start + chord.direction * at - a);
        let [low, high] = chord.ends;
        let (below, above) = (height(low), height(high));
        let climb = unit.dot(chord.direction);
        let exact = |at: f64| {
            let (event, k) = ray.at(piece.from + at);
            (unit.dot(self.place(event) - a), unit.dot(self.direction(k)))
        };
        let through = |low: f64, high: f64, below: f64| {
            let at = root(low, high, below, exact);
            let (event, k) = ray.at(piece.from + at);
            let hidden = leaf.one_sided && self.direction(k).dot(normal) >= 0.0;
            (!hidden && is_within([a, b, c], normal, self.place(event))).then_some(at)
        };
        if (below <= 0.0) != (above <= 0.0) {
            // Where the chord goes through, the ray does so nearby: within the margin, and what of the way it takes
            // along the plane to make up for that.
            let guess = low + (high - low) * (below / (below - above));
            let middle = (a + b + c) / 3.0;
            let around = (a - middle).length().max((b - middle).length()).max((c - middle).length());
            let slope = (climb.abs() / chord.direction.length()).max(1e-6);
            let reach = around * (1.0 + RIM) + chord.margin * (1.0 + 2.0 / slope);
            let off = chord.start + chord.direction * guess - middle;
            if off.length_squared() > reach * reach {
                return None;
            }
            return through(low, high, below);
        }
        if below.abs().min(above.abs()) > chord.margin || chord.margin == 0.0 {
            return None;
        }
        let side = if below > 0.0 { 1.0 } else { -1.0 };
        if side * exact(low).1 >= 0.0 || side * exact(high).1 <= 0.0 {
            return None;
        }
        // The ray's nearest point to the plane, by halving what is between falling and rising.
        let (mut falls, mut rises) = (low, high);
        for _ in 0..50 {
            let middle = 0.5 * (falls + rises);
            let (at, slope) = exact(middle);
            if side * at <= 0.0 {
                // Both ways through are found.
                return through(low, middle, below).or_else(|| through(middle, high, at));
            }
            if side * slope < 0.0 { falls = middle } else { rises = middle }
        }
        None
    }
}

/// Where a height is 0 between two places on different sides: Newton's way, and halving where that leaves them.
fn root(low: f64, high: f64, below: f64, exact: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high) = (low, high);
    let rising = below <= 0.0;
    let mut at = 0.5 * (low + high);
    let mut last = f64::INFINITY;
    for _ in 0..60 {
        let (height, slope) = exact(at);
        if (height <= 0.0) == rising {
            low = at
        } else {
            high = at
        }
        let next = at - height / slope;
        let step = (next - at).abs();
        if step <= 4.0 * f64::EPSILON * at.abs() || height == 0.0 {
            return at;
        }
        // Rounding takes over where steps no longer become smaller.
        let good = next > low && next < high && step < 0.7 * last;
        if !good && step < 1e-12 * (high + low).abs() {
            return at;
        }
        (at, last) = if good { (next, step) } else { (0.5 * (low + high), high - low) };
    }
    at
}

/// Whether a point of a triangle's plane is in the triangle.
fn is_within([a, b, c]: [DVec3; 3], normal: DVec3, at: DVec3) -> bool {
    let [a, b, c] = [a, b, c].map(|corner| corner - at);
    let whole = normal.length_squared();
    [b.cross(c), c.cross(a), a.cross(b)].iter().all(|area| area.dot(normal) >= -RIM * whole)
}
