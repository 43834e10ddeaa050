use crate::Real;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with about 32 significant digits: the unevaluated sum of two `f64`, `high` the nearest to the
/// whole.
///
/// For quantities computed once a body or once a frame whose digits a later difference needs, such as the
/// observer's position in the rest frame of a body at γ = 10⁹. Not for inner loops.
///
/// Source: T. J. Dekker, *A floating-point technique for extending the available precision* (1971).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Wide {
    /// The nearest `f64`.
    pub high: f64,
    /// What `high` leaves over; at most half a unit in its last place.
    pub low: f64,
}

impl Wide {
    /// a + b, exactly.
    #[inline]
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let b_part = high - a;
        Self { high, low: (a - (high - b_part)) + (b - b_part) }
    }

    /// a − b, exactly.
    #[inline]
    pub fn difference(a: f64, b: f64) -> Self {
        Self::sum(a, -b)
    }

    /// a · b, exactly (barring overflow and underflow).
    #[inline]
    pub fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self { high, low: a.mul_add(b, -high) }
    }

    /// As [`sum`](Self::sum) for |a| ≥ |b|, in fewer operations.
    #[inline]
    fn renormalised(a: f64, b: f64) -> Self {
        let high = a + b;
        Self { high, low: b - (high - a) }
    }
}

impl From<f64> for Wide {
    #[inline]
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for Wide {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        let low = Self::sum(self.low, other.low);
        let carried = Self::renormalised(high.high, high.low + low.high);
        Self::renormalised(carried.high, carried.low + low.low)
    }
}

impl Neg for Wide {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Wide {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for Wide {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let exact = Self::product(self.high, other.high);
        Self::renormalised(exact.high, exact.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Wide {
    type Output = Self;

    #[inline]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        Self::renormalised(first, second) + Self::from(rest.high / other.high)
    }
}

impl Real for Wide {
    #[inline]
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::from(self.high.sqrt());
        }
        let root = Self::from(self.high.sqrt());
        // One Newton step doubles the digits.
        root + (self - root * root) / (root + root)
    }

    #[inline]
    fn value(self) -> f64 {
        self.high
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_times_three_is_one_to_thirty_digits() {
        let third = Wide::from(1.0) / Wide::from(3.0);
        let off = third * 3.0.into() - 1.0.into();
        assert!(off.high.abs() < 1e-31, "{off:?}");
    }

    #[test]
    fn the_square_of_a_root_is_the_number_to_thirty_digits() {
        for value in [2.0, 3.0e18, 7.0e-12] {
            let root = Wide::from(value).sqrt();
            let off = (root * root - value.into()).high / value;
            assert!(off.abs() < 1e-31, "{value}: {off:e}");
        }
        assert_eq!(Wide::from(0.0).sqrt(), 0.0.into());
    }

    #[test]
    fn a_difference_keeps_the_digits_f64_loses() {
        let gamma = Wide::from(1e9);
        let celerity = (gamma * gamma - 1.0.into()).sqrt();
        let off = (gamma - celerity) * (gamma + celerity) - 1.0.into();
        assert!(off.high.abs() < 1e-13, "γ − |u| of γ = 1e9, relative: {off:?}");
        assert_ne!(gamma.high - celerity.high, (gamma - celerity).high);
    }
}
