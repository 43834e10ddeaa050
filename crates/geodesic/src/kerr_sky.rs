use crate::mino::{Constants, Pack, SIZE, state};
use crate::{End, Event, FourVector, KerrSchild, Method, World};

/// Where many rays near a rotating black hole came from, sky or horizon, when nothing is in their way: several
/// rays at once in the lanes of the processor, with the constants of motion put in.
///
/// For the same rays one by one, or to meet things on the way, follow [`Curved`](crate::Curved)::kerr; both
/// agree to the tolerance. Wave vectors may be of any frequency; rays next to each other should be next to each
/// other in the picture, because those that go together share their steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KerrSky {
    hole: KerrSchild,
    tolerance: f64,
}

/// Rays that go together; four doubles are a register of AVX2 and two of SSE2.
const LANES: usize = 4;
const PACKED: usize = LANES * SIZE;
/// Steps of one pack; a ray turning a thousand times around the hole takes fewer.
const STEPS: u32 = 10_000;

impl KerrSky {
    /// For a black hole, with the error allowed in a step as an angle in radians, 10⁻⁶ to 10⁻¹² usually.
    pub fn new(hole: KerrSchild, tolerance: f64) -> Self {
        Self { hole, tolerance }
    }

    /// The end of every ray, from its event and its wave vector, which points back along the light.
    ///
    /// A wave vector that is not null to 10⁻⁶ ends as [`End::Drift`], as does one that leaves to the future.
    pub fn trace(&self, rays: &[(Event<World>, FourVector<World>)]) -> Vec<End> {
        let mut ends = vec![End::StepLimit; rays.len()];
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            // Safe: the processor has just been asked.
            unsafe { self.trace_avx2(rays, &mut ends) };
            return ends;
        }
        self.trace_here(rays, &mut ends);
        ends
    }

    /// As [`trace`](Self::trace) without asking for more than every processor has; for comparison.
    pub fn trace_baseline(&self, rays: &[(Event<World>, FourVector<World>)]) -> Vec<End> {
        let mut ends = vec![End::StepLimit; rays.len()];
        self.trace_here(rays, &mut ends);
        ends
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn trace_avx2(&self, rays: &[(Event<World>, FourVector<World>)], ends: &mut [End]) {
        self.trace_here(rays, ends);
    }

    #[inline(always)]
    fn trace_here(&self, rays: &[(Event<World>, FourVector<World>)], ends: &mut [End]) {
        for (rays, ends) in rays.chunks(LANES).zip(ends.chunks_mut(LANES)) {
            self.trace_pack(rays, ends);
        }
    }

    #[inline(always)]
    fn trace_pack(&self, rays: &[(Event<World>, FourVector<World>)], ends: &mut [End]) {
        let mut lanes = [Lane::EMPTY; LANES];
        for ((lane, &(event, k)), end) in lanes.iter_mut().zip(rays).zip(ends.iter_mut()) {
            let x: [f64; 4] = event.coordinates().into();
            match self.begin(x, k.into()) {
                Ok(begun) => *lane = begun,
                Err(failed) => *end = failed,
            }
        }
        let Some(mut filler) = lanes.iter().position(|lane| lane.running) else { return };
        let mut y = [0.0; PACKED];
        // A lane without a ray of its own goes along with one that has.
        let copies: [Lane; LANES] =
            std::array::from_fn(|j| if lanes[j].running { lanes[j] } else { lanes[filler] });
        for (j, copy) in copies.iter().enumerate() {
            for i in 0..SIZE {
                y[i * LANES + j] = copy.start[i];
            }
        }
        let mut constants = copies.map(|copy| copy.constants);
        let mut pack = Pack::new(&self.hole, constants);
        let mut allowed = self.allowed(&pack);
        let fastest = pack.total.iter().copied().fold(0.0, f64::max).max(0.0).sqrt() + self.hole.mass();
        // A tenth of a turn for 1e-8.
        let mut h = 6.0 * self.tolerance.powf(0.125) / fastest;
        let method = Method::Dop853;
        let mut slope: [f64; PACKED] = pack.derivative(&y);
        for _ in 0..STEPS {
            let trial = method.step(&pack, &y, &slope, h);
            // The mean over all lanes is at least a quarter of the worst lane's square.
            let error = trial.error(method, &allowed) * (LANES as f64).sqrt();
            if error.is_nan() || error > 1.0 {
                h *= if error.is_finite() { method.rescaling(error).min(0.9) } else { 0.2 };
                continue;
            }
            let (next, _) = method.slope_at_end(&pack, &trial);
            let mut dense = None;
            let mut changed = false;
            for j in 0..LANES {
                let (w, w_slope) = (trial.end[j], trial.end[LANES + j]);
                if !lanes[j].running {
                    continue;
                }
                if w <= 0.0 {
                    let (dense, _) = dense.get_or_insert_with(|| method.dense(&pack, &y, &trial, &next, h));
                    let x = root(|x| dense.component(j, x));
                    let at = |i: usize| dense.component(i * LANES + j, x);
                    ends[j] = lanes[j].sky([at(2), at(3), at(4)], at(8));
                } else if lanes[j].constants.captured(&self.hole, w, w_slope) {
                    ends[j] = End::Horizon;
                } else {
                    continue;
                }
                lanes[j].running = false;
                changed = true;
            }
            y = trial.end;
            slope = next;
            if changed {
                match lanes.iter().position(|lane| lane.running) {
                    Some(running) => filler = running,
                    None => return,
                }
                for j in (0..LANES).filter(|&j| !lanes[j].running) {
                    constants[j] = constants[filler];
                    for i in 0..SIZE {
                        y[i * LANES + j] = y[i * LANES + filler];
                        slope[i * LANES + j] = slope[i * LANES + filler];
                    }
                }
                pack = Pack::new(&self.hole, constants);
                allowed = self.allowed(&pack);
            }
            h *= method.rescaling(error);
        }
    }

    fn begin(&self, x: [f64; 4], k: [f64; 4]) -> Result<Lane, End> {
        if !x.iter().chain(&k).all(|c| c.is_finite()) {
            return Err(End::NotANumber);
        }
        let r = self.hole.radius([x[1], x[2], x[3]]);
        if r <= self.hole.horizon() * (1.0 + 1e-6) {
            return Err(End::Horizon);
        }
        let (constants, start, energy) = state(&self.hole, x, k).ok_or(End::Drift)?;
        if !start.iter().all(|c| c.is_finite()) {
            return Err(End::NotANumber);
        }
        // Not null: W(w) and w′² differ by what k·k is.
        let off = constants.radial(&self.hole, start[0]) - start[1] * start[1];
        if off.abs() > 1e-6 * (1.0 + start[1] * start[1]) {
            return Err(End::Drift);
        }
        if constants.captured(&self.hole, start[0], start[1]) {
            return Err(End::Horizon);
        }
        Ok(Lane { running: true, constants, start, energy })
    }

    /// The error each component may have: w as a fraction of what it is at closest approach.
    fn allowed(&self, pack: &Pack<LANES>) -> [f64; PACKED] {
        let mut allowed = [self.tolerance; PACKED];
        for j in 0..LANES {
            let impact = pack.total[j].max(0.0).sqrt().max(self.hole.mass());
            allowed[j] = self.tolerance / impact;
            for i in 5..8 {
                allowed[i * LANES + j] = self.tolerance * impact;
            }
        }
        allowed
    }
}

