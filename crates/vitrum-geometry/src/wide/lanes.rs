//! Numbers side by side: what the traversal computes with, whatever the processor.
//!
//! Everything done with them is conservative, so that a lane may be computed with or without a fused multiply-add: what is
//! found does not depend on it.

/// A kind of processor.
pub(crate) trait Processor {
    /// For the eight children of a node.
    type Node: Lanes;
    /// For the items of a block, all sixteen or half of them.
    type Leaf: Lanes;
}

/// Eight or sixteen `f32`.
pub(crate) trait Lanes: Copy {
    /// How many.
    const COUNT: usize;

    fn splat(x: f32) -> Self;
    /// The first of these. Panics if there are not enough.
    fn load(from: &[f32]) -> Self;
    /// To the first of these. Panics if there are not enough.
    fn store(self, to: &mut [f32]);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// self · factor − less, fused where the processor does so at no cost.
    fn mul_sub(self, factor: Self, less: Self) -> Self;
    /// self · factor + addend, fused where the processor does so at no cost.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// addend − self · factor, fused where the processor does so at no cost.
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self;
    /// The smaller of two; the second where one is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger of two; the second where one is NaN.
    fn max(self, other: Self) -> Self;
    fn abs(self) -> Self;
    /// A bit for each lane where self ≤ other.
    fn at_most(self, other: Self) -> u32;
    /// A bit for each of the first of these numbers that is this one. Panics if there are not enough.
    fn equal(number: u32, to: &[u32]) -> u32;
}

/// Any processor.
pub(crate) struct Portable;

impl Processor for Portable {
    type Node = Eight;
    type Leaf = Eight;
}

/// Loops that the compiler turns into what there is.
#[derive(Clone, Copy)]
pub(crate) struct Eight([f32; 8]);

impl Eight {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl Lanes for Eight {
    const COUNT: usize = 8;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        Self(*from.first_chunk().expect("eight numbers"))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        *to.first_chunk_mut().expect("room for eight") = self.0;
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, less: Self) -> Self {
        self.mul(factor).sub(less)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self.mul(factor).add(addend)
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        addend.sub(self.mul(factor))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(self.0[i] <= other.0[i]) << i)
    }
    #[inline(always)]
    fn equal(number: u32, to: &[u32]) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(to[i] == number) << i)
    }
}
