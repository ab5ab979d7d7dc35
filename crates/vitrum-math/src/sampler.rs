//! Sample points: Owen-scrambled Sobol' pairs, addressed by place instead of drawn from a generator.
//!
//! A number is a pure function of (seed, pixel, sample index, ray-tree node, purpose). No generator carries state,
//! so a branch that is not taken never shifts what another one draws, and pixels, samples and machines are
//! independent of each other's order.
//!
//! For one pixel, node and purpose the pairs of all sample indices form one randomised (0, 2)-sequence in base 2:
//! every aligned power-of-two range of indices is stratified in all elementary intervals. Different addresses are
//! independently shuffled and scrambled.
//!
//! Sources: I. Sobol', 1967 (the sequence); A. Owen, 1995 (nested uniform scrambling); S. Laine and T. Karras,
//! Stratified Sampling for Stochastic Transparency, 2011 (scrambling by a hash whose bits depend on lower bits only);
//! B. Burley, Practical Hash-based Owen Scrambling, 2020 (index shuffling and padding of dimensions); N. Vegdahl,
//! Building a Better LK Hash, 2021 (its constants).

/// What a number is drawn for: numbers of different purposes at one node are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    /// Position inside the pixel.
    Film = 1,
    /// Position on the lens.
    Lens = 2,
    /// Which part of a model a path follows; and whether it goes on.
    Choice = 3,
    /// Direction that a model scatters to.
    Direction = 4,
    /// Which light is asked, and at which of its points.
    Light = 5,
}

/// Where a ray stands in its tree: the root, or a child of another node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeKey(u64);

impl NodeKey {
    /// The camera ray.
    pub const ROOT: Self = Self(1);

    /// The child that is transmitted in the one direction that Snell's law gives.
    #[inline]
    pub fn transmitted(self) -> Self {
        Self(self.folded() << 2)
    }

    /// The child that is mirrored.
    #[inline]
    pub fn reflected(self) -> Self {
        Self(self.folded() << 2 | 1)
    }

    /// The child that goes anywhere.
    #[inline]
    pub fn scattered(self) -> Self {
        Self(self.folded() << 2 | 2)
    }

    /// Exact for the first 30 levels; deeper keys are folded by a hash, which leaves a chance of 2⁻⁵⁹ that two nodes of
    /// one tree share their numbers.
    #[inline]
    fn folded(self) -> u64 {
        if self.0 >> 60 == 0 { self.0 } else { mix(self.0) >> 4 | 1 << 59 }
    }
}

/// How the numbers of different samples of a pixel hang together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sequence {
    /// They fill the unit square evenly.
    #[default]
    Sobol,
    /// Not at all: for measuring what the sequence gains.
    Independent,
}

/// One sample of one pixel: the part of the address that all nodes of a ray tree share.
#[derive(Clone, Copy, Debug)]
pub struct SampleAddress {
    pixel: u64,
    index: u32,
    sequence: Sequence,
}

impl SampleAddress {
    /// Sample `index` of the pixel in column `x` and row `y` of the whole image, whatever part of it is rendered.
    #[inline]
    pub fn new(seed: u64, x: u32, y: u32, index: u32) -> Self {
        let pixel = mix(mix(seed) ^ (u64::from(y) << 32 | u64::from(x)));
        Self { pixel, index, sequence: Sequence::Sobol }
    }

    /// The same sample with numbers of another kind.
    #[inline]
    pub fn of_sequence(self, sequence: Sequence) -> Self {
        Self { sequence, ..self }
    }

    /// Two numbers in [0, 1), stratified together over the sample index.
    #[inline]
    pub fn pair(&self, node: NodeKey, purpose: Purpose) -> [f64; 2] {
        let of_address = self.of_address(node, purpose);
        [of_address.first(), of_address.second()]
    }

    /// The first number of the pair, for less than both.
    #[inline]
    pub fn first(&self, node: NodeKey, purpose: Purpose) -> f64 {
        self.of_address(node, purpose).first()
    }

    /// The second number of the pair, for less than both.
    #[inline]
    pub fn second(&self, node: NodeKey, purpose: Purpose) -> f64 {
        self.of_address(node, purpose).second()
    }

    #[inline]
    fn of_address(&self, node: NodeKey, purpose: Purpose) -> OfAddress {
        let key = mix(self.pixel ^ mix(node.0.wrapping_add(u64::from(purpose as u32) << 56)));
        match self.sequence {
            Sequence::Sobol => OfAddress::Sobol { key, index: owen_scramble(self.index, key as u32) },
            Sequence::Independent => OfAddress::Independent(mix(key ^ u64::from(self.index))),
        }
    }
}

/// What both numbers of an address are made of.
#[derive(Clone, Copy)]
enum OfAddress {
    /// The hash of the address, and the index of the point, shuffled.
    Sobol { key: u64, index: u32 },
    /// 64 random bits.
    Independent(u64),
}

impl OfAddress {
    #[inline]
    fn first(self) -> f64 {
        unit_interval(match self {
            Self::Sobol { key, index } => owen_scramble(index.reverse_bits(), (key >> 32) as u32),
            Self::Independent(bits) => bits as u32,
        })
    }

    #[inline]
    fn second(self) -> f64 {
        unit_interval(match self {
            Self::Sobol { key, index } => owen_scramble(sobol_second(index), mix(key) as u32),
            Self::Independent(bits) => (bits >> 32) as u32,
        })
    }
}

