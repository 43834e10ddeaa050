use glam::DVec3;
use terrell_geodesic::{Celerity, CelerityError};

/// How fast and which way, in any of the five ways files may say it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Velocity {
    /// β, as a vector.
    pub velocity: Option<DVec3>,
    /// γβ, as a vector.
    pub celerity: Option<DVec3>,
    /// |β|, along the direction.
    pub beta: Option<f64>,
    /// γ, along the direction.
    pub gamma: Option<f64>,
    /// The rapidity, along the direction.
    pub rapidity: Option<f64>,
    /// Of any length; +x, if left out.
    pub direction: Option<DVec3>,
}

/// What is wrong with a velocity, and at which of its keys.
pub(super) struct VelocityFault {
    pub key: &'static str,
    pub message: String,
}

impl Velocity {
    /// The velocity, if there is one.
    pub fn told(&self) -> Result<Option<Celerity>, VelocityFault> {
        let fault = |key, message| Err(VelocityFault { key, message });
        let direction = self.direction.unwrap_or(DVec3::X);
        let along = |beta: f64| match direction.normalize_or_zero() {
            DVec3::ZERO => Err(CelerityError::NoDirection),
            unit => Celerity::from_beta(unit * beta),
        };
        let ways = [
            ("velocity", self.velocity.map(Celerity::from_beta)),
            ("celerity", self.celerity.map(Celerity::new)),
            ("beta", self.beta.map(along)),
            ("gamma", self.gamma.map(|gamma| Celerity::from_gamma(gamma, direction))),
            ("rapidity", self.rapidity.map(|rapidity| Celerity::from_rapidity(rapidity, direction))),
        ];
        let mut given = ways.into_iter().filter_map(|(key, made)| Some((key, made?)));
        let Some((key, made)) = given.next() else {
            return match self.direction {
                Some(_) => {
                    fault("direction", "a direction needs a speed: add beta, gamma or rapidity".to_owned())
                }
                None => Ok(None),
            };
        };
        if let Some((other, _)) = given.next() {
            return fault(other, format!("both {key} and {other} are given; one is enough"));
        }
        if self.direction.is_some() && matches!(key, "velocity" | "celerity") {
            return fault("direction", format!("{key} already has a direction; remove one of the two"));
        }
        made.map(Some).or_else(|e| fault(key, format!("{key}: {e}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_say_it_and_no_two() {
        let beta = |velocity: Velocity| velocity.told().ok().flatten().map(|c| c.beta());
        let direction = Some(DVec3::Y * 7.0);
        let expected = DVec3::Y * 0.6;
        let none = Velocity::default();
        let ways = [
            Velocity { velocity: Some(expected), ..none },
            Velocity { celerity: Some(DVec3::Y * 0.75), ..none },
            Velocity { beta: Some(0.6), direction, ..none },
            Velocity { gamma: Some(1.25), direction, ..none },
            Velocity { rapidity: Some(2f64.ln()), direction, ..none },
        ];
        for way in ways {
            assert!((beta(way).unwrap() - expected).length() < 1e-15, "{way:?}");
        }
        assert_eq!(beta(Velocity { beta: Some(0.6), ..none }), Some(DVec3::X * 0.6));
        assert!(matches!(none.told(), Ok(None)));
        let zero = Some(DVec3::ZERO);
        for (bad, key, part) in [
            (Velocity { direction, ..none }, "direction", "needs a speed"),
            (Velocity { direction, ..ways[0] }, "direction", "velocity already has"),
            (Velocity { direction, ..ways[1] }, "direction", "celerity already has"),
            (Velocity { gamma: Some(2.0), ..ways[0] }, "gamma", "both velocity and gamma"),
            (Velocity { gamma: Some(2.0), ..ways[2] }, "gamma", "both beta and gamma"),
            (Velocity { direction: zero, ..ways[2] }, "beta", "length zero"),
            (Velocity { direction: zero, ..ways[4] }, "rapidity", "length zero"),
            (Velocity { beta: Some(1.0), ..none }, "beta", "beta: |β| = 1 is not below 1"),
        ] {
            let fault = bad.told().unwrap_err();
            assert!(fault.key == key && fault.message.contains(part), "{}: {}", fault.key, fault.message);
        }
    }
}
