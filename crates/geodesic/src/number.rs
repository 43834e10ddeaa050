use crate::Real;
use std::ops::{Add, Div, Mul, Sub};

/// The numbers a metric is written over: `f64` for its values, [`Dual`](crate::Dual) for its derivatives too.
pub trait Number:
    Real + Add<f64, Output = Self> + Sub<f64, Output = Self> + Mul<f64, Output = Self> + Div<f64, Output = Self>
{
    /// The absolute value.
    fn abs(self) -> Self;
    /// The n-th power.
    fn powi(self, n: i32) -> Self;
    /// A power with any exponent, of a positive number.
    fn powf(self, n: f64) -> Self;
    /// e to this power.
    fn exp(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// The sine.
    fn sin(self) -> Self;
    /// The cosine.
    fn cos(self) -> Self;
    /// The hyperbolic sine.
    fn sinh(self) -> Self;
    /// The hyperbolic cosine.
    fn cosh(self) -> Self;
    /// The hyperbolic tangent.
    fn tanh(self) -> Self;

    /// The square.
    #[inline]
    fn squared(self) -> Self {
        self * self
    }
}

macro_rules! as_f64 {
    ($($name:ident($($argument:ident: $kind:ty)?)),+ $(,)?) => {
        impl Number for f64 {
            $(#[inline]
            fn $name(self $(, $argument: $kind)?) -> Self {
                f64::$name(self $(, $argument)?)
            })+
        }
    };
}

as_f64!(abs(), powi(n: i32), powf(n: f64), exp(), ln(), sin(), cos(), sinh(), cosh(), tanh());
