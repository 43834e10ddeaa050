//! Straight pieces laid along a ray: as long as they may be within the sagitta.

use super::LightRay;
use crate::runge_kutta::Dense;
use crate::{Law, Segment};

/// An accepted step, to be evaluated anywhere within.
pub(super) struct Step {
    pub(super) from: f64,
    pub(super) length: f64,
    pub(super) dense: Dense<8>,
    /// The length of the step as it was taken, before it was cut where the ray stopped.
    pub(super) whole: f64,
    /// Events at the quarters of the step, its end the last.
    samples: [[f64; 4]; SAMPLES],
}

const SAMPLES: usize = 4;

impl Step {
    pub(super) fn new(from: f64, length: f64, dense: Dense<8>, whole: f64) -> Self {
        let mut step = Self { from, length, dense, whole, samples: [[0.0; 4]; SAMPLES] };
        step.samples = std::array::from_fn(|part| step.event_at(from + length * Self::fraction(part)));
        step
    }

    fn fraction(part: usize) -> f64 {
        (part + 1) as f64 / SAMPLES as f64
    }

    pub(super) fn to(&self) -> f64 {
        self.from + self.length
    }

    #[inline(always)]
    fn event_at(&self, s: f64) -> [f64; 4] {
        self.dense.first((s - self.from) / self.whole)
    }
}

impl<L: Law> LightRay<'_, L> {
    /// The state at an affine parameter, continued from the nearest step known.
    pub(super) fn state_at(&self, s: f64) -> Option<[f64; 8]> {
        let step = self.steps.iter().find(|step| s <= step.to()).or(self.steps.back())?;
        Some(step.dense.at((s - step.from) / step.whole))
    }

    /// How far the ray is from the chord from `start` to the end of a stretch of step `last`, as a fraction of what
    /// is allowed.
    ///
    /// Every step's own stretch of the chord is looked at: steps are short where the ray bends.
    fn sagitta(&self, last: usize, to: f64, end: &[f64; 4]) -> f64 {
        let length = to - self.from;
        let chord: [f64; 4] = std::array::from_fn(|i| (end[i] - self.start[i]) / length);
        let across = 1.0 / dot3(&chord, &chord);
        let allowed = [self.accuracy.sagitta, self.accuracy.lag].map(|most| 1.0 / (most * most));
        let mut worst = 0.0f64;
        let mut look = |s: f64, at: &[f64; 4]| {
            let off: [f64; 4] = std::array::from_fn(|i| at[i] - self.start[i] - chord[i] * (s - self.from));
            let along = dot3(&off, &chord);
            let aside = (dot3(&off, &off) - along * along * across).max(0.0);
            // Unlike `max`, this keeps a NaN.
            let (aside, lag) = (aside * allowed[0], off[0] * off[0] * allowed[1]);
            let square = if aside > lag || aside.is_nan() { aside } else { lag };
            worst = if square <= worst || worst.is_nan() { worst } else { square };
        };
        for (index, step) in self.steps.iter().enumerate().take(last + 1) {
            let whole = step.from >= self.from && index < last;
            if whole {
                for (part, at) in step.samples.iter().enumerate() {
                    look(step.from + step.length * Step::fraction(part), at);
                }
            } else {
                let (first, to) = (step.from.max(self.from), step.to().min(to));
                // Where the chord is within one step it is smooth and its own middle tells most.
                const PARTS: u32 = 4;
                for part in 1..PARTS {
                    let s = first + (to - first) * (f64::from(part) / f64::from(PARTS));
                    look(s, &step.event_at(s));
                }
                if index < last {
                    look(step.to(), &step.samples[SAMPLES - 1]);
                }
            }
        }
        worst.sqrt()
    }

    /// The longest chord from where the last one ended that is within the sagitta.
    pub(super) fn chord(&mut self) -> Option<Segment> {
        // What a chord's samples may miss of its greatest sagitta.
        const AIM: f64 = 0.9;
        while self.steps.front().is_some_and(|step| step.to() <= self.from) {
            self.steps.pop_front();
        }
        let mut fits: Option<(f64, [f64; 4])> = None;
        let mut last = 0;
        // Where the step before was long enough for many chords, the next chord is about as long as the last.
        let within = self.steps.front().filter(|step| self.from + 1.5 * self.length < step.to());
        let guess = within.filter(|step| self.length > 0.0 && step.from < self.from).map(|step| step.to());
        // Else step by step as long as the chord may run to the step's end.
        let mut reached = 0.0;
        let (beyond, mut sagitta) = loop {
            if let Some(beyond) = guess {
                break (beyond, AIM * ((beyond - self.from) / self.length).powi(2));
            }
            if last == self.steps.len() && self.integrated.is_none() {
                self.advance(true);
            }
            let Some(step) = self.steps.get(last) else {
                return fits.map(|(to, end)| self.cut(to, end));
            };
            let (to, end) = (step.to(), step.samples[SAMPLES - 1]);
            let sagitta = self.sagitta(last, to, &end);
            if sagitta.is_nan() {
                return None;
            }
            if sagitta > AIM {
                break (to, sagitta);
            }
            fits = Some((to, end));
            reached = sagitta;
            last += 1;
        };
        // Then within the step: the sagitta grows like a power of the length, like its square as long as nothing
        // else is known.
        let length = |to: f64| to - self.from;
        let mut high = (length(beyond), sagitta);
        let mut low = fits.map_or((0.0, 0.0), |(to, _)| (length(to), reached));
        let start = (self.steps[last].from - self.from).max(0.0);
        let mut long = match guess {
            Some(_) => self.length,
            None => foretell(low, high, AIM),
        };
        for _ in 0..30 {
            let (least, most) = (low.0.max(start), high.0);
            if !(long > least && long < most) {
                long = 0.5 * (least + most);
            }
            let to = self.from + long;
            let end = self.steps[last].event_at(to);
            sagitta = self.sagitta(last, to, &end);
            if sagitta <= AIM {
                fits = Some((to, end));
                low = (long, sagitta);
                if sagitta > 0.8 * AIM || high.0 - long < 0.01 * long {
                    break;
                }
            } else {
                high = (long, sagitta);
                if fits.is_some() && high.0 - low.0 < 0.01 * long {
                    break;
                }
            }
            long = foretell(low, high, AIM);
        }
        fits.map(|(to, end)| self.cut(to, end))
    }

    /// The segment to the affine parameter `to`, where the ray is at `end`.
    fn cut(&mut self, to: f64, end: [f64; 4]) -> Segment {
        let length = to - self.from;
        let direction: [f64; 4] = std::array::from_fn(|i| (end[i] - self.start[i]) / length);
        let segment =
            Segment { start: self.start.into(), direction: direction.into(), from: self.from, length };
        self.from = to;
        self.start = end;
        self.length = length;
        segment
    }
}

/// The length at which the sagitta will be nine tenths of `aim`, from two lengths with their sagittas, one too short
/// and one too long.
fn foretell(low: (f64, f64), high: (f64, f64), aim: f64) -> f64 {
    let wanted = 0.9 * aim;
    if low.1 > 0.0 && low.1 < wanted {
        low.0 * (high.0 / low.0).powf((wanted / low.1).ln() / (high.1 / low.1).ln())
    } else {
        high.0 * (wanted / high.1).sqrt()
    }
}

/// The product of the space parts.
#[inline(always)]
fn dot3(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}
