//! Observers that a rotating black hole singles out.

use crate::local_frame::{normalised, static_observer};
use crate::{Curved, Event, FourVector, FrameError, KerrSchild, Spacetime, World};

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
    /// With q = √(2Mr(r² + a²)): u^r = −q/Σ, u^φ = a(2Mr + q)/(ΣΔ) and
    /// u^t = ((r² + a²)² − a²Δ sin² θ + 2Mrq)/(ΣΔ) in this chart. No two terms cancel, so it keeps its digits down
    /// to the horizon.
    ///
    /// # Errors
    /// At or inside the horizon.
    pub fn rain(&self, event: Event<World>) -> Result<FourVector<World>, FrameError> {
        self.outside(event)?;
        let [x, y, z] = event.position().to_array();
        let (mass, a) = (self.mass(), self.spin());
        let r = self.radius([x, y, z]);
        let e = r * r + a * a;
        let delta = r * (r - 2.0 * mass) + a * a;
        let sigma = r * r + (a * z / r).powi(2);
        let fall = (2.0 * mass * r * e).sqrt();
        let radial = -fall / sigma;
        let around = a * (2.0 * mass * r + fall) / (sigma * delta);
        // sin² θ = (x² + y²)/(r² + a²).
        let time = (e * e - a * a * delta * (x * x + y * y) / e + 2.0 * mass * r * fall) / (sigma * delta);
        Ok(FourVector::new(
            time,
            radial * (x * r - y * a) / e - around * y,
            radial * (y * r + x * a) / e + around * x,
            radial * z / r,
        ))
    }

    fn outside(&self, event: Event<World>) -> Result<(), FrameError> {
        match Curved::new(*self).fault(event) {
            None => Ok(()),
            Some(crate::End::Horizon) => Err(FrameError::InsideHorizon),
            Some(fault) => Err(FrameError::NoMetric(fault)),
        }
    }
}
