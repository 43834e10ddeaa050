//! Ordinary differential equations y′ = f(y) of a size fixed when compiled, by explicit Runge–Kutta methods with
//! step control and continuation within the step.

mod dop853;
mod dopri5;

/// A method to integrate rays with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Order 8 by Dormand and Prince, the cheaper one from errors of 10⁻⁶ down.
    #[default]
    Dop853,
    /// Order 5 by Dormand and Prince.
    Dopri5,
}

/// f in y′ = f(y).
///
/// Any closure is one; a type of its own can insist on being inlined, and so on the instructions of its caller.
pub(crate) trait Slope<const N: usize> {
    /// The derivative at `y`.
    fn slope(&self, y: &[f64; N]) -> [f64; N];
}

impl<const N: usize, F: Fn(&[f64; N]) -> [f64; N]> Slope<N> for F {
    #[inline(always)]
    fn slope(&self, y: &[f64; N]) -> [f64; N] {
        self(y)
    }
}

/// A step that may yet be refused.
#[derive(Clone, Copy)]
pub(crate) struct Trial<const N: usize> {
    /// Where it leads.
    pub end: [f64; N],
    fifth: [f64; N],
    third: [f64; N],
    stages: [[f64; N]; 12],
}

/// A step's continuation: y at any fraction of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dense<const N: usize>([[f64; N]; 8]);

/// `base` + h Σ cᵢ kᵢ.
#[inline(always)]
fn combine<const N: usize, const K: usize>(
    base: &[f64; N],
    h: f64,
    terms: [(f64, &[f64; N]); K],
) -> [f64; N] {
    let mut sum = [0.0; N];
    for i in 0..N {
        let mut total = terms[0].0 * terms[0].1[i];
        for &(coefficient, k) in &terms[1..] {
            total += coefficient * k[i];
        }
        sum[i] = base[i] + h * total;
    }
    sum
}

impl Method {
    /// One trial step of length `h` from `y`, where the derivative is `slope`.
    #[inline(always)]
    pub(crate) fn step<const N: usize>(
        self,
        f: &impl Slope<N>,
        y: &[f64; N],
        slope: &[f64; N],
        h: f64,
    ) -> Trial<N> {
        match self {
            Self::Dop853 => dop853::step(f, y, slope, h),
            Self::Dopri5 => dopri5::step(f, y, slope, h),
        }
    }

    /// How many evaluations of f a trial step takes.
    pub(crate) fn stages(self) -> u32 {
        match self {
            Self::Dop853 => dop853::STAGES,
            Self::Dopri5 => dopri5::STAGES,
        }
    }

    /// The derivative at the end of an accepted step, and how many evaluations of f that took.
    #[inline(always)]
    pub(crate) fn slope_at_end<const N: usize>(self, f: &impl Slope<N>, trial: &Trial<N>) -> ([f64; N], u32) {
        match self {
            Self::Dop853 => (f.slope(&trial.end), 1),
            Self::Dopri5 => (trial.stages[6], 0),
        }
    }

    /// The continuation within an accepted step, and how many evaluations of f that took.
    #[inline(always)]
    pub(crate) fn dense<const N: usize>(
        self,
        f: &impl Slope<N>,
        y: &[f64; N],
        trial: &Trial<N>,
        slope_at_end: &[f64; N],
        h: f64,
    ) -> (Dense<N>, u32) {
        match self {
            Self::Dop853 => (dop853::dense(f, y, trial, slope_at_end, h), dop853::DENSE_STAGES),
            Self::Dopri5 => (dopri5::dense(y, trial, h), 0),
        }
    }

    /// By what a step is to be multiplied so that its error becomes the tolerance; `error` is in units of that.
    #[inline]
    pub(crate) fn rescaling(self, error: f64) -> f64 {
        // 0.9 so that the next step is likely to be accepted; the bounds are those of Hairer et al.
        (0.9 / self.root(error)).clamp(0.2, 6.0)
    }

    /// By what the step that would have been right for the last one differs from that for the one before it.
    #[inline]
    pub(crate) fn trend(self, lengths: f64, errors: f64) -> f64 {
        lengths * self.root(errors)
    }

    /// The root that turns an error into a length: the eighth for DOP853, the fifth for DOPRI5.
    #[inline]
    fn root(self, error: f64) -> f64 {
        match self {
            Self::Dop853 => error.sqrt().sqrt().sqrt(),
            Self::Dopri5 => error.powf(0.2),
        }
    }
}

impl<const N: usize> Trial<N> {
    /// The error in units of what is allowed for each component; NaN where the step met no number.
    #[inline(always)]
    pub(crate) fn error(&self, method: Method, allowed: &[f64; N]) -> f64 {
        let square = |estimate: &[f64; N]| {
            let mut sum = 0.0;
            for i in 0..N {
                let part = estimate[i] / allowed[i];
                sum += part * part;
            }
            sum
        };
        let fifth = square(&self.fifth);
        match method {
            Method::Dopri5 => (fifth / N as f64).sqrt(),
            // Hairer et al.: the estimate of order 5, tempered by that of order 3, behaves like order 8.
            Method::Dop853 => {
                let tempered = fifth + 0.01 * square(&self.third);
                if tempered == 0.0 { 0.0 } else { fifth / (tempered * N as f64).sqrt() }
            }
        }
    }
}

