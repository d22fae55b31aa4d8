//! Units that are said twice, and whether both say the same.

use crate::document::Variable;

/// Spellings of one unit beside that of the standard, which stands first; a number without a unit is `nd` in it.
///
/// A fraction is such a number; a percentage is a hundredth of one and stands for itself.
const SPELLINGS: [&[&str]; 14] = [
    &["nd", "", "none", "nondimensional", "dimensionless", "unitless", "frac", "-"],
    &["deg", "degree", "degrees"],
    &["rad", "radian", "radians"],
    &["deg_s", "deg/s", "deg/sec", "deg_sec", "degps", "dps"],
    &["rad_s", "rad/s", "rad/sec", "rad_sec", "radps"],
    &["m", "meter", "meters", "metre", "metres"],
    &["ft", "foot", "feet"],
    &["m_s", "m/s", "m/sec", "m_sec"],
    &["ft_s", "ft/s", "ft/sec", "ft_sec", "fps"],
    &["nmi_h", "kt", "kts", "knot", "knots"],
    &["lbf", "lb", "lbs"],
    &["kgm2", "kg_m2", "kg-m2"],
    &["slugft2", "slug_ft2", "slug-ft2"],
    &["pct", "percent", "%"],
];

/// Whether units agree with those of the variable: they are its own, in another spelling too, or are not said.
pub(super) fn agree(found: &str, of_variable: &str) -> bool {
    let found = found.trim();
    found.is_empty() || standard(found) == standard(of_variable.trim())
}

/// What units that do not agree should be.
pub(super) fn of_variable(variable: &Variable) -> String {
    let units = if variable.units.is_empty() { "nd" } else { &variable.units };
    format!("{units}, the units of the variable")
}

/// The standard's spelling; capitals do not count in those that are known.
fn standard(units: &str) -> &str {
    let mut rows = SPELLINGS.iter();
    let row = rows.find(|row| row.iter().any(|spelling| spelling.eq_ignore_ascii_case(units)));
    row.and_then(|row| row.first()).copied().unwrap_or(units)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_agrees_with_its_other_spellings_and_with_no_other_unit() {
        for (found, variable) in [
            ("", "deg"),
            ("degrees", "deg"),
            ("ND", "nd"),
            ("nd", ""),
            ("fps", "ft_s"),
            ("kPa", "kPa"),
        ] {
            assert!(agree(found, variable), "{found} {variable}");
        }
        for (found, variable) in [
            ("rad", "deg"),
            ("pct", "nd"),
            ("kPa", "kpa"),
            ("deg", ""),
            ("m", "ft"),
            ("deg", "deg_s"),
        ] {
            assert!(!agree(found, variable), "{found} {variable}");
        }
    }

    #[test]
    fn no_spelling_stands_for_two_units() {
        let all: Vec<_> = SPELLINGS.iter().flat_map(|row| row.iter()).collect();
        for (index, one) in all.iter().enumerate() {
            assert!(all.iter().skip(index + 1).all(|two| one != two), "{one}");
        }
    }
}
