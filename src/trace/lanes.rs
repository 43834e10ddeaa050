//! Several f32 at a time, as the processor has them.

/// A vector of f32. Masks are vectors, too: of all ones or all zeros.
///
/// # Safety
/// Methods may be called only where the processor has what the type is named after.
pub(super) trait Lanes: Copy {
    /// How many.
    const COUNT: usize;
    /// All the same.
    unsafe fn splat(value: f32) -> Self;
    /// The first of a slice, which has as many.
    unsafe fn load(from: &[f32]) -> Self;
    /// Into the first of a slice, which has as many.
    unsafe fn store(self, to: &mut [f32]);
    /// self·by + plus; rounded once where the processor can.
    unsafe fn mul_add(self, by: Self, plus: Self) -> Self;
    unsafe fn add(self, other: Self) -> Self;
    unsafe fn sub(self, other: Self) -> Self;
    unsafe fn mul(self, by: Self) -> Self;
    /// The second where one is not a number.
    unsafe fn min(self, other: Self) -> Self;
    /// The second where one is not a number.
    unsafe fn max(self, other: Self) -> Self;
    /// Mask of self ≥ other.
    unsafe fn at_least(self, other: Self) -> Self;
    /// Mask of self > other.
    unsafe fn above(self, other: Self) -> Self;
    /// Of masks.
    unsafe fn and(self, other: Self) -> Self;
    /// This mask without another.
    unsafe fn without(self, other: Self) -> Self;
    /// By this mask, one or the other.
    unsafe fn choose(self, yes: Self, no: Self) -> Self;
    /// A bit for each of a mask.
    unsafe fn bits(self) -> u32;
}

#[cfg(target_arch = "x86_64")]
pub(super) mod x86 {
    use super::Lanes;
    use std::arch::x86_64::*;

    /// Eight, with AVX2 and FMA.
    #[derive(Clone, Copy)]
    pub struct Avx2(__m256);

