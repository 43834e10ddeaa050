mod chords;

use crate::law::split;
use crate::{Accuracy, End, Event, FourVector, Law, Monitor, Ray, Segment, Stop, World};
use chords::Step;
use std::collections::VecDeque;

/// A ray of a [`Curved`](crate::Curved) spacetime: integrated step by step, handed out chord by chord.
pub struct LightRay<'a, L> {
    law: &'a L,
    accuracy: Accuracy,
    /// The affine parameter up to which it is integrated, and the state and its derivative there.
    s: f64,
    state: [f64; 8],
    slope: [f64; 8],
    /// The step to try next.
    h: f64,
    /// The eighth root of the tolerance, in which steps are measured beforehand.
    stride: f64,
    /// Error and length of the last accepted step.
    before: Option<(f64, f64)>,
    outward: Option<Outward>,
    off_cone: f64,
    /// Why the integration ended.
    integrated: Option<End>,
    steps: VecDeque<Step>,
    /// Where the next chord begins: affine parameter and event.
    from: f64,
    start: [f64; 4],
    /// Length of the last chord.
    length: f64,
    /// The last segment's direction where it runs to infinity.
    infinite: Option<Segment>,
    finished: bool,
    monitor: Monitor,
}

/// What was before the last step, to foretell what is to come on the way out.
struct Outward {
    r: f64,
    wave: [f64; 4],
    change: [f64; 4],
}

impl<'a, L: Law> LightRay<'a, L> {
    pub(crate) fn new(
        law: &'a L,
        accuracy: Accuracy,
        event: Event<World>,
        wave_vector: FourVector<World>,
    ) -> Self {
        let start: [f64; 4] = event.coordinates().into();
        let k: [f64; 4] = wave_vector.into();
        let mut ray = Self {
            law,
            accuracy,
            s: 0.0,
            state: [f64::NAN; 8],
            slope: [f64::NAN; 8],
            h: 0.0,
            stride: accuracy.tolerance.powf(0.125),
            before: None,
            outward: None,
            off_cone: 0.0,
            integrated: None,
            steps: VecDeque::new(),
            from: 0.0,
            start,
            length: 0.0,
            infinite: None,
            finished: false,
            monitor: Monitor::default(),
        };
        ray.integrated = ray.begin(start, k).err();
        ray
    }

    fn begin(&mut self, x: [f64; 4], k: [f64; 4]) -> Result<(), End> {
        if !x.iter().chain(&k).all(|c| c.is_finite()) {
            return Err(End::NotANumber);
        }
        if let Some(stop) = self.law.stop(x) {
            return Err(stop.into());
        }
        if let Some(fault) = self.law.fault(x) {
            return Err(fault);
        }
        self.state = self.law.state(x, k);
        self.slope = self.law.derivative(&self.state);
        self.monitor.evaluations = 1;
        if !self.slope.iter().all(|c| c.is_finite()) {
            return Err(End::NotANumber);
        }
        self.off_cone = self.law.off_cone(&self.state, &self.slope).unwrap_or(0.0);
        let speed = length(&k[1..]);
        if speed == 0.0 {
            return Err(End::NotANumber);
        }
        // A fifth of the way to the origin at a tolerance of 1e-8; refused if that is too far.
        self.h = 2.0 * self.stride * (self.law.scale() + length(&x[1..])) / speed;
        self.shorten();
        Ok(())
    }

    /// Integrates one more step, keeping its continuation if `dense`.
    fn advance(&mut self, dense: bool) -> Option<End> {
        match self.try_advance(dense) {
            Ok(()) => None,
            Err(end) => {
                self.integrated = Some(end);
                Some(end)
            }
        }
    }

