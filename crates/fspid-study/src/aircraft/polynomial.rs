//! Transfer functions as books print them.

use fspid_lti::TransferFunction;
use serde_json::{Value, json};

use fspid_scenario::aircraft::number::significant;

/// Significant digits of a coefficient.
const DIGITS: usize = 7;

/// A polynomial in s: `-11.73898 s² - 23.17986 s - 1.169816`.
pub(super) fn polynomial(coefficients: &[f64]) -> String {
    let degree = coefficients.len().saturating_sub(1);
    let powers = (0..=degree).rev().zip(coefficients);
    let terms = powers.filter(|(_, coefficient)| **coefficient != 0.0);
    let mut text = String::new();
    for (power, &coefficient) in terms {
        text.push_str(sign(text.is_empty(), coefficient));
        text.push_str(&term(power, coefficient.abs()));
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

fn sign(is_first: bool, coefficient: f64) -> &'static str {
    match (is_first, coefficient < 0.0) {
        (true, true) => "-",
        (true, false) => "",
        (false, true) => " - ",
        (false, false) => " + ",
    }
}

fn term(power: usize, size: f64) -> String {
    const RAISED: [&str; 10] = ["", "", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"];
    let number = significant(size, DIGITS);
    let is_one = size.total_cmp(&1.0).is_eq();
    let letter = match RAISED.get(power) {
        _ if power == 0 => return if is_one { "1".to_owned() } else { number },
        Some(raised) => format!("s{raised}"),
        None => format!("s^{power}"),
    };
    if is_one { letter } else { format!("{number} {letter}") }
}

/// Numerator over denominator with a line between.
pub(super) fn fraction(plant: &TransferFunction) -> String {
    let above = polynomial(plant.numerator().coefficients());
    let below = polynomial(plant.denominator().coefficients());
    let width = above.chars().count().max(below.chars().count());
    let line = "-".repeat(width);
    let room = |text: &str| " ".repeat((width - text.chars().count()) / 2);
    format!("  {}{above}\n  {line}\n  {}{below}\n", room(&above), room(&below))
}

/// Coefficients for programs, the highest power of s first.
pub(super) fn json(plant: &TransferFunction) -> Value {
    json!({
        "numerator": plant.numerator().coefficients(),
        "denominator": plant.denominator().coefficients(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_reads_as_in_a_book() {
        assert_eq!(polynomial(&[1.0, 0.0, -2.5, 1.0]), "s³ - 2.500000 s + 1");
        assert_eq!(polynomial(&[-1.69144, -0.84341]), "-1.691440 s - 0.8434100");
        assert_eq!(polynomial(&[0.0]), "0");
    }
}
