//! Sobol's sequence with direction numbers of Joe and Kuo, and its nested random scramble.

use super::directions::DIRECTIONS;
use super::key::Key;

/// Binary digits of a point before its scramble, so many points can be told apart.
const DIGITS: usize = 32;

/// One dimension of the sequence.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sobol {
    /// Direction numbers $v_k = m_k / 2^k$ in units of 2⁻³².
    directions: [u32; DIGITS],
    key: Key,
}

impl Sobol {
    /// A dimension, counted from 0, scrambled by a key. One that is not stored repeats the first;
    /// [`super::Cube`] refuses it.
    pub(super) fn new(dimension: usize, key: Key) -> Self {
        let row = dimension.checked_sub(1).and_then(|row| DIRECTIONS.get(row));
        Self { directions: row.map_or_else(radical_inverse, directions), key }
    }

    /// The coordinate of a point as a binary fraction of 32 digits, before its scramble.
    ///
    /// $$ x_i = \bigoplus_k i_k v_k $$
    ///
    /// with the binary digits $i_k$ of the point's number, in natural order and not in that of the
    /// Gray code.
    fn digits(&self, point: u64) -> u32 {
        let directions = self.directions.iter().enumerate();
        directions.filter(|(k, _)| point >> k & 1 == 1).fold(0, |digits, (_, v)| digits ^ v)
    }

    /// The scrambled coordinate of a point, as a binary fraction of 64 digits.
    ///
    /// Each digit is turned or not as a hash of the digits before it says: the nested uniform
    /// scramble of Owen (1995), in which every node of the binary tree of intervals has a random
    /// bit of its own. It keeps the net, and unlike a digital shift it makes the error for smooth
    /// functions fall as $n^{-3/2}$. The hash stands for the bits of a tree that no memory holds,
    /// as in Burley (2020); that work takes one weak hash for all digits, because pictures need
    /// billions of points. Here a hash for each digit costs nothing beside a flight.
    ///
    /// The digits beyond the 32nd are 0 before the scramble, thus independent after it: bits of
    /// the hash of the 32.
    ///
    /// # Source
    /// A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995, and "Scrambled net
    /// variance for integrals of smooth functions", Annals of Statistics 25 (1997); B. Burley,
    /// "Practical hash-based Owen scrambling", Journal of Computer Graphics Techniques 9 (2020).
    pub(super) fn bits(&self, point: u64) -> u64 {
        let digits = u64::from(self.digits(point));
        let turned = (0..DIGITS)
            .fold(0, |turned, depth| turned << 1 | self.key.hash(node(digits, depth)) >> 63);
        (digits ^ turned) << 32 | self.key.hash(node(digits, DIGITS)) >> 32
    }
}

/// Number of the interval of width $2^{-depth}$ that holds a point, among those of all widths: the
/// root is 1, the halves of n are 2n and 2n + 1.
const fn node(digits: u64, depth: usize) -> u64 {
    (1 << depth) | (digits >> (DIGITS - depth))
}

/// Direction numbers of the first dimension: $m_k = 1$, the sequence of van der Corput.
fn radical_inverse() -> [u32; DIGITS] {
    std::array::from_fn(|k| 1 << (DIGITS - 1 - k))
}

/// Direction numbers of a primitive polynomial of degree s and its initial numbers.
///
/// $$ m_k = 2 a_1 m_{k-1} \oplus \ldots \oplus 2^{s-1} a_{s-1} m_{k-s+1} \oplus 2^s m_{k-s}
/// \oplus m_{k-s} $$
///
/// # Source
/// P. Bratley and B. L. Fox, "Algorithm 659: Implementing Sobol's quasirandom sequence generator",
/// ACM Transactions on Mathematical Software 14 (1988).
fn directions(&(polynomial, initial): &(u32, &[u32])) -> [u32; DIGITS] {
    let degree = initial.len();
    // As fractions m_k / 2^k the powers of two become shifts of the whole: 2^j m_{k-j} is v_{k-j},
    // and m_{k-s} without its power is v_{k-s} shifted by s.
    let mut v = [0; DIGITS];
    for k in 0..DIGITS {
        let before = |j: usize| k.checked_sub(j).and_then(|at| v.get(at)).copied().unwrap_or(0);
        let new = initial.get(k).map_or_else(
            || {
                let taken = (1..degree).filter(|j| polynomial >> (degree - j) & 1 == 1);
                taken.fold(before(degree) ^ before(degree) >> degree, |sum, j| sum ^ before(j))
            },
            |m| m << (DIGITS - 1 - k),
        );
        if let Some(here) = v.get_mut(k) {
            *here = new;
        }
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Natural number of a point, then its digits in each dimension.
    fn fixture() -> impl Iterator<Item = Vec<u64>> {
        let rows = include_str!("../../tests/data/sobol.csv").lines().skip(1);
        rows.map(|row| row.split(',').map(|field| field.parse().unwrap()).collect())
    }

    #[test]
    fn points_before_their_scramble_are_those_of_scipy_in_every_dimension() {
        let axes: Vec<Sobol> = (0..161).map(|d| Sobol::new(d, Key::new(0, 0))).collect();
        let mut compared = 0;
        for row in fixture() {
            let (point, expected) = row.split_first().unwrap();
            assert_eq!(expected.len(), axes.len());
            for (axis, digits) in axes.iter().zip(expected) {
                assert_eq!(u64::from(axis.digits(*point)), *digits, "point {point}");
                compared += 1;
            }
        }
        assert_eq!(compared, 17 * 161);
    }

    #[test]
    fn a_scramble_turns_digits_by_the_digits_before_them_alone() {
        let axis = Sobol::new(5, Key::new(3, 5));
        for (a, b) in [(0_u64, 1_u64), (12, 4097), (77, 78), (1, 1 << 31)] {
            let [before, after] =
                [axis.digits(a) ^ axis.digits(b), ((axis.bits(a) ^ axis.bits(b)) >> 32) as u32];
            // Nested: as many leading digits agree as did before.
            assert_eq!(before.leading_zeros(), after.leading_zeros());
        }
    }

    #[test]
    fn the_root_and_the_leaves_of_the_tree_have_numbers_of_their_own() {
        assert_eq!(node(0xffff_ffff, 0), 1);
        assert_eq!([node(0, 1), node(0x8000_0000, 1)], [2, 3]);
        assert_eq!(node(0xffff_ffff, 32), 0x1_ffff_ffff);
    }
}
