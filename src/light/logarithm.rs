//! ln of Doppler factors, as exact as tables of colours need: 10⁻¹⁰.

use std::f64::consts::{FRAC_1_SQRT_2, LN_2};

/// Of one.
#[inline]
pub(super) fn ln(doppler: f64) -> f64 {
    if is_normal(doppler) { of_normal(doppler) } else { doppler.ln() }
}

/// Of many; with AVX2 if `vectors` and there is such.
pub(crate) fn logarithms<const N: usize>(dopplers: &[f64; N], logarithms: &mut [f64; N], vectors: bool) {
    #[cfg(target_arch = "x86_64")]
    if vectors && crate::processor::has_avx2() {
        // SAFETY: the processor has both.
        unsafe { logarithms_avx2(dopplers, logarithms) };
        return;
    }
    let _ = vectors;
    logarithms_with(dopplers, logarithms);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn logarithms_avx2<const N: usize>(dopplers: &[f64; N], logarithms: &mut [f64; N]) {
    logarithms_with(dopplers, logarithms);
}

/// In a loop of plain arithmetic, which compilers make vectors of.
#[inline(always)]
fn logarithms_with<const N: usize>(dopplers: &[f64; N], logarithms: &mut [f64; N]) {
    let mut all = true;
    for (doppler, logarithm) in dopplers.iter().zip(logarithms.iter_mut()) {
        all &= is_normal(*doppler);
        *logarithm = of_normal(*doppler);
    }
    if !all {
        for (doppler, logarithm) in dopplers.iter().zip(logarithms) {
            *logarithm = ln(*doppler);
        }
    }
}

#[inline(always)]
fn is_normal(x: f64) -> bool {
    (f64::MIN_POSITIVE..=f64::MAX).contains(&x)
}

#[inline(always)]
fn of_normal(x: f64) -> f64 {
    // A power of two times m between √½ and √2. Shifts of numbers that are not negative, and a float made of its digits: what
    // vectors have, too.
    const BIAS: u64 = 1023 << 52;
    const DIGITS: f64 = (1u64 << 52) as f64;
    let bits = x.to_bits();
    let power = (bits.wrapping_sub(FRAC_1_SQRT_2.to_bits()).wrapping_add(BIAS)) >> 52;
    let m = f64::from_bits(bits.wrapping_sub(power.wrapping_sub(1023) << 52));
    let power = f64::from_bits(power | DIGITS.to_bits()) - (DIGITS + 1023.0);
    // ln m = 2 artanh s, by its series.
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    let series = q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * (1.0 / 11.0)))));
    power * LN_2 + 2.0 * (s + s * series)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_are_as_exact_as_tables_need() {
        let mut x = 1e-300;
        while x < 1e300 {
            // The first term that is left out, q⁶/13, with √2 the worst.
            assert!((ln(x) - x.ln()).abs() < 1e-10, "{x}");
            x *= 1.0137;
        }
        for x in [1.0, 0.5, 2.0, std::f64::consts::SQRT_2, f64::MIN_POSITIVE, f64::MAX, f64::INFINITY, 0.0] {
            assert!(ln(x) == x.ln() || (ln(x) - x.ln()).abs() < 1e-10, "{x}");
        }
        assert!(ln(f64::NAN).is_nan() && ln(-1.0).is_nan());
    }

    #[test]
    fn many_are_as_one() {
        let mut dopplers: [f64; 16] = std::array::from_fn(|i| (3.7 * (i as f64 - 8.0)).exp());
        for odd in [None, Some(f64::NAN), Some(0.0), Some(5e-324), Some(f64::INFINITY), Some(-2.0)] {
            dopplers[5] = odd.unwrap_or(dopplers[5]);
            for vectors in [false, true] {
                let mut all = [0.0; 16];
                logarithms(&dopplers, &mut all, vectors);
                for (doppler, logarithm) in dopplers.iter().zip(all) {
                    assert!(logarithm.to_bits() == ln(*doppler).to_bits(), "{doppler}");
                }
            }
        }
    }
}
