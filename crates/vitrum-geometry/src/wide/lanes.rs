//! Numbers side by side: what the traversal computes with, whatever the processor.
//!
//! Everything done with [`Lanes`] is conservative, so that a lane may be computed with or without a fused multiply-add: what
//! is found does not depend on it. [`Doubles`] decide, so they are the same numbers everywhere.

use glam::Vec3A;

/// A kind of processor.
pub(crate) trait Processor {
    /// For the eight children of a node.
    type Node: Lanes;
    /// For the items of a block, all sixteen or half of them.
    type Leaf: Lanes;
    /// For one ray, or one triangle.
    type Exact: Doubles;
}

/// Four `f64`, each rounded once by every operation, as IEEE 754 says.
pub(crate) trait Doubles: Copy {
    fn new(numbers: [f64; 4]) -> Self;
    fn widen(numbers: [f32; 4]) -> Self;
    fn numbers(self) -> [f64; 4];
    /// The first three, rounded.
    fn narrow(self) -> Vec3A;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// The smaller of two; the second where one is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger of two; the second where one is NaN.
    fn max(self, other: Self) -> Self;
    /// These magnitudes with those signs.
    fn with_signs_of(self, other: Self) -> Self;
    /// A bit for each of the four where self ≤ other.
    fn at_most(self, other: Self) -> u32;
    /// The smallest; none may be NaN.
    fn least(self) -> f64;
    /// The largest; none may be NaN.
    fn largest(self) -> f64;
    /// The second, third and first number, and the fourth.
    fn turned_left(self) -> Self;
    /// The third, first and second number, and the fourth.
    fn turned_right(self) -> Self;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self::new([x; 4])
    }
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
    /// A bit for each of the first of these numbers that is not this one. Panics if there are not enough.
    fn others(number: u32, among: &[u32]) -> u32;
}

/// Any processor.
pub(crate) struct Portable;

impl Processor for Portable {
    type Node = Eight;
    type Leaf = Eight;
    type Exact = Four;
}

/// Four numbers one by one.
#[derive(Clone, Copy)]
pub(crate) struct Four([f64; 4]);

impl Four {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl Doubles for Four {
    #[inline(always)]
    fn new(numbers: [f64; 4]) -> Self {
        Self(numbers)
    }
    #[inline(always)]
    fn widen(numbers: [f32; 4]) -> Self {
        Self(numbers.map(f64::from))
    }
    #[inline(always)]
    fn numbers(self) -> [f64; 4] {
        self.0
    }
    #[inline(always)]
    fn narrow(self) -> Vec3A {
        let [x, y, z, _] = self.0.map(|number| number as f32);
        Vec3A::new(x, y, z)
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
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn with_signs_of(self, other: Self) -> Self {
        self.zip(other, f64::copysign)
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        (0..4).fold(0, |mask, i| mask | u32::from(self.0[i] <= other.0[i]) << i)
    }
    #[inline(always)]
    fn least(self) -> f64 {
        let [a, b, c, d] = self.0;
        a.min(b).min(c).min(d)
    }
    #[inline(always)]
    fn largest(self) -> f64 {
        let [a, b, c, d] = self.0;
        a.max(b).max(c).max(d)
    }
    #[inline(always)]
    fn turned_left(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([b, c, a, d])
    }
    #[inline(always)]
    fn turned_right(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([c, a, b, d])
    }
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
    fn others(number: u32, among: &[u32]) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(among[i] != number) << i)
    }
}
