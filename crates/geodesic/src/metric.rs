use crate::Number;

/// A spacetime given by its metric alone, in coordinates (t, x, y, z) that are Cartesian far away.
///
/// Only [`covariant`](Self::covariant) has to be written, once, over any [`Number`]; dual numbers give the rest
/// (see [`ByMetric`](crate::ByMetric)). It may depend on time. The other methods say where rays stop.
pub trait Metric: Sync {
    /// The components g_μν at (t, x, y, z), signature −+++. It is symmetric: only μ ≤ ν is read.
    fn covariant<S: Number>(&self, x: [S; 4]) -> [[S; 4]; 4];

    /// Whether a ray that has come here stops, and why: at a horizon (test r a little *outside* of where the
    /// coordinates fail), or at the edge of what the metric describes. By default nowhere.
    fn stop(&self, x: [f64; 4]) -> Option<Stop> {
        let _ = x;
        None
    }

    /// The distance from the origin within which a ray never counts as one that came from the sky, however
    /// straight it is; infinite if spacetime is not flat far away. By default 100 of [`scale`](Self::scale).
    ///
    /// Beyond it a ray ends once what is left of its deflection is below the tolerance.
    fn escape_radius(&self) -> f64 {
        100.0 * self.scale()
    }

    /// The length on which the metric changes where it changes most, such as a mass: errors of position are
    /// measured against it and the distance from the origin. By default 1.
    fn scale(&self) -> f64 {
        1.0
    }
}

/// Why a ray stops where nothing fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Here is a horizon.
    Horizon,
    /// Here ends what the spacetime describes.
    Edge,
}

/// Flat spacetime in Cartesian coordinates, diag(−1, 1, 1, 1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Minkowski;

impl Metric for Minkowski {
    #[inline(always)]
    fn covariant<S: Number>(&self, _: [S; 4]) -> [[S; 4]; 4] {
        minkowski()
    }
}

/// diag(−1, 1, 1, 1), to which metrics far away tend.
#[inline(always)]
pub fn minkowski<S: Number>() -> [[S; 4]; 4] {
    let (zero, one) = (S::from(0.0), S::from(1.0));
    let mut g = [[zero; 4]; 4];
    g[0][0] = -one;
    g[1][1] = one;
    g[2][2] = one;
    g[3][3] = one;
    g
}

impl<M: Metric> Metric for &M {
    #[inline(always)]
    fn covariant<S: Number>(&self, x: [S; 4]) -> [[S; 4]; 4] {
        M::covariant(self, x)
    }

    fn stop(&self, x: [f64; 4]) -> Option<Stop> {
        M::stop(self, x)
    }

    fn escape_radius(&self) -> f64 {
        M::escape_radius(self)
    }

    fn scale(&self) -> f64 {
        M::scale(self)
    }
}
