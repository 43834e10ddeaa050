//! Symmetric 4×4 matrices, of which only the upper half is read.

pub(crate) type Matrix = [[f64; 4]; 4];

/// The product a·g·b.
#[inline]
pub(crate) fn product(g: &Matrix, a: &[f64; 4], b: &[f64; 4]) -> f64 {
    dot(&lowered(g, a), b)
}

#[inline(always)]
pub(crate) fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// g·a: the index of `a` lowered.
#[inline(always)]
pub(crate) fn lowered(g: &Matrix, a: &[f64; 4]) -> [f64; 4] {
    [
        g[0][0] * a[0] + g[0][1] * a[1] + g[0][2] * a[2] + g[0][3] * a[3],
        g[0][1] * a[0] + g[1][1] * a[1] + g[1][2] * a[2] + g[1][3] * a[3],
        g[0][2] * a[0] + g[1][2] * a[1] + g[2][2] * a[2] + g[2][3] * a[3],
        g[0][3] * a[0] + g[1][3] * a[1] + g[2][3] * a[2] + g[3][3] * a[3],
    ]
}

/// The inverse (both halves) and the determinant, by 2×2 minors: no pivot can vanish on an ergosphere.
#[inline(always)]
pub(crate) fn inverse(g: &Matrix) -> (Matrix, f64) {
    let (a, b, c, d) = (g[0][0], g[0][1], g[0][2], g[0][3]);
    let (e, f, h) = (g[1][1], g[1][2], g[1][3]);
    let (i, j) = (g[2][2], g[2][3]);
    let k = g[3][3];
    // Minors of the upper two rows and of the lower two.
    let s0 = a * e - b * b;
    let s1 = a * f - b * c;
    let s2 = a * h - b * d;
    let s3 = b * f - e * c;
    let s4 = b * h - e * d;
    let s5 = c * h - f * d;
    let c5 = i * k - j * j;
    let c4 = f * k - h * j;
    let c3 = f * j - h * i;
    let c2 = c * k - d * j;
    let c1 = c * j - d * i;
    let c0 = c * h - d * f;
    let determinant = s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
    let n = 1.0 / determinant;
    let m00 = (e * c5 - f * c4 + h * c3) * n;
    let m01 = (-b * c5 + c * c4 - d * c3) * n;
    let m02 = (h * s5 - j * s4 + k * s3) * n;
    let m03 = (-f * s5 + i * s4 - j * s3) * n;
    let m11 = (a * c5 - c * c2 + d * c1) * n;
    let m12 = (-d * s5 + j * s2 - k * s1) * n;
    let m13 = (c * s5 - i * s2 + j * s1) * n;
    let m22 = (d * s4 - h * s2 + k * s0) * n;
    let m23 = (-c * s4 + f * s2 - j * s0) * n;
    let m33 = (c * s3 - f * s1 + i * s0) * n;
    let rows = [[m00, m01, m02, m03], [m01, m11, m12, m13], [m02, m12, m22, m23], [m03, m13, m23, m33]];
    (rows, determinant)
}

/// Whether a symmetric matrix is finite with one negative and three positive eigenvalues.
///
/// All eigenvalues are real, so Descartes' rule counts the positive roots of the characteristic polynomial
/// exactly.
pub(crate) fn is_lorentzian(g: &Matrix) -> bool {
    if !g.iter().enumerate().all(|(i, row)| row[i..].iter().all(|c| c.is_finite())) {
        return false;
    }
    // Scaled so that products of four entries neither overflow nor vanish.
    let largest =
        (0..4).flat_map(|i| (i..4).map(move |j| (i, j))).map(|(i, j)| g[i][j].abs()).fold(0.0, f64::max);
    let at = |i: usize, j: usize| g[i.min(j)][i.max(j)] / largest;
    let minor2 = |i: usize, j: usize| at(i, i) * at(j, j) - at(i, j) * at(i, j);
    let minor3 = |i: usize, j: usize, k: usize| {
        at(i, i) * minor2(j, k) - at(i, j) * (at(i, j) * at(k, k) - at(j, k) * at(i, k))
            + at(i, k) * (at(i, j) * at(j, k) - at(j, j) * at(i, k))
    };
    let scaled: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| at(i, j)));
    let trace = at(0, 0) + at(1, 1) + at(2, 2) + at(3, 3);
    let second = minor2(0, 1) + minor2(0, 2) + minor2(0, 3) + minor2(1, 2) + minor2(1, 3) + minor2(2, 3);
    let third = minor3(0, 1, 2) + minor3(0, 1, 3) + minor3(0, 2, 3) + minor3(1, 2, 3);
    let determinant = inverse(&scaled).1;
    // λ⁴ − trace λ³ + second λ² − third λ + determinant.
    let signs = [1.0, -trace, second, -third, determinant];
    let mut changes = 0;
    let mut last = 1.0f64;
    for sign in signs.into_iter().filter(|&c| c != 0.0) {
        if sign.signum() != last.signum() {
            changes += 1;
        }
        last = sign;
    }
    determinant < 0.0 && changes == 3
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Rᵀ diag R for a shear-and-rotation R, which keeps the signs of the diagonal (Sylvester).
    fn congruent(diagonal: [f64; 4], r: &[[f64; 4]; 4]) -> Matrix {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..4).map(|k| r[k][i] * diagonal[k] * r[k][j]).sum())
        })
    }

    proptest! {
        #[test]
        fn the_inverse_undoes_and_the_signature_is_kept(
            entries in prop::array::uniform4(prop::array::uniform4(-0.2..0.2f64)),
            diagonal in prop::array::uniform4(0.3..3.0f64),
        ) {
            let mut r = entries;
            for (i, row) in r.iter_mut().enumerate() {
                row[i] += 1.0;
            }
            let [a, b, c, d] = diagonal;
            let g = congruent([-a, b, c, d], &r);
            prop_assert!(is_lorentzian(&g));
            for other in [[a, b, c, d], [-a, -b, c, d], [-a, -b, -c, d], [-a, -b, -c, -d], [-a, b, c, 0.0]] {
                // With a zero the determinant is one only of rounding, whose sign is chance.
                let lorentzian = is_lorentzian(&congruent(other, &r));
                prop_assert!(!lorentzian || other[3] == 0.0, "{other:?}");
            }
            let (inverse, determinant) = inverse(&g);
            for (i, column) in g.iter().enumerate() {
                let back = lowered(&inverse, column);
                for (j, entry) in back.into_iter().enumerate() {
                    let unit = if i == j { 1.0 } else { 0.0 };
                    // Entries up to 100 of which about ten are summed.
                    prop_assert!((entry - unit).abs() < 1e-12, "{determinant}: {entry}");
                }
            }
        }
    }
}
