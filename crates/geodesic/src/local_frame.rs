use crate::{End, Event, FourVector, Observer, Spacetime, World};
use glam::DVec3;

/// An observer in any spacetime: an event and four legs, orthonormal in the metric there; what
/// [`Tetrad`](crate::Tetrad) is in flat spacetime.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalFrame {
    event: Event<World>,
    /// Four-velocity, right, up, forward.
    legs: [FourVector<World>; 4],
}

/// Why there is no such observer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FrameError {
    /// The event is within a horizon, which these coordinates do not describe.
    #[error(
        "the observer is inside a horizon, or so near that it cannot be told; only what is outside can be described, so move it outwards"
    )]
    InsideHorizon,
    /// The metric is not known there, or is none.
    #[error("no observer can be there: a ray that starts there {0}")]
    NoMetric(End),
    /// Nothing can rest there: the coordinate time is not a time, as in an ergosphere.
    #[error(
        "nothing can rest there (g_tt = {0} is not negative), as in an ergosphere; let the observer move along with the rotation"
    )]
    NoStaticObserver(f64),
    /// The velocity is not slower than light.
    #[error("that velocity is not slower than light there (u·u = {0} for dt = 1 is not negative)")]
    NotTimelike(f64),
    /// The four-velocity points to the past, or is not of length −1.
    #[error("a four-velocity has u·u = −1, not {0}")]
    NotNormalised(f64),
    /// `forward` has length zero or is not finite.
    #[error("the forward direction has length zero or is not finite")]
    NoForward,
    /// `up` has length zero, is not finite, or is parallel to `forward`.
    #[error("the up direction has length zero, is not finite, or is parallel to forward")]
    NoUp,
    /// Circular orbits are asked for out of the equatorial plane.
    #[error("circular orbits are in the equatorial plane; z = {0} is not 0")]
    NotEquatorial(f64),
}

impl LocalFrame {
    /// An observer at `event` with a four-velocity, looking along `forward` with `up` upward in the picture. Both
    /// are coordinate directions, made orthonormal in the metric by Gram and Schmidt: forward keeps its
    /// direction within the observer's space, up is turned square to it, right is what is left of
    /// forward × up.
    ///
    /// # Errors
    /// If the event is within a horizon or has no metric, if u·u is not −1 to 10⁻⁶, or if the directions span no
    /// plane.
    pub fn new(
        space: &impl Spacetime,
        event: Event<World>,
        four_velocity: FourVector<World>,
        forward: DVec3,
        up: DVec3,
    ) -> Result<Self, FrameError> {
        check(space, event)?;
        let g = |a, b| space.product(event, a, b);
        let norm = g(four_velocity, four_velocity);
        // A four-velocity computed in f64 is better than this even at γ = 10⁴.
        if norm.is_nan() || (norm + 1.0).abs() > 1e-6 {
            return Err(FrameError::NotNormalised(norm));
        }
        // For who is fast in these coordinates the norm itself is a difference of large terms: where it tells
        // nothing but their rounding, the four-velocity is better as it is.
        let size = four_velocity.t * four_velocity.t + four_velocity.xyz().length_squared();
        let rounding = 16.0 * f64::EPSILON * size;
        let scale = if (norm + 1.0).abs() <= rounding { 1.0 } else { 1.0 / (-norm).sqrt() };
        let time = four_velocity * scale;
        let forward = hint(forward).ok_or(FrameError::NoForward)?;
        let up = hint(up).ok_or(FrameError::NoUp)?;
        let right = forward.cross(up);
        // Closer than this the picture's upright direction would be rounding noise.
        if right.length() < 1e-12 {
            return Err(FrameError::NoUp);
        }
        let leg = |direction: DVec3, others: &[FourVector<World>]| {
            let mut vector = FourVector::from_parts(0.0, direction.normalize());
            // Twice, so that what rounding leaves of the other legs is gone too.
            for _ in 0..2 {
                for (i, &other) in others.iter().enumerate() {
                    let sign = if i == 0 { -1.0 } else { 1.0 };
                    vector = vector - other * (sign * g(vector, other));
                }
                let size = g(vector, vector);
                vector = vector * (1.0 / size.sqrt());
            }
            vector.t.is_finite().then_some(vector)
        };
        let forward = leg(forward, &[time]).ok_or(FrameError::NoForward)?;
        let up = leg(up, &[time, forward]).ok_or(FrameError::NoUp)?;
        let right = leg(right, &[time, forward, up]).ok_or(FrameError::NoUp)?;
        Ok(Self { event, legs: [time, right, up, forward] })
    }

    /// Where and when.
    pub fn event(&self) -> Event<World> {
        self.event
    }

    /// The four-velocity.
    pub fn four_velocity(&self) -> FourVector<World> {
        self.legs[0]
    }

    /// Four-velocity, right, up, forward.
    pub fn legs(&self) -> [FourVector<World>; 4] {
        self.legs
    }

    /// The wave vector of light seen with frequency 1 from a unit direction (x right, y up, z forward): it points
    /// back along the light, k = −u + n.
    pub fn seen_from(&self, direction: DVec3) -> FourVector<World> {
        let [time, right, up, forward] = self.legs;
        right * direction.x + up * direction.y + forward * direction.z - time
    }

    /// The components of a vector at the observer's event in the observer's own frame.
    pub fn components(&self, space: &impl Spacetime, vector: FourVector<World>) -> FourVector<Observer> {
        let [t, x, y, z] = self.legs.map(|leg| space.product(self.event, leg, vector));
        FourVector::new(-t, x, y, z)
    }
}