    fn try_advance(&mut self, keep: bool) -> Result<(), End> {
        let Accuracy { method, tolerance, .. } = self.accuracy;
        let law = self.law;
        let f = |y: &[f64; 8]| law.derivative(y);
        let mut grow = true;
        loop {
            if self.monitor.steps + self.monitor.refused >= self.accuracy.steps {
                return Err(End::StepLimit);
            }
            let trial = method.step(&f, &self.state, &self.slope, self.h);
            self.monitor.evaluations += method.stages();
            let error = trial.error(method, &self.allowed(&trial.end, tolerance));
            if error.is_nan() || error > 1.0 || !error.is_finite() {
                self.monitor.refused += 1;
                grow = false;
                self.h *= if error.is_finite() { method.rescaling(error).min(0.9) } else { 0.2 };
                // Smaller, and it would no longer change where the ray is.
                let reach = self.h * length(&self.slope[1..4]);
                if reach < 1e-13 * (self.law.scale() + length(&self.state[1..4])) {
                    let ahead: [f64; 4] =
                        std::array::from_fn(|i| self.state[i] + 8.0 * self.h * self.slope[i]);
                    return Err(self.law.fault(ahead).unwrap_or(End::StepLimit));
                }
                continue;
            }
            let (slope, count) = method.slope_at_end(&f, &trial);
            self.monitor.evaluations += count;
            if !slope.iter().all(|c| c.is_finite()) {
                self.monitor.refused += 1;
                grow = false;
                self.h *= 0.2;
                continue;
            }
            let stop = law.stop(split(&trial.end).0);
            if keep || stop.is_some() {
                let (dense, count) = method.dense(&f, &self.state, &trial, &slope, self.h);
                self.monitor.evaluations += count;
                self.steps.push_back(Step::new(self.s, self.h, dense, self.h));
            }
            self.s += self.h;
            self.monitor.steps += 1;
            let taken = self.h;
            let mut factor = method.rescaling(error);
            if let Some((before, length)) = self.before {
                // Where steps have to become shorter one after the other, as on the way in, the next one will have
                // to as well (K. Gustafsson, ACM Trans. Math. Softw. 20 (1994) 496).
                factor = factor.min(factor * method.trend(taken / length, before / error));
            }
            self.h *= if grow { factor } else { factor.min(1.0) };
            self.before = Some((error.max(1e-6), taken));
            self.outward = Some(Outward {
                r: length(&self.state[1..4]),
                wave: split(&self.state).1,
                change: split(&self.slope).1,
            });
            self.state = trial.end;
            self.slope = slope;
            self.shorten();
            if let Some(stop) = stop {
                self.locate();
                return Err(stop.into());
            }
            if let Some(off) = law.off_cone(&self.state, &self.slope) {
                let drift = (off - self.off_cone).abs();
                self.monitor.drift = self.monitor.drift.max(drift);
                if drift.is_nan() || drift > self.accuracy.drift {
                    return Err(End::Drift);
                }
            }
            return match self.escaped() {
                Some(wave_vector) => Err(End::Sky { wave_vector }),
                None => Ok(()),
            };
        }
    }

    /// Keeps the next step from leaping over what is near the origin: no estimate of its error would tell.
    fn shorten(&mut self) {
        let place = &self.state[1..4];
        let velocity = &self.slope[1..4];
        let r = length(place);
        let inward = -(0..3).map(|i| place[i] * velocity[i]).sum::<f64>() > 0.5 * r * length(velocity);
        // About half of the way in at a tolerance of 1e-8: what would be refused is not tried.
        let most = if inward { (5.5 * self.stride).min(0.8) } else { 6.0 } * (self.law.scale() + r)
            / length(velocity);
        self.h = self.h.min(most);
    }

    /// What error each component may have in a step.
    #[inline(always)]
    fn allowed(&self, end: &[f64; 8], tolerance: f64) -> [f64; 8] {
        let before = &self.state;
        let place = tolerance * (self.law.scale() + length(&before[1..4]).max(length(&end[1..4])));
        let wave = tolerance * length(&before[4..]).max(length(&end[4..]));
        [place, place, place, place, wave, wave, wave, wave]
    }

    /// Cuts the last step where the ray first stops.
    fn locate(&mut self) {
        let Some(step) = self.steps.back_mut() else { return };
        let (mut before, mut after) = (0.0, 1.0);
        // To a millionth of the step.
        for _ in 0..20 {
            let middle = 0.5 * (before + after);
            if self.law.stop(split(&step.dense.at(middle)).0).is_some() {
                after = middle;
            } else {
                before = middle;
            }
        }
        self.state = step.dense.at(after);
        self.s = step.from + after * step.length;
        *step = Step::new(step.from, after * step.length, step.dense, step.whole);
    }

