/// Weights of four values, evenly spaced, for the cubic through them (Lagrange) at a place `t` steps beyond the second.
#[inline]
pub(crate) fn cubic(t: f64) -> [f64; 4] {
    let (a, b, c) = (t + 1.0, t - 1.0, t - 2.0);
    const SIXTH: f64 = 1.0 / 6.0;
    [-t * b * c * SIXTH, a * b * c * 0.5, -a * t * c * 0.5, a * t * b * SIXTH]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_kept() {
        let of = |x: f64| 2.0 - x + 0.5 * x * x - 0.3 * x * x * x;
        for t in [0.0, 0.25, 0.7, 1.0] {
            let weights = cubic(t);
            let between: f64 = (0..4).map(|i| weights[i] * of(i as f64 - 1.0)).sum();
            assert!((between - of(t)).abs() < 1e-14, "{t}");
        }
    }
}
