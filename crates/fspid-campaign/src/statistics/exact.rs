//! Sums of doubles without any rounding: the same bits in whatever order, and in whatever pieces, they are added.

/// Bits of a digit; the digits themselves are wider, so that many terms go in before anything is carried.
const DIGIT_BITS: usize = 32;
/// Terms that a digit of 64 bits has room for before it is carried: each adds less than 2³².
const ROOM: u32 = 1 << 30;
/// Place of the least bit of a double: it is 2⁻¹⁰⁷⁴.
const LEAST: i32 = -1074;
/// Digits for 2⁴⁰ doubles: from 2⁻¹⁰⁷⁴ to 2¹⁰²⁴, and 40 bits for their number.
const OF_VALUES: usize = (1024 + 1074 + 40) / DIGIT_BITS + 2;
/// Digits for as many squares.
const OF_SQUARES: usize = (2 * (1024 + 1074) + 40) / DIGIT_BITS + 2;

/// How many finite values there are, their sum and the sum of their squares, exactly.
///
/// Whole numbers are added, so that merging is associative and commutative in every bit. What a mean or a spread of them
/// is, is rounded once.
///
/// # Source
/// U. Kulisch, *Very fast and exact accumulation of products*, Computing 91 (2011): a register as long as the range of
/// the doubles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ExactSums {
    count: u64,
    values: Digits<OF_VALUES>,
    squares: Digits<OF_SQUARES>,
}

/// Mean and standard deviation of values whose sums are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MeanAndDeviation {
    pub(super) mean: f64,
    /// `None` for a single value.
    pub(super) deviation: Option<f64>,
}

impl ExactSums {
    /// Adds a finite value.
    pub(super) fn add(&mut self, value: f64) {
        let bits = value.to_bits();
        let (exponent, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
        // Subnormal numbers have the place of the least normal ones and no leading one.
        let (mantissa, place) = match exponent {
            0 => (fraction, 0),
            exponent => (fraction | 1 << 52, exponent as usize - 1),
        };
        self.count += 1;
        self.values.add(u128::from(mantissa), place, value < 0.0);
        self.squares.add(u128::from(mantissa) * u128::from(mantissa), 2 * place, false);
    }

    /// Adds what others were added to.
    pub(super) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.values.merge(&other.values);
        self.squares.merge(&other.squares);
    }

    /// Rounded once each; `None` without values, and where they are no doubles.
    ///
    /// $$ \bar x = S / n, \quad s^2 = \frac{n Q - S^2}{n (n - 1)} $$
    ///
    /// with $S$ the sum and $Q$ that of the squares: the difference that would cancel in doubles is one of whole numbers.
    pub(super) fn mean_and_deviation(&self) -> Option<MeanAndDeviation> {
        if self.count == 0 {
            return None;
        }
        let (negative, sum) = self.values.magnitude();
        let (_, squares) = self.squares.magnitude();
        let mean = quotient(&sum, self.count);
        let mean = if negative { -mean } else { mean };
        let n = self.count as f64;
        let deviation = (self.count > 1).then(|| {
            let spread = difference(&times(&squares, self.count), &square(&sum));
            let (leading, place) = leading(&spread);
            // An even power of two comes out of the root as a whole one.
            let odd = place.rem_euclid(2);
            let scaled = libm::scalbn(leading, odd) / (n * (n - 1.0));
            libm::scalbn(scaled.sqrt(), (place - odd) / 2 + LEAST)
        });
        let found = MeanAndDeviation { mean, deviation };
        (mean.is_finite() && deviation.unwrap_or(0.0).is_finite()).then_some(found)
    }
}

/// A whole number in digits of 32 bits, the least first, of which the last has the sign.
#[derive(Clone, Debug, PartialEq)]
struct Digits<const N: usize> {
    digits: Vec<i64>,
    terms: u32,
}

impl<const N: usize> Default for Digits<N> {
    fn default() -> Self {
        Self { digits: vec![0; N], terms: 0 }
    }
}

