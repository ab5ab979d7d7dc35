//! [`Lanes`] for processors with AVX2 and FMA.
//!
//! Values of this type are made only inside functions that are compiled for these instructions, and these are called only
//! after the processor has been asked ([`super::isa::Isa::best`]): that is what makes every block below sound.
#![allow(unsafe_code)]

use super::isa::Task;
use super::lanes::{Doubles, Lanes, Processor};
use glam::Vec3A;
use std::arch::x86_64::{
    __m256, __m256d, _CMP_LE_OQ, _mm_cvtsd_f64, _mm_loadu_ps, _mm_max_pd, _mm_max_sd, _mm_min_pd, _mm_min_sd,
    _mm_unpackhi_pd, _mm256_add_pd, _mm256_add_ps, _mm256_and_pd, _mm256_andnot_pd, _mm256_andnot_ps,
    _mm256_castpd256_pd128, _mm256_castsi256_ps, _mm256_cmp_pd, _mm256_cmp_ps, _mm256_cmpeq_epi32,
    _mm256_cvtpd_ps, _mm256_cvtps_pd, _mm256_div_pd, _mm256_div_ps, _mm256_extractf128_pd, _mm256_fmadd_ps,
    _mm256_fmsub_ps, _mm256_fnmadd_ps, _mm256_loadu_pd, _mm256_loadu_ps, _mm256_loadu_si256, _mm256_max_pd,
    _mm256_max_ps, _mm256_min_pd, _mm256_min_ps, _mm256_movemask_pd, _mm256_movemask_ps, _mm256_mul_pd,
    _mm256_mul_ps, _mm256_or_pd, _mm256_permute4x64_pd, _mm256_set1_epi32, _mm256_set1_pd, _mm256_set1_ps,
    _mm256_storeu_pd, _mm256_storeu_ps, _mm256_sub_pd, _mm256_sub_ps,
};

/// Does the work with these instructions.
#[target_feature(enable = "avx2,fma,bmi1")]
pub(super) fn run<T: Task>(task: &mut T) -> T::Output {
    task.run::<Avx2>()
}

struct Avx2;

impl Processor for Avx2 {
    type Node = Eight;
    type Leaf = Eight;
    type Exact = Four;
}

/// A register of four.
#[derive(Clone, Copy)]
pub(super) struct Four(__m256d);

impl Doubles for Four {
    #[inline(always)]
    fn new(numbers: [f64; 4]) -> Self {
        // SAFETY: the processor has AVX (see the head of this file), and four numbers stand at this address.
        Self(unsafe { _mm256_loadu_pd(numbers.as_ptr()) })
    }
    #[inline(always)]
    fn widen(numbers: [f32; 4]) -> Self {
        // SAFETY: the processor has AVX, and four numbers stand at this address.
        Self(unsafe { _mm256_cvtps_pd(_mm_loadu_ps(numbers.as_ptr())) })
    }
    #[inline(always)]
    fn numbers(self) -> [f64; 4] {
        let mut numbers = [0.0; 4];
        // SAFETY: the processor has AVX, and there is room for four numbers at this address.
        unsafe { _mm256_storeu_pd(numbers.as_mut_ptr(), self.0) };
        numbers
    }
    #[inline(always)]
    fn narrow(self) -> Vec3A {
        // SAFETY: the processor has AVX.
        Vec3A::from(unsafe { _mm256_cvtpd_ps(self.0) })
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_add_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_sub_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_mul_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_div_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn with_signs_of(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe {
            let sign = _mm256_set1_pd(-0.0);
            _mm256_or_pd(_mm256_andnot_pd(sign, self.0), _mm256_and_pd(sign, other.0))
        })
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: the processor has AVX.
        unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0)) }.cast_unsigned()
    }
    #[inline(always)]
    fn least(self) -> f64 {
        // SAFETY: the processor has AVX.
        unsafe {
            let two = _mm_min_pd(_mm256_castpd256_pd128(self.0), _mm256_extractf128_pd::<1>(self.0));
            _mm_cvtsd_f64(_mm_min_sd(two, _mm_unpackhi_pd(two, two)))
        }
    }
    #[inline(always)]
    fn largest(self) -> f64 {
        // SAFETY: the processor has AVX.
        unsafe {
            let two = _mm_max_pd(_mm256_castpd256_pd128(self.0), _mm256_extractf128_pd::<1>(self.0));
            _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)))
        }
    }
    #[inline(always)]
    fn turned_left(self) -> Self {
        // SAFETY: the processor has AVX2.
        Self(unsafe { _mm256_permute4x64_pd::<0b11_00_10_01>(self.0) })
    }
    #[inline(always)]
    fn turned_right(self) -> Self {
        // SAFETY: the processor has AVX2.
        Self(unsafe { _mm256_permute4x64_pd::<0b11_01_00_10>(self.0) })
    }
}

/// A register of eight.
#[derive(Clone, Copy)]
pub(super) struct Eight(__m256);

impl Lanes for Eight {
    const COUNT: usize = 8;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        // SAFETY: the processor has AVX (see the head of this file).
        Self(unsafe { _mm256_set1_ps(x) })
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let eight: &[f32; 8] = from.first_chunk().expect("eight numbers");
        // SAFETY: the processor has AVX, and eight numbers stand at this address.
        Self(unsafe { _mm256_loadu_ps(eight.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let eight: &mut [f32; 8] = to.first_chunk_mut().expect("room for eight");
        // SAFETY: the processor has AVX, and there is room for eight numbers at this address.
        unsafe { _mm256_storeu_ps(eight.as_mut_ptr(), self.0) };
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
    fn div(self, other: Self) -> Self {
        // SAFETY: the processor has AVX.
        Self(unsafe { _mm256_div_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, less: Self) -> Self {
        // SAFETY: the processor has FMA.
        Self(unsafe { _mm256_fmsub_ps(self.0, factor.0, less.0) })
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: the processor has FMA.
        Self(unsafe { _mm256_fmadd_ps(self.0, factor.0, addend.0) })
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: the processor has FMA.
        Self(unsafe { _mm256_fnmadd_ps(self.0, factor.0, addend.0) })
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
    #[inline(always)]
    fn others(number: u32, among: &[u32]) -> u32 {
        let eight: &[u32; 8] = among.first_chunk().expect("eight numbers");
        // SAFETY: the processor has AVX2, and eight numbers stand at this address.
        let same = unsafe {
            let among = _mm256_loadu_si256(eight.as_ptr().cast());
            let same = _mm256_cmpeq_epi32(among, _mm256_set1_epi32(number.cast_signed()));
            _mm256_movemask_ps(_mm256_castsi256_ps(same))
        };
        !same.cast_unsigned() & 0xff
    }
}
