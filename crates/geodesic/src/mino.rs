//! Light near a rotating black hole in Mino time λ (ds = r² + a² cos²θ dλ), backwards, for E = 1, with the
//! constants of motion put in: w = 1/r and the unit vector N towards (θ, φ) move on their own,
//!
//! w″ = ½ W′(w) with W = 1 + (a² − L² − Q)w² + 2M(Q + (L − a)²)w³ − a²Q w⁴,
//! N″ = −(L² + Q + 2a² N_z²)N + a² N_z ẑ,
//!
//! and the azimuth of the outgoing Kerr–Schild chart runs ahead of N's by τ,
//! τ′ = −a(2Mw − aLw² − w′)/(1 − 2Mw + a²w²).
//!
//! No pole, no square root with a sign to choose, and infinity is the ordinary place w = 0. In all of it L and Q
//! are those of the light, which runs the other way.
//!
//! Sources: B. Carter, Phys. Rev. 174 (1968) 1559; Y. Mino, Phys. Rev. D 67 (2003) 084027; differentiated here.

use crate::runge_kutta::Slope;
use crate::{KerrSchild, Metric};

/// Constants of motion of light with energy 1, in units of M and M².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Constants {
    /// The component L of the angular momentum along the axis.
    pub angular_momentum: f64,
    /// Carter's constant Q.
    pub carter: f64,
}

/// w, w′, N, N′, τ.
pub(crate) const SIZE: usize = 9;

impl Constants {
    /// W(w), the square of w′.
    pub(crate) fn radial(&self, hole: &KerrSchild, w: f64) -> f64 {
        let [w2, w3, w4] = self.polynomial(hole);
        1.0 + w * w * (w2 + w * (w3 + w * w4))
    }

    /// Whether what is at w and moves inwards certainly comes out of the horizon, because W has no zero before:
    /// its coefficients in the Bernstein basis between here and there, of which it is a mean, are all positive.
    pub(crate) fn captured(&self, hole: &KerrSchild, w: f64, w_slope: f64) -> bool {
        let width = 1.0 / hole.horizon() - w;
        if w_slope <= 0.0 || width <= 1e-6 * w {
            return w_slope > 0.0;
        }
        let [w2, w3, w4] = self.polynomial(hole);
        // W(w + x width) = Σ dⱼ xʲ.
        let d0 = self.radial(hole, w);
        let d1 = w * (2.0 * w2 + w * (3.0 * w3 + w * 4.0 * w4)) * width;
        let d2 = (w2 + w * (3.0 * w3 + w * 6.0 * w4)) * width * width;
        let d3 = (w3 + 4.0 * w * w4) * width.powi(3);
        let d4 = w4 * width.powi(4);
        d0 > 0.0
            && d0 + d1 / 4.0 > 0.0
            && d0 + d1 / 2.0 + d2 / 6.0 > 0.0
            && d0 + 0.75 * d1 + d2 / 2.0 + d3 / 4.0 > 0.0
            && d0 + d1 + d2 + d3 + d4 > 0.0
    }

    /// The coefficients of w², w³ and w⁴ in W.
    pub(crate) fn polynomial(&self, hole: &KerrSchild) -> [f64; 3] {
        let (l, q, a) = (self.angular_momentum, self.carter, hole.spin());
        [a * a - l * l - q, 2.0 * hole.mass() * (q + (l - a) * (l - a)), -a * a * q]
    }
}

/// The derivative of `LANES` states that lie interleaved: component `i` of lane `j` at `i·LANES + j`.
#[derive(Clone, Copy)]
pub(crate) struct Pack<const LANES: usize> {
    pub mass: f64,
    pub spin: f64,
    pub angular_momentum: [f64; LANES],
    /// L² + Q.
    pub total: [f64; LANES],
    /// Coefficients of w², w³ and w⁴ in W.
    pub polynomial: [[f64; LANES]; 3],
}

