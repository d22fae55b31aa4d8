//! Keys and values that were given in another unit than a key has.

use crate::keyed::document::Value;
use crate::keyed::{KeyRow, Kind};
use crate::units::{FOOT_M, KNOT_M_S, POUND_FORCE_N, POUND_KG, SLUG_KG, radians};
use fspid_diagnostics::digits::to_digits;

/// How many digits of a converted number are told: enough for what is written by hand.
const DIGITS: usize = 7;

/// A unit as names of keys end with it.
struct Unit {
    ending: &'static str,
    words: &'static str,
    /// As text beside a number has it.
    symbol: &'static str,
    /// The unit of the same quantity of which this one is so many.
    of: &'static str,
    size: f64,
}

const fn unit(
    ending: &'static str,
    words: &'static str,
    symbol: &'static str,
    of: &'static str,
    size: f64,
) -> Unit {
    Unit { ending, words, symbol, of, size }
}

/// The units that keys have, and those in which their quantities are often given.
fn units() -> [Unit; 30] {
    let degree = radians(1.0);
    [
        unit("deg_s", "degrees per second", "deg/s", "rad/s", degree),
        unit("rad_s", "radians per second", "rad/s", "rad/s", 1.0),
        unit("m_s2", "metres per second squared", "m/s2", "m/s2", 1.0),
        unit("ft_s2", "feet per second squared", "ft/s2", "m/s2", FOOT_M),
        unit("km_h", "kilometres per hour", "km/h", "m/s", 1.0 / 3.6),
        unit("m_s", "metres per second", "m/s", "m/s", 1.0),
        unit("ft_s", "feet per second", "ft/s", "m/s", FOOT_M),
        unit("kts", "knots", "kts", "m/s", KNOT_M_S),
        unit("kt", "knots", "kt", "m/s", KNOT_M_S),
        unit("ms", "milliseconds", "ms", "s", 1e-3),
        unit("us", "microseconds", "us", "s", 1e-6),
        unit("min", "minutes", "min", "s", 60.0),
        unit("s", "seconds", "s", "s", 1.0),
        unit("khz", "kilohertz", "kHz", "Hz", 1e3),
        unit("hz", "hertz", "Hz", "Hz", 1.0),
        unit("mrad", "milliradians", "mrad", "rad", 1e-3),
        unit("rad", "radians", "rad", "rad", 1.0),
        unit("deg", "degrees", "deg", "rad", degree),
        unit("km", "kilometres", "km", "m", 1e3),
        unit("cm", "centimetres", "cm", "m", 1e-2),
        unit("mm", "millimetres", "mm", "m", 1e-3),
        unit("ft", "feet", "ft", "m", FOOT_M),
        unit("m", "metres", "m", "m", 1.0),
        unit("lbf", "pounds of force", "lbf", "N", POUND_FORCE_N),
        unit("n", "newtons", "N", "N", 1.0),
        unit("slug", "slugs", "slug", "kg", SLUG_KG),
        unit("lb", "pounds", "lb", "kg", POUND_KG),
        unit("kg", "kilograms", "kg", "kg", 1.0),
        unit("kpa", "kilopascals", "kPa", "Pa", 1e3),
        unit("pa", "pascals", "Pa", "Pa", 1.0),
    ]
}

/// What a key measures and in which unit: the longest ending counts, so that `rate_deg_s` is in no seconds.
fn parted(name: &str) -> Option<(&str, Unit)> {
    let ends = |unit: Unit| {
        let what = name.strip_suffix(unit.ending)?.strip_suffix('_')?;
        (!what.is_empty()).then_some((what, unit))
    };
    units().into_iter().filter_map(ends).max_by_key(|(_, unit)| unit.ending.len())
}

