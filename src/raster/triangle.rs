use crate::light::owns_boundary;
use crate::relativity::{ApparentMap, RestSky};
use glam::{DVec2, DVec3};

/// A triangle as three planes through the observer: e = m·n for the pixel's direction n is positive inside
/// all three, and the three e are the barycentric coordinates of the point hit, to a factor.
///
/// a × b = −(b × a) in floating point too, so two triangles at an edge agree to the bit on which of them a
/// direction belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes {
    /// Plane normals opposite the first, second and third corner, turned inward.
    pub edges: [DVec3; 3],
    /// Σ m / det: its product with n is 1/t, the point hit being t·n.
    nearness: DVec3,
}

impl Planes {
    /// None for a triangle seen edge-on.
    pub fn new([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let edges = [b.cross(c), c.cross(a), a.cross(b)];
        let volume = a.dot(edges[0]);
        // Also false for NaN.
        if !(volume.abs() > 0.0 && volume.is_finite()) {
            return None;
        }
        let edges = if volume < 0.0 { edges.map(|m| -m) } else { edges };
        let nearness = (edges[0] + edges[1] + edges[2]) / volume.abs();
        nearness.is_finite().then_some(Self { edges, nearness })
    }
}

/// Where a line of sight meets the plane of the mesh's own triangle, exactly: what is cut and flat is only what
/// decides which triangle a pixel sees.
///
/// In the rest frame the plane is N′·x′ = h and the line of sight s·v′, so that 1/s = N′·v′/h, and s·v is where
/// it is seen. With v′ across the motion as v is, and along it as [`RestSky`] has it, 1/s is a linear function
/// of the pixel plus a constant times one number a pixel and body.
///
/// [`RestSky`]: crate::relativity::RestSky
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    /// Coefficients of v, observer's axes: N′ across the motion, over h.
    pub across: DVec3,
    /// Coefficient of v′·û: N′·û/h.
    pub along: f64,
    /// Bounds of 1/r: beside its outline, where an outline drawn a fraction of a pixel too wide still covers
    /// pixels, the plane of a face seen edge-on is anywhere.
    range: [f64; 2],
}

/// How far beyond the distances of the flat piece the exact surface may be, as a factor.
const BEYOND: f64 = 4.0;

impl Surface {
    /// The surface of a piece of a triangle: `rest`, the triangle's corners from the observer in the rest frame;
    /// `seen`, the piece's apparent corners; `flat`, the planes of those.
    #[inline]
    pub fn new(map: &ApparentMap, sky: &RestSky, rest: [DVec3; 3], seen: [DVec3; 3], flat: &Planes) -> Self {
        let [a, b, c] = rest;
        let normal = (b - a).cross(c - a);
        let inverse_h = 1.0 / normal.dot(a);
        let normal_observer = map.rotate(normal);
        let along = normal_observer.dot(sky.axis());
        // The farthest point of a flat piece is a corner; the nearest is not nearer than its plane, nor than the
        // nearest corner by more than a side.
        let squares = seen.map(|v| v.length_squared());
        let farthest = squares.into_iter().fold(0.0, f64::max).sqrt();
        let nearest = squares.into_iter().fold(f64::INFINITY, f64::min).sqrt();
        let side = |i: usize, j: usize| (seen[i] - seen[j]).abs().element_sum();
        let side = side(0, 1).max(side(1, 2)).max(side(2, 0));
        let nearest = (nearest - side).max(1.0 / flat.nearness.length());
        let range = [1.0 / (BEYOND * farthest), BEYOND / nearest];
        let across = (normal_observer - along * sky.axis()) * inverse_h;
        let along = along * inverse_h;
        if across.is_finite() && along.is_finite() {
            Self { across, along, range }
        } else {
            // Through the observer, to rounding: as flat as it is drawn.
            let along = flat.nearness.dot(sky.axis());
            Self { across: flat.nearness - along * sky.axis(), along, range }
        }
    }

    /// Least and greatest 1/r.
    #[cfg(feature = "gpu")]
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// 1/s where the line of sight s·v of length s·`length` meets it, within what is possible there.
    #[inline]
    pub fn clamped(&self, nearness: f64, length: f64) -> f64 {
        nearness.max(self.range[0] * length).min(self.range[1] * length)
    }

    /// 1/s for a line of sight and its boost.
    #[inline]
    pub fn nearness(&self, v: DVec3, length: f64, along: f64) -> f64 {
        self.clamped(self.across.dot(v) + self.along * along, length)
    }
}

/// A linear function of the picture's coordinates: A x + B y + C.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear {
    pub a: f64,
    pub b: f64,
    pub c: f64,
}

impl Linear {
    /// m·n as a function of the pixel for a pinhole, n = ((x − X)/F, (Y − y)/F, 1) with (X, Y) the middle.
    #[inline]
    pub fn of_pinhole(m: DVec3, middle: DVec2, inverse_focal: f64) -> Self {
        let (a, b) = (m.x * inverse_focal, -m.y * inverse_focal);
        Self { a, b, c: m.z - (a * middle.x + b * middle.y) }
    }

    /// B y + C.
    #[inline]
    pub fn row(&self, y: f64) -> f64 {
        self.b * y + self.c
    }
}

/// The half-plane on the inner side of an edge, on the picture of a pinhole.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPlane {
    edge: Linear,
    /// −1/A: where a row crosses the edge, roughly.
    crossing: f64,
    /// Whether the edge itself belongs to it.
    closed: bool,
}

impl HalfPlane {
    #[inline]
    pub fn new(m: DVec3, middle: DVec2, inverse_focal: f64) -> Self {
        let edge = Linear::of_pinhole(m, middle, inverse_focal);
        Self { edge, crossing: -1.0 / edge.a, closed: owns_boundary(m) }
    }

    #[inline]
    pub fn row(&self, y: f64) -> f64 {
        self.edge.row(y)
    }

    /// Whether the sample at `x` of the row is inside.
    #[inline]
    pub fn holds(&self, row: f64, x: f64) -> bool {
        let e = self.edge.a * x + row;
        e > 0.0 || (self.closed && e == 0.0)
    }

    /// The pixels of `[from, to)` inside, their samples `offset` to the right of their left sides. The edge
    /// function is monotonic along the row, so that they are a run; its end is guessed by the crossing and
    /// settled by the function itself.
    #[inline]
    pub fn clip(&self, row: f64, offset: f64, [from, to]: [u32; 2]) -> [u32; 2] {
        let inside = |x: u32| self.holds(row, f64::from(x) + offset);
        // NaN, for an edge along the row, becomes the least.
        let guess = (row * self.crossing - offset).max(f64::from(from)).min(f64::from(to)) as u32;
        if self.edge.a > 0.0 {
            let mut first = guess;
            while first > from && inside(first - 1) {
                first -= 1;
            }
            while first < to && !inside(first) {
                first += 1;
            }
            [first, to]
        } else if self.edge.a < 0.0 {
            let mut end = guess;
            while end < to && inside(end) {
                end += 1;
            }
            while end > from && !inside(end - 1) {
                end -= 1;
            }
            [from, end]
        } else if from < to && inside(from) {
            [from, to]
        } else {
            [from, from]
        }
    }
}
