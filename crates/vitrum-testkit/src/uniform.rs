//! Uniform random numbers for a sampler under test.
//!
//! `SplitMix64` (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators"): one addition and one
//! mixing step per number, equidistributed over its period of 2^64, and seeded by any integer. It is kept apart from
//! the renderer's own samplers, so that a flaw in those cannot hide in a test of something else.

/// A stream of uniform numbers in [0, 1), determined by its seed.
#[derive(Clone, Debug)]
pub struct Uniform {
    state: u64,
}

impl Uniform {
    /// The stream of this seed. Any seed is a good one; neighbouring seeds give unrelated streams.
    pub fn new(seed: u64) -> Self {
        // Seeds that differ little would start overlapping streams, hence the mixing.
        Self { state: mix(seed) }
    }

    /// The next number: a multiple of 2^-53 in [0, 1).
    pub fn number(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        (mix(self.state) >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// The next two numbers: a point in the unit square.
    pub fn pair(&mut self) -> [f64; 2] {
        [self.number(), self.number()]
    }
}

/// The finaliser of `SplitMix64` (Stafford's variant 13): a bijection in which every input bit stirs every output bit.
fn mix(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Moments, z_test};

    #[test]
    fn numbers_lie_in_the_unit_interval_with_mean_a_half() {
        let mut uniform = Uniform::new(1);
        let moments: Moments =
            (0..100_000).map(|_| uniform.number()).inspect(|u| assert!((0.0..1.0).contains(u))).collect();
        assert!(z_test(&moments, 0.5).passes(1e-3));
        // The variance of the uniform distribution is 1/12, that of its estimate (1/80 - 1/144)/n: 4 sigma of it.
        assert!(
            (moments.variance() - 1.0 / 12.0).abs()
                < 4.0 * (1.0f64 / 80.0 - 1.0 / 144.0).sqrt() / 100_000.0f64.sqrt()
        );
    }

    #[test]
    fn the_stream_is_its_seeds() {
        let [first, again, other] = [7, 7, 8].map(|seed| Uniform::new(seed).pair());
        assert_eq!(first, again);
        assert_ne!(first, other);
    }
}
