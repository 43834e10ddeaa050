use crate::{Real, Wide};
use glam::DVec3;

/// The velocity of a body as celerity u = γβ (proper velocity): the space part of its four-velocity (γ, u).
///
/// Any finite u is a possible motion, and u keeps its digits where β = 1 − 10⁻¹⁸ has none left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Celerity(DVec3);

/// Why a velocity cannot be one.
#[derive(Clone, Debug, PartialEq)]
pub enum CelerityError {
    /// A component is NaN or infinite.
    NotFinite(DVec3),
    /// |β| ≥ 1: as fast as light, or faster.
    NotSlowerThanLight(f64),
    /// γ < 1.
    GammaBelowOne(f64),
    /// |u| beyond [`Celerity::LIMIT`].
    TooFast(f64),
    /// A direction of length zero.
    NoDirection,
}

impl std::fmt::Display for CelerityError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite(v) => write!(f, "the velocity ({}, {}, {}) is not finite", v.x, v.y, v.z),
            Self::NotSlowerThanLight(beta) => write!(
                f,
                "|β| = {beta} is not below 1; nothing with mass is that fast. Near light speed give gamma or celerity (γβ) instead"
            ),
            Self::GammaBelowOne(gamma) => {
                write!(f, "γ = {gamma} is below 1; a body at rest has γ = 1")
            }
            Self::TooFast(celerity) => {
                write!(
                    f,
                    "celerity γβ = {celerity:e} is beyond {:e}, where 32 digits no longer hold an event",
                    Celerity::LIMIT
                )
            }
            Self::NoDirection => write!(f, "the direction of motion has length zero"),
        }
    }
}

impl std::error::Error for CelerityError {}

fn finite(v: DVec3) -> Result<DVec3, CelerityError> {
    if v.is_finite() { Ok(v) } else { Err(CelerityError::NotFinite(v)) }
}

/// `direction` scaled to length 1 in [`Wide`], so that a huge or tiny one neither overflows nor loses digits.
fn unit(direction: DVec3) -> Result<[Wide; 3], CelerityError> {
    let largest = finite(direction)?.abs().max_element();
    if largest == 0.0 {
        return Err(CelerityError::NoDirection);
    }
    // A power of two scales without rounding.
    let scale = 2f64.powi(-(largest.log2().floor() as i32).clamp(-1000, 1000));
    let scaled = direction.to_array().map(|c| Wide::from(c * scale));
    let length = norm(scaled);
    Ok(scaled.map(|c| c / length))
}

fn norm([x, y, z]: [Wide; 3]) -> Wide {
    (x * x + y * y + z * z).sqrt()
}

impl Celerity {
    /// The greatest |u| accepted: γ² must leave some of the 32 digits of [`Wide`].
    pub const LIMIT: f64 = 1e13;

    /// No motion.
    pub fn at_rest() -> Self {
        Self(DVec3::ZERO)
    }

    /// From the celerity vector γβ itself.
    ///
    /// # Errors
    /// If a component is not finite, or |u| exceeds [`LIMIT`](Self::LIMIT).
    pub fn new(celerity: DVec3) -> Result<Self, CelerityError> {
        let largest = finite(celerity)?.abs().max_element();
        if largest > Self::LIMIT {
            return Err(CelerityError::TooFast(largest));
        }
        Ok(Self(celerity))
    }

    /// From the velocity β, with 1 − β² formed without cancellation.
    ///
    /// # Errors
    /// If |β| ≥ 1 or a component is not finite.
    pub fn from_beta(beta: DVec3) -> Result<Self, CelerityError> {
        let [x, y, z] = finite(beta)?.to_array().map(Wide::from);
        let slack = Wide::from(1.0) - (x * x + y * y + z * z);
        if slack.high <= 0.0 {
            return Err(CelerityError::NotSlowerThanLight(beta.length()));
        }
        let inverse_gamma = slack.sqrt();
        Self::new(DVec3::from_array([x, y, z].map(|c| (c / inverse_gamma).value())))
    }

    /// From the Lorentz factor γ ≥ 1 and a direction of any length: |u| = √((γ − 1)(γ + 1)).
    ///
    /// # Errors
    /// If γ < 1, the direction is zero, or anything is not finite.
    pub fn from_gamma(gamma: f64, direction: DVec3) -> Result<Self, CelerityError> {
        if !gamma.is_finite() {
            return Err(CelerityError::NotFinite(DVec3::new(gamma, 0.0, 0.0)));
        }
        if gamma < 1.0 {
            return Err(CelerityError::GammaBelowOne(gamma));
        }
        if gamma > Self::LIMIT {
            return Err(CelerityError::TooFast(gamma));
        }
        let length = (Wide::difference(gamma, 1.0) * Wide::sum(gamma, 1.0)).sqrt();
        Self::new(DVec3::from_array(unit(direction)?.map(|c| (c * length).value())))
    }

    /// From the rapidity w (|u| = sinh w) and a direction of any length.
    ///
    /// # Errors
    /// If the direction is zero, or anything is not finite or overflows (w > 710).
    pub fn from_rapidity(rapidity: f64, direction: DVec3) -> Result<Self, CelerityError> {
        let length = rapidity.sinh();
        if length.abs() > Self::LIMIT {
            return Err(CelerityError::TooFast(length.abs()));
        }
        let length = Wide::from(length);
        Self::new(DVec3::from_array(unit(direction)?.map(|c| (c * length).value())))
    }