impl<const LANES: usize> Pack<LANES> {
    pub(crate) fn new(hole: &KerrSchild, constants: [Constants; LANES]) -> Self {
        let polynomials = constants.map(|c| c.polynomial(hole));
        Self {
            mass: hole.mass(),
            spin: hole.spin(),
            angular_momentum: constants.map(|c| c.angular_momentum),
            total: constants.map(|c| c.angular_momentum * c.angular_momentum + c.carter),
            polynomial: [0, 1, 2].map(|k| polynomials.map(|p| p[k])),
        }
    }

    #[inline(always)]
    pub(crate) fn derivative<const N: usize>(&self, y: &[f64; N]) -> [f64; N] {
        let a = self.spin;
        let a2 = a * a;
        let mut out = [0.0; N];
        for j in 0..LANES {
            let at = |i: usize| y[i * LANES + j];
            let (w, w_slope) = (at(0), at(1));
            let (nx, ny, nz) = (at(2), at(3), at(4));
            let [w2, w3, w4] = self.polynomial.map(|c| c[j]);
            let pull = self.total[j] + 2.0 * a2 * nz * nz;
            out[j] = w_slope;
            out[LANES + j] = w * (w2 + w * (1.5 * w3 + 2.0 * w * w4));
            out[2 * LANES + j] = at(5);
            out[3 * LANES + j] = at(6);
            out[4 * LANES + j] = at(7);
            out[5 * LANES + j] = -pull * nx;
            out[6 * LANES + j] = -pull * ny;
            out[7 * LANES + j] = (a2 - pull) * nz;
            let delta = 1.0 + w * (a2 * w - 2.0 * self.mass);
            out[8 * LANES + j] =
                -a * (w * (2.0 * self.mass - a * self.angular_momentum[j] * w) - w_slope) / delta;
        }
        out
    }
}

impl<const LANES: usize, const N: usize> Slope<N> for Pack<LANES> {
    #[inline(always)]
    fn slope(&self, y: &[f64; N]) -> [f64; N] {
        self.derivative(y)
    }
}

/// The constants and the state of a ray at a place with a wave vector of the outgoing Kerr–Schild chart that
/// points back along the light, and the energy |E| by which the wave vector is to be divided.
///
/// `None` for a wave vector without energy.
pub(crate) fn state(hole: &KerrSchild, x: [f64; 4], k: [f64; 4]) -> Option<(Constants, [f64; SIZE], f64)> {
    let a = hole.spin();
    let lowered = crate::tensor::lowered(&Metric::covariant(hole, x), &k);
    let energy = lowered[0];
    if energy.is_nan() || energy <= 0.0 {
        return None;
    }
    let [_, x, y, z] = x;
    let r = hole.radius([x, y, z]);
    // As in the law of motion: the gradient of r.
    let d = 2.0 * r * r - (x * x + y * y + z * z - a * a);
    let slope = [x * r / d, y * r / d, z * (r * r + a * a) / (r * d)];
    // d is also r² + a² cos² θ.
    let rate = d / energy;
    let moved = [k[1] * rate, k[2] * rate, k[3] * rate];
    let r_rate = slope[0] * moved[0] + slope[1] * moved[1] + slope[2] * moved[2];
    let angular_momentum = -(x * lowered[2] - y * lowered[1]) / energy;
    let e = r * r + a * a;
    // (x + iy)/(r − ia), of size sin θ.
    let over = |re: f64, im: f64| [(re * r - im * a) / e, (im * r + re * a) / e];
    let [nx, ny] = over(x, y);
    let [mut nx_rate, mut ny_rate] = over(moved[0] - nx * r_rate, moved[1] - ny * r_rate);
    let nz = z / r;
    let nz_rate = (moved[2] - nz * r_rate) / r;
    let delta = r * (r - 2.0 * hole.mass()) + a * a;
    let twist = -a * (2.0 * hole.mass() * r - a * angular_momentum + r_rate) / delta;
    nx_rate += twist * ny;
    ny_rate -= twist * nx;
    let turning = nx_rate * nx_rate + ny_rate * ny_rate + nz_rate * nz_rate;
    let carter = turning - angular_momentum * angular_momentum - a * a * nz * nz;
    let state = [1.0 / r, -r_rate / (r * r), nx, ny, nz, nx_rate, ny_rate, nz_rate, 0.0];
    Some((Constants { angular_momentum, carter }, state, energy))
}

