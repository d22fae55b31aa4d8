//! Numbers in sentences: no more digits than mean something, and never a row of zeros.

use std::ops::Range;

/// Smallest size that is written without a power of ten.
const SMALLEST: f64 = 1e-4;
/// The first size that is written as a power of ten.
const LARGEST: f64 = 1e6;

/// `value` to so many significant digits.
#[must_use]
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// `value` to so many significant digits, without zeros behind them.
#[must_use]
pub fn to_digits(value: f64, digits: usize) -> String {
    shortest(rounded(value, digits))
}

/// The shortest digits that read back as `value`; with a power of ten below 1e-4 and from 1e6 on.
#[must_use]
pub fn shortest(value: f64) -> String {
    shortest_within(value, SMALLEST..LARGEST)
}

/// As [`shortest`], with a power of ten for sizes outside of `plain`.
#[must_use]
pub fn shortest_within(value: f64, plain: Range<f64>) -> String {
    match value {
        f64::INFINITY => "infinite".to_owned(),
        f64::NEG_INFINITY => "minus infinite".to_owned(),
        value if value.is_nan() => "not a number".to_owned(),
        // No sign of a zero.
        value if value == 0.0 || plain.contains(&value.abs()) => format!("{}", value + 0.0),
        value => format!("{value:e}"),
    }
}

/// The digits of a number without the zeros behind its point; powers of ten stay as they are.
#[must_use]
pub fn without_zeros(text: &str) -> &str {
    let is_plain = text.contains('.') && !text.contains(['e', '\u{d7}']);
    if is_plain { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// At most six decimals, none that say nothing: times and angles for people.
#[must_use]
pub fn to_six_decimals(value: f64) -> String {
    without_zeros(&format!("{value:.6}")).to_owned()
}

/// A number with its digits in groups of three: `1 234 567`.
#[must_use]
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// "1 controller", "2 controllers".
#[must_use]
pub fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_and_small_numbers_are_powers_of_ten_and_never_rows_of_zeros() {
        let texts = [0.123_456_7, 1234.567, 123_456.7, 999_999.0, 1e300, -2.5e-7, 1e-4, -0.0]
            .map(|value| to_digits(value, 3));
        assert_eq!(texts, ["0.123", "1230", "123000", "1e6", "1e300", "-2.5e-7", "0.0001", "0"]);
        assert_eq!(
            ["1.50", "2.000", "100", "1.00e-7"].map(without_zeros),
            ["1.5", "2", "100", "1.00e-7"]
        );
        let none = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN].map(shortest);
        assert_eq!(none, ["infinite", "minus infinite", "not a number"]);
        assert_eq!(shortest(0.1 + 0.2), "0.30000000000000004");
    }

    #[test]
    fn digits_stand_in_groups_of_three() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1 000", "1 234 567"]);
    }

    #[test]
    fn one_thing_is_told_as_one() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "shard")), ["0 shards", "1 shard", "2 shards"]);
    }
}