    /// The vector u = γβ.
    #[inline]
    pub fn vector(&self) -> DVec3 {
        self.0
    }

    /// |u| = γβ.
    pub fn magnitude(&self) -> f64 {
        norm(self.0.to_array().map(Wide::from)).value()
    }

    /// The Lorentz factor γ = √(1 + u²).
    pub fn gamma(&self) -> f64 {
        self.gamma_as::<Wide>().value()
    }

    /// The Lorentz factor with which two move relative to each other: γγ′ − u·u′, of which nothing is lost where both are
    /// fast in one direction.
    pub fn relative_gamma(&self, other: &Self) -> f64 {
        let ([a, b, c], [x, y, z]) = (self.0.to_array().map(Wide::from), other.0.to_array().map(Wide::from));
        (self.gamma_as::<Wide>() * other.gamma_as::<Wide>() - (a * x + b * y + c * z)).value()
    }

    /// γ with the digits of `S`.
    pub(crate) fn gamma_as<S: Real>(&self) -> S {
        let [x, y, z] = self.0.to_array().map(S::from);
        (S::from(1.0) + (x * x + y * y + z * z)).sqrt()
    }

    /// The velocity β = u/γ.
    pub fn beta(&self) -> DVec3 {
        self.0 / self.gamma()
    }

    /// The rapidity w = asinh |u|.
    pub fn rapidity(&self) -> f64 {
        self.magnitude().asinh()
    }

    /// The unit vector along the motion; none at rest.
    pub fn direction(&self) -> Option<DVec3> {
        unit(self.0).ok().map(|axis| DVec3::from_array(axis.map(Wide::value)))
    }

    /// Whether it is any motion at all.
    pub fn moves(&self) -> bool {
        self.0 != DVec3::ZERO
    }

    /// The opposite motion.
    pub fn reversed(&self) -> Self {
        Self(-self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn relative_gamma_is_that_of_the_difference_of_rapidities() {
        let of = |rapidity: f64| Celerity::from_rapidity(rapidity, DVec3::new(1.0, -2.0, 2.0)).unwrap();
        // To the last digit of u, of which each counts its own γ times.
        for (a, b) in [(0.0, 3.0), (1.0, -2.0), (20.0, 20.0), (21.0, 19.0)] {
            let (gamma, expected) = (of(a).relative_gamma(&of(b)), (a - b).cosh());
            assert!((gamma / expected - 1.0).abs() < 1e-14, "{a} {b}: {gamma} {expected}");
        }
        assert_eq!(of(1.0).relative_gamma(&Celerity::at_rest()), of(1.0).gamma());
    }

    #[test]
    fn beta_gamma_celerity_and_rapidity_name_one_motion() {
        let x = DVec3::X;
        let from_beta = Celerity::from_beta(x * 0.6).unwrap();
        assert_eq!(from_beta.vector(), x * 0.75);
        assert_eq!(from_beta.gamma(), 1.25);
        // The f64 nearest 0.6 is not 0.6, hence one unit in the last place.
        for other in [
            Celerity::from_gamma(1.25, x * 7.0).unwrap(),
            Celerity::from_rapidity(2f64.ln(), x).unwrap(),
            Celerity::new(x * 0.75).unwrap(),
        ] {
            assert!((other.vector() - from_beta.vector()).length() <= 2.0 * f64::EPSILON);
        }
    }

    #[test]
    fn what_moves_has_a_direction() {
        for u in [0.0, -0.0, 5e-324, 1e-200, 1.0, 1e13] {
            let celerity = Celerity::new(DVec3::Y * u).unwrap();
            assert_eq!(celerity.moves(), u != 0.0, "{u}");
            assert_eq!(celerity.moves(), celerity.direction().is_some(), "{u}");
        }
    }

    #[test]
    fn what_is_no_velocity_is_refused() {
        for beta in [1.0, 1.5, -1.0] {
            assert!(matches!(
                Celerity::from_beta(DVec3::X * beta),
                Err(CelerityError::NotSlowerThanLight(_))
            ));
        }
        assert!(matches!(Celerity::from_beta(DVec3::NAN), Err(CelerityError::NotFinite(_))));
        assert!(matches!(Celerity::from_gamma(0.99, DVec3::X), Err(CelerityError::GammaBelowOne(_))));
        assert!(matches!(Celerity::from_gamma(f64::NAN, DVec3::X), Err(CelerityError::NotFinite(_))));
        assert!(matches!(Celerity::from_gamma(2.0, DVec3::ZERO), Err(CelerityError::NoDirection)));
        assert!(Celerity::from_rapidity(1e3, DVec3::X).is_err());
    }

    #[test]
    fn a_direction_may_have_any_length() {
        for length in [1e-300, 1e-20, 1.0, 1e20, 1e300] {
            let u = Celerity::from_gamma(2.0, DVec3::new(3.0, 0.0, 4.0) * length).unwrap().vector();
            let expected = DVec3::new(0.6, 0.0, 0.8) * 3f64.sqrt();
            assert!((u - expected).length() < 1e-15, "{length}: {u}");
        }
    }

    proptest! {
        #[test]
        fn beta_there_and_back(x in -0.57..0.57f64, y in -0.57..0.57f64, z in -0.57..0.57f64) {
            let beta = DVec3::new(x, y, z);
            let back = Celerity::from_beta(beta).unwrap().beta();
            prop_assert!((back - beta).length() <= 4.0 * f64::EPSILON);
        }
    }
}