/// The place and the wave vector (for energy 1) of a state, in the outgoing Kerr–Schild chart at time 0.
pub(crate) fn place(hole: &KerrSchild, constants: Constants, state: &[f64; SIZE]) -> ([f64; 4], [f64; 4]) {
    let (a, mass) = (hole.spin(), hole.mass());
    let [w, w_rate, nx, ny, nz, nx_rate, ny_rate, nz_rate, twist] = *state;
    let r = 1.0 / w;
    let r_rate = -w_rate * r * r;
    let delta = r * (r - 2.0 * mass) + a * a;
    let twist_rate = -a * (2.0 * mass * r - a * constants.angular_momentum + r_rate) / delta;
    let (sine, cosine) = twist.sin_cos();
    let turned = |re: f64, im: f64| [re * cosine - im * sine, re * sine + im * cosine];
    let [zx, zy] = turned(nx, ny);
    let [zx_rate, zy_rate] = turned(nx_rate - twist_rate * ny, ny_rate + twist_rate * nx);
    // (r − ia)(z_x + i z_y) and its rate.
    let x = [0.0, r * zx + a * zy, r * zy - a * zx, r * nz];
    let rates = [
        r_rate * zx + r * zx_rate + a * zy_rate,
        r_rate * zy + r * zy_rate - a * zx_rate,
        r_rate * nz + r * nz_rate,
    ];
    let sigma = r * r + a * a * nz * nz;
    let k = rates.map(|rate| rate / sigma);
    // From k_t = 1 and k·k = 0, by whichever does not divide by what may vanish here.
    let f = 2.0 * mass * r / sigma;
    let across = -(zx * k[0] + zy * k[1] + nz * k[2]);
    let along = if (1.0 + across).abs() > (1.0 - f).abs() {
        (1.0 - (k[0] * k[0] + k[1] * k[1] + k[2] * k[2])) / (1.0 + across)
    } else {
        f * (across - 1.0) / (1.0 - f)
    };
    (x, [along - 1.0, k[0], k[1], k[2]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::product;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn place_and_wave_vector_come_back(
            spin in -1.0..1.0f64, x in -9.0..9.0f64, y in -9.0..9.0f64, z in -9.0..9.0f64,
            n in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let hole = KerrSchild::new(1.0, spin).unwrap();
            let at = [0.0, x, y, z];
            prop_assume!(hole.radius([x, y, z]) > 2.5 && n.iter().any(|c| c.abs() > 0.1));
            // Null and to the past: −kt² + |k|² + f (l·k)² = 0 solved for kt.
            let g = Metric::covariant(&hole, at);
            let [a, b, c] = [0, 1, 2].map(|term| {
                let k = [0.0, n[0], n[1], n[2]];
                let t = [1.0, 0.0, 0.0, 0.0];
                match term { 0 => product(&g, &t, &t), 1 => product(&g, &t, &k), _ => product(&g, &k, &k) }
            });
            let kt = (-b + (b * b - a * c).sqrt()) / a;
            let k = [kt, n[0], n[1], n[2]];
            prop_assert!(product(&g, &k, &k).abs() < 1e-12);
            let (constants, state, energy) = state(&hole, at, k).unwrap();
            prop_assert!((constants.radial(&hole, state[0]) - state[1] * state[1]).abs() < 1e-11,
                "{constants:?} {state:?}");
            let (there, back) = place(&hole, constants, &state);
            for i in 1..4 {
                prop_assert!((there[i] - at[i]).abs() < 1e-12);
            }
            for i in 0..4 {
                prop_assert!((back[i] * energy - k[i]).abs() < 1e-10, "{back:?} {energy} {k:?}");
            }
        }
    }
}
