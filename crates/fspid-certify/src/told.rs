//! Numbers of a claim as they are told: never better than what is proved.

use fspid_diagnostics::digits::to_six_decimals;

/// Rounded up at the third digit, so that what is told is a bound as well.
pub(super) fn at_most(value: f64) -> String {
    rounded(value, libm::ceil)
}

/// Rounded down likewise.
pub(super) fn at_least(value: f64) -> String {
    rounded(value, libm::floor)
}

fn rounded(value: f64, to: fn(f64) -> f64) -> String {
    if !(value > 0.0 && value.is_finite()) {
        return to_six_decimals(value);
    }
    let size = libm::pow(10.0, 2.0 - libm::floor(libm::log10(value)));
    let told = to(value * size) / size;
    // Fewer decimals than these would tell nothing of it.
    if told < 1e-4 { format!("{told:e}") } else { to_six_decimals(told) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_of_a_bound_is_never_better_than_the_bound() {
        assert_eq!(at_least(0.000_696_508), "0.000696");
        assert_eq!(at_most(6.642_74e-6), "6.65e-6");
        assert_eq!([at_least(0.003_501_6), at_most(0.003_501_6)], ["0.0035", "0.00351"]);
        assert_eq!([at_least(12.345), at_most(12.345)], ["12.3", "12.4"]);
        for value in [1e-9, 3.3e-5, 0.017, 0.999_9, 8.0, 123.456, 7.7e5] {
            let [least, most] =
                [at_least(value), at_most(value)].map(|it| it.parse::<f64>().expect("a number"));
            // Digits of a float that is no decimal number.
            let close = value * 1e-12;
            assert!(least <= value + close && value <= most + close, "{least} {value} {most}");
        }
    }
}
