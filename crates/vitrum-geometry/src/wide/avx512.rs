//! [`Lanes`] for processors with AVX-512: the items of a block all at once.
//!
//! The same rules as in [`avx2`](super::avx2).
#![allow(unsafe_code)]

use super::avx2::{Eight, Four};
use super::isa::Task;
use super::lanes::{Lanes, Processor};
use std::arch::x86_64::{
    __m512, _CMP_LE_OQ, _mm512_abs_ps, _mm512_add_ps, _mm512_cmp_ps_mask, _mm512_cmpneq_epi32_mask,
    _mm512_div_ps, _mm512_fmadd_ps, _mm512_fmsub_ps, _mm512_fnmadd_ps, _mm512_loadu_ps, _mm512_loadu_si512,
    _mm512_max_ps, _mm512_min_ps, _mm512_mul_ps, _mm512_set1_epi32, _mm512_set1_ps, _mm512_storeu_ps,
    _mm512_sub_ps,
};

/// Does the work with these instructions.
#[target_feature(enable = "avx2,fma,bmi1,avx512f,avx512dq,avx512vl")]
pub(super) fn run<T: Task>(task: &mut T) -> T::Output {
    task.run::<Avx512>()
}

struct Avx512;

impl Processor for Avx512 {
    type Node = Eight;
    type Leaf = Sixteen;
    type Exact = Four;
}

/// A register of sixteen.
#[derive(Clone, Copy)]
pub(super) struct Sixteen(__m512);

impl Lanes for Sixteen {
    const COUNT: usize = 16;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_set1_ps(x) })
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let sixteen: &[f32; 16] = from.first_chunk().expect("sixteen numbers");
        // SAFETY: the processor has AVX-512, and sixteen numbers stand at this address.
        Self(unsafe { _mm512_loadu_ps(sixteen.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let sixteen: &mut [f32; 16] = to.first_chunk_mut().expect("room for sixteen");
        // SAFETY: the processor has AVX-512, and there is room for sixteen numbers at this address.
        unsafe { _mm512_storeu_ps(sixteen.as_mut_ptr(), self.0) };
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_add_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_sub_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_mul_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_div_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, less: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_fmsub_ps(self.0, factor.0, less.0) })
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_fmadd_ps(self.0, factor.0, addend.0) })
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_fnmadd_ps(self.0, factor.0, addend.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the processor has AVX-512.
        Self(unsafe { _mm512_abs_ps(self.0) })
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: the processor has AVX-512.
        u32::from(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn others(number: u32, among: &[u32]) -> u32 {
        let sixteen: &[u32; 16] = among.first_chunk().expect("sixteen numbers");
        // SAFETY: the processor has AVX-512, and sixteen numbers stand at this address.
        u32::from(unsafe {
            let among = _mm512_loadu_si512(sixteen.as_ptr().cast());
            _mm512_cmpneq_epi32_mask(among, _mm512_set1_epi32(number.cast_signed()))
        })
    }
}
