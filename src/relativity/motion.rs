use glam::DVec3;
use terrell_geodesic::{Celerity, Event, Lamp, Lorentz, Real, Rest, Tetrad, Wide, World};

/// How a body moves: uniformly, its rest-frame origin passing through one event of the world.
///
/// X_world = L(celerity) · X_rest + origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// The velocity in the world, as celerity u = γβ.
    pub celerity: Celerity,
    /// The event of the rest frame's origin (at rest-frame time 0).
    pub origin: Event<World>,
}

/// A body that does not move relative to the camera is never seen to pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the body and the camera are at rest relative to each other, so it is never seen to pass")]
pub struct NeverAbreast;

impl Motion {
    /// At rest at a position, at all times.
    pub fn at_rest(position: DVec3) -> Self {
        Self { celerity: Celerity::at_rest(), origin: Event::at(0.0, position) }
    }

    /// The map from rest-frame to world components.
    pub fn world_from_rest<S: Real>(&self) -> Lorentz<World, Rest, S> {
        Lorentz::boost(&self.celerity)
    }

    /// As [`world_from_rest`](Self::world_from_rest), of a lamp.
    pub fn world_from_lamp<S: Real>(&self) -> Lorentz<World, Lamp, S> {
        Lorentz::boost(&self.celerity)
    }

    /// Where the body's points, given in its rest frame, are at a time of the world.
    pub fn at_time(&self, t: f64) -> impl Fn(DVec3) -> DVec3 + use<> {
        let (beta, gamma) = (self.celerity.beta(), self.celerity.gamma());
        let along = self.celerity.direction().unwrap_or(DVec3::ZERO);
        let origin = self.origin.position() + beta * (t - self.origin.t());
        move |x_rest| origin + x_rest + along * (along.dot(x_rest) * (1.0 / gamma - 1.0))
    }

    /// The observer `observer` becomes when it sees the rest-frame point `x_rest` abreast: at right angles to
    /// the relative motion in its own frame, which is where the point appears nearest.
    ///
    /// # Errors
    /// If nothing moves.
    pub fn seen_abreast(&self, x_rest: DVec3, observer: &Tetrad) -> Result<Tetrad, NeverAbreast> {
        self.seen_passed(x_rest, observer, 0.0)
    }

    /// The observer `observer` becomes when the rest-frame point `x_rest` *appears* `passed` beyond abreast, along
    /// the relative motion: before it if that is negative.
    ///
    /// With s = `passed` and r = √(s² + Q²) its apparent distance, the inverse map x′ = γ(x + βr) says where the
    /// observer is in the rest frame, hence a proper time of s/β + r − P/|u| from the given event, with P the
    /// point's offset along the relative motion and Q across it.
    ///
    /// # Errors
    /// If nothing moves.
    pub fn seen_passed(&self, x_rest: DVec3, observer: &Tetrad, passed: f64) -> Result<Tetrad, NeverAbreast> {
        let whole = observer.observer_from_world::<Wide>() * self.world_from_rest::<Wide>();
        let u = whole.celerity_in_from();
        let speed = (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]).sqrt();
        if speed.high == 0.0 {
            return Err(NeverAbreast);
        }
        let observer_rest =
            self.world_from_rest::<Wide>().inverse() * observer.event().since::<Wide>(self.origin);
        let offset: [Wide; 3] = [0, 1, 2].map(|i| Wide::from(x_rest[i]) - observer_rest.space[i]);
        let axis = u.map(|c| c / speed);
        let along = offset[0] * axis[0] + offset[1] * axis[1] + offset[2] * axis[2];
        let across = [0, 1, 2].map(|i| offset[i] - along * axis[i]);
        let across = (across[0] * across[0] + across[1] * across[1] + across[2] * across[2]).sqrt();
        let passed = Wide::from(passed);
        let distance = (passed * passed + across * across).sqrt();
        let gamma = (Wide::from(1.0) + speed * speed).sqrt();
        let elapsed = passed * gamma / speed + distance - along / speed;
        Ok(observer.later(elapsed.value()))
    }
}
