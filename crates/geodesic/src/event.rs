use crate::Real;
use glam::DVec3;
use std::marker::PhantomData;
use std::ops::{Add, Mul, Neg, Sub};

/// The components (t, x, y, z) of a four-vector in the frame `F`.
#[derive(Debug, PartialEq)]
pub struct FourVector<F, S = f64> {
    /// Time component (upper index).
    pub t: S,
    /// Space components x, y, z.
    pub space: [S; 3],
    frame: PhantomData<fn() -> F>,
}

/// A point of spacetime, by its coordinates in the frame `F`.
///
/// Events differ by a [`FourVector`]; two events cannot be added.
#[derive(Debug, PartialEq)]
pub struct Event<F>(FourVector<F>);

// Derived impls would ask the same of the frame, which has no values.
impl<F, S: Copy> Copy for FourVector<F, S> {}
impl<F, S: Copy> Clone for FourVector<F, S> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<F> Copy for Event<F> {}
impl<F> Clone for Event<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F, S: Real> FourVector<F, S> {
    /// From components.
    pub fn new(t: S, x: S, y: S, z: S) -> Self {
        Self { t, space: [x, y, z], frame: PhantomData }
    }

    /// The product −t t′ + x x′ + y y′ + z z′, the same in every frame.
    pub fn dot(self, other: Self) -> S {
        let [x, y, z] = self.space;
        let [a, b, c] = other.space;
        x * a + y * b + z * c - self.t * other.t
    }

    /// The same components as plain `f64`.
    pub fn rounded(self) -> FourVector<F> {
        let [x, y, z] = self.space.map(S::value);
        FourVector::new(self.t.value(), x, y, z)
    }
}

impl<F> FourVector<F> {
    /// From the time component and the space components.
    pub fn from_parts(t: f64, space: DVec3) -> Self {
        Self::new(t, space.x, space.y, space.z)
    }

    /// The wave vector K = (−1, n) of light seen from the unit direction `n`: it points back along the light.
    pub fn seen_from(n: DVec3) -> Self {
        Self::from_parts(-1.0, n)
    }

    /// The space components.
    pub fn xyz(self) -> DVec3 {
        DVec3::from_array(self.space)
    }

    /// The same components with the digits of `S`.
    pub fn widened<S: Real>(self) -> FourVector<F, S> {
        let [x, y, z] = self.space.map(S::from);
        FourVector::new(self.t.into(), x, y, z)
    }
}

impl<F, S: Real> Add for FourVector<F, S> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let [x, y, z] = self.space;
        let [a, b, c] = other.space;
        Self::new(self.t + other.t, x + a, y + b, z + c)
    }
}

impl<F, S: Real> Neg for FourVector<F, S> {
    type Output = Self;

    fn neg(self) -> Self {
        let [x, y, z] = self.space;
        Self::new(-self.t, -x, -y, -z)
    }
}

impl<F, S: Real> Sub for FourVector<F, S> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl<F, S: Real> Mul<S> for FourVector<F, S> {
    type Output = Self;

    fn mul(self, by: S) -> Self {
        let [x, y, z] = self.space;
        Self::new(self.t * by, x * by, y * by, z * by)
    }
}

impl<F> Event<F> {
    /// From coordinates.
    pub fn new(t: f64, x: f64, y: f64, z: f64) -> Self {
        Self(FourVector::new(t, x, y, z))
    }

    /// From a time and a position.
    pub fn at(t: f64, position: DVec3) -> Self {
        Self(FourVector::from_parts(t, position))
    }

    /// The origin of the frame.
    pub fn origin() -> Self {
        Self::new(0.0, 0.0, 0.0, 0.0)
    }

    /// Time coordinate.
    pub fn t(self) -> f64 {
        self.0.t
    }

    /// Position.
    pub fn position(self) -> DVec3 {
        self.0.xyz()
    }

    /// The displacement from the frame's origin.
    pub fn coordinates(self) -> FourVector<F> {
        self.0
    }

    /// The displacement from `other` to this event, rounded only as `S` rounds.
    pub fn since<S: Real>(self, other: Self) -> FourVector<F, S> {
        self.0.widened() - other.0.widened()
    }
}

impl<F> Add<FourVector<F>> for Event<F> {
    type Output = Self;

    fn add(self, displacement: FourVector<F>) -> Self {
        Self(self.0 + displacement)
    }
}

impl<F> Sub for Event<F> {
    type Output = FourVector<F>;

    fn sub(self, other: Self) -> FourVector<F> {
        self.0 - other.0
    }
}

impl<F> From<FourVector<F>> for [f64; 4] {
    fn from(vector: FourVector<F>) -> Self {
        let [x, y, z] = vector.space;
        [vector.t, x, y, z]
    }
}

impl<F> From<[f64; 4]> for FourVector<F> {
    fn from([t, x, y, z]: [f64; 4]) -> Self {
        Self::new(t, x, y, z)
    }
}

impl<F> From<[f64; 4]> for Event<F> {
    fn from(x: [f64; 4]) -> Self {
        Self(x.into())
    }
}
