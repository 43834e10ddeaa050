//! Observers that a rotating black hole singles out.

use crate::local_frame::{normalised, static_observer};
use crate::{Curved, Event, FourVector, FrameError, KerrSchild, Law, Spacetime, World};

/// Which way an orbit goes around.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// With the hole's rotation (about +z, if it does not rotate).
    Prograde,
    /// Against it.
    Retrograde,
}

impl KerrSchild {
    /// The four-velocity of the observer of zero angular momentum, who is dragged around with
    /// ω = −g_tφ/g_φφ; exists everywhere outside of the horizon.
    ///
    /// # Errors
    /// At or inside the horizon.
    pub fn zamo(&self, event: Event<World>) -> Result<FourVector<World>, FrameError> {
        let space = Curved::new(*self);
        let place = event.position();
        if place.x == 0.0 && place.y == 0.0 {
            return static_observer(&space, event);
        }
        self.outside(event)?;
        let time = FourVector::new(1.0, 0.0, 0.0, 0.0);
        let around = FourVector::new(0.0, -place.y, place.x, 0.0);
        let omega = -space.product(event, time, around) / space.product(event, around, around);
        normalised(&space, event, time + around * omega)
    }

    /// The four-velocity on a circular orbit in the equatorial plane, with the angular velocity
    /// Ω = ±√M/(r^{3/2} ± a√M) seen from far away.
    ///
    /// Source: J. M. Bardeen, W. H. Press, S. A. Teukolsky, ApJ 178 (1972) 347, Eq. 2.16.
    ///
    /// # Errors
    /// Out of the equatorial plane, at or inside the horizon, or where such an orbit would be faster than light.
    pub fn circular(&self, event: Event<World>, sense: Sense) -> Result<FourVector<World>, FrameError> {
        self.outside(event)?;
        let place = event.position();
        // Rounding of a position turned into the plane.
        if place.z.abs() > 1e-9 * place.length() {
            return Err(FrameError::NotEquatorial(place.z));
        }
        let with = if self.spin() < 0.0 { -1.0 } else { 1.0 };
        let sign = match sense {
            Sense::Prograde => with,
            Sense::Retrograde => -with,
        };
        let r = self.radius(place.to_array());
        let root = self.mass().sqrt();
        let omega = sign * root / (r * r.sqrt() + sign * self.spin() * root);
        let along = FourVector::new(1.0, -omega * place.y, omega * place.x, 0.0);
        normalised(&Curved::new(*self), event, along)
    }

    /// The four-velocity of rain: free fall from rest at infinity without angular momentum (E = 1, L = Q = 0).
    ///
    /// u_t = −1 and u_r = −(2Mr + √(2Mr(r² + a²)))/Δ in this chart, the other components zero.
    ///
    /// # Errors
    /// At or inside the horizon.
    pub fn rain(&self, event: Event<World>) -> Result<FourVector<World>, FrameError> {
        self.outside(event)?;
        let [x, y, z] = event.position().to_array();
        let (mass, a2) = (self.mass(), self.spin() * self.spin());
        let r = self.radius([x, y, z]);
        let delta = r * (r - 2.0 * mass) + a2;
        let radial = -(2.0 * mass * r + (2.0 * mass * r * (r * r + a2)).sqrt()) / delta;
        // ∂r/∂x, as in the law of motion.
        let d = (2.0 * r * r - (x * x + y * y + z * z - a2)).max(f64::MIN_POSITIVE);
        let [px, py, pz] = [x * r / d, y * r / d, z * (r * r + a2) / (r * d)].map(|slope| slope * radial);
        let state = [event.t(), x, y, z, -1.0, px, py, pz];
        let velocity = FourVector::from(Law::wave_vector(self, &state));
        // The sum of terms as large as γ² is off by rounding, which its length tells.
        normalised(&Curved::new(*self), event, velocity)
    }

    fn outside(&self, event: Event<World>) -> Result<(), FrameError> {
        match Curved::new(*self).fault(event) {
            None => Ok(()),
            Some(crate::End::Horizon) => Err(FrameError::InsideHorizon),
            Some(fault) => Err(FrameError::NoMetric(fault)),
        }
    }
}
