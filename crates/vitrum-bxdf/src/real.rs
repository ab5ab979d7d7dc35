//! The two scalars that the models are written for, and their vectors.
//!
//! Square roots are correctly rounded (IEEE 754) whoever computes them, and every transcendental function comes from `libm`,
//! so that results are the same on every machine and with every choice of features.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};
use glam::{DVec3, Vec3};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
    impl Sealed for glam::Vec3 {}
    impl Sealed for glam::DVec3 {}
}

/// `f32` or `f64`.
pub trait Real:
    sealed::Sealed
    + Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// glam's vector of three of them: a direction, or a colour.
    type Vec3: Vector<Self>;

    /// The nearest value to `x`.
    fn from_f64(x: f64) -> Self;
    /// The same value, exactly.
    fn to_f64(self) -> f64;
    /// The square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// The absolute value.
    fn abs(self) -> Self;
    /// `self` raised to `exponent`, for `self ≥ 0`.
    fn powf(self, exponent: Self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// True unless infinite or NaN.
    fn is_finite(self) -> bool;

    /// The exponential of anything below this is zero.
    fn smallest_logarithm() -> Self;
    /// The distance from one to the next larger number.
    fn epsilon() -> Self;

    /// Zero.
    #[inline]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    /// One.
    #[inline]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
    /// π.
    #[inline]
    fn pi() -> Self {
        Self::from_f64(core::f64::consts::PI)
    }
    /// The larger of two; `self` where `other` is NaN.
    #[inline]
    fn at_least(self, other: Self) -> Self {
        if self < other { other } else { self }
    }
    /// The smaller of two; `self` where `other` is NaN.
    #[inline]
    fn at_most(self, other: Self) -> Self {
        if self > other { other } else { self }
    }
    /// `self` times itself.
    #[inline]
    fn squared(self) -> Self {
        self * self
    }
}

/// glam's vector of three [`Real`]s.
pub trait Vector<R>:
    sealed::Sealed
    + Copy
    + Debug
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<R, Output = Self>
    + Div<R, Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// From its components.
    fn new(x: R, y: R, z: R) -> Self;
    /// All components equal.
    fn splat(v: R) -> Self;
    /// First component.
    fn x(self) -> R;
    /// Second component.
    fn y(self) -> R;
    /// Third component: the cosine of a direction's angle to the normal.
    fn z(self) -> R;
    /// Scalar product.
    fn dot(self, other: Self) -> R;
    /// True when every component is zero.
    fn is_zero(self) -> bool;
    /// Mean of the components.
    fn mean(self) -> R;

    /// Each component as `f` maps it.
    #[inline]
    fn map(self, mut f: impl FnMut(R) -> R) -> Self {
        Self::new(f(self.x()), f(self.y()), f(self.z()))
    }
    /// `f` of the components of two, one by one.
    #[inline]
    fn zip(self, other: Self, mut f: impl FnMut(R, R) -> R) -> Self {
        Self::new(f(self.x(), other.x()), f(self.y(), other.y()), f(self.z(), other.z()))
    }
    /// The vector of length one in this direction, which is not zero.
    #[inline]
    fn normalised(self) -> Self
    where
        R: Real<Vec3 = Self>,
    {
        self / self.dot(self).sqrt()
    }
    /// Mirrored at the surface: the z component with the other sign.
    #[inline]
    fn mirrored(self) -> Self
    where
        R: Real<Vec3 = Self>,
    {
        Self::new(self.x(), self.y(), -self.z())
    }
}

macro_rules! real {
    ($real:ty, $vec3:ty, $sqrt:path, $pow:path, $sincos:path, $smallest_logarithm:literal) => {
        impl Real for $real {
            type Vec3 = $vec3;
            #[inline]
            fn from_f64(x: f64) -> Self {
                x as Self
            }
            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline]
            fn abs(self) -> Self {
                <$real>::abs(self)
            }
            #[inline]
            fn powf(self, exponent: Self) -> Self {
                $pow(self, exponent)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                $sincos(self)
            }
            #[inline]
            fn is_finite(self) -> bool {
                <$real>::is_finite(self)
            }
            #[inline]
            fn smallest_logarithm() -> Self {
                $smallest_logarithm
            }
            #[inline]
            fn epsilon() -> Self {
                <$real>::EPSILON
            }
        }

        impl Vector<$real> for $vec3 {
            #[inline]
            fn new(x: $real, y: $real, z: $real) -> Self {
                <$vec3>::new(x, y, z)
            }
            #[inline]
            fn splat(v: $real) -> Self {
                <$vec3>::splat(v)
            }
            #[inline]
            fn x(self) -> $real {
                self.x
            }
            #[inline]
            fn y(self) -> $real {
                self.y
            }
            #[inline]
            fn z(self) -> $real {
                self.z
            }
            #[inline]
            fn dot(self, other: Self) -> $real {
                <$vec3>::dot(self, other)
            }
            #[inline]
            fn is_zero(self) -> bool {
                self.x == 0.0 && self.y == 0.0 && self.z == 0.0
            }
            #[inline]
            fn mean(self) -> $real {
                (self.x + self.y + self.z) / 3.0
            }
        }
    };
}

#[cfg(feature = "std")]
mod root {
    pub(super) fn single(x: f32) -> f32 {
        x.sqrt()
    }
    pub(super) fn double(x: f64) -> f64 {
        x.sqrt()
    }
}
#[cfg(not(feature = "std"))]
mod root {
    pub(super) use libm::{sqrt as double, sqrtf as single};
}

real!(f32, Vec3, root::single, libm::powf, libm::sincosf, -105.0);
real!(f64, DVec3, root::double, libm::pow, libm::sincos, -746.0);