/// The second dimension of the Sobol' sequence: bit `i` of the index adds column `i` of Pascal's triangle modulo 2. Column
/// `i + 2^k` is column `i` folded once more by `2^k` bits, so that all columns are added by halves.
#[inline]
fn sobol_second(index: u32) -> u32 {
    let x = index ^ index >> 16;
    let x = x ^ (x >> 8 & 0x00ff_00ff);
    let x = x ^ (x >> 4 & 0x0f0f_0f0f);
    let x = x ^ (x >> 2 & 0x3333_3333);
    let x = x ^ (x >> 1 & 0x5555_5555);
    x.reverse_bits()
}

/// Nested uniform scrambling: every bit is flipped, or not, by a hash of the bits above it and the seed.
#[inline]
fn owen_scramble(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul(seed >> 16 | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

#[inline]
fn unit_interval(x: u32) -> f64 {
    f64::from(x) * (1.0 / 4_294_967_296.0)
}

/// A bijective mix of 64 bits in which every input bit moves every output bit (the finaliser of D. Stafford's thirteenth
/// variant, 2011).
#[inline]
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every aligned block of 2^m samples puts exactly one point in each elementary interval of area 2^-m: the defining
    /// property of a (0, m, 2)-net, which scrambling and shuffling must keep.
    #[test]
    fn aligned_blocks_are_nets() {
        for (seed, m) in [(0u64, 4u32), (1, 6), (77, 8), (5, 10)] {
            for block in [0u32, 1, 3] {
                let points: Vec<[f64; 2]> = (0..1u32 << m)
                    .map(|i| {
                        SampleAddress::new(seed, 3, 9, (block << m) + i).pair(NodeKey::ROOT, Purpose::Film)
                    })
                    .collect();
                for log_columns in 0..=m {
                    let (columns, rows) = (1u32 << log_columns, 1u32 << (m - log_columns));
                    let mut seen = vec![0; 1 << m];
                    for [u, v] in &points {
                        seen[((v * f64::from(rows)) as u32 * columns + (u * f64::from(columns)) as u32)
                            as usize] += 1;
                    }
                    assert!(seen.iter().all(|&n| n == 1), "seed {seed}, 2^{m} points, {columns} columns");
                }
            }
        }
    }

    /// Beyond 2^16 samples the net goes on: no repetition, still stratified.
    #[test]
    fn late_blocks_are_nets_too() {
        let points =
            (0..1024).map(|i| SampleAddress::new(2, 0, 0, (1 << 20) + i).pair(NodeKey::ROOT, Purpose::Lens));
        let mut cells: Vec<u32> = points.map(|[u, v]| (v * 32.0) as u32 * 32 + (u * 32.0) as u32).collect();
        cells.sort_unstable();
        assert_eq!(cells, (0..1024).collect::<Vec<_>>());
    }

    /// Against the definition: each column is the last one folded onto itself by one bit.
    #[test]
    fn the_second_dimension_is_pascals_triangle() {
        let by_columns = |index: u32| {
            let columns = std::iter::successors(Some(1u32 << 31), |column| Some(column ^ column >> 1));
            (0..32)
                .zip(columns)
                .filter(|(bit, _)| index >> bit & 1 == 1)
                .fold(0, |point, (_, column)| point ^ column)
        };
        for i in (0..70_000).chain((0..32).map(|bit| 1 << bit)).chain([u32::MAX, 0xdead_beef]) {
            assert_eq!(sobol_second(i), by_columns(i), "{i}");
        }
    }

    #[test]
    fn different_addresses_give_different_numbers() {
        let base = SampleAddress::new(0, 1, 2, 3);
        let mut all = vec![base.pair(NodeKey::ROOT, Purpose::Film)];
        all.push(base.pair(NodeKey::ROOT, Purpose::Lens));
        all.push(base.pair(NodeKey::ROOT.reflected(), Purpose::Film));
        all.push(base.pair(NodeKey::ROOT.transmitted(), Purpose::Film));
        for other in [(1, 1, 2, 3), (0, 2, 1, 3), (0, 1, 2, 4), (0, 1, 3, 3)] {
            all.push(
                SampleAddress::new(other.0, other.1, other.2, other.3).pair(NodeKey::ROOT, Purpose::Film),
            );
        }
        for (i, a) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|b| a != b));
        }
    }

    #[test]
    fn one_number_is_that_of_the_pair() {
        for sequence in [Sequence::Sobol, Sequence::Independent] {
            for index in 0..100 {
                let address = SampleAddress::new(5, 1, 2, index).of_sequence(sequence);
                let (node, purpose) = (NodeKey::ROOT.scattered(), Purpose::Choice);
                let both = [address.first(node, purpose), address.second(node, purpose)];
                assert_eq!(both, address.pair(node, purpose));
            }
        }
    }

    /// A smooth integrand's error falls much faster than independent sampling's 1/√N.
    #[test]
    fn integrates_a_smooth_function_faster_than_random_points() {
        let error = |n: u32| {
            let squares: f64 = (0..64)
                .map(|seed| {
                    let sum: f64 = (0..n)
                        .map(|i| SampleAddress::new(seed, 0, 0, i).pair(NodeKey::ROOT, Purpose::Film))
                        .map(|[u, v]| u * u * v)
                        .sum();
                    (sum / f64::from(n) - 1.0 / 6.0).powi(2)
                })
                .sum();
            (squares / 64.0).sqrt()
        };
        // Owen (1997): variance falls as N^-3 up to logarithms, so the error falls by about 32^1.5 = 181; random points
        // would give 5.7.
        let ratio = error(16) / error(512);
        assert!(ratio > 60.0, "error fell only by {ratio}");
    }

    #[test]
    fn deep_trees_keep_distinct_keys() {
        let (mut a, mut b) = (NodeKey::ROOT, NodeKey::ROOT.reflected());
        for _ in 0..500 {
            assert_ne!(a, b);
            assert_ne!(a.scattered(), b.scattered());
            (a, b) = (a.reflected(), b.transmitted());
        }
    }
}
