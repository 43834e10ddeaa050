use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The numbers spacetime arithmetic is written over: `f64`, and [`Wide`](crate::Wide) where a difference of
/// large numbers must keep its digits.
pub trait Real:
    Copy
    + Debug
    + PartialEq
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The non-negative square root.
    fn sqrt(self) -> Self;

    /// The nearest `f64`.
    fn value(self) -> f64;
}

impl Real for f64 {
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline]
    fn value(self) -> f64 {
        self
    }
}
