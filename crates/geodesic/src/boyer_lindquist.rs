use crate::{Event, KerrSchild, World};
use glam::DVec3;

/// An event near a black hole in the coordinates of Boyer and Lindquist, in which observers, discs and
/// reference values are usually given.
///
/// t and φ agree with Kerr–Schild's infinitely far away, but for the logarithm that every such t has: here
/// t_KS = t − 2M/(r₊ − r₋) [r₊ ln((r − r₊)/2M) − r₋ ln((r − r₋)/2M)].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoyerLindquist {
    /// Time.
    pub t: f64,
    /// Radius; the horizon is at [`KerrSchild::horizon`].
    pub r: f64,
    /// Angle from the axis of rotation.
    pub theta: f64,
    /// Azimuth, growing as the hole turns for a > 0; −π to π where it is computed.
    pub phi: f64,
}

impl KerrSchild {
    /// Time and azimuth of Boyer and Lindquist less those of the outgoing Kerr–Schild chart at a radius:
    /// ∫ 2Mr/Δ dr and ∫ a/Δ dr.
    fn chart_offsets(&self, r: f64) -> (f64, f64) {
        let (mass, spin) = (self.mass(), self.spin());
        let half = ((mass - spin) * (mass + spin)).sqrt();
        let (outer, inner) = (r - mass - half, r - mass + half);
        // ln((r − r₊)/(r − r₋))/(r₊ − r₋), which tends to −1/(r − M) for a = M.
        let ratio = -2.0 * half / inner;
        let slope = if half == 0.0 { -1.0 / inner } else { ratio.ln_1p() / (2.0 * half) };
        // 2Mr/Δ = M Δ′/Δ + 2M²/Δ.
        let time =
            mass * ((outer / (2.0 * mass)).ln() + (inner / (2.0 * mass)).ln()) + 2.0 * mass * mass * slope;
        (time, spin * slope)
    }

    /// The Boyer–Lindquist coordinates of an event outside of the horizon; φ is 0 on the axis.
    pub fn to_boyer_lindquist(&self, event: Event<World>) -> BoyerLindquist {
        let place = event.position();
        let r = self.radius(place.to_array());
        let (time, azimuth) = self.chart_offsets(r);
        let around = place.x.hypot(place.y);
        // x + iy = (r − ia) sin θ e^{iφ′}.
        let phi =
            if around == 0.0 { 0.0 } else { place.y.atan2(place.x) + (self.spin() / r).atan() + azimuth };
        let phi = phi - std::f64::consts::TAU * (phi / std::f64::consts::TAU).round();
        // From both sin and cos, so that neither end loses digits.
        let theta = (around / r.hypot(self.spin())).atan2(place.z / r);
        BoyerLindquist { t: event.t() + time, r, theta, phi }
    }

    /// The azimuth φ′ of the outgoing Kerr–Schild chart, in which x + iy = (r − ia) sin θ e^{iφ′}.
    pub(crate) fn azimuth(&self, at: BoyerLindquist) -> f64 {
        at.phi - self.chart_offsets(at.r).1
    }

    /// The event with given Boyer–Lindquist coordinates.
    pub fn from_boyer_lindquist(&self, at: BoyerLindquist) -> Event<World> {
        let (time, _) = self.chart_offsets(at.r);
        let around = at.r.hypot(self.spin()) * at.theta.sin();
        let (sine, cosine) = (self.azimuth(at) - (self.spin() / at.r).atan()).sin_cos();
        Event::at(at.t - time, DVec3::new(around * cosine, around * sine, at.r * at.theta.cos()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn there_and_back(
            spin in -1.0..=1.0f64, t in -9.0..9.0f64, over in 1.001..50.0f64, theta in 0.01..3.13f64,
            phi in -3.1..3.1f64,
        ) {
            let hole = KerrSchild::new(2.0, 2.0 * spin).unwrap();
            let at = BoyerLindquist { t, r: over * hole.horizon(), theta, phi };
            let back = hole.to_boyer_lindquist(hole.from_boyer_lindquist(at));
            // r is computed to rounding; t and φ change 1/(over − 1) ~ 1000 times faster near the horizon.
            prop_assert!((back.r - at.r).abs() < 1e-13 * at.r);
            prop_assert!((back.theta - at.theta).abs() < 1e-13);
            prop_assert!((back.t - at.t).abs() < 1e-10, "{back:?} {at:?}");
            let turn = (back.phi - at.phi).abs();
            prop_assert!(turn.min(std::f64::consts::TAU - turn) < 1e-10, "{back:?} {at:?}");
        }
    }

    #[test]
    fn offsets_have_the_slopes_they_are_integrals_of() {
        for spin in [0.0, 0.5, -0.9, 1.0] {
            let hole = KerrSchild::new(1.0, spin).unwrap();
            for r in [2.5, 4.0, 100.0] {
                let h = 1e-4 * r;
                let (up, down) = (hole.chart_offsets(r + h), hole.chart_offsets(r - h));
                let delta = r * r - 2.0 * r + spin * spin;
                // Central differences: relative error (h/r)² times numbers of order 10.
                assert!(((up.0 - down.0) / (2.0 * h) * delta / (2.0 * r) - 1.0).abs() < 1e-6, "{spin} {r}");
                assert!(((up.1 - down.1) / (2.0 * h) * delta - spin).abs() < 1e-6, "{spin} {r}");
            }
        }
    }
}
