use glam::{DAffine3, DQuat, DVec3};
use std::sync::Arc;

/// How a mesh moves rigidly within its body's rest frame: an animation slow against light.
///
/// Only one pose is shown at a time: that of the moment at which the light now seen left the mesh's middle. A
/// point farther away or nearer by Δr′ is then off by v·Δr′, so that v, its speed in the rest frame, must be
/// small.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// From the outermost to the mesh's own.
    pub joints: Vec<Joint>,
    /// Length in seconds of the clip; then it begins again.
    pub period: f64,
    /// Seconds of the clip that pass in a unit of the body's own time.
    pub rate: f64,
}

/// A placement within the one before it.
#[derive(Clone, Debug, PartialEq)]
pub enum Joint {
    /// Always the same.
    Fixed(DAffine3),
    /// A scale, then a rotation, then a shift, each of which may change.
    Moving {
        /// The shift.
        translation: Track<DVec3>,
        /// The rotation.
        rotation: Track<DQuat>,
        /// The scale.
        scale: Track<DVec3>,
    },
}

/// A value over time; copies share it.
#[derive(Clone, Debug, PartialEq)]
pub struct Track<T> {
    times: Arc<[f64]>,
    values: Arc<[T]>,
    between: Between,
}

/// What happens between the keys of a [`Track`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// The earlier key's value.
    Step,
    /// A straight line; for rotations, the shortest turn.
    Linear,
    /// A cubic with given slopes: three values a key, the slope before it, the value, the slope behind it.
    Cubic,
}

/// A value that can be blended.
pub trait Blend: Copy {
    /// From `a` (at 0) to `b` (at 1).
    fn line(a: Self, b: Self, t: f64) -> Self;
    /// Σ wᵢ vᵢ, made valid again.
    fn sum(terms: [(f64, Self); 4]) -> Self;
    /// Whether it is made of numbers, and a value of its kind.
    fn is_valid(self) -> bool;
}

impl Blend for DVec3 {
    fn line(a: Self, b: Self, t: f64) -> Self {
        a.lerp(b, t)
    }

    fn sum(terms: [(f64, Self); 4]) -> Self {
        terms.into_iter().map(|(w, v)| w * v).sum()
    }

    fn is_valid(self) -> bool {
        self.is_finite()
    }
}

impl Blend for DQuat {
    fn line(a: Self, b: Self, t: f64) -> Self {
        a.slerp(b, t)
    }

    fn sum(terms: [(f64, Self); 4]) -> Self {
        let mut sum = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        terms.into_iter().for_each(|(w, v)| sum += v * w);
        if sum.length_squared() > 0.0 { sum.normalize() } else { DQuat::IDENTITY }
    }

    fn is_valid(self) -> bool {
        self.is_finite()
    }
}

impl<T: Blend> Track<T> {
    /// What never changes.
    pub fn fixed(value: T) -> Self {
        Self { times: [0.0].into(), values: [value].into(), between: Between::Step }
    }

    /// Values at rising times in seconds (three values a time for [`Between::Cubic`]); none if that is not what they
    /// are.
    pub fn new(times: Vec<f64>, values: Vec<T>, between: Between) -> Option<Self> {
        let needed = times.len() * if between == Between::Cubic { 3 } else { 1 };
        let rising = times.windows(2).all(|t| t[0] < t[1]) && times.iter().all(|t| t.is_finite());
        let good =
            !times.is_empty() && rising && values.len() == needed && values.iter().all(|v| v.is_valid());
        good.then(|| Self { times: times.into(), values: values.into(), between })
    }

    /// The value at a time; before the first key and after the last, theirs.
    pub fn at(&self, seconds: f64) -> T {
        let after = self.times.partition_point(|t| *t <= seconds);
        let value =
            |i: usize| if self.between == Between::Cubic { self.values[3 * i + 1] } else { self.values[i] };
        if after == 0 || after == self.times.len() {
            return value(after.saturating_sub(1));
        }
        let (i, j) = (after - 1, after);
        let span = self.times[j] - self.times[i];
        let t = (seconds - self.times[i]) / span;
        match self.between {
            Between::Step => value(i),
            Between::Linear => T::line(value(i), value(j), t),
            Between::Cubic => {
                let (t2, t3) = (t * t, t * t * t);
                T::sum([
                    (2.0 * t3 - 3.0 * t2 + 1.0, value(i)),
                    (span * (t3 - 2.0 * t2 + t), self.values[3 * i + 2]),
                    (-2.0 * t3 + 3.0 * t2, value(j)),
                    (span * (t3 - t2), self.values[3 * j]),
                ])
            }
        }
    }

    fn last(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }
}

impl Joint {
    fn at(&self, seconds: f64) -> DAffine3 {
        match self {
            Self::Fixed(place) => *place,
            Self::Moving { translation, rotation, scale } => DAffine3::from_scale_rotation_translation(
                scale.at(seconds),
                rotation.at(seconds),
                translation.at(seconds),
            ),
        }
    }

    fn key_times(&self) -> Vec<f64> {
        match self {
            Self::Fixed(_) => Vec::new(),
            Self::Moving { translation, rotation, scale } => {
                [&translation.times, &rotation.times, &scale.times]
                    .map(|t| t.iter())
                    .into_iter()
                    .flatten()
                    .copied()
                    .collect()
            }
        }
    }
}

impl Clip {
    /// The greatest speed a clip may have, in units of that of light.
    pub const FASTEST: f64 = 0.1;

