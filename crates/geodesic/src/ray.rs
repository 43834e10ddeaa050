use crate::law::split;
use crate::runge_kutta::Dense;
use crate::{Accuracy, End, Event, FourVector, Law, Monitor, Ray, Segment, Stop, World};
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

/// An accepted step, to be evaluated anywhere within.
struct Step {
    from: f64,
    length: f64,
    dense: Dense<8>,
}

impl Step {
    fn to(&self) -> f64 {
        self.from + self.length
    }
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
        self.h = 2.0 * self.accuracy.tolerance.powf(0.125) * (self.law.scale() + length(&x[1..])) / speed;
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
                self.steps.push_back(Step { from: self.s, length: self.h, dense });
            }
            self.s += self.h;
            self.monitor.steps += 1;
            let factor = method.rescaling(error);
            self.h *= if grow { factor } else { factor.min(1.0) };
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
        let most = if inward { 0.8 } else { 6.0 } * (self.law.scale() + r) / length(velocity);
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
    }

    /// The wave vector at infinity, once what is not known of it is below the tolerance.
    ///
    /// Where g − η falls like M/r, the derivative ḱ of the wave vector falls like 1/r² along it and like 1/r³
    /// across it: what is left of its change is ḱ r/|k| and half of that. The error of this is of relative order
    /// b/r and M/r, b the distance at which the straight ray passes the origin.
    fn escaped(&self) -> Option<FourVector<World>> {
        let place = &self.state[1..4];
        let k = &self.state[5..8];
        let r = length(place);
        if r < self.law.escape_radius() {
            return None;
        }
        let size = length(k);
        let outward = (0..3).map(|i| place[i] * k[i]).sum::<f64>() / (r * size);
        if outward.is_nan() || outward < 0.9 {
            return None;
        }
        let reach = r / size;
        let change = &self.slope[5..8];
        let along = (0..3).map(|i| change[i] * k[i]).sum::<f64>() / (size * size);
        let across: [f64; 3] = std::array::from_fn(|i| change[i] - along * k[i]);
        let aside = (1.0 - outward * outward).max(0.0).sqrt();
        let bend = 0.5 * length(&across) * reach / size;
        let stretch = along.abs() * reach;
        let time = self.slope[4] * reach;
        let unknown = bend * (aside + stretch + bend) + (time / size).abs() * (stretch + bend);
        if unknown > 0.1 * self.accuracy.tolerance {
            return None;
        }
        let n: [f64; 3] = std::array::from_fn(|i| k[i] + 0.5 * across[i] * reach);
        let norm = length(&n);
        let before = self.law.wave_vector(&self.state)[0];
        let frequency = (self.state[4] + time).abs();
        let [x, y, z] = n.map(|c| c / norm * frequency);
        Some(FourVector::new(frequency.copysign(before), x, y, z))
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

    /// The state at an affine parameter, continued from the nearest step known.
    fn state_at(&self, s: f64) -> Option<[f64; 8]> {
        let step = self.steps.iter().find(|step| s <= step.to()).or(self.steps.back())?;
        Some(step.dense.at((s - step.from) / step.length))
    }

    fn event_at(&self, s: f64) -> [f64; 4] {
        match self.steps.iter().find(|step| s <= step.to()).or(self.steps.back()) {
            Some(step) => {
                let x = (s - step.from) / step.length;
                std::array::from_fn(|i| step.dense.component(i, x))
            }
            None => self.start,
        }
    }

    /// How far the ray is from the chord to the affine parameter `to`, 1 being as far as allowed, and where the
    /// chord ends.
    ///
    /// Every step's own stretch of the chord is looked at: steps are short where the ray bends.
    fn sagitta(&self, to: f64) -> (f64, [f64; 4]) {
        let end = self.event_at(to);
        let length = to - self.from;
        let chord: [f64; 4] = std::array::from_fn(|i| (end[i] - self.start[i]) / length);
        let across = dot3(&chord, &chord);
        let mut worst = 0.0f64;
        let overlapping = self.steps.iter().filter(|step| step.from < to).count();
        let parts = if overlapping == 1 { 6 } else { 4 };
        for step in self.steps.iter().take_while(|step| step.from < to) {
            let (first, last) = (step.from.max(self.from), step.to().min(to));
            for part in 1..=parts {
                let s = first + (last - first) * f64::from(part) / f64::from(parts);
                let x = (s - step.from) / step.length;
                let off: [f64; 4] = std::array::from_fn(|i| {
                    step.dense.component(i, x) - self.start[i] - chord[i] * (s - self.from)
                });
                let along = dot3(&off, &chord);
                let aside = (dot3(&off, &off) - along * along / across).max(0.0);
                worst = worst
                    .max(aside / (self.accuracy.sagitta * self.accuracy.sagitta))
                    .max((off[0] / self.accuracy.lag).powi(2));
            }
        }
        (worst.sqrt(), end)
    }

    /// The longest chord from where the last one ended that is within the sagitta.
    fn chord(&mut self) -> Option<Segment> {
        // What a chord's own samples may miss of its greatest sagitta.
        const AIM: f64 = 0.95;
        while self.steps.front().is_some_and(|step| step.to() <= self.from) {
            self.steps.pop_front();
        }
        let mut length = if self.length > 0.0 { self.length } else { self.h };
        let mut fits: Option<(f64, [f64; 4])> = None;
        let mut too_long = f64::INFINITY;
        for _ in 0..40 {
            while self.integrated.is_none() && self.from + length > self.s {
                self.advance(true);
            }
            let most = self.s - self.from;
            if most <= 0.0 {
                return None;
            }
            let whole = self.integrated.is_some() && length >= most;
            length = length.min(most);
            let (sagitta, end) = self.sagitta(self.from + length);
            let factor = (AIM * AIM / sagitta).sqrt();
            if sagitta <= AIM {
                fits = Some((length, end));
                if whole || sagitta > 0.85 * AIM {
                    break;
                }
                length = (length * factor.min(3.0)).min(0.5 * (length + too_long).min(f64::MAX));
            } else if sagitta.is_nan() {
                return None;
            } else {
                too_long = too_long.min(length);
                length *= factor.clamp(0.1, 0.97);
                if let Some((known, _)) = fits {
                    length = length.max(0.5 * (known + too_long));
                    if too_long - known < 0.02 * known {
                        break;
                    }
                }
            }
        }
        let (length, end) = fits?;
        let direction: [f64; 4] = std::array::from_fn(|i| (end[i] - self.start[i]) / length);
        let segment =
            Segment { start: self.start.into(), direction: direction.into(), from: self.from, length };
        self.from += length;
        self.start = end;
        self.length = length;
        Some(segment)
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

/// The product of the space parts.
#[inline(always)]
fn dot3(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}
