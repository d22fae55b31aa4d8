//! Numbers with units, as they are written on a command line.

use fspid_scenario::aircraft::units::Unit;

/// A quantity with or without a unit, such as `176ft/s`, `100 kt` or `53.6`, in SI.
///
/// `bare` is the unit of a number without one.
pub(super) fn quantity(
    option: &str,
    text: &str,
    known: &[Unit],
    bare: Unit,
) -> Result<f64, String> {
    let (digits, suffix) = split(text.trim());
    let unit = match suffix {
        "" => bare,
        _ => *known
            .iter()
            .find(|unit| unit.symbol == suffix)
            .ok_or_else(|| unknown(option, text, suffix, known))?,
    };
    match digits.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value * unit.size),
        _ => Err(format!(
            "{option} {text}: no number; write a number with a unit, such as 100{}",
            bare.symbol
        )),
    }
}

/// The number and the unit behind it.
fn split(text: &str) -> (&str, &str) {
    let is_number = |end: &usize| text.get(..*end).is_some_and(|part| part.parse::<f64>().is_ok());
    let ends = (0..=text.len()).rev().filter(|end| text.is_char_boundary(*end));
    let end = ends.into_iter().find(is_number).unwrap_or(0);
    let (digits, suffix) = text.split_at(end);
    (digits, suffix.trim())
}

fn unknown(option: &str, text: &str, suffix: &str, known: &[Unit]) -> String {
    let known: Vec<&str> = known.iter().map(|unit| unit.symbol).collect();
    format!("{option} {text}: `{suffix}` is no unit known here; known are {}", known.join(", "))
}

/// Values from the first to the last, as `first:last:count`, in SI.
pub(super) fn span(
    option: &str,
    text: &str,
    known: &[Unit],
    bare: Unit,
) -> Result<Vec<f64>, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let wrong = || format!("{option} {text}: write first:last:count, such as 40:80:9");
    let &[first, last, count] = parts.as_slice() else { return Err(wrong()) };
    let (_, suffix) = split(last.trim());
    // A unit behind the last number is meant for the first too.
    let bare = known.iter().copied().find(|unit| unit.symbol == suffix).unwrap_or(bare);
    let first = quantity(option, first, known, bare)?;
    let last = quantity(option, last, known, bare)?;
    let count = count.trim().parse::<usize>().map_err(|_| wrong())?;
    spread(first, last, count).ok_or_else(|| {
        format!(
            "{option} {text}: the first must be below the last, and the count from 2 to {MOST}; or one value and 1"
        )
    })
}

/// Most values along one side of an envelope.
const MOST: usize = 201;

fn spread(first: f64, last: f64, count: usize) -> Option<Vec<f64>> {
    if count == 1 && first.total_cmp(&last).is_eq() {
        return Some(vec![first]);
    }
    let good = first < last && (2..=MOST).contains(&count);
    let at = |n: usize| first + (last - first) * (n as f64 / (count - 1) as f64);
    good.then(|| (0..count).map(|n| if n + 1 == count { last } else { at(n) }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_scenario::aircraft::units::{Kind, LENGTHS, SPEEDS, Units};

    fn speed(text: &str) -> Result<f64, String> {
        quantity("--speed", text, &SPEEDS, Units::Si.of(Kind::Speed))
    }

    #[test]
    fn a_unit_may_stand_close_or_apart_or_be_left_out() {
        for text in ["53.6448", "53.6448m/s", " 53.6448 m/s", "176ft/s", "1.76e2 ft/s"] {
            assert!((speed(text).expect("a speed") - 53.6448).abs() < 1e-12, "{text}");
        }
        assert!((speed("100kt").expect("a speed") - 51.444_444_444).abs() < 1e-9);
        let bare = Units::English.of(Kind::Length);
        let altitude = quantity("--altitude", "20000", &LENGTHS, bare).expect("an altitude");
        assert!((altitude - 6096.0).abs() < 1e-9);
    }

    #[test]
    fn an_unknown_unit_lists_the_known_ones() {
        let message = speed("176fps").expect_err("no such unit");
        assert_eq!(
            message,
            "--speed 176fps: `fps` is no unit known here; known are m/s, km/h, ft/s, kt"
        );
        for text in ["", "fast", "m/s", "inf", "nan", "1e999m/s"] {
            assert!(speed(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_span_has_its_ends_and_one_unit_for_both() {
        let bare = Units::Si.of(Kind::Speed);
        let speeds = span("--speeds", "100:200ft/s:3", &SPEEDS, bare).expect("three");
        let expected = [30.48, 45.72, 60.96];
        assert!(speeds.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12));
        for text in ["1:2", "2:1:3", "1:2:0", "1:2:1", "1:2:9999", "1:2:x", "a:2:3"] {
            assert!(span("--speeds", text, &SPEEDS, bare).is_err(), "{text}");
        }
        assert_eq!(span("--speeds", "50:50:1", &SPEEDS, bare), Ok(vec![50.0]));
    }
}
