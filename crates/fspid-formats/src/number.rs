//! Numbers as tools write them.

use std::fmt;

/// Why a word is no number that can be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refused {
    /// Not written like a number.
    Syntax,
    /// Beyond the largest double.
    TooLarge,
    /// An infinity where a finite number is needed.
    Infinite,
    /// NaN.
    NotANumber,
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Syntax => "not a number",
            Self::TooLarge => "a number beyond the largest double, 1.797e308",
            Self::Infinite => "an infinity is not allowed here",
            Self::NotANumber => "NaN is not allowed here",
        })
    }
}

/// Words for an infinity, in lower case.
const INFINITY: [&str; 2] = ["inf", "infinity"];

/// The number that a word stands for: `1`, `+.5`, `1.`, `1e-3`, `-Inf`, `NaN` (any case), nothing else.
///
/// # Errors
/// [`Refused::Syntax`] and [`Refused::TooLarge`].
pub(crate) fn any(word: &str) -> Result<f64, Refused> {
    let (sign, magnitude) = signed(word);
    if is_decimal(magnitude) {
        let number: f64 = word.parse().map_err(|_| Refused::Syntax)?;
        return if number.is_finite() { Ok(number) } else { Err(Refused::TooLarge) };
    }
    if INFINITY.iter().any(|name| magnitude.eq_ignore_ascii_case(name)) {
        return Ok(sign * f64::INFINITY);
    }
    if magnitude.eq_ignore_ascii_case("nan") { Ok(f64::NAN) } else { Err(Refused::Syntax) }
}

/// The same without NaN.
///
/// # Errors
/// As for [`any`], and [`Refused::NotANumber`].
pub(crate) fn ordered(word: &str) -> Result<f64, Refused> {
    any(word).and_then(|number| if number.is_nan() { Err(Refused::NotANumber) } else { Ok(number) })
}

/// The same without infinities.
///
/// # Errors
/// As for [`ordered`], and [`Refused::Infinite`].
pub(crate) fn finite(word: &str) -> Result<f64, Refused> {
    ordered(word)
        .and_then(|number| if number.is_finite() { Ok(number) } else { Err(Refused::Infinite) })
}

/// The shortest digits that read back as the same double: `1`, `0.1`, `1e-7`, `-0`, `inf`, `nan`.
pub(crate) fn written(number: f64) -> String {
    if number.is_nan() {
        return "nan".into();
    }
    let digits = format!("{number:?}");
    match digits.strip_suffix(".0") {
        Some(whole) => whole.into(),
        None => digits,
    }
}

/// Several numbers with a blank between them.
pub(crate) fn written_all(numbers: &[f64]) -> String {
    numbers.iter().map(|&number| written(number)).collect::<Vec<_>>().join(" ")
}

fn signed(word: &str) -> (f64, &str) {
    match word.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, word.strip_prefix('+').unwrap_or(word)),
    }
}

/// Digits with a point among or beside them, and perhaps an exponent.
fn is_decimal(word: &str) -> bool {
    let (mantissa, exponent) = match word.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent)),
        None => (word, None),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let some = |part: &str| !part.is_empty();
    let exponent_fits = exponent.is_none_or(|part| some(signed(part).1) && digits(signed(part).1));
    digits(whole) && digits(fraction) && (some(whole) || some(fraction)) && exponent_fits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_write_a_number_is_read() {
        for (word, number) in [
            ("1", 1.0),
            ("-.5", -0.5),
            ("+1.", 1.0),
            ("1e-3", 0.001),
            ("1.5E+03", 1500.0),
            ("007", 7.0),
            ("Inf", f64::INFINITY),
            ("-inf", f64::NEG_INFINITY),
            ("+Infinity", f64::INFINITY),
        ] {
            assert_eq!(ordered(word), Ok(number), "{word}");
        }
    }

    #[test]
    fn what_only_looks_like_a_number_is_refused() {
        for word in [
            "", ".", "-", "e3", "1e", "1e+", "1.2.3", "0x1F", "1,5", "1_000", "--1", "１", "1d3",
            "infin",
        ] {
            assert_eq!(any(word), Err(Refused::Syntax), "{word}");
        }
        assert_eq!(any("1e999"), Err(Refused::TooLarge));
        assert_eq!(ordered("NaN"), Err(Refused::NotANumber));
        assert_eq!(finite("-Inf"), Err(Refused::Infinite));
    }

    #[test]
    fn written_numbers_read_back_bit_for_bit() {
        let numbers =
            [0.0, -0.0, 1.0, 0.1, 1e-7, 1e300, 5e-324, f64::MAX, 1.0 / 3.0, f64::INFINITY];
        for number in numbers {
            assert_eq!(any(&written(number)).map(f64::to_bits), Ok(number.to_bits()));
        }
        assert_eq!(written_all(&[1.0, 0.5, 1e21]), "1 0.5 1e21");
    }

    #[test]
    fn a_number_of_a_million_digits_takes_no_time_to_speak_of() {
        assert_eq!(any(&format!("0.{}1", "0".repeat(1_000_000))), Ok(0.0));
        assert_eq!(any(&"9".repeat(1_000_000)), Err(Refused::TooLarge));
    }
}