impl<const N: usize> Dense<N> {
    /// The cubic through both ends with their slopes, and four terms that vanish there.
    #[inline(always)]
    fn hermite(
        start: &[f64; N],
        slope: &[f64; N],
        end: &[f64; N],
        slope_at_end: &[f64; N],
        h: f64,
        rest: [[f64; N]; 4],
    ) -> Self {
        let mut cubic = [[0.0; N]; 3];
        for i in 0..N {
            let whole = end[i] - start[i];
            let bend = h * slope[i] - whole;
            cubic[0][i] = whole;
            cubic[1][i] = bend;
            cubic[2][i] = whole - h * slope_at_end[i] - bend;
        }
        Self([*start, cubic[0], cubic[1], cubic[2], rest[0], rest[1], rest[2], rest[3]])
    }

    /// The first `K` components at the fraction `x` of the step.
    #[inline(always)]
    pub(crate) fn first<const K: usize>(&self, x: f64) -> [f64; K] {
        let y = 1.0 - x;
        let mut sum = [0.0; K];
        // c₀ + x(c₁ + y(c₂ + x(c₃ + …))), all components side by side.
        for (degree, coefficients) in self.0.iter().enumerate().rev() {
            let by = if degree % 2 == 0 { x } else { y };
            for (sum, coefficient) in sum.iter_mut().zip(coefficients) {
                *sum = coefficient + by * *sum;
            }
        }
        sum
    }

    /// Component `i` at the fraction `x` of the step.
    #[inline(always)]
    pub(crate) fn component(&self, i: usize, x: f64) -> f64 {
        let y = 1.0 - x;
        self.0.iter().enumerate().rev().fold(0.0, |sum, (degree, coefficients)| {
            coefficients[i] + if degree % 2 == 0 { x } else { y } * sum
        })
    }

    /// All components at the fraction `x` of the step.
    #[inline]
    pub(crate) fn at(&self, x: f64) -> [f64; N] {
        self.first(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pendulum, y″ = −sin y, beside its own clock: nothing in it is linear.
    fn pendulum(y: &[f64; 3]) -> [f64; 3] {
        [y[1], -y[0].sin(), 1.0 + 0.1 * y[1] * y[0]]
    }

    /// From 0 to 3 in `n` equal steps; the state at the end and the worst mid-step continuation against `exact`.
    fn integrate(method: Method, n: u32) -> ([f64; 3], Vec<[f64; 3]>) {
        let h = 3.0 / f64::from(n);
        let mut y = [1.0, 0.3, 0.0];
        let mut inside = Vec::new();
        for _ in 0..n {
            let slope = pendulum(&y);
            let trial = method.step(&pendulum, &y, &slope, h);
            let (slope_at_end, _) = method.slope_at_end(&pendulum, &trial);
            let (dense, _) = method.dense(&pendulum, &y, &trial, &slope_at_end, h);
            assert_eq!(dense.at(0.0), y);
            for i in 0..3 {
                assert!((dense.at(1.0)[i] - trial.end[i]).abs() < 1e-15);
            }
            inside.push(dense.at(0.37));
            y = trial.end;
        }
        (y, inside)
    }

    fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
        (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn errors_fall_with_the_order_of_the_method() {
        let (exact, _) = integrate(Method::Dop853, 400);
        // The measured order over a halving differs from the order by terms of the next one: 0.5 allows for it.
        for (method, n, order) in [(Method::Dop853, 6, 8.0), (Method::Dopri5, 20, 5.0)] {
            let coarse = distance(&integrate(method, n).0, &exact);
            let fine = distance(&integrate(method, 2 * n).0, &exact);
            let measured = (coarse / fine).log2();
            assert!(measured > order - 0.5, "{method:?}: {coarse:e} {fine:e} order {measured}");
        }
    }

    #[test]
    fn the_continuation_has_its_own_order() {
        for (method, n, order) in [(Method::Dop853, 5, 7.0), (Method::Dopri5, 16, 4.0)] {
            let worst = |n: u32| {
                // The same point of the same steps, reached from each step's start in 64 steps.
                let h = 3.0 / f64::from(n);
                let (_, inside) = integrate(method, n);
                let mut y = [1.0, 0.3, 0.0];
                let mut worst = 0.0f64;
                for found in inside {
                    let mut exact = y;
                    for _ in 0..64 {
                        exact = method.step(&pendulum, &exact, &pendulum(&exact), 0.37 * h / 64.0).end;
                    }
                    worst = worst.max(distance(&found, &exact));
                    y = method.step(&pendulum, &y, &pendulum(&y), h).end;
                }
                worst
            };
            // Within one step the error is of one order more than over many.
            let measured = (worst(n) / worst(2 * n)).log2();
            assert!(measured > order + 0.5, "{method:?}: order {measured}");
        }
    }

    #[test]
    fn the_error_estimate_is_an_estimate() {
        let y = [1.0, 0.3, 0.0];
        for (method, h) in [(Method::Dop853, 0.8), (Method::Dopri5, 0.2)] {
            let trial = method.step(&pendulum, &y, &pendulum(&y), h);
            let mut exact = y;
            for _ in 0..50 {
                exact = Method::Dop853.step(&pendulum, &exact, &pendulum(&exact), h / 50.0).end;
            }
            let estimate = trial.error(method, &[1.0; 3]);
            let error = distance(&trial.end, &exact);
            // It is of the lower order's error and so should exceed the error, but not by orders of magnitude.
            assert!(estimate > 0.2 * error && estimate < 1e4 * error, "{method:?} {estimate:e} {error:e}");
        }
    }
}
