use crate::tensor::{Matrix, dot, inverse, is_lorentzian, lowered, product};
use crate::{Dual, End, Metric, Minkowski, Stop};

/// A law of motion for light: eight first-order equations, as the integrator wants them.
///
/// [`ByMetric`] makes one of any metric, [`BySecondDerivative`] of any second derivative; write one by hand only
/// where speed asks for it, as [`KerrSchild`](crate::KerrSchild) does.
pub trait Law: Sync {
    /// The state at an event with a wave vector: the event first, then four numbers that carry the wave vector.
    fn state(&self, x: [f64; 4], k: [f64; 4]) -> [f64; 8];

    /// The derivative of the state by the affine parameter; NaN where there is none.
    fn derivative(&self, state: &[f64; 8]) -> [f64; 8];

    /// The wave vector (upper index) of a state.
    fn wave_vector(&self, state: &[f64; 8]) -> [f64; 4];

    /// The metric at an event.
    fn covariant(&self, x: [f64; 4]) -> [[f64; 4]; 4];

    /// As [`Metric::stop`].
    fn stop(&self, x: [f64; 4]) -> Option<Stop>;

    /// As [`Metric::escape_radius`].
    fn escape_radius(&self) -> f64;

    /// As [`Metric::scale`].
    fn scale(&self) -> f64;

    /// g(k, k) as a fraction of the terms it is the sum of; `None` where the metric is not known.
    fn off_cone(&self, state: &[f64; 8], derivative: &[f64; 8]) -> Option<f64>;

    /// What is wrong at an event, if anything is.
    fn fault(&self, x: [f64; 4]) -> Option<End> {
        let g = self.covariant(x);
        if !x.iter().chain(g.iter().flatten()).all(|c| c.is_finite()) {
            return Some(End::NotANumber);
        }
        (!is_lorentzian(&g)).then_some(End::SingularMetric)
    }
}

#[inline(always)]
pub(crate) fn split(state: &[f64; 8]) -> ([f64; 4], [f64; 4]) {
    let [t, x, y, z, a, b, c, d] = *state;
    ([t, x, y, z], [a, b, c, d])
}

#[inline(always)]
pub(crate) fn join([t, x, y, z]: [f64; 4], [a, b, c, d]: [f64; 4]) -> [f64; 8] {
    [t, x, y, z, a, b, c, d]
}

/// Σ a_μ b^μ as a fraction of the sum of its terms' absolute values.
#[inline(always)]
pub(crate) fn relative_dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let terms: f64 = (0..4).map(|i| (a[i] * b[i]).abs()).sum();
    if terms == 0.0 { 0.0 } else { dot(a, b) / terms }
}

/// Light in a metric known as g alone, by Hamilton's equations: with p covariant,
/// ẋ^μ = g^μν p_ν and ṗ_μ = ½ ∂_μ g_αβ ẋ^α ẋ^β.
///
/// Dual numbers differentiate g; no Christoffel symbol is ever formed.
#[derive(Clone, Copy, Debug)]
pub struct ByMetric<M>(pub M);

impl<M: Metric> Law for ByMetric<M> {
    fn state(&self, x: [f64; 4], k: [f64; 4]) -> [f64; 8] {
        join(x, lowered(&self.covariant(x), &k))
    }

    #[inline(always)]
    fn derivative(&self, state: &[f64; 8]) -> [f64; 8] {
        let (x, p) = split(state);
        let g = self.0.covariant(Dual::coordinates(x));
        // Written out, because `map` of arrays this large is not inlined.
        let mut values = [[0.0; 4]; 4];
        for a in 0..4 {
            for b in a..4 {
                values[a][b] = g[a][b].value;
            }
        }
        let (inverse, determinant) = inverse(&values);
        let v = lowered(&inverse, &p);
        let mut force = [0.0; 4];
        for a in 0..4 {
            for b in a..4 {
                let weight = if a == b { 0.5 * v[a] * v[a] } else { v[a] * v[b] };
                for (part, slope) in force.iter_mut().zip(g[a][b].gradient) {
                    *part += weight * slope;
                }
            }
        }
        // No metric of one time and three spaces has a determinant that is not negative.
        if determinant < 0.0 { join(v, force) } else { [f64::NAN; 8] }
    }

    fn wave_vector(&self, state: &[f64; 8]) -> [f64; 4] {
        let (x, p) = split(state);
        lowered(&inverse(&self.covariant(x)).0, &p)
    }

    fn covariant(&self, x: [f64; 4]) -> Matrix {
        self.0.covariant(x)
    }

    fn stop(&self, x: [f64; 4]) -> Option<Stop> {
        self.0.stop(x)
    }

    fn escape_radius(&self) -> f64 {
        self.0.escape_radius()
    }

    fn scale(&self) -> f64 {
        self.0.scale()
    }

    fn off_cone(&self, state: &[f64; 8], derivative: &[f64; 8]) -> Option<f64> {
        Some(relative_dot(&split(state).1, &split(derivative).0))
    }
}

/// Light by its second derivative alone, ẍ(x, ẋ) (Nollert et al. 2000, Eq. 6 and Fig. 7).
///
/// The function is given the event (t, x, y, z) and the wave vector, both as upper components, and returns the
/// change of the wave vector by the affine parameter, −Γ^μ_αβ ẋ^α ẋ^β in a metric. Where observers are set up
/// spacetime is taken as flat, and nothing tells where rays stop, until a metric is given too.
#[derive(Clone, Copy, Debug)]
pub struct BySecondDerivative<F, M = Minkowski> {
    acceleration: F,
    metric: M,
    metric_known: bool,
}

impl<F: Fn([f64; 4], [f64; 4]) -> [f64; 4] + Sync> BySecondDerivative<F> {
    /// From the function alone.
    pub fn new(acceleration: F) -> Self {
        Self { acceleration, metric: Minkowski, metric_known: false }
    }
}

impl<F, M> BySecondDerivative<F, M> {
    /// With a metric for products, for the watch on the light cone, and for where rays stop.
    pub fn with_metric<N: Metric>(self, metric: N) -> BySecondDerivative<F, N> {
        BySecondDerivative { acceleration: self.acceleration, metric, metric_known: true }
    }
}

impl<F: Fn([f64; 4], [f64; 4]) -> [f64; 4] + Sync, M: Metric> Law for BySecondDerivative<F, M> {
    fn state(&self, x: [f64; 4], k: [f64; 4]) -> [f64; 8] {
        join(x, k)
    }

    #[inline(always)]
    fn derivative(&self, state: &[f64; 8]) -> [f64; 8] {
        let (x, k) = split(state);
        join(k, (self.acceleration)(x, k))
    }

    fn wave_vector(&self, state: &[f64; 8]) -> [f64; 4] {
        split(state).1
    }

    fn covariant(&self, x: [f64; 4]) -> Matrix {
        self.metric.covariant(x)
    }

    fn stop(&self, x: [f64; 4]) -> Option<Stop> {
        self.metric.stop(x)
    }

    fn escape_radius(&self) -> f64 {
        self.metric.escape_radius()
    }

    fn scale(&self) -> f64 {
        self.metric.scale()
    }

    fn off_cone(&self, state: &[f64; 8], _: &[f64; 8]) -> Option<f64> {
        let (x, k) = split(state);
        self.metric_known.then(|| {
            let g = self.metric.covariant(x);
            relative_dot(&lowered(&g, &k), &k)
        })
    }
}

/// g(a, b) at an event.
pub(crate) fn product_at(law: &impl Law, x: [f64; 4], a: [f64; 4], b: [f64; 4]) -> f64 {
    product(&law.covariant(x), &a, &b)
}
