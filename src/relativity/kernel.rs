//! The apparent map's inner loop, written once for f64 and f32, scalar and vector.

use std::ops::{Add, Div, Mul, Neg, Sub};
use terrell_geodesic::Wide;

/// The number a vertex is stored in: `f64` or `f32`.
pub trait Lane:
    Copy
    + Send
    + Sync
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + sealed::Sealed
{
    #[doc(hidden)]
    const ZERO: Self;
    #[doc(hidden)]
    const HALF: Self;
    /// The leading half of the significand, so that products of two such are exact.
    #[doc(hidden)]
    fn top(self) -> Self;
    #[doc(hidden)]
    fn root(self) -> Self;
    #[doc(hidden)]
    fn magnitude(self) -> Self;
    #[doc(hidden)]
    fn fused(self, by: Self, plus: Self) -> Self;
    /// The nearest number, and what it leaves over.
    #[doc(hidden)]
    fn split_wide(value: Wide) -> Pair<Self>;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}

macro_rules! lane {
    ($number:ty, low bits $half:literal, $split_wide:expr) => {
        impl Lane for $number {
            const ZERO: Self = 0.0;
            const HALF: Self = 0.5;
            #[inline(always)]
            fn top(self) -> Self {
                Self::from_bits(self.to_bits() & (!0 << $half))
            }
            #[inline(always)]
            fn root(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn magnitude(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            fn fused(self, by: Self, plus: Self) -> Self {
                self.mul_add(by, plus)
            }
            fn split_wide(value: Wide) -> Pair<Self> {
                $split_wide(value)
            }
        }
    };
}

lane!(f64, low bits 27, |value: Wide| Pair { high: value.high, low: value.low });
lane!(f32, low bits 12, |value: Wide| {
    let high = value.high as f32;
    Pair { high, low: ((value.high - f64::from(high)) + value.low) as f32 }
});

/// An unevaluated sum high + low.
#[derive(Clone, Copy, Debug)]
pub struct Pair<R> {
    pub(super) high: R,
    pub(super) low: R,
}

/// What the map of one body and one observer needs at every vertex, in the body's rest frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Constants<R> {
    /// The observer's position across the axis; small, where the position itself is γ times as large as
    /// distances in the world are.
    pub across: [Pair<R>; 3],
    /// The observer's position along the axis.
    pub along: Pair<R>,
    /// Unit vector of the relative motion.
    pub axis: [Pair<R>; 3],
    /// k = γ + |u|, the Doppler factor dead ahead of the approaching body, and 1/k.
    pub k: Pair<R>,
    pub inverse_k: Pair<R>,
    /// Rows: the observer's axes.
    pub axes: [[R; 3]; 3],
}

impl<R: Lane> Constants<R> {
    /// Whether the axis is +x to the last digit.
    fn is_aligned(&self) -> bool {
        let [x, y, z] = self.axis;
        let zero = |r: R| r == R::ZERO;
        [x.low, y.high, y.low, z.high, z.low].into_iter().all(zero) && x.high > R::ZERO
    }
}

/// A vertex as it is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<R> {
    /// Relative to the observer: in the observer's axes if rotated, else in the body's.
    pub position: [R; 3],
    pub distance: R,
    pub doppler: R,
    /// In the rest frame: distance r′ and offset P along the motion.
    pub rest_distance: R,
    pub rest_along: R,
    pub along: R,
}

/// How an offset is taken apart along and across the axis, (x′·axis, x′ × axis), with the last digit right
/// even where the products cancel: from plain products a point at 10⁻⁹ off the axis would lose nine digits.
pub(super) trait Decompose {
    fn decomposed<R: Lane>(offset: [Pair<R>; 3], axis: &[Pair<R>; 3]) -> (Pair<R>, [Pair<R>; 3]);
}

/// The axis is +x exactly: nothing cancels.
pub(super) struct Aligned;
/// With a fused multiply-add.
pub(super) struct Fused;
/// With plain multiplications, on halves of the significands whose products are exact.
pub(super) struct Halved;

impl Decompose for Aligned {
    #[inline(always)]
    fn decomposed<R: Lane>([x, y, z]: [Pair<R>; 3], _axis: &[Pair<R>; 3]) -> (Pair<R>, [Pair<R>; 3]) {
        let none = Pair { high: R::ZERO, low: R::ZERO };
        (x, [none, z, Pair { high: -y.high, low: -y.low }])
    }
}

