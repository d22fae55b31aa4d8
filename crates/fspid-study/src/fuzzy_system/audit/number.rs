//! Proved numbers for people.

use fspid_diagnostics::digits::without_zeros;

/// A number with at most five significant digits; in words where it is none, as an end of bounds that nothing proved.
pub(crate) fn short(value: f64) -> String {
    if !value.is_finite() {
        return "no proved bound".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let decimals = 4_i32.saturating_sub(value.abs().log10().floor() as i32).clamp(0, 8);
    without_zeros(&format!("{value:.*}", usize::try_from(decimals).unwrap_or(0))).to_owned()
}

/// A number that lies between proved bounds: one number where they are close, else both.
pub(crate) fn between([lower, upper]: [f64; 2]) -> String {
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => {}
        (true, false) => return format!("at least {}", short(lower)),
        (false, true) => return format!("at most {}", short(upper)),
        (false, false) => return "a number without proved bounds".to_owned(),
    }
    let size = lower.abs().max(upper.abs());
    if upper - lower <= 1e-3 * size.max(1e-3) {
        return short(0.5 * lower + 0.5 * upper);
    }
    format!("between {} and {}", short(lower), short(upper))
}

/// A number beside others of the size `scale`; what is far smaller is 0.
pub(crate) fn about(value: f64, scale: f64) -> String {
    short(if value.abs() < 1e-9 * scale { 0.0 } else { value })
}

/// As [`between`], beside others of the size `scale`.
pub(crate) fn between_about(bounds: [f64; 2], scale: f64) -> String {
    between(bounds.map(|bound| if bound.abs() < 1e-9 * scale { 0.0 } else { bound }))
}

/// A share of the whole between proved bounds, in percent.
pub(crate) fn percent([lower, upper]: [f64; 2]) -> String {
    let (lower, upper) = (100.0 * lower, 100.0 * upper);
    if upper - lower < 0.05 {
        return format!("{:.1} %", 0.5 * lower + 0.5 * upper);
    }
    format!("{lower:.1} to {upper:.1} %")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_five_digits_and_no_zeros() {
        let written = [0.5, -4.444_385, 1234.56, 1e-9, 12.0, 0.0, 2.0e6].map(short);
        assert_eq!(written, ["0.5", "-4.4444", "1234.6", "1.000e-9", "12", "0", "2.000e6"]);
    }

    #[test]
    fn close_bounds_are_one_number_and_wide_ones_two() {
        assert_eq!(between([-4.234_089_8, -4.234_089_7]), "-4.2341");
        assert_eq!(between([1.2, 1.4]), "between 1.2 and 1.4");
        assert_eq!(between([0.0, 0.0]), "0");
        // Was "NaN".
        let entire = [f64::NEG_INFINITY, f64::INFINITY];
        assert_eq!(between(entire), "a number without proved bounds");
        assert_eq!(between([1.5, f64::INFINITY]), "at least 1.5");
        assert_eq!(between([f64::NAN, 1.5]), "at most 1.5");
        assert_eq!(about(f64::INFINITY, 1.0), "no proved bound");
        assert_eq!(percent([0.0571, 0.0589]), "5.7 to 5.9 %");
    }
}