/// The known key that measures the same as an unknown one in another unit, and what to write in its place.
pub(super) fn other_unit(
    name: &str,
    value: &Value,
    known: &[&'static str],
) -> Option<(&'static str, String)> {
    let lower = name.to_lowercase();
    if let Some(period) = of_rate(&lower, value, known) {
        return Some(period);
    }
    let (what, given) = parted(&lower)?;
    let (key, asked) = known.iter().find_map(|key| {
        let (of, asked) = parted(key)?;
        (of == what && asked.ending != given.ending).then_some((*key, asked))
    })?;
    let words = asked.words;
    let told = match (value, given.of == asked.of) {
        (Value::Integer(value, _) | Value::Float(value), true) if value.is_finite() => {
            let converted = to_digits(value * given.size / asked.size, DIGITS);
            format!("write `{key} = {converted}`: this key is in {words}")
        }
        _ => format!("did you mean `{key}`? It is in {words}"),
    };
    Some((key, told))
}

/// The period that is the inverse of a rate: `sample_period_s` for `sample_rate_hz`.
fn of_rate(name: &str, value: &Value, known: &[&'static str]) -> Option<(&'static str, String)> {
    let (what, given) = parted(name).filter(|(_, unit)| unit.of == "Hz")?;
    let of = ["_rate", "_frequency"].iter().find_map(|ending| what.strip_suffix(ending))?;
    let key = *known.iter().find(|key| key.strip_suffix("_period_s") == Some(of))?;
    let told = match value {
        Value::Integer(rate, _) | Value::Float(rate) if rate.is_finite() && *rate > 0.0 => {
            let period = to_digits(1.0 / (rate * given.size), DIGITS);
            format!("write `{key} = {period}`: this key is the time between samples, in seconds")
        }
        _ => format!("did you mean `{key}`? It is the time between samples, in seconds"),
    };
    Some((key, told))
}

/// What to write in place of a number with its unit in a text, such as "10 ms" for a key in seconds.
pub(super) fn in_text(text: &str, symbol: &str) -> Option<String> {
    let text = text.trim();
    let end = text.find(|it: char| !(it.is_ascii_digit() || "+-.".contains(it)))?;
    let (number, given) = text.split_at(end);
    let value: f64 = number.parse().ok()?;
    let find = |symbol: &str| units().into_iter().find(|it| it.symbol == symbol);
    let (given, asked) = (find(given.trim())?, find(symbol)?);
    (given.of == asked.of).then(|| {
        let converted = to_digits(value * given.size / asked.size, DIGITS);
        format!("; write {converted}, in {}", asked.words)
    })
}

/// Known keys that are numbers, by their names.
pub(super) fn numbers(keys: &[KeyRow]) -> Vec<&'static str> {
    let is_number = |key: &&KeyRow| {
        matches!(key.kind(), Kind::Number { .. } | Kind::Numbers { .. } | Kind::Interval { .. })
    };
    keys.iter().filter(is_number).map(|key| key.name().as_str()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name: &str, value: f64, known: &[&'static str]) -> Option<String> {
        other_unit(name, &Value::Float(value), known).map(|(_, told)| told)
    }

    #[test]
    fn a_number_in_another_unit_is_converted_and_one_of_another_quantity_is_not() {
        let known = ["sample_period_s", "amplitude_deg", "rate_limit_deg_s", "airspeed_m_s"];
        let same = |name, value, what: &str, words: &str| {
            let expected = format!("write `{what}`: this key is in {words}");
            assert_eq!(told(name, value, &known), Some(expected));
        };
        same("sample_period_ms", 10.0, "sample_period_s = 0.01", "seconds");
        same("amplitude_rad", 0.08, "amplitude_deg = 4.583662", "degrees");
        same("rate_limit_rad_s", 1.0, "rate_limit_deg_s = 57.29578", "degrees per second");
        same("airspeed_kt", 100.0, "airspeed_m_s = 51.44444", "metres per second");
        let hertz = told("sample_period_hz", 100.0, &known);
        assert_eq!(hertz.as_deref(), Some("did you mean `sample_period_s`? It is in seconds"));
        let seconds = "the time between samples, in seconds";
        for (rate, value) in [("sample_rate_hz", 100.0), ("sample_frequency_kHz", 0.1)] {
            let expected = format!("write `sample_period_s = 0.01`: this key is {seconds}");
            assert_eq!(told(rate, value, &known), Some(expected));
        }
        let none = told("sample_rate_hz", 0.0, &known).expect("a hint");
        assert!(none.starts_with("did you mean `sample_period_s`?"), "{none}");
        for other in ["amplitude_deg", "gain_rad", "sample_period", "s", "_s", "period_s"] {
            assert_eq!(told(other, 1.0, &known), None, "{other}");
        }
    }

    #[test]
    fn a_number_with_its_unit_in_a_text_is_told_as_a_number() {
        let written = |text, symbol| in_text(text, symbol);
        assert_eq!(written("10 ms", "s").as_deref(), Some("; write 0.01, in seconds"));
        assert_eq!(written("5deg", "deg").as_deref(), Some("; write 5, in degrees"));
        for (text, symbol) in [("10 m", "s"), ("ten ms", "s"), ("10", "s"), ("1 ms", ""), ("", "s")]
        {
            assert_eq!(written(text, symbol), None, "{text}");
        }
    }

    /// A unit of which another one of the table is an ending is found whatever the order of the rows.
    #[test]
    fn every_unit_is_told_apart_from_the_others() {
        for unit in units() {
            let name = format!("size_{}", unit.ending);
            let found = parted(&name).map(|(what, found)| (what.to_owned(), found.ending));
            assert_eq!(found, Some(("size".to_owned(), unit.ending)));
        }
    }
}
