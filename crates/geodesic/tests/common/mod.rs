//! What the tests of curved light share: reference values, and rays set up by hand.
#![allow(dead_code, reason = "every test file uses its own part")]

use glam::DVec3;
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use terrell_geodesic::{
    Curved, End, Event, FourVector, Law, LightRay, LocalFrame, Ray, Segment, Spacetime, World,
};

/// One block of `reference/curved.json` (G = c = M = 1, 20 digits).
pub fn reference(block: &str) -> Value {
    let all: Value = serde_json::from_str(include_str!("../reference/curved.json")).unwrap();
    all[block].clone()
}

/// A number that may be written as a string of 20 digits.
pub fn number(value: &Value) -> f64 {
    match value {
        Value::String(digits) => digits.parse().unwrap(),
        other => other.as_f64().unwrap_or_else(|| panic!("{other} is no number")),
    }
}

/// The list a block is.
pub fn rows(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap()
}

/// `k` with its time component put so that it is null and to the past, the space part kept.
pub fn null_to_past(space: &impl Spacetime, at: Event<World>, direction: DVec3) -> FourVector<World> {
    let t = FourVector::new(1.0, 0.0, 0.0, 0.0);
    let n = FourVector::from_parts(0.0, direction);
    let (a, b, c) = (space.product(at, t, t), space.product(at, t, n), space.product(at, n, n));
    n + t * ((-b + (b * b - a * c).sqrt()) / a)
}

/// The angle through which a ray near the z axis's plane turned, counted on while it passes half-turns: from the
/// directions of all its segments.
pub fn total_turn<L: Law>(ray: &mut LightRay<'_, L>) -> (f64, End) {
    let mut last: Option<DVec3> = None;
    let mut turned = 0.0;
    for segment in ray.by_ref() {
        let direction = segment.direction.xyz().normalize();
        if let Some(last) = last {
            turned += last.angle_between(direction);
        }
        last = Some(direction);
    }
    (turned, ray.end().unwrap())
}

/// The turn from `first` to `last` that is nearest to a rough count of it, in a plane through the origin.
pub fn refine_turn(first: DVec3, last: DVec3, rough: f64) -> f64 {
    let angle = first.cross(last).length().atan2(first.dot(last));
    [0.0, 1.0, 2.0, 3.0]
        .into_iter()
        .flat_map(|turns| [TAU * turns + angle, TAU * turns - angle])
        .min_by(|a, b| (a - rough).abs().total_cmp(&(b - rough).abs()))
        .unwrap()
}

/// The sky direction of a ray that escaped.
pub fn sky(end: End) -> DVec3 {
    match end {
        End::Sky { wave_vector } => wave_vector.xyz().normalize(),
        other => panic!("the ray {other}"),
    }
}

/// Bisects for the parameter in [inside, outside] at which rays change from captured to escaping.
pub fn capture_boundary(mut inside: f64, mut outside: f64, end: impl Fn(f64) -> End) -> f64 {
    assert_eq!(end(inside), End::Horizon);
    assert!(matches!(end(outside), End::Sky { .. }), "{:?}", end(outside));
    while (outside - inside).abs() > 1e-13 * outside.abs().max(inside.abs()) {
        let middle = 0.5 * (inside + outside);
        if middle == inside || middle == outside {
            break;
        }
        match end(middle) {
            End::Horizon => inside = middle,
            End::Sky { .. } => outside = middle,
            other => panic!("at {middle} the ray {other}"),
        }
    }
    0.5 * (inside + outside)
}

/// The exact events and wave vectors where `f` of the event changes sign along a ray, found by bisection on the
/// continuation within the segments, up to `most` of them.
pub fn crossings<R: Ray>(
    ray: &mut R,
    most: usize,
    f: impl Fn(Event<World>) -> f64,
) -> Vec<(Event<World>, FourVector<World>)> {
    let mut found = Vec::new();
    while found.len() < most {
        let Some(Segment { from, length, .. }) = ray.next() else { break };
        let to = from + length.min(1e9);
        // In quarters, because a long chord may cross twice.
        for quarter in 0..4 {
            let (mut low, mut high) = (
                from + (to - from) * 0.25 * f64::from(quarter),
                from + (to - from) * 0.25 * f64::from(quarter + 1),
            );
            let sign = f(ray.at(low).0).signum();
            if f(ray.at(high).0).signum() == sign || f(ray.at(low).0) == 0.0 {
                continue;
            }
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if f(ray.at(middle).0).signum() == sign { low = middle } else { high = middle }
            }
            found.push(ray.at(0.5 * (low + high)));
        }
    }
    found.truncate(most);
    found
}

/// A frame at `event` of an observer who looks along −x with z up.
pub fn looking_inwards(space: &impl Spacetime, event: Event<World>, u: FourVector<World>) -> LocalFrame {
    LocalFrame::new(space, event, u, -DVec3::X, DVec3::Z).unwrap()
}

/// An angle brought to (−π, π].
pub fn principal(angle: f64) -> f64 {
    let angle = angle.rem_euclid(TAU);
    if angle > PI { angle - TAU } else { angle }
}

/// A ray of a spacetime followed to its end.
pub fn end_of<L: Law>(space: &Curved<L>, event: Event<World>, k: FourVector<World>) -> End {
    space.ray(event, k).follow()
}
