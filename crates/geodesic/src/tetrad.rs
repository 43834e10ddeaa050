use crate::{Celerity, Event, FourVector, Lorentz, Observer, Real, World};
use glam::DVec3;

/// An observer: an event, a four-velocity and three axes. Everything seen is decided by it, never by more.
///
/// The axes are given in the observer's own frame, reached from the world's by a pure boost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tetrad {
    event: Event<World>,
    celerity: Celerity,
    /// Right, up, forward: orthonormal, in the boosted (unrotated) axes.
    axes: [DVec3; 3],
}

/// Why two directions do not make a set of axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TetradError {
    /// `forward` has length zero or is not finite.
    NoForward,
    /// `up` has length zero, is not finite, or is parallel to `forward`.
    NoUp,
}

impl std::fmt::Display for TetradError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoForward => write!(f, "the forward direction has length zero or is not finite"),
            Self::NoUp => {
                write!(f, "the up direction has length zero, is not finite, or is parallel to forward")
            }
        }
    }
}

impl std::error::Error for TetradError {}

impl Tetrad {
    /// An observer at `event` moving with `celerity`, looking along `forward` with `up` upward in the picture;
    /// right = forward × up. Directions need not be unit vectors, `up` need not be square to `forward`.
    ///
    /// # Errors
    /// If the two directions span no plane.
    pub fn new(
        event: Event<World>,
        celerity: Celerity,
        forward: DVec3,
        up: DVec3,
    ) -> Result<Self, TetradError> {
        let forward = unit(forward).ok_or(TetradError::NoForward)?;
        let up = unit(up).ok_or(TetradError::NoUp)?;
        let right = forward.cross(up);
        // Closer than this the picture's upright direction would be rounding noise.
        if right.length() < 1e-12 {
            return Err(TetradError::NoUp);
        }
        let right = right.normalize();
        Ok(Self { event, celerity, axes: [right, right.cross(forward), forward] })
    }

    /// At rest at `event`, with axes that *are* the world's: x right, y up, z forward.
    ///
    /// (Left-handed as a picture; use it where components matter and not the picture.)
    pub fn of_world(event: Event<World>) -> Self {
        Self { event, celerity: Celerity::at_rest(), axes: [DVec3::X, DVec3::Y, DVec3::Z] }
    }

    /// Where and when.
    pub fn event(&self) -> Event<World> {
        self.event
    }

    /// The observer's motion in the world.
    pub fn celerity(&self) -> Celerity {
        self.celerity
    }

    /// Right, up, forward.
    pub fn axes(&self) -> [DVec3; 3] {
        self.axes
    }

    /// The four-velocity (γ, u) in the world.
    pub fn four_velocity(&self) -> FourVector<World> {
        FourVector::from_parts(self.celerity.gamma(), self.celerity.vector())
    }

    /// The map from world components to this observer's.
    pub fn observer_from_world<S: Real>(&self) -> Lorentz<Observer, World, S> {
        Lorentz::<Observer, World, S>::rotation(self.axes)
            * Lorentz::<World, World, S>::boost(&self.celerity.reversed())
    }

    /// The same observer, `proper_time` later on its straight world line.
    pub fn later(&self, proper_time: f64) -> Self {
        Self { event: self.event + self.four_velocity() * proper_time, ..*self }
    }
}

fn unit(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    (v.is_finite() && largest > 0.0).then(|| (v / largest).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_legs_of_a_moving_tetrad_are_orthonormal_in_the_world() {
        let tetrad = Tetrad::new(
            Event::origin(),
            Celerity::new(DVec3::new(2.0, -1.0, 0.5)).unwrap(),
            DVec3::new(1.0, 2.0, 0.0),
            DVec3::Z,
        )
        .unwrap();
        let world_from_observer = tetrad.observer_from_world::<f64>().inverse();
        let leg = |t, x, y, z| world_from_observer * FourVector::new(t, x, y, z);
        let legs = [
            leg(1.0, 0.0, 0.0, 0.0),
            leg(0.0, 1.0, 0.0, 0.0),
            leg(0.0, 0.0, 1.0, 0.0),
            leg(0.0, 0.0, 0.0, 1.0),
        ];
        for i in 0..4 {
            for j in 0..4 {
                let expected = if i != j { 0.0 } else { if i == 0 { -1.0 } else { 1.0 } };
                assert!((legs[i].dot(legs[j]) - expected).abs() < 1e-13);
            }
        }
        let u = tetrad.four_velocity() - legs[0];
        assert!(u.t.abs() + u.xyz().length() < 1e-13, "the time leg is the four-velocity");
    }

    #[test]
    fn axes_that_span_no_plane_are_refused() {
        let make = |forward, up| Tetrad::new(Event::origin(), Celerity::at_rest(), forward, up);
        assert_eq!(make(DVec3::ZERO, DVec3::Z), Err(TetradError::NoForward));
        assert_eq!(make(DVec3::NAN, DVec3::Z), Err(TetradError::NoForward));
        assert_eq!(make(DVec3::Z * 2.0, DVec3::Z), Err(TetradError::NoUp));
        assert!(make(DVec3::X * 1e200, DVec3::Z * 1e-200).is_ok());
    }
}
