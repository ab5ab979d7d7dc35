//! The instructions that a tree is walked with.

use super::lanes::{Portable, Processor};

/// What the processor can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Isa {
    /// Any processor.
    Portable,
    /// AVX2, FMA and BMI1, which came together.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// The same and AVX-512 F, DQ and VL.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

/// Work that is compiled once for each kind of processor.
///
/// A trait and not a closure: closures are compiled for any processor, whatever function they are called from, unless the
/// compiler happens to inline them.
pub(crate) trait Task {
    /// What the work finds.
    type Output;

    /// Does it. Must be `#[inline(always)]`, with all that it calls on its way.
    fn run<P: Processor>(&mut self) -> Self::Output;
}

impl Isa {
    /// The best that this processor has.
    pub(crate) fn best() -> Self {
        *Self::all().last().expect("at least one")
    }

    /// All that this processor has, the best last.
    pub(crate) fn all() -> &'static [Self] {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
        {
            let avx512 = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl");
            return &[Self::Portable, Self::Avx2, Self::Avx512][..if avx512 { 3 } else { 2 }];
        }
        &[Self::Portable]
    }

    /// Does the work with these instructions.
    #[inline(always)]
    pub(crate) fn run<T: Task>(self, task: &mut T) -> T::Output {
        match self {
            Self::Portable => on_any_processor(task),
            #[cfg(target_arch = "x86_64")]
            #[allow(unsafe_code)]
            // SAFETY: `Isa::Avx2` is made only where the processor was asked for these instructions.
            Self::Avx2 => unsafe { super::avx2::run(task) },
            #[cfg(target_arch = "x86_64")]
            #[allow(unsafe_code)]
            // SAFETY: as above.
            Self::Avx512 => unsafe { super::avx512::run(task) },
        }
    }
}

// Not inlined: it would stand in the way of what nearly every processor does.
#[inline(never)]
fn on_any_processor<T: Task>(task: &mut T) -> T::Output {
    task.run::<Portable>()
}
