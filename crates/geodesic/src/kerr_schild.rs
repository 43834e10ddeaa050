use crate::law::{join, relative_dot, split};
use crate::tensor::{Matrix, lowered};
use crate::{Law, Metric, Number, Stop, minkowski};

/// A rotating black hole (a resting one for spin 0) in Cartesian Kerr–Schild coordinates, its axis along z:
/// g = η + f l l with f = 2Mr³/(r⁴ + a²z²).
///
/// The chart is the *outgoing* one, l = (1, −(rx − ay)/(r² + a²), −(ry + ax)/(r² + a²), −z/r): light followed
/// backwards in time crosses the horizon of this chart smoothly, where in the ingoing one it would pile up on
/// it. Far away both are Minkowski coordinates. It describes what is outside of the horizon.
///
/// As a [`Law`] it is written out by hand; `ByMetric(KerrSchild)` is the same through dual numbers.
///
/// Source: R. P. Kerr, A. Schild (1965); M. Visser, arXiv:0706.0622, Eqs. 32–34.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KerrSchild {
    mass: f64,
    spin: f64,
}

/// Why there is no such black hole.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum KerrError {
    /// The mass is zero, negative, NaN or infinite.
    #[error("the mass {0} is not a positive number")]
    Mass(f64),
    /// |a| > M, or NaN: there would be no horizon.
    #[error(
        "the spin a = {spin} is not within ±{mass}, the mass: with more there is no horizon but a naked singularity"
    )]
    Spin {
        /// The mass M.
        mass: f64,
        /// The spin a asked for.
        spin: f64,
    },
}

impl KerrSchild {
    /// A black hole of mass M and spin a = J/M, both lengths; a > 0 turns from x to y.
    ///
    /// # Errors
    /// If M is not positive, or |a| > M.
    pub fn new(mass: f64, spin: f64) -> Result<Self, KerrError> {
        if !(mass > 0.0 && mass.is_finite()) {
            return Err(KerrError::Mass(mass));
        }
        if spin.is_nan() || spin.abs() > mass {
            return Err(KerrError::Spin { mass, spin });
        }
        Ok(Self { mass, spin })
    }

    /// A black hole that does not rotate.
    ///
    /// # Errors
    /// If the mass is not positive.
    pub fn schwarzschild(mass: f64) -> Result<Self, KerrError> {
        Self::new(mass, 0.0)
    }

    /// The mass M.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// The spin a.
    pub fn spin(&self) -> f64 {
        self.spin
    }

    /// The radius r₊ = M + √(M² − a²) of the horizon.
    pub fn horizon(&self) -> f64 {
        self.mass + ((self.mass - self.spin) * (self.mass + self.spin)).sqrt()
    }

    /// dr/dr* = Δ/(r² + a²) at a Boyer–Lindquist radius: how fast r of light that goes straight in or out (along a principal
    /// null direction) changes with the time far away. 1 far away, 0 at the horizon.
    pub fn tortoise_slope(&self, r: f64) -> f64 {
        let inner = self.spin * self.spin / self.horizon();
        (r - self.horizon()) * (r - inner) / (r * r + self.spin * self.spin)
    }

    /// The Boyer–Lindquist radius r of a place: r⁴ − (x² + y² + z² − a²) r² − a²z² = 0.
    #[inline(always)]
    pub fn radius<S: Number>(&self, [x, y, z]: [S; 3]) -> S {
        let a2 = self.spin * self.spin;
        let u = x * x + y * y + z * z - a2;
        ((u + (u * u + z * z * (4.0 * a2)).sqrt()) * 0.5).sqrt()
    }
}

impl Metric for KerrSchild {
    #[inline(always)]
    fn covariant<S: Number>(&self, [_, x, y, z]: [S; 4]) -> [[S; 4]; 4] {
        let a = self.spin;
        let r = self.radius([x, y, z]);
        let r2 = r * r;
        let f = r2 * r * (2.0 * self.mass) / (r2 * r2 + z * z * (a * a));
        let across = S::from(1.0) / (r2 + a * a);
        let l = [S::from(1.0), (y * a - x * r) * across, -(y * r + x * a) * across, -z / r];
        let mut g = minkowski::<S>();
        for i in 0..4 {
            let part = f * l[i];
            for j in i..4 {
                g[i][j] = g[i][j] + part * l[j];
                g[j][i] = g[i][j];
            }
        }
        g
    }

    #[inline]
    fn stop(&self, [_, x, y, z]: [f64; 4]) -> Option<Stop> {
        // A millionth outside, so that rays that only creep towards the horizon of a = M end as well.
        (self.radius([x, y, z]) <= self.horizon() * (1.0 + 1e-6)).then_some(Stop::Horizon)
    }

    fn scale(&self) -> f64 {
        self.mass
    }
}

impl Law for KerrSchild {
    fn state(&self, x: [f64; 4], k: [f64; 4]) -> [f64; 8] {
        join(x, lowered(&Metric::covariant(self, x), &k))
    }

