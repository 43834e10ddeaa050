use glam::DVec3;

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
    pub nearness: DVec3,
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

/// Whether a direction *on* a plane belongs to this side: of the two triangles at an edge, one.
#[inline]
pub(super) fn owns_boundary(m: DVec3) -> bool {
    if m.x != 0.0 {
        m.x > 0.0
    } else if m.y != 0.0 {
        m.y > 0.0
    } else {
        m.z > 0.0
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
    /// m·n as a function of the pixel for a pinhole, n = ((x − w/2)/F, (h/2 − y)/F, 1).
    #[inline]
    pub fn of_pinhole(m: DVec3, width: f64, height: f64, focal: f64) -> Self {
        let (a, b) = (m.x / focal, -m.y / focal);
        Self { a, b, c: m.z - 0.5 * (a * width + b * height) }
    }

    /// B y + C.
    #[inline]
    pub fn row(&self, y: f64) -> f64 {
        self.b * y + self.c
    }
}
