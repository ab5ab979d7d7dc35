//! [`Lanes`] for processors with AVX2 and FMA.
//!
//! Values of this type are made only inside functions that are compiled for these instructions, and these are called only
//! after the processor has been asked ([`super::Isa::best`]): that is what makes every block below sound.
#![allow(unsafe_code)]

use super::lanes::Lanes;
use super::{FrameRay, Visitor, WideTree};
use std::arch::x86_64::{
    __m256, _CMP_LE_OQ, _mm256_add_ps, _mm256_andnot_ps, _mm256_cmp_ps, _mm256_fmadd_ps, _mm256_loadu_ps,
    _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_set1_ps, _mm256_storeu_ps,
    _mm256_sub_ps,
};

/// Walks a tree with these instructions.
#[target_feature(enable = "avx2,fma")]
pub(super) fn walk(tree: &WideTree, ray: &FrameRay, limit: f32, visitor: &mut impl Visitor) {
    tree.walk_in::<Avx2>(ray, limit, visitor);
}

/// A register of eight.
#[derive(Clone, Copy)]
struct Avx2(__m256);

impl Lanes for Avx2 {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: the processor has AVX (see the head of this file).
        Self(unsafe { _mm256_set1_ps(x) })
    }
    #[inline(always)]
    fn load(x: &[f32; 8]) -> Self {
        // SAFETY: the processor has AVX, and eight numbers stand at this address.
        Self(unsafe { _mm256_loadu_ps(x.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 8]) {
        // SAFETY: the processor has AVX, and there is room for eight numbers at this address.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) };
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_add_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_sub_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_mul_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: the processor has FMA.
        Self(unsafe { _mm256_fmadd_ps(self.0, factor.0, addend.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: the processor has AVX.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) }.cast_unsigned()
    }
}
