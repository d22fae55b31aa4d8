//! Numbers for people: a proper minus sign, and no more digits than mean something.

use std::fmt::Display;

use fspid_diagnostics::digits::without_zeros;

/// Minus signs as print has them.
fn signed(text: String) -> String {
    let negative_zero = text.starts_with('-') && !text.contains(|c: char| ('1'..='9').contains(&c));
    if negative_zero { text.replace('-', "") } else { text.replace('-', "\u{2212}") }
}

/// `value` with so many decimals.
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() { signed(format!("{value:.decimals$}")) } else { "\u{2013}".to_owned() }
}

/// `value` with its sign, `+` too.
pub fn with_sign(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    let is_zero = !text.contains(|c: char| ('1'..='9').contains(&c));
    if text.starts_with('\u{2212}') || is_zero { text } else { format!("+{text}") }
}

/// `value` with so many significant digits, in powers of ten where that is shorter.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..6).contains(&exponent) {
        let decimals = usize::try_from((digits as i32 - 1 - exponent).max(0)).unwrap_or(0);
        return signed(format!("{value:.decimals$}"));
    }
    format!("{} \u{d7} 10{}", signed(mantissa.to_owned()), raised(exponent))
}

/// The same without zeros behind its digits.
#[must_use]
pub fn short(value: f64, digits: usize) -> String {
    without_zeros(&significant(value, digits)).to_owned()
}

/// An exponent in raised digits.
fn raised(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| match c.to_digit(10) {
        Some(digit) => DIGITS.get(digit as usize).copied().unwrap_or(c),
        None => '⁻',
    };
    exponent.to_string().chars().map(raise).collect()
}

/// The shortest digits that read back as `value`: for settings.
pub fn exact(value: f64) -> String {
    let text = format!("{value:?}");
    signed(text.strip_suffix(".0").unwrap_or(&text).to_owned())
}

/// A measure, or the reason why there is none.
pub fn measured(value: Result<f64, impl Display>, decimals: usize) -> String {
    value.map_or_else(|reason| reason.to_string(), |value| fixed(value, decimals))
}

/// The text with a capital at its beginning.
pub fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}

/// The text with a full stop, where it does not end as a sentence does.
pub fn sentence(text: &str) -> String {
    let stop = if text.ends_with(['.', '?', '!']) { "" } else { "." };
    format!("{text}{stop}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_minus_sign_and_no_negative_zero() {
        assert_eq!(fixed(-1.25, 1), "\u{2212}1.2");
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(with_sign(0.2165, 4), "+0.2165");
        assert_eq!(with_sign(1e-12, 4), "0.0000");
        assert_eq!(fixed(f64::NAN, 2), "\u{2013}");
    }

    #[test]
    fn significant_digits_do_not_depend_on_the_size() {
        assert_eq!(significant(0.000_313_278, 3), "0.000313");
        assert_eq!(significant(38.402, 3), "38.4");
        assert_eq!(significant(2.7e-10, 2), "2.7 \u{d7} 10⁻¹⁰");
        assert_eq!(significant(16008.0, 5), "16008");
    }
}
