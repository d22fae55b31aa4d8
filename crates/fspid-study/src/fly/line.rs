//! What a line says.

use fspid_scenario::units::{degrees, radians};

/// Longest line with its end, bytes.
pub(super) const LONGEST_LINE: usize = 4096;
/// Of what was found, as much as is shown.
const SHOWN: usize = 40;

/// The unit of all angles on the line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Angles {
    /// Degrees and degrees per second.
    #[default]
    Degrees,
    /// Radians and radians per second: the controllers' own, nothing is converted.
    Radians,
}

impl Angles {
    fn to_radians(self, angle: f64) -> f64 {
        match self {
            Self::Degrees => radians(angle),
            Self::Radians => angle,
        }
    }

    /// Finite for what is finite: no gain is too high for a client that must read a number.
    pub(super) fn of_radians(self, angle_rad: f64) -> f64 {
        match self {
            Self::Degrees => degrees(angle_rad).clamp(f64::MIN, f64::MAX),
            Self::Radians => angle_rad,
        }
    }
}

/// A line that could be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Line {
    /// Empty, or a comment.
    Nothing,
    /// Start anew.
    Reset,
    /// A sample.
    Sample(Request),
}

/// A sample as it was asked; its numbers need not be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Request {
    pub(super) setpoint_rad: f64,
    pub(super) measurement_rad: f64,
    pub(super) dt_s: f64,
    pub(super) rate_rad_s: Option<f64>,
}

impl Line {
    /// Reads a line, or says what is wrong with it.
    pub(super) fn read(line: &[u8], angles: Angles) -> Result<Self, String> {
        let bytes = line.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(line).trim_ascii();
        match bytes {
            [b'#', ..] => Ok(Self::Nothing),
            // Of such a line the end is not at hand; whatever it says, it is no empty one.
            _ if line.len() > LONGEST_LINE => Err(format!("longer than {LONGEST_LINE} bytes")),
            [] => Ok(Self::Nothing),
            b"reset" => Ok(Self::Reset),
            _ => Request::read(&String::from_utf8_lossy(bytes), angles).map(Self::Sample),
        }
    }
}

impl Request {
    fn read(text: &str, angles: Angles) -> Result<Self, String> {
        let numbers = numbers(text)?;
        let (&[setpoint, measured, dt_s], rate) = match numbers.split_first_chunk() {
            Some((first, [])) => (first, None),
            Some((first, &[rate])) => (first, Some(rate)),
            _ => return Err(format!("{} field(s); allowed are 3 or 4", numbers.len())),
        };
        Ok(Self {
            setpoint_rad: angles.to_radians(setpoint),
            measurement_rad: angles.to_radians(measured),
            dt_s,
            rate_rad_s: rate.map(|rate| angles.to_radians(rate)),
        })
    }
}

/// The fields. Where there is a comma, commas alone part them, so that `5,,0.01` cannot be taken
/// for two fields that are full.
fn numbers(text: &str) -> Result<Vec<f64>, String> {
    match text.contains(',') {
        true => text.split(',').map(|field| number(field.trim())).collect(),
        false => text.split_ascii_whitespace().map(number).collect(),
    }
}

fn number(field: &str) -> Result<f64, String> {
    field.parse().map_err(|_| format!("`{}` is not a number", shown(field)))
}

/// Short, and without characters that a terminal would obey.
fn shown(field: &str) -> String {
    let mut text: String = field.escape_debug().take(SHOWN).collect();
    if field.escape_debug().nth(SHOWN).is_some() {
        text.push('…');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Result<Line, String> {
        Line::read(line.as_bytes(), Angles::Radians)
    }

    fn sample(rate_rad_s: Option<f64>) -> Result<Line, String> {
        let (setpoint_rad, measurement_rad, dt_s) = (5.0, -4.5, 0.01);
        Ok(Line::Sample(Request { setpoint_rad, measurement_rad, dt_s, rate_rad_s }))
    }

    #[test]
    fn blanks_or_commas_part_the_fields_and_line_ends_of_every_system_are_taken() {
        for line in ["5 -4.5 0.01", " 5\t-4.5   1e-2\r\n", "5,-4.5,0.01\n", "5 , -4.5 , .01"] {
            assert_eq!(read(line), sample(None), "{line}");
        }
        for line in ["5 -4.5 0.01 0.2", "\u{feff}5,-4.5,0.01,0.2\n"] {
            assert_eq!(read(line), sample(Some(0.2)), "{line}");
        }
    }

    #[test]
    fn an_empty_line_and_a_comment_say_nothing() {
        for line in ["", "\n", " \t\r\n", "# t = 1 s", "  #5 4 0.01"] {
            assert_eq!(read(line), Ok(Line::Nothing), "{line}");
        }
        assert_eq!(read(" reset \r\n"), Ok(Line::Reset));
    }

    /// `5,,0.01,0.3` once meant a measurement of 0.01; German decimals are four fields or none.
    #[test]
    fn a_line_that_could_be_misunderstood_is_refused() {
        let wrong = |line: &str| read(line).expect_err(line);
        assert_eq!(wrong("5 4"), "2 field(s); allowed are 3 or 4");
        assert_eq!(wrong("5 4 0.01 0 0"), "5 field(s); allowed are 3 or 4");
        assert_eq!(wrong("5,,0.01,0.3"), "`` is not a number");
        assert_eq!(wrong("5 4,0.01"), "`5 4` is not a number");
        assert_eq!(wrong("5,0 4,9 0,01"), "`0 4` is not a number");
        assert_eq!(wrong("Reset"), "`Reset` is not a number");
        assert_eq!(wrong("1 2 \u{1b}[2J"), "`\\u{1b}[2J` is not a number");
        assert_eq!(wrong(&"7x".repeat(50)), format!("`{}…` is not a number", "7x".repeat(20)));
    }

    #[test]
    fn a_command_beyond_the_largest_number_of_degrees_is_still_a_number() {
        assert_eq!(Angles::Degrees.of_radians(-1e308), f64::MIN);
        assert_eq!(Angles::Radians.of_radians(-1e308), -1e308);
    }
}
