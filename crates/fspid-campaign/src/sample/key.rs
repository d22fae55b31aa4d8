//! Numbers that look random and depend on a key: for the permutations and scrambles that need
//! hundreds of them for each coordinate.

use super::random;

/// A key of 128 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Key(u64, u64);

impl Key {
    /// The key of a stream.
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        Self(random::bits(seed, stream, 0), random::bits(seed, stream, 1))
    }

    /// 64 bits for each number, no two of them related to the eye of a test.
    pub(super) const fn hash(&self, number: u64) -> u64 {
        mixed(mixed(number ^ self.0).wrapping_add(self.1))
    }
}

/// A bijection of 64-bit numbers in which every bit changes about half of all bits.
///
/// # Source
/// G. L. Steele, D. Lea and C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA
/// 2014: the output function of `SplitMix64`, with the multipliers and shifts of D. Stafford's
/// variant 13.
const fn mixed(number: u64) -> u64 {
    let number = (number ^ (number >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    number ^ (number >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mixing_is_that_of_the_published_generator() {
        // The first three numbers of SplitMix64 from the seed 1234567; its increment is the
        // golden ratio. The values are on rosettacode.org, "Pseudo-random numbers/Splitmix64".
        let golden = 0x9e37_79b9_7f4a_7c15_u64;
        let output = |k: u64| mixed(1_234_567_u64.wrapping_add(golden.wrapping_mul(k)));
        let expected =
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!([output(1), output(2), output(3)], expected);
    }

    #[test]
    fn each_bit_of_a_number_changes_each_bit_of_its_hash_in_about_half_of_all_cases() {
        let key = Key::new(11, 0);
        let trials = 4096_u64;
        for bit in 0..64 {
            let mut changes = [0_u32; 64];
            for number in 0..trials {
                let difference = key.hash(number) ^ key.hash(number ^ (1 << bit));
                for (place, count) in changes.iter_mut().enumerate() {
                    *count += u32::from(difference >> place & 1 == 1);
                }
            }
            // Five standard errors of a share of a half, which is √4096 / 2 = 32: 4096 shares.
            assert!(changes.iter().all(|count| count.abs_diff(2048) < 160), "{bit}: {changes:?}");
        }
    }

    #[test]
    fn keys_depend_on_seed_and_stream() {
        assert_eq!(Key::new(1, 2), Key::new(1, 2));
        assert_ne!(Key::new(1, 2), Key::new(1, 3));
        assert_ne!(Key::new(1, 2), Key::new(2, 2));
    }
}