impl<const N: usize> Digits<N> {
    /// Adds `mantissa`, of at most 106 bits, times two to the power of `place`.
    fn add(&mut self, mantissa: u128, place: usize, negative: bool) {
        let (first, shift) = (place / DIGIT_BITS, place % DIGIT_BITS);
        let low = u128::from(mantissa as u64) << shift;
        let high = (mantissa >> 64) << shift;
        for (at, part) in [(first, low), (first + 64 / DIGIT_BITS, high)] {
            for (digit, bits) in self.digits.iter_mut().skip(at).zip([0, 32, 64]) {
                let part = i64::from((part >> bits) as u32);
                *digit += if negative { -part } else { part };
            }
        }
        // Two parts may meet in a digit.
        self.terms += 2;
        if self.terms >= ROOM {
            self.carry();
        }
    }

    fn merge(&mut self, other: &Self) {
        self.carry();
        let mut other = other.clone();
        other.carry();
        self.digits.iter_mut().zip(other.digits).for_each(|(mine, theirs)| *mine += theirs);
        self.carry();
    }

    /// Leaves each digit but the last from 0 to 2³² − 1: the one way to write the number.
    fn carry(&mut self) {
        let mut carried = 0;
        let last = self.digits.len().saturating_sub(1);
        for (index, digit) in self.digits.iter_mut().enumerate() {
            let whole = *digit + carried;
            carried = if index == last { 0 } else { whole >> DIGIT_BITS };
            *digit = whole - (carried << DIGIT_BITS);
        }
        self.terms = 0;
    }

    /// Whether it is below 0, and its size.
    fn magnitude(&self) -> (bool, Vec<u32>) {
        let mut size = self.clone();
        size.carry();
        let negative = size.digits.last().is_some_and(|last| *last < 0);
        if negative {
            size.digits.iter_mut().for_each(|digit| *digit = -*digit);
            size.carry();
        }
        (negative, size.digits.into_iter().map(|digit| digit as u32).collect())
    }
}

/// A whole number times a small one.
fn times(digits: &[u32], factor: u64) -> Vec<u32> {
    let mut carried = 0_u128;
    let mut product: Vec<u32> = Vec::with_capacity(digits.len() + 2);
    for digit in digits.iter().chain(&[0, 0]) {
        carried += u128::from(*digit) * u128::from(factor);
        product.push(carried as u32);
        carried >>= DIGIT_BITS;
    }
    product
}

fn square(digits: &[u32]) -> Vec<u32> {
    let mut product = vec![0_u32; 2 * digits.len()];
    for (place, one) in digits.iter().enumerate() {
        let mut carried = 0_u64;
        for (sum, other) in product.iter_mut().skip(place).zip(digits.iter().chain(&[0])) {
            carried += u64::from(*sum) + u64::from(*one) * u64::from(*other);
            *sum = carried as u32;
            carried >>= DIGIT_BITS;
        }
    }
    product
}

/// Of two whole numbers, the second of which is not above the first.
fn difference(of: &[u32], less: &[u32]) -> Vec<u32> {
    let mut borrowed = 0_i64;
    let digit = |place: usize| {
        let at = |digits: &[u32]| i64::from(digits.get(place).copied().unwrap_or(0));
        borrowed += at(of) - at(less);
        let digit = borrowed as u32;
        borrowed >>= DIGIT_BITS;
        digit
    };
    (0..of.len().max(less.len())).map(digit).collect()
}

/// A whole number of 2⁻¹⁰⁷⁴ over a small one, rounded to the nearest double.
fn quotient(digits: &[u32], by: u64) -> f64 {
    // Three digits behind the point: more than a double has, so that only what is left over rounds.
    const BEHIND: i32 = 3;
    let mut rest = 0_u128;
    let mut found: Vec<u32> = Vec::with_capacity(digits.len() + 3);
    for digit in digits.iter().rev().chain(&[0; BEHIND as usize]) {
        rest = rest << DIGIT_BITS | u128::from(*digit);
        found.push((rest / u128::from(by)) as u32);
        rest %= u128::from(by);
    }
    found.reverse();
    if let (true, Some(least)) = (rest > 0, found.first_mut()) {
        *least |= 1;
    }
    let (leading, place) = leading(&found);
    libm::scalbn(leading, place + LEAST - BEHIND * DIGIT_BITS as i32)
}