    /// From H = ½(p·p − f S²), S = l·p in flat products: ẋ = p − f S l and ṗ = ½S²∂f + f S ∂S.
    #[inline(always)]
    fn derivative(&self, state: &[f64; 8]) -> [f64; 8] {
        let [_, x, y, z, pt, px, py, pz] = *state;
        let a = self.spin;
        let a2 = a * a;
        let u = x * x + y * y + z * z - a2;
        let d2 = u * u + 4.0 * a2 * z * z;
        let d = d2.sqrt();
        let r2 = 0.5 * (u + d);
        let r = r2.sqrt();
        let e = r2 + a2;
        // One division for 1/d, 1/r and 1/(r² + a²).
        let all = 1.0 / (d * r * e);
        let over_d = r * e * all;
        let over_r = d * e * all;
        let over_e = d * r * all;
        let dr = [x * r * over_d, y * r * over_d, z * e * over_r * over_d];
        let f = 2.0 * self.mass * r * over_d;
        let mx = (r * x - a * y) * over_e;
        let my = (r * y + a * x) * over_e;
        let mz = z * over_r;
        let across = mx * px + my * py;
        let s = -(pt + across + mz * pz);
        // ∂(m·p): by x, y, z directly, and through r.
        let by_r = (x * px + y * py - 2.0 * r * across) * over_e - mz * pz * over_r;
        let dp = [
            (r * px + a * py) * over_e + by_r * dr[0],
            (r * py - a * px) * over_e + by_r * dr[1],
            pz * over_r + by_r * dr[2],
        ];
        let dd = [2.0 * u * x * over_d, 2.0 * u * y * over_d, (2.0 * u + 4.0 * a2) * z * over_d];
        let fs = f * s;
        let half = 0.5 * s * s;
        let force = |i: usize| half * (2.0 * self.mass * dr[i] - f * dd[i]) * over_d - fs * dp[i];
        [-pt + fs, px + fs * mx, py + fs * my, pz + fs * mz, 0.0, force(0), force(1), force(2)]
    }

    fn wave_vector(&self, state: &[f64; 8]) -> [f64; 4] {
        split(&Law::derivative(self, state)).0
    }

    fn covariant(&self, x: [f64; 4]) -> Matrix {
        Metric::covariant(self, x)
    }

    fn stop(&self, x: [f64; 4]) -> Option<Stop> {
        Metric::stop(self, x)
    }

    fn escape_radius(&self) -> f64 {
        Metric::escape_radius(self)
    }

    fn scale(&self) -> f64 {
        self.mass
    }

    fn off_cone(&self, state: &[f64; 8], derivative: &[f64; 8]) -> Option<f64> {
        Some(relative_dot(&split(state).1, &split(derivative).0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ByMetric;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_law_by_hand_is_the_law_by_the_metric(
            spin in -1.0..1.0f64,
            position in prop::array::uniform3(-20.0..20.0f64),
            p in prop::array::uniform4(-1.0..1.0f64),
        ) {
            let hole = KerrSchild::new(1.0, spin).unwrap();
            prop_assume!(hole.radius(position) > hole.horizon());
            let [x, y, z] = position;
            let state = join([7.0, x, y, z], p);
            let by_hand = Law::derivative(&hole, &state);
            let by_metric = ByMetric(hole).derivative(&state);
            for i in 0..8 {
                // Near the horizon terms up to about 10 cancel.
                prop_assert!((by_hand[i] - by_metric[i]).abs() < 1e-13, "{by_hand:?} {by_metric:?}");
            }
            let k = split(&by_hand).0;
            let back = Law::state(&hole, [7.0, x, y, z], k);
            for i in 0..8 {
                prop_assert!((back[i] - state[i]).abs() < 1e-13, "{back:?} {state:?}");
            }
        }
    }

    /// Δ/(r² + a²), by the definition of Δ, and also where that cancels.
    #[test]
    fn light_slows_down_towards_the_horizon() {
        for spin in [0.0, 0.5, -0.9, 0.999, 1.0] {
            let hole = KerrSchild::new(1.0, spin).unwrap();
            for r in [1.001, 1.1, 2.0, 5.0, 1e6].map(|part| part * hole.horizon()) {
                let expected = (r * r - 2.0 * r + spin * spin) / (r * r + spin * spin);
                assert!((hole.tortoise_slope(r) - expected).abs() < 1e-15, "{spin} {r}");
            }
            assert_eq!(hole.tortoise_slope(hole.horizon()), 0.0);
        }
    }

    #[test]
    fn what_is_no_black_hole_is_refused() {
        assert_eq!(KerrSchild::new(1.0, 1.1), Err(KerrError::Spin { mass: 1.0, spin: 1.1 }));
        assert_eq!(KerrSchild::new(0.0, 0.0), Err(KerrError::Mass(0.0)));
        for (mass, spin) in
            [(-1.0, 0.0), (f64::NAN, 0.0), (1.0, f64::NAN), (f64::INFINITY, 0.0), (1.0, -1.0001)]
        {
            assert!(KerrSchild::new(mass, spin).is_err(), "{mass} {spin}");
        }
        assert_eq!(KerrSchild::new(2.0, -2.0).unwrap().horizon(), 2.0);
    }
}
