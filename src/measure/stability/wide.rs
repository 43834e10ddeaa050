//! Where a point is seen, to 32 digits.

use crate::relativity::Motion;
use glam::DVec3;
use terrell_geodesic::{Celerity, Event, Real, Wide, World};

/// A point as an observer at rest in the world sees it, in the world's axes.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Apparent position relative to the observer.
    pub position: [Wide; 3],
    /// Apparent distance.
    pub distance: Wide,
    /// Doppler factor.
    pub doppler: Wide,
}

pub(super) type Vector = [Wide; 3];

pub(super) fn dot(a: Vector, b: Vector) -> Wide {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The sum of two, the second multiplied.
pub(super) fn plus(a: Vector, by: Wide, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + by * b[i])
}

/// From the observer's place in the body's rest frame to a point of it.
pub(super) fn offset(motion: &Motion, observer: Event<World>, x_rest: DVec3) -> Vector {
    let rest_from_world = motion.world_from_rest::<Wide>().inverse();
    let observer_rest = rest_from_world * observer.since::<Wide>(motion.origin);
    [0, 1, 2].map(|i| Wide::from(x_rest[i]) - observer_rest.space[i])
}

/// Where a point of a body is seen by an observer at rest in the world (Nollert et al. 2000, Eq. 1).
///
/// Of r′ ± P, with P along the motion, the one that would cancel is taken from their product. So it is within 10⁻³⁰ times
/// the [`conditioning`].
pub fn seen(motion: &Motion, observer: Event<World>, x_rest: DVec3) -> Seen {
    let one = Wide::from(1.0);
    let offset = offset(motion, observer, x_rest);
    let u: Vector = motion.celerity.vector().to_array().map(Wide::from);
    let speed = dot(u, u).sqrt();
    let axis = if speed.high > 0.0 { u.map(|c| c / speed) } else { [one, Wide::from(0.0), Wide::from(0.0)] };
    let along = dot(offset, axis);
    let across = cross(offset, axis);
    let square = dot(across, across);
    let rest_distance = (along * along + square).sqrt();
    let (large, ahead) =
        if along.high >= 0.0 { (rest_distance + along, true) } else { (rest_distance - along, false) };
    let small = if large.high > 0.0 { square / large } else { large };
    let (a, b) = if ahead { (large, small) } else { (small, large) };
    let k = (one + speed * speed).sqrt() + speed;
    let (a, b) = (a / k, b * k);
    let half = Wide::from(0.5);
    let distance = half * (a + b);
    // What is across is kept as it is.
    let position = plus(cross(axis, across), half * (a - b), axis);
    Seen { position, distance, doppler: distance / rest_distance }
}

/// By how much of the apparent distance a point is seen elsewhere, for a relative change of one of the numbers it is computed
/// from: the greatest of all of them.
pub fn conditioning(motion: &Motion, observer: Event<World>, x_rest: DVec3) -> f64 {
    let exact = seen(motion, observer, x_rest);
    let [u, origin, place]: [Vec<f64>; 3] = [
        motion.celerity.vector().to_array().to_vec(),
        <[f64; 4]>::from(motion.origin.coordinates()).to_vec(),
        <[f64; 4]>::from(observer.coordinates()).to_vec(),
    ];
    let inputs: Vec<f64> = [u, origin, place, x_rest.to_array().to_vec()].concat();
    let worst = |i: usize| {
        let (before, after) = (inputs[i], inputs[i].next_up());
        if before == 0.0 {
            return 0.0;
        }
        let mut moved = inputs.clone();
        moved[i] = after;
        let Ok(celerity) = Celerity::new(DVec3::from_slice(&moved[..3])) else { return 0.0 };
        let event = |at: usize| Event::new(moved[at], moved[at + 1], moved[at + 2], moved[at + 3]);
        let other = seen(&Motion { celerity, origin: event(3) }, event(7), DVec3::from_slice(&moved[11..]));
        let change = plus(other.position, Wide::from(-1.0), exact.position);
        let relative = ((Wide::from(after) - Wide::from(before)) / Wide::from(before)).value().abs();
        dot(change, change).sqrt().value() / exact.distance.value() / relative
    };
    (0..inputs.len()).map(worst).fold(0.0, f64::max)
}