/// One ray of a pack.
#[derive(Clone, Copy)]
struct Lane {
    running: bool,
    constants: Constants,
    start: [f64; SIZE],
    energy: f64,
}

impl Lane {
    const EMPTY: Self = Self {
        running: false,
        constants: Constants { angular_momentum: 0.0, carter: 0.0 },
        start: [0.0; SIZE],
        energy: 0.0,
    };

    fn sky(&self, [x, y, z]: [f64; 3], twist: f64) -> End {
        let (sine, cosine) = twist.sin_cos();
        let size = self.energy / (x * x + y * y + z * z).sqrt();
        let direction = [(x * cosine - y * sine) * size, (x * sine + y * cosine) * size, z * size];
        End::Sky { wave_vector: FourVector::new(-self.energy, direction[0], direction[1], direction[2]) }
    }
}

/// Where a function that falls from above 0 to below on [0, 1] is 0, by the rule of false position with the
/// weight of a lasting end halved (Illinois).
fn root(f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let (mut above, mut below) = (f(low), f(high));
    let mut side = 0;
    for _ in 0..60 {
        let x = (low * below - high * above) / (below - above);
        let value = f(x);
        if (high - low) < 1e-15 || value == 0.0 || x == low || x == high {
            return x;
        }
        if value > 0.0 {
            (low, above) = (x, value);
            if side == 1 {
                below *= 0.5;
            }
            side = 1;
        } else {
            (high, below) = (x, value);
            if side == -1 {
                above *= 0.5;
            }
            side = -1;
        }
    }
    0.5 * (low + high)
}