/// The four-velocity of what rests in the coordinates: ∂_t/√(−g_tt).
///
/// # Errors
/// If g_tt ≥ 0 there, or there is no metric, or a horizon.
pub fn static_observer(space: &impl Spacetime, event: Event<World>) -> Result<FourVector<World>, FrameError> {
    check(space, event)?;
    let along = FourVector::new(1.0, 0.0, 0.0, 0.0);
    normalised(space, event, along).map_err(|error| match error {
        FrameError::NotTimelike(norm) => FrameError::NoStaticObserver(norm),
        other => other,
    })
}

/// The four-velocity of what has the coordinate velocity dx/dt.
///
/// # Errors
/// If that is not slower than light there, or there is no metric, or a horizon.
pub fn moving_observer(
    space: &impl Spacetime,
    event: Event<World>,
    velocity: DVec3,
) -> Result<FourVector<World>, FrameError> {
    check(space, event)?;
    normalised(space, event, FourVector::from_parts(1.0, velocity))
}

/// A vector along a world line to the future, as a four-velocity.
pub(crate) fn normalised(
    space: &impl Spacetime,
    event: Event<World>,
    along: FourVector<World>,
) -> Result<FourVector<World>, FrameError> {
    let norm = space.product(event, along, along);
    if norm.is_nan() || norm >= 0.0 {
        return Err(FrameError::NotTimelike(norm));
    }
    Ok(along * (1.0 / (-norm).sqrt()))
}

fn check(space: &impl Spacetime, event: Event<World>) -> Result<(), FrameError> {
    match space.fault(event) {
        None => Ok(()),
        Some(End::Horizon) => Err(FrameError::InsideHorizon),
        Some(fault) => Err(FrameError::NoMetric(fault)),
    }
}

/// A direction of length 1, whatever its length was.
fn hint(direction: DVec3) -> Option<DVec3> {
    let largest = direction.abs().max_element();
    (direction.is_finite() && largest > 0.0).then(|| (direction / largest).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Celerity, Curved, Flat, Tetrad};
    use proptest::prelude::*;

    #[test]
    fn in_flat_spacetime_it_is_the_tetrad() {
        let celerity = Celerity::new(DVec3::new(0.3, -2.0, 0.7)).unwrap();
        let event = Event::new(1.0, 2.0, 3.0, 4.0);
        let tetrad = Tetrad::new(event, celerity, DVec3::X, DVec3::Z).unwrap();
        let velocity = tetrad.four_velocity();
        let frame = LocalFrame::new(&Flat, event, velocity, DVec3::X, DVec3::Z).unwrap();
        // The axes differ by how the hints are taken; the light seen is the same light.
        let n = DVec3::new(0.36, 0.48, 0.8);
        let k = frame.seen_from(n);
        assert!(k.dot(k).abs() < 1e-13);
        assert!((k.dot(velocity) - 1.0).abs() < 1e-13);
        assert!((frame.components(&Flat, k).xyz() - n).length() < 1e-13);
    }

    #[test]
    fn who_cannot_be_there_is_told_so() {
        let hole = Curved::kerr(1.0, 0.9).unwrap();
        let rest = |x| static_observer(&hole, Event::new(0.0, x, 0.0, 0.0));
        assert!(rest(2.5).is_ok());
        assert!(matches!(rest(2.0), Err(FrameError::NoStaticObserver(_))), "in the ergosphere");
        assert_eq!(rest(1.2), Err(FrameError::InsideHorizon));
        assert_eq!(rest(f64::NAN), Err(FrameError::NoMetric(End::NotANumber)));
        let fast = moving_observer(&hole, Event::new(0.0, 9.0, 0.0, 0.0), DVec3::Y);
        assert!(matches!(fast, Err(FrameError::NotTimelike(_))));
        let make = |u, forward, up| LocalFrame::new(&Flat, Event::origin(), u, forward, up);
        let u = FourVector::new(1.0, 0.0, 0.0, 0.0);
        assert_eq!(make(u, DVec3::ZERO, DVec3::Z), Err(FrameError::NoForward));
        assert_eq!(make(u, DVec3::Z, DVec3::Z), Err(FrameError::NoUp));
        assert!(matches!(make(u * 2.0, DVec3::X, DVec3::Z), Err(FrameError::NotNormalised(_))));
    }

    proptest! {
        #[test]
        fn legs_are_orthonormal_in_the_metric(
            spin in -1.0..1.0f64,
            place in prop::array::uniform3(-9.0..9.0f64),
            velocity in prop::array::uniform3(-0.2..0.2f64),
            forward in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let hole = Curved::kerr(1.0, spin).unwrap();
            let event = Event::at(0.0, DVec3::from_array(place));
            let forward = DVec3::from_array(forward);
            prop_assume!(event.position().length() > 4.0 && forward.length() > 0.1 && forward.x.abs() > 0.01);
            let u = moving_observer(&hole, event, DVec3::from_array(velocity)).unwrap();
            let frame = LocalFrame::new(&hole, event, u, forward, DVec3::Z).unwrap();
            let legs = frame.legs();
            for i in 0..4 {
                for j in 0..4 {
                    let expected = if i != j { 0.0 } else if i == 0 { -1.0 } else { 1.0 };
                    let product = hole.product(event, legs[i], legs[j]);
                    prop_assert!((product - expected).abs() < 1e-13, "{i} {j} {product}");
                }
            }
        }
    }
}
