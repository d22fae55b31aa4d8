//! Numbers in tables for a terminal: plain signs, as many digits as mean something.

use fspid_diagnostics::digits::without_zeros;

/// `value` with so many significant digits, without zeros behind them.
pub fn short(value: f64, digits: usize) -> String {
    without_zeros(&significant(value, digits)).to_owned()
}

/// `value` with so many significant digits.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return if value.is_nan() { "-".to_owned() } else { format!("{value}") };
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent = scientific.split_once('e').and_then(|(_, power)| power.parse::<i32>().ok());
    match exponent.unwrap_or(0) {
        exponent @ -4..9 => {
            let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
            format!("{value:.decimals$}")
        }
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_do_not_depend_on_the_size() {
        assert_eq!(significant(-3.368_81, 6), "-3.36881");
        assert_eq!(significant(0.000_123_456_78, 4), "0.0001235");
        assert_eq!(significant(37_901.07, 7), "37901.07");
        assert_eq!(significant(1.5e-12, 3), "1.50e-12");
        assert_eq!(short(1.5, 6), "1.5");
        assert_eq!(short(100.0, 6), "100");
        assert_eq!(short(0.0, 6), "0");
    }
}
