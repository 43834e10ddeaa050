//! A body in motion through light that is the same from everywhere.

use crate::spectrum::cubic;
use std::f64::consts::{PI, TAU};

/// Light that is isotropic in one frame, as a surface of a body meets it that moves in that frame.
///
/// From a direction at the angle θ to the motion (in the body's rest frame) it comes with the Doppler factor
/// D = 1/(γ − γβ cos θ): radiance in frequency goes with D³. What reaches a surface depends on the angle ψ between its
/// normal and the motion alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bath {
    rapidity: f64,
}

/// Shares of the light from rings around the motion, whose ln D are evenly spaced.
pub(super) struct Ring {
    pub doppler: f64,
    /// Of Simpson's rule, times dμ/d ln D.
    weight: f64,
    /// cos θ.
    cosine: f64,
}

impl Bath {
    pub fn new(rapidity: f64) -> Self {
        Self { rapidity }
    }

    /// Of the body in the light's frame.
    pub fn rapidity(&self) -> f64 {
        self.rapidity
    }

    /// Whether the body is at rest in it.
    pub fn is_still(&self) -> bool {
        self.rapidity < 1e-9
    }

    /// Rings, an even number and one more.
    pub fn rings(&self, count: usize) -> Vec<Ring> {
        let w = self.rapidity;
        let (gamma, speed) = (w.cosh(), w.sinh());
        let step = 2.0 * w / count as f64;
        (0..=count)
            .map(|i| {
                let ln_doppler = -w + i as f64 * step;
                let simpson = match i {
                    0 => 1.0,
                    i if i == count => 1.0,
                    i if i % 2 == 1 => 4.0,
                    _ => 2.0,
                };
                let doppler = ln_doppler.exp();
                Ring {
                    doppler,
                    weight: simpson * step / 3.0 / (speed * doppler),
                    cosine: ((gamma - 1.0 / doppler) / speed).clamp(-1.0, 1.0),
                }
            })
            .collect()
    }
}

impl Ring {
    /// ∫ cos ι dΩ over the part of the ring above a surface whose normal is at ψ to the motion.
    pub fn share(&self, cos_psi: f64) -> f64 {
        let (along, across) = (
            self.cosine * cos_psi,
            ((1.0 - self.cosine * self.cosine) * (1.0 - cos_psi * cos_psi)).max(0.0).sqrt(),
        );
        let around = if along >= across {
            TAU * along
        } else if along <= -across {
            0.0
        } else {
            let above = (-along / across).acos();
            2.0 * (along * above + across * above.sin())
        };
        self.weight * around
    }
}

/// ∫ Dⁿ cos ι dΩ by cos ψ, for n = 3 (frequency by frequency) and 4 (over all): evenly spaced from −1 to 1.
#[derive(Clone, Debug)]
pub(super) struct Irradiance(Vec<[f64; 2]>);

/// Steps of cos ψ.
const STEPS: usize = 128;

impl Irradiance {
    pub fn new(bath: &Bath) -> Self {
        if bath.is_still() {
            return Self(vec![[PI; 2]; STEPS + 1]);
        }
        let rings = bath.rings(1024);
        let at = |i: usize| {
            let cos_psi = 2.0 * i as f64 / STEPS as f64 - 1.0;
            rings.iter().fold([0.0; 2], |[three, four], ring| {
                let d3 = ring.doppler.powi(3) * ring.share(cos_psi);
                [three + d3, four + ring.doppler * d3]
            })
        };
        Self((0..=STEPS).map(at).collect())
    }

    /// By a cubic through the four nearest.
    pub fn at(&self, cos_psi: f64) -> [f64; 2] {
        let place = (0.5 * (cos_psi + 1.0) * STEPS as f64).max(0.0).min(STEPS as f64);
        let low = (place as usize).clamp(1, STEPS - 2);
        let weights = cubic(place - low as f64);
        let value = |k: usize| (0..4).map(|j| weights[j] * self.0[low - 1 + j][k]).sum::<f64>();
        // Across the edge of what is lit a cubic swings.
        [0, 1].map(|k| value(k).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over all directions, against ∫ D⁴ dΩ = 4π γ²(1 + β²/3), the energy density of isotropic radiation as a body in
    /// motion meets it; and on a surface ahead against a sum over directions.
    #[test]
    fn a_bath_is_stronger_ahead() {
        for rapidity in [0.2f64, 1.0, 3.0] {
            let bath = Bath::new(rapidity);
            let (gamma, beta) = (rapidity.cosh(), rapidity.tanh());
            let rings = bath.rings(512);
            let whole: f64 = rings.iter().map(|r| TAU * r.weight * r.doppler.powi(4)).sum();
            let expected = 4.0 * PI * gamma * gamma * (1.0 + beta * beta / 3.0);
            assert!((whole / expected - 1.0).abs() < 1e-7, "{rapidity}: {whole} {expected}");
            let irradiance = Irradiance::new(&bath);
            for cos_psi in [-1.0, -0.4, 0.0, 0.53, 1.0f64] {
                let sin_psi = (1.0 - cos_psi * cos_psi).sqrt();
                let mut sum = [0.0; 2];
                let n = 1000;
                for i in 0..n {
                    // Evenly over the sky of the light's own frame, and aberrated.
                    let own: f64 = 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
                    let mu = (own + beta) / (1.0 + beta * own);
                    let d = gamma * (1.0 + beta * own);
                    for j in 0..n {
                        let phi = TAU * (f64::from(j) + 0.5) / f64::from(n);
                        let cosine = mu * cos_psi + (1.0 - mu * mu).max(0.0).sqrt() * sin_psi * phi.cos();
                        let share = cosine.max(0.0) * 2.0 * TAU / f64::from(n * n) / (d * d);
                        sum = [sum[0] + d.powi(3) * share, sum[1] + d.powi(4) * share];
                    }
                }
                let got = irradiance.at(cos_psi);
                for k in 0..2 {
                    // A cubic through 129 places; at γ = 10 behind it is 1e-5 of what is ahead.
                    let scale = sum[k].max(1e-3 * irradiance.at(1.0)[k]);
                    assert!((got[k] - sum[k]).abs() < 3e-4 * scale, "{rapidity} {cos_psi}: {got:?} {sum:?}");
                }
            }
        }
        let still = Irradiance::new(&Bath::new(0.0)).at(0.3);
        assert!(still.iter().all(|e| (e - PI).abs() < 1e-14), "{still:?}");
    }
}