impl Decompose for Fused {
    #[inline(always)]
    fn decomposed<R: Lane>([x, y, z]: [Pair<R>; 3], [a, b, c]: &[Pair<R>; 3]) -> (Pair<R>, [Pair<R>; 3]) {
        // Σ high·low + low·high, on top of what the leading products leave over.
        let minor = |p: Pair<R>, q: &Pair<R>, rest: R| p.high.fused(q.low, p.low.fused(q.high, rest));
        // Kahan's difference of products: p q − s t with both roundings taken back.
        let difference = |p: Pair<R>, q: &Pair<R>, s: Pair<R>, t: &Pair<R>| {
            let less = s.high * t.high;
            let rest = (-s.high).fused(t.high, less);
            let whole = p.high.fused(q.high, -less);
            let negative = Pair { high: -s.high, low: -s.low };
            Pair { high: whole, low: minor(p, q, minor(negative, t, rest)) }
        };
        let first = x.high * a.high;
        let rest = x.high.fused(a.high, -first);
        let second = y.high.fused(b.high, first);
        let along =
            Pair { high: z.high.fused(c.high, second), low: minor(x, a, minor(y, b, minor(z, c, rest))) };
        (along, [difference(y, c, z, b), difference(z, a, x, c), difference(x, b, y, a)])
    }
}

impl Decompose for Halved {
    #[inline(always)]
    fn decomposed<R: Lane>(offset: [Pair<R>; 3], axis: &[Pair<R>; 3]) -> (Pair<R>, [Pair<R>; 3]) {
        let halves = |p: Pair<R>| {
            let top = p.high.top();
            (top, (p.high - top) + p.low)
        };
        let [x, y, z] = offset.map(halves);
        let [a, b, c] = axis.map(halves);
        let difference = |(p1, p2): (R, R), (q1, q2): (R, R), (s1, s2): (R, R), (t1, t2): (R, R)| Pair {
            high: p1 * q1 - s1 * t1,
            low: ((p1 * q2 - s1 * t2) + (p2 * q1 - s2 * t1)) + (p2 * q2 - s2 * t2),
        };
        let minor = |(p1, p2): (R, R), (q1, q2): (R, R)| p1 * q2 + p2 * (q1 + q2);
        let along =
            Pair { high: x.0 * a.0 + y.0 * b.0 + z.0 * c.0, low: minor(x, a) + minor(y, b) + minor(z, c) };
        (along, [difference(y, c, z, b), difference(z, a, x, c), difference(x, b, y, a)])
    }
}

#[inline(always)]
fn two_sum<R: Lane>(a: R, b: R) -> Pair<R> {
    let high = a + b;
    let b_part = high - a;
    Pair { high, low: (a - (high - b_part)) + (b - b_part) }
}

/// A boosted null vector.
struct Boosted<R> {
    /// r′ and r.
    before: R,
    after: R,
    /// x along the axis.
    along: R,
    /// x across the axis.
    beside: [R; 3],
}

impl<R: Lane> Boosted<R> {
    #[inline(always)]
    fn position(&self, axis: [R; 3]) -> [R; 3] {
        let [x, y, z] = self.beside;
        [self.along * axis[0] + x, self.along * axis[1] + y, self.along * axis[2] + z]
    }
}

/// The boost of the null vector (−r′, x′) given its parts: along the axis (P) and across it (x′ × axis).
///
/// With a = r′ + P and b = r′ − P, the one that cancels replaced through a·b = Q²:
/// r = (k·b + a/k)/2, x∥ = (a/k − k·b)/2. Every step is backward stable, at every γ.
#[inline(always)]
fn boosted<R: Lane>(
    along: R,
    across: [Pair<R>; 3],
    axis: [R; 3],
    k: Pair<R>,
    inverse_k: Pair<R>,
) -> Boosted<R> {
    // What rounding x′ × axis takes off matters to Q², twice.
    let across = across.map(|w| {
        let high = w.high + w.low;
        Pair { high, low: (w.high - high) + w.low }
    });
    let minor = across.map(|w| w.high * w.low);
    let rest = minor[0] + minor[1] + minor[2];
    let [wx, wy, wz] = across;
    let square = wx.high * wx.high + wy.high * wy.high + wz.high * wz.high + (rest + rest);
    let before = (along * along + square).root();
    let large = before + along.magnitude();
    let small = if large > R::ZERO { square / large } else { R::ZERO };
    let ahead = along >= R::ZERO;
    let (a, b) = (if ahead { large } else { small }, if ahead { small } else { large });
    let a = a * inverse_k.high + a * inverse_k.low;
    let b = b * k.high + b * k.low;
    let [x, y, z] = axis;
    let [wx, wy, wz] = across.map(|w| w.high);
    Boosted {
        before,
        after: R::HALF * (a + b),
        along: R::HALF * (a - b),
        // axis × (x′ × axis) is the part of x′ across the axis, with the digits of the cross product.
        beside: [y * wz - z * wy, z * wx - x * wz, x * wy - y * wx],
    }
}

#[inline(always)]
fn rotated<R: Lane>(axes: &[[R; 3]; 3], [x, y, z]: [R; 3]) -> [R; 3] {
    axes.map(|[a, b, c]| a * x + b * y + c * z)
}

