use crate::{Number, Real};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number and its derivatives along the four coordinates: forward differentiation, exact to rounding.
///
/// v + Σ d_μ ε_μ with ε_μ ε_ν = 0; so f(v + dε) = f(v) + f′(v) dε.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// Its derivatives by t, x, y, z.
    pub gradient: [f64; 4],
}

impl Dual {
    /// The four coordinates, each with derivative 1 along itself.
    #[inline(always)]
    pub fn coordinates(x: [f64; 4]) -> [Self; 4] {
        let [t, x, y, z] = x;
        [
            Self { value: t, gradient: [1.0, 0.0, 0.0, 0.0] },
            Self { value: x, gradient: [0.0, 1.0, 0.0, 0.0] },
            Self { value: y, gradient: [0.0, 0.0, 1.0, 0.0] },
            Self { value: z, gradient: [0.0, 0.0, 0.0, 1.0] },
        ]
    }

    /// f of this number, from f and f′ there.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        let [t, x, y, z] = self.gradient;
        Self { value, gradient: [t * slope, x * slope, y * slope, z * slope] }
    }
}

impl From<f64> for Dual {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value, gradient: [0.0; 4] }
    }
}

#[inline(always)]
fn zip(a: [f64; 4], b: [f64; 4], f: impl Fn(f64, f64) -> f64) -> [f64; 4] {
    [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])]
}

impl Add for Dual {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, gradient: zip(self.gradient, other.gradient, |a, b| a + b) }
    }
}

impl Sub for Dual {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, gradient: zip(self.gradient, other.gradient, |a, b| a - b) }
    }
}

impl Mul for Dual {
    type Output = Self;
    #[inline(always)]
    // The product rule adds.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        Self { value: a * b, gradient: zip(self.gradient, other.gradient, |da, db| da * b + a * db) }
    }
}

impl Div for Dual {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        let value = self.value * inverse;
        Self { value, gradient: zip(self.gradient, other.gradient, |a, b| (a - b * value) * inverse) }
    }
}

impl Neg for Dual {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl Sub<f64> for Dual {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, other)
    }
}

impl Div<f64> for Dual {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self * (1.0 / other)
    }
}

impl Real for Dual {
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
}

impl Number for Dual {
    #[inline]
    fn abs(self) -> Self {
        self.chain(self.value.abs(), self.value.signum())
    }

    #[inline]
    fn powi(self, n: i32) -> Self {
        // Not through 1/x, which a zero would turn into NaN.
        self.chain(self.value.powi(n), if n == 0 { 0.0 } else { f64::from(n) * self.value.powi(n - 1) })
    }

    #[inline]
    fn powf(self, n: f64) -> Self {
        self.chain(self.value.powf(n), if n == 0.0 { 0.0 } else { n * self.value.powf(n - 1.0) })
    }

    #[inline]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    #[inline]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), 1.0 / self.value)
    }

    #[inline]
    fn sin(self) -> Self {
        let (sine, cosine) = self.value.sin_cos();
        self.chain(sine, cosine)
    }

    #[inline]
    fn cos(self) -> Self {
        let (sine, cosine) = self.value.sin_cos();
        self.chain(cosine, -sine)
    }

    #[inline]
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }

    #[inline]
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }

    #[inline]
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.chain(value, 1.0 - value * value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every operation once, in a way that depends on all four coordinates.
    fn everything<S: Number>([t, x, y, z]: [S; 4]) -> S {
        (t * x + y / (z.squared() + 1.0)).sin() * (x * 0.3).exp()
            + (y.squared() + 2.0).sqrt().ln() * (z / 2.0).cos()
            - (t.squared() + 1.0).powf(0.7) * z.tanh()
            + (x - 0.5).powi(3) * (y.sinh() - y.cosh()).abs()
            + (-t)
    }

    proptest! {
        #[test]
        fn derivatives_are_those_that_differences_approach(
            x in prop::array::uniform4(-1.5..1.5f64),
        ) {
            let dual = everything(Dual::coordinates(x));
            // Quotients are rounded once more than in f64; the sum has terms up to 30.
            prop_assert!((dual.value - everything(x)).abs() < 1e-14);
            for axis in 0..4 {
                let shifted = |by: f64| {
                    let mut there = x;
                    there[axis] += by;
                    everything(there)
                };
                let h = 1e-3;
                // Fourth order: the error is h⁴ f⁽⁵⁾/30 ~ 1e-12 times derivatives of order 10³ at most.
                let slope = (8.0 * (shifted(h) - shifted(-h)) - shifted(2.0 * h) + shifted(-2.0 * h)) / (12.0 * h);
                prop_assert!((dual.gradient[axis] - slope).abs() < 1e-9, "{axis}: {dual:?} {slope}");
            }
        }
    }
}