    impl Lanes for Avx2 {
        const COUNT: usize = 8;
        #[inline(always)]
        unsafe fn splat(value: f32) -> Self {
            unsafe { Self(_mm256_set1_ps(value)) }
        }
        #[inline(always)]
        unsafe fn load(from: &[f32]) -> Self {
            debug_assert!(from.len() >= 8);
            unsafe { Self(_mm256_loadu_ps(from.as_ptr())) }
        }
        #[inline(always)]
        unsafe fn store(self, to: &mut [f32]) {
            debug_assert!(to.len() >= 8);
            unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) }
        }
        #[inline(always)]
        unsafe fn mul_add(self, by: Self, plus: Self) -> Self {
            unsafe { Self(_mm256_fmadd_ps(self.0, by.0, plus.0)) }
        }
        #[inline(always)]
        unsafe fn add(self, other: Self) -> Self {
            unsafe { Self(_mm256_add_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn sub(self, other: Self) -> Self {
            unsafe { Self(_mm256_sub_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn mul(self, by: Self) -> Self {
            unsafe { Self(_mm256_mul_ps(self.0, by.0)) }
        }
        #[inline(always)]
        unsafe fn min(self, other: Self) -> Self {
            unsafe { Self(_mm256_min_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn max(self, other: Self) -> Self {
            unsafe { Self(_mm256_max_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn at_least(self, other: Self) -> Self {
            unsafe { Self(_mm256_cmp_ps::<_CMP_GE_OQ>(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn above(self, other: Self) -> Self {
            unsafe { Self(_mm256_cmp_ps::<_CMP_GT_OQ>(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn and(self, other: Self) -> Self {
            unsafe { Self(_mm256_and_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn without(self, other: Self) -> Self {
            unsafe { Self(_mm256_andnot_ps(other.0, self.0)) }
        }
        #[inline(always)]
        unsafe fn choose(self, yes: Self, no: Self) -> Self {
            unsafe { Self(_mm256_blendv_ps(no.0, yes.0, self.0)) }
        }
        #[inline(always)]
        unsafe fn bits(self) -> u32 {
            unsafe { _mm256_movemask_ps(self.0) as u32 }
        }
    }

    /// Four, with SSE2, which every x86-64 processor has.
    #[derive(Clone, Copy)]
    pub struct Sse2(__m128);

    impl Lanes for Sse2 {
        const COUNT: usize = 4;
        #[inline(always)]
        unsafe fn splat(value: f32) -> Self {
            unsafe { Self(_mm_set1_ps(value)) }
        }
        #[inline(always)]
        unsafe fn load(from: &[f32]) -> Self {
            debug_assert!(from.len() >= 4);
            unsafe { Self(_mm_loadu_ps(from.as_ptr())) }
        }
        #[inline(always)]
        unsafe fn store(self, to: &mut [f32]) {
            debug_assert!(to.len() >= 4);
            unsafe { _mm_storeu_ps(to.as_mut_ptr(), self.0) }
        }
        #[inline(always)]
        unsafe fn mul_add(self, by: Self, plus: Self) -> Self {
            unsafe { Self(_mm_add_ps(_mm_mul_ps(self.0, by.0), plus.0)) }
        }
        #[inline(always)]
        unsafe fn add(self, other: Self) -> Self {
            unsafe { Self(_mm_add_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn sub(self, other: Self) -> Self {
            unsafe { Self(_mm_sub_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn mul(self, by: Self) -> Self {
            unsafe { Self(_mm_mul_ps(self.0, by.0)) }
        }
        #[inline(always)]
        unsafe fn min(self, other: Self) -> Self {
            unsafe { Self(_mm_min_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn max(self, other: Self) -> Self {
            unsafe { Self(_mm_max_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn at_least(self, other: Self) -> Self {
            unsafe { Self(_mm_cmpge_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn above(self, other: Self) -> Self {
            unsafe { Self(_mm_cmpgt_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn and(self, other: Self) -> Self {
            unsafe { Self(_mm_and_ps(self.0, other.0)) }
        }
        #[inline(always)]
        unsafe fn without(self, other: Self) -> Self {
            unsafe { Self(_mm_andnot_ps(other.0, self.0)) }
        }
        #[inline(always)]
        unsafe fn choose(self, yes: Self, no: Self) -> Self {
            unsafe { Self(_mm_or_ps(_mm_and_ps(self.0, yes.0), _mm_andnot_ps(self.0, no.0))) }
        }
        #[inline(always)]
        unsafe fn bits(self) -> u32 {
            unsafe { _mm_movemask_ps(self.0) as u32 }
        }
    }
}

/// One, on any processor.
#[cfg(any(test, not(target_arch = "x86_64")))]
#[derive(Clone, Copy)]
pub(super) struct One(f32);

#[cfg(any(test, not(target_arch = "x86_64")))]
impl One {
    fn mask(holds: bool) -> Self {
        Self(f32::from_bits(if holds { !0 } else { 0 }))
    }

    fn holds(self) -> bool {
        self.0.to_bits() != 0
    }
}

#[cfg(any(test, not(target_arch = "x86_64")))]
impl Lanes for One {
    const COUNT: usize = 1;
    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        Self(value)
    }
    #[inline(always)]
    unsafe fn load(from: &[f32]) -> Self {
        Self(from[0])
    }
    #[inline(always)]
    unsafe fn store(self, to: &mut [f32]) {
        to[0] = self.0;
    }
    #[inline(always)]
    unsafe fn mul_add(self, by: Self, plus: Self) -> Self {
        Self(self.0 * by.0 + plus.0)
    }
    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
    #[inline(always)]
    unsafe fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
    #[inline(always)]
    unsafe fn mul(self, by: Self) -> Self {
        Self(self.0 * by.0)
    }
    #[inline(always)]
    unsafe fn min(self, other: Self) -> Self {
        if self.0 < other.0 { self } else { other }
    }
    #[inline(always)]
    unsafe fn max(self, other: Self) -> Self {
        if self.0 > other.0 { self } else { other }
    }
    #[inline(always)]
    unsafe fn at_least(self, other: Self) -> Self {
        Self::mask(self.0 >= other.0)
    }
    #[inline(always)]
    unsafe fn above(self, other: Self) -> Self {
        Self::mask(self.0 > other.0)
    }
    #[inline(always)]
    unsafe fn and(self, other: Self) -> Self {
        Self(f32::from_bits(self.0.to_bits() & other.0.to_bits()))
    }
    #[inline(always)]
    unsafe fn without(self, other: Self) -> Self {
        Self(f32::from_bits(self.0.to_bits() & !other.0.to_bits()))
    }
    #[inline(always)]
    unsafe fn choose(self, yes: Self, no: Self) -> Self {
        if self.holds() { yes } else { no }
    }
    #[inline(always)]
    unsafe fn bits(self) -> u32 {
        u32::from(self.holds())
    }
}