/// A whole number as a double times a power of two: rounded to nearest, ties to even.
fn leading(digits: &[u32]) -> (f64, i32) {
    let Some(top) = digits.iter().rposition(|digit| *digit != 0) else {
        return (0.0, 0);
    };
    let at = |back: usize| {
        let digit = top.checked_sub(back).and_then(|place| digits.get(place));
        u128::from(digit.copied().unwrap_or(0))
    };
    let mut bits = at(0) << 64 | at(1) << 32 | at(2);
    // What lies below cannot but break a tie.
    let below = digits.iter().take(top.saturating_sub(2)).any(|digit| *digit != 0);
    bits |= u128::from(below);
    (bits as f64, (top as i32 - 2) * DIGIT_BITS as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Moments;
    use proptest::prelude::*;

    fn sums(values: &[f64]) -> ExactSums {
        let mut sums = ExactSums::default();
        values.iter().for_each(|value| sums.add(*value));
        sums
    }

    fn found(values: &[f64]) -> MeanAndDeviation {
        sums(values).mean_and_deviation().expect("values")
    }

    #[test]
    fn what_cancels_in_doubles_does_not_here() {
        assert_eq!(found(&[1.0, 1e100, 1.0, -1e100]).mean, 0.5);
        let far = found(&[1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0]);
        assert_eq!((far.mean, far.deviation), (1e9 + 10.0, Some(30f64.sqrt())));
        assert_eq!(found(&[f64::MAX, -f64::MAX, 3.0]).mean, 1.0);
    }

    #[test]
    fn the_ends_of_the_doubles_are_added_too() {
        let least = f64::from_bits(1);
        assert_eq!(found(&[least, least]), MeanAndDeviation { mean: least, deviation: Some(0.0) });
        assert_eq!(found(&[f64::MAX, f64::MAX]).mean, f64::MAX);
        assert_eq!(found(&[-0.0]), MeanAndDeviation { mean: 0.0, deviation: None });
        assert_eq!(ExactSums::default().mean_and_deviation(), None);
    }

    #[test]
    fn digits_that_are_full_are_carried() {
        let full = vec![i64::from(ROOM) << 30; OF_VALUES];
        let mut digits = Digits::<OF_VALUES> { digits: full, terms: ROOM - 2 };
        let before = digits.magnitude();
        digits.add(0, 0, true);
        assert_eq!((digits.terms, digits.magnitude()), (0, before));
    }

    fn doubles() -> impl Strategy<Value = Vec<f64>> {
        let any = any::<f64>().prop_filter("finite", |value| value.is_finite());
        prop::collection::vec(prop_oneof![any, -1e3..1e3, Just(0.1)], 1..60)
    }

    proptest! {
        #[test]
        fn any_order_and_any_pieces_give_the_same_bits(values in doubles(), cut in 0usize..60) {
            let (one, other) = values.split_at(cut.min(values.len()));
            let mut merged = sums(other);
            merged.merge(&sums(one));
            let mut reversed = values.clone();
            reversed.reverse();
            prop_assert_eq!(merged.mean_and_deviation(), sums(&reversed).mean_and_deviation());
        }

        #[test]
        fn moments_are_those_of_compensated_sums(values in prop::collection::vec(-1e3..1e3f64, 2..200)) {
            let (exact, other) = (found(&values), Moments::of(&values).expect("values"));
            let spread = other.standard_deviation.expect("two values");
            // The compensated sums are good to a few last places.
            prop_assert!((exact.mean - other.mean).abs() <= 1e-15 * 1e3);
            prop_assert!((exact.deviation.expect("two values") / spread - 1.0).abs() < 1e-14);
        }
    }
}