    /// A clip as long as its tracks, a second of it to a unit of time.
    pub fn new(joints: Vec<Joint>) -> Self {
        let last = |joint: &Joint| match joint {
            Joint::Fixed(_) => 0.0,
            Joint::Moving { translation, rotation, scale } => {
                translation.last().max(rotation.last()).max(scale.last())
            }
        };
        let period = joints.iter().map(last).fold(0.0, f64::max);
        Self { joints, period, rate: 1.0 }
    }

    /// Where the mesh is at a moment of the rest frame.
    pub fn pose(&self, time_rest: f64) -> DAffine3 {
        let seconds = self.rate * time_rest;
        let seconds = if self.period > 0.0 { seconds.rem_euclid(self.period) } else { 0.0 };
        self.pose_in_clip(seconds)
    }

    fn pose_in_clip(&self, seconds: f64) -> DAffine3 {
        self.joints.iter().fold(DAffine3::IDENTITY, |place, joint| place * joint.at(seconds))
    }

    /// Moves and turns everything, at all times.
    pub fn placed(mut self, place: DAffine3) -> Self {
        self.joints.insert(0, Joint::Fixed(place));
        self
    }

    /// The greatest speed, in units of that of light, of any corner of a box within the rest frame; measured
    /// between keys and at points between these.
    pub fn greatest_speed(&self, (low, high): (DVec3, DVec3)) -> f64 {
        /// Points between two keys, as long as there are not too many keys.
        const BETWEEN: usize = 16;
        const MOST: usize = 20_000;
        let mut keys: Vec<f64> = self.joints.iter().flat_map(Joint::key_times).collect();
        keys.push(0.0);
        keys.retain(|t| (0.0..=self.period).contains(t));
        keys.sort_by(f64::total_cmp);
        keys.dedup();
        let steps = (MOST / keys.len()).clamp(1, BETWEEN);
        let corners: Vec<DVec3> = (0..8)
            .map(|i| {
                let of = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
                DVec3::new(of(0), of(1), of(2))
            })
            .collect();
        let mut greatest: f64 = 0.0;
        for pair in keys.windows(2) {
            let step = (pair[1] - pair[0]) / steps as f64;
            let mut before = self.pose_in_clip(pair[0]);
            for k in 1..=steps {
                // Not the last instant itself: a jump between steps is none of the motion's.
                let at = pair[0] + step * (k as f64 - if k == steps { 1e-6 } else { 0.0 });
                let after = self.pose_in_clip(at);
                for corner in &corners {
                    let way = after.transform_point3(*corner) - before.transform_point3(*corner);
                    greatest = greatest.max(way.length() / step);
                }
                before = after;
            }
        }
        greatest * self.rate.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Turns once about z in four seconds.
    fn wheel() -> Clip {
        let quarter = |i: usize| DQuat::from_rotation_z(TAU * i as f64 / 4.0);
        let rotation =
            Track::new((0..5).map(|i| i as f64).collect(), (0..5).map(quarter).collect(), Between::Linear);
        Clip::new(vec![
            Joint::Fixed(DAffine3::from_translation(DVec3::Y)),
            Joint::Moving {
                translation: Track::fixed(DVec3::ZERO),
                rotation: rotation.unwrap(),
                scale: Track::fixed(DVec3::ONE),
            },
        ])
    }

    #[test]
    fn a_wheel_turns_and_begins_again() {
        let wheel = wheel();
        for turns in [0.0, 1.0, -3.0] {
            let at = wheel.pose(4.0 * turns + 0.5).transform_point3(DVec3::X);
            let (sin, cos) = (TAU / 8.0).sin_cos();
            assert!((at - DVec3::new(cos, 1.0 + sin, 0.0)).length() < 1e-12, "{at}");
        }
        // The rim, at 2π/4; the box's corner is √2 out. Chords of sixteenths of a quarter are 0.04 % short.
        let speed = wheel.greatest_speed((DVec3::new(-1.0, -1.0, 0.0), DVec3::ONE.with_z(0.0)));
        assert!((speed / (TAU / 4.0 * 2f64.sqrt()) - 1.0).abs() < 1e-3, "{speed}");
    }

    #[test]
    fn cubics_go_through_their_keys_with_their_slopes() {
        let values = [0.0, 1.0, 2.0, -1.0, 3.0, 0.0].map(DVec3::splat).to_vec();
        let track = Track::new(vec![1.0, 3.0], values, Between::Cubic).unwrap();
        assert_eq!(track.at(0.0), DVec3::splat(1.0));
        assert_eq!(track.at(9.0), DVec3::splat(3.0));
        let slope = |t: f64| (track.at(t + 1e-6).x - track.at(t).x) / 1e-6;
        assert!((slope(1.0) - 2.0).abs() < 1e-4);
        assert!((slope(3.0 - 1e-6) + 1.0).abs() < 1e-4);
    }

    #[test]
    fn odd_tracks_are_none() {
        let v = DVec3::ONE;
        assert!(Track::new(vec![], Vec::<DVec3>::new(), Between::Linear).is_none());
        assert!(Track::new(vec![1.0, 1.0], vec![v, v], Between::Linear).is_none());
        assert!(Track::new(vec![0.0, f64::NAN], vec![v, v], Between::Linear).is_none());
        assert!(Track::new(vec![0.0, 1.0], vec![v, v], Between::Cubic).is_none());
    }
}