    /// The wave vector at infinity, once what is not known of it is below the tolerance.
    ///
    /// Where g − η falls like M/r, the change of the wave vector falls like A/r² + B/r³; the changes at the last
    /// two steps' ends tell A and B, and what is left, A/r + B/2r², is added. How well that would have foretold the
    /// last step tells its error.
    fn escaped(&self) -> Option<FourVector<World>> {
        let place = &self.state[1..4];
        let k = &self.state[5..8];
        let r = length(place);
        if r < self.law.escape_radius() {
            return None;
        }
        let before = self.outward.as_ref()?;
        let size = length(k);
        let outward = (0..3).map(|i| place[i] * k[i]).sum::<f64>() / (r * size);
        if outward.is_nan() || outward < 0.9 || r < 1.2 * before.r {
            return None;
        }
        let (now, then) = (size / r, size / before.r);
        let mut left = [0.0; 4];
        let mut unknown = 0.0;
        for (i, left) in left.iter_mut().enumerate() {
            let (f, g) = (self.slope[4 + i] / (now * now), before.change[i] / (then * then));
            let b = (g - f) / (then - now);
            let a = f - b * now;
            let to_infinity = |from: f64| from * (a + 0.5 * b * from);
            *left = to_infinity(now);
            let foretold = to_infinity(then) - *left;
            unknown += (self.state[4 + i] - before.wave[i] - foretold).powi(2);
        }
        // The next term falls like 1/r³ at least, and here is taken to fall by half as much as it could.
        let unknown = unknown.sqrt() / size * (before.r / r).powi(2);
        if unknown.is_nan() || unknown > 0.3 * self.accuracy.tolerance {
            return None;
        }
        let n = [0, 1, 2].map(|i| k[i] + left[1 + i]);
        let norm = length(&n);
        let sign = self.law.wave_vector(&self.state)[0];
        let frequency = (self.state[4] + left[0]).abs();
        let [x, y, z] = n.map(|c| c / norm * frequency);
        Some(FourVector::new(frequency.copysign(sign), x, y, z))
    }

    /// Follows the ray to its end without laying segments along it; cheaper where nothing is in the way.
    pub fn follow(&mut self) -> End {
        loop {
            if let Some(end) = self.integrated {
                self.finished = true;
                return end;
            }
            self.advance(false);
        }
    }
}

impl<L: Law> Iterator for LightRay<'_, L> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        if self.finished {
            return None;
        }
        if (self.integrated.is_none() || self.from < self.s)
            && let Some(segment) = self.chord()
        {
            self.monitor.segments += 1;
            return Some(segment);
        }
        self.finished = true;
        // No chord where there is a ray: it could not be measured.
        self.integrated.get_or_insert(End::NotANumber);
        let Some(End::Sky { wave_vector }) = self.integrated else { return None };
        let segment = Segment {
            start: self.start.into(),
            direction: wave_vector,
            from: self.from,
            length: f64::INFINITY,
        };
        self.infinite = Some(segment);
        self.monitor.segments += 1;
        Some(segment)
    }
}

impl<L: Law> Ray for LightRay<'_, L> {
    fn at(&self, s: f64) -> (Event<World>, FourVector<World>) {
        if let Some(segment) = self.infinite {
            return (segment.at(s), segment.direction);
        }
        let state = self.state_at(s).unwrap_or(self.state);
        (split(&state).0.into(), self.law.wave_vector(&state).into())
    }

    fn end(&self) -> Option<End> {
        if self.finished { self.integrated } else { None }
    }

    fn monitor(&self) -> Monitor {
        self.monitor
    }
}

impl From<Stop> for End {
    fn from(stop: Stop) -> Self {
        match stop {
            Stop::Horizon => Self::Horizon,
            Stop::Edge => Self::Edge,
        }
    }
}

#[inline(always)]
fn length(v: &[f64]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}
