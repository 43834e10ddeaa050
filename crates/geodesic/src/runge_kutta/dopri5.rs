//! The explicit Runge–Kutta method of order 5 by Dormand and Prince: error estimate of order 4, continuation of
//! order 4 within the step.
//!
//! Coefficients: J. R. Dormand, P. J. Prince, J. Comp. Appl. Math. 6 (1980) 19; continuation: L. F. Shampine,
//! Math. Comp. 46 (1986) 135.

use super::{Dense, Slope, Trial, combine};

/// One trial step of length `h` from `y`, where the derivative is `k1`.
#[inline(always)]
pub(super) fn step<const N: usize>(f: &impl Slope<N>, y: &[f64; N], k1: &[f64; N], h: f64) -> Trial<N> {
    let k1 = *k1;
    let k2 = f.slope(&combine(y, h, [(0.2, &k1)]));
    let k3 = f.slope(&combine(y, h, [(3.0 / 40.0, &k1), (9.0 / 40.0, &k2)]));
    let k4 = f.slope(&combine(y, h, [(44.0 / 45.0, &k1), (-56.0 / 15.0, &k2), (32.0 / 9.0, &k3)]));
    let k5 = f.slope(&combine(
        y,
        h,
        [(19372.0 / 6561.0, &k1), (-25360.0 / 2187.0, &k2), (64448.0 / 6561.0, &k3), (-212.0 / 729.0, &k4)],
    ));
    let k6 = f.slope(&combine(
        y,
        h,
        [
            (9017.0 / 3168.0, &k1),
            (-355.0 / 33.0, &k2),
            (46732.0 / 5247.0, &k3),
            (49.0 / 176.0, &k4),
            (-5103.0 / 18656.0, &k5),
        ],
    ));
    let end = combine(
        y,
        h,
        [
            (35.0 / 384.0, &k1),
            (500.0 / 1113.0, &k3),
            (125.0 / 192.0, &k4),
            (-2187.0 / 6784.0, &k5),
            (11.0 / 84.0, &k6),
        ],
    );
    let k7 = f.slope(&end);
    let error = combine(
        &[0.0; N],
        h,
        [
            (71.0 / 57600.0, &k1),
            (-71.0 / 16695.0, &k3),
            (71.0 / 1920.0, &k4),
            (-17253.0 / 339200.0, &k5),
            (22.0 / 525.0, &k6),
            (-1.0 / 40.0, &k7),
        ],
    );
    let zero = [0.0; N];
    Trial {
        end,
        fifth: error,
        third: zero,
        stages: [k1, k2, k3, k4, k5, k6, k7, zero, zero, zero, zero, zero],
    }
}

/// Evaluations of the right-hand side in [`step`]; its last is the derivative at the end.
pub(super) const STAGES: u32 = 6;

/// The continuation within a step taken from `y` to `trial.end`.
#[inline(always)]
pub(super) fn dense<const N: usize>(y: &[f64; N], trial: &Trial<N>, h: f64) -> Dense<N> {
    let [k1, _, k3, k4, k5, k6, k7, ..] = trial.stages;
    let zero = [0.0; N];
    let fourth = combine(
        &zero,
        h,
        [
            (-12715105075.0 / 11282082432.0, &k1),
            (87487479700.0 / 32700410799.0, &k3),
            (-10690763975.0 / 1880347072.0, &k4),
            (701980252875.0 / 199316789632.0, &k5),
            (-1453857185.0 / 822651844.0, &k6),
            (69997945.0 / 29380423.0, &k7),
        ],
    );
    Dense::hermite(y, &k1, &trial.end, &k7, h, [fourth, zero, zero, zero])
}