/// Rest-frame vertex to apparent vertex.
#[inline(always)]
pub(super) fn see<R: Lane, D: Decompose, const ROTATE: bool>(c: &Constants<R>, x: [R; 3]) -> Seen<R> {
    let offset = |i: usize| {
        let o = c.across[i];
        let d = two_sum(x[i], -o.high);
        Pair { high: d.high, low: d.low - o.low }
    };
    let axis = [c.axis[0].high, c.axis[1].high, c.axis[2].high];
    let (along, across) = D::decomposed([offset(0), offset(1), offset(2)], &c.axis);
    let rest_along = (along.high - c.along.high) + (along.low - c.along.low);
    let light = boosted(rest_along, across, axis, c.k, c.inverse_k);
    let position = light.position(axis);
    Seen {
        position: if ROTATE { rotated(&c.axes, position) } else { position },
        distance: light.after,
        doppler: light.after / light.before,
        rest_distance: light.before,
        rest_along,
        along: light.along,
    }
}

/// Apparent position (relative to the observer, in its axes) back to the rest-frame vertex.
pub(super) fn unsee(c: &Constants<f64>, seen: [f64; 3]) -> ([f64; 3], Seen<f64>) {
    let [right, up, forward] = c.axes;
    let aligned: [f64; 3] = [0, 1, 2].map(|i| right[i] * seen[0] + up[i] * seen[1] + forward[i] * seen[2]);
    let axis = c.axis.map(|a| a.high);
    let (along, across) = Halved::decomposed(aligned.map(|v| Pair { high: v, low: 0.0 }), &c.axis);
    let along = along.high + along.low;
    let light = boosted(along, across, axis, c.inverse_k, c.k);
    // Along the axis both summands may be large, and their sum small.
    let whole_along = (light.along + c.along.high) + c.along.low;
    let vertex =
        [0, 1, 2].map(|i| (light.beside[i] + whole_along * axis[i]) + (c.across[i].high + c.across[i].low));
    // The boost back: what it calls before is seen.
    let doppler = light.before / light.after;
    let (distance, rest_distance, rest_along) = (light.before, light.after, light.along);
    (vertex, Seen { position: seen, distance, doppler, rest_distance, rest_along, along })
}

/// Points as three slices of equal length.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a, R> {
    /// x of every point.
    pub x: &'a [R],
    /// y of every point.
    pub y: &'a [R],
    /// z of every point.
    pub z: &'a [R],
}

/// Apparent points to be filled: five slices, as long as the [`Points`] mapped into them.
#[derive(Debug)]
pub struct PointsMut<'a, R> {
    /// Apparent position, x.
    pub x: &'a mut [R],
    /// Apparent position, y.
    pub y: &'a mut [R],
    /// Apparent position, z.
    pub z: &'a mut [R],
    /// Apparent distance r.
    pub distance: &'a mut [R],
    /// Doppler factor D = r/r′.
    pub doppler: &'a mut [R],
}

#[inline(always)]
fn see_all<R: Lane, D: Decompose, const ROTATE: bool>(
    c: &Constants<R>,
    from: Points<'_, R>,
    to: PointsMut<'_, R>,
) {
    // One length for all slices lets the compiler drop the bounds checks and use vectors.
    let n = from.x.len();
    let (x, y, z) = (&from.x[..n], &from.y[..n], &from.z[..n]);
    let (tx, ty, tz) = (&mut to.x[..n], &mut to.y[..n], &mut to.z[..n]);
    let (distance, doppler) = (&mut to.distance[..n], &mut to.doppler[..n]);
    for i in 0..n {
        let seen = see::<R, D, ROTATE>(c, [x[i], y[i], z[i]]);
        tx[i] = seen.position[0];
        ty[i] = seen.position[1];
        tz[i] = seen.position[2];
        distance[i] = seen.distance;
        doppler[i] = seen.doppler;
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn see_all_avx2<R: Lane, D: Decompose, const ROTATE: bool>(
    c: &Constants<R>,
    from: Points<'_, R>,
    to: PointsMut<'_, R>,
) {
    see_all::<R, D, ROTATE>(c, from, to);
}

/// Maps all points: where the motion is along x without the products that could cancel, and with AVX2 and
/// FMA where the processor has them and `vectors` allows.
///
/// # Panics
/// If the slices differ in length.
pub(super) fn run<R: Lane, const ROTATE: bool>(
    c: &Constants<R>,
    from: Points<'_, R>,
    to: PointsMut<'_, R>,
    vectors: bool,
) {
    let aligned = c.is_aligned();
    #[cfg(target_arch = "x86_64")]
    if vectors && crate::processor::has_avx2() {
        // SAFETY: the processor has both features.
        return unsafe {
            if aligned {
                see_all_avx2::<R, Aligned, ROTATE>(c, from, to)
            } else {
                see_all_avx2::<R, Fused, ROTATE>(c, from, to)
            }
        };
    }
    let _ = vectors;
    if aligned {
        see_all::<R, Aligned, ROTATE>(c, from, to)
    } else {
        see_all::<R, Halved, ROTATE>(c, from, to)
    }
}
