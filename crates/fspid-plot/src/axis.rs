//! Axes: which range is shown, where the ticks are and what they are called.
//!
//! Ticks stand at steps of 1, 2 or 5 times a power of ten. Inside the drawing code an axis is used in
//! *tick units*: 0 is a tick near the lower end and 1 the next one, so that neither very large nor very
//! small numbers reach the canvas.

/// Largest magnitude that is drawn; larger values are drawn there.
const LIMIT: f64 = 1e150;

/// One axis of a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axis {
    /// Lower end, in display units (its logarithm when `log`).
    pub(super) lo: f64,
    /// Upper end, in display units (its logarithm when `log`).
    pub(super) hi: f64,
    mantissa: f64,
    exponent: i32,
    /// True when positions are decimal logarithms.
    pub(super) log: bool,
}

/// A tick: its position along the axis from 0 to 1 and its label, empty for a minor one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub(super) at: f64,
    pub(super) label: String,
}

/// Smallest and largest finite value; `None` when there is none.
pub(super) fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values.into_iter().filter(|v| v.is_finite()).fold(None, |range, v| {
        let v = v.clamp(-LIMIT, LIMIT);
        Some(range.map_or((v, v), |(lo, hi): (f64, f64)| (lo.min(v), hi.max(v))))
    })
}

impl Axis {
    /// A linear axis over `range` with about `ticks` ticks, widened by the fraction `margin` at both ends.
    ///
    /// No range, or a range without width, becomes one that can be drawn.
    pub(super) fn linear(range: Option<(f64, f64)>, margin: f64, ticks: usize) -> Self {
        let (lo, hi) = open_up(range);
        let pad = (hi - lo) * margin;
        Self::exact(lo - pad, hi + pad, ticks)
    }

    /// A linear axis over exactly the range that was asked for, where it makes sense.
    pub(super) fn fixed(asked: Option<(f64, f64)>, ticks: usize) -> Option<Self> {
        let (lo, hi) = asked?;
        (lo.abs() <= LIMIT && hi.abs() <= LIMIT && lo < hi).then(|| {
            let (lo, hi) = open_up(Some((lo, hi)));
            Self::exact(lo, hi, ticks)
        })
    }

    /// A linear axis of angles (deg): ticks at even parts of a turn where a few of those fit.
    pub(super) fn degrees(range: Option<(f64, f64)>, margin: f64, ticks: usize) -> Self {
        let plain = Self::linear(range, margin, ticks);
        let raw = (plain.hi - plain.lo) / ticks.max(1) as f64;
        let steps = [(1.5, 1), (3.0, 1), (4.5, 1), (9.0, 1), (1.8, 2), (3.6, 2)];
        let fits = |&(mantissa, exponent): &(f64, i32)| mantissa * power_of_ten(exponent) >= raw;
        match steps.into_iter().find(fits).filter(|_| raw > 7.5) {
            Some((mantissa, exponent)) => Self { mantissa, exponent, ..plain },
            None => plain,
        }
    }

    /// A logarithmic axis over the positive part of `range`.
    pub(super) fn logarithmic(range: Option<(f64, f64)>, margin: f64) -> Self {
        let (lo, hi) = range.filter(|(lo, hi)| *lo > 0.0 && hi >= lo).unwrap_or((0.5, 2.0));
        let (mut lo, mut hi) = (libm::log10(lo), libm::log10(hi));
        if hi - lo < 0.2 {
            let middle = (lo + hi) / 2.0;
            (lo, hi) = (middle - 0.2, middle + 0.2);
        }
        let pad = (hi - lo) * margin;
        Self { lo: lo - pad, hi: hi + pad, mantissa: 1.0, exponent: 0, log: true }
    }

    fn exact(lo: f64, hi: f64, ticks: usize) -> Self {
        let raw = (hi - lo) / ticks.max(1) as f64;
        let mut exponent = libm::log10(raw).floor() as i32;
        let lead = raw / power_of_ten(exponent);
        // The nearest of 1, 2, 5 and 10 on a logarithmic scale.
        let mantissa = match lead {
            lead if lead <= 1.414 => 1.0,
            lead if lead <= 3.162 => 2.0,
            lead if lead <= 7.071 => 5.0,
            _ => {
                exponent += 1;
                1.0
            }
        };
        Self { lo, hi, mantissa, exponent, log: false }
    }

    /// Distance between two ticks, in axis positions.
    pub(super) fn step(&self) -> f64 {
        self.mantissa * power_of_ten(self.exponent)
    }

    /// Index of the tick from which tick units are counted.
    fn origin(&self) -> f64 {
        (self.lo / self.step()).floor()
    }

    /// Position of `value` in tick units; not finite where the value cannot be shown.
    pub(super) fn unit(&self, value: f64) -> f64 {
        if !value.is_finite() {
            return f64::NAN;
        }
        let position = if self.log { libm::log10(value) } else { value.clamp(-LIMIT, LIMIT) };
        self.position_to_unit(position)
    }

    fn position_to_unit(&self, position: f64) -> f64 {
        position / self.step() - self.origin()
    }

    /// Lower and upper end in tick units.
    pub(super) fn unit_range(&self) -> (f64, f64) {
        (self.position_to_unit(self.lo), self.position_to_unit(self.hi))
    }

    /// Part of the way from the lower to the upper end, 0 to 1 inside.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        let (lo, hi) = self.unit_range();
        (self.unit(value) - lo) / (hi - lo)
    }

    /// Lower end, upper end, and `log` where they are decimal logarithms, as a script reads them.
    pub(super) fn data(&self) -> String {
        format!("{:e} {:e}{}", self.lo, self.hi, if self.log { " log" } else { "" })
    }

    /// Label of the tick at `unit`.
    pub(super) fn label(&self, unit: f64) -> String {
        let index = (unit + self.origin()).round();
        if self.log {
            return plain(index as i32);
        }
        let largest = self.lo.abs().max(self.hi.abs());
        let value = index * self.step();
        if index == 0.0 {
            return "0".to_owned();
        }
        if (1e-4..1e6).contains(&largest) {
            let decimals = usize::try_from(-self.exponent).unwrap_or(0).min(15);
            return with_minus(&format!("{value:.decimals$}"));
        }
        let top = libm::log10(largest).floor() as i32;
        let decimals = usize::try_from(top - self.exponent).unwrap_or(0).min(15);
        let mantissa = format!("{:.decimals$}", value / power_of_ten(top));
        with_minus(&format!("{mantissa}\u{d7}10{}", superscript(top)))
    }

    /// All ticks within the range; a logarithmic axis adds those at 2 and 5 where there is room.
    pub(super) fn ticks(&self) -> Vec<Tick> {
        let (lo, hi) = self.unit_range();
        if !(0.0..=400.0).contains(&(hi - lo)) || lo >= hi {
            return Vec::new();
        }
        let at = |unit: f64| (unit - lo) / (hi - lo);
        let slack = (hi - lo) * 1e-9;
        let within = |unit: &f64| *unit >= lo - slack && *unit <= hi + slack;
        let mut ticks = Vec::new();
        // Within a decade the ones, twos and fives would be too few.
        let all_named = hi - lo < 0.9;
        for index in (lo.floor() as i64)..=(hi.ceil() as i64) {
            let unit = index as f64;
            if within(&unit) {
                ticks.push(Tick { at: at(unit), label: self.label(unit) });
            }
            if self.log && hi - lo <= 4.0 {
                let decade = (unit + self.origin()).round() as i32;
                for lead in [2_u8, 3, 4, 5, 6, 7, 8, 9] {
                    let unit = unit + libm::log10(f64::from(lead));
                    let named = all_named || lead == 2 || lead == 5;
                    let label = if named { times_power(lead, decade) } else { String::new() };
                    if within(&unit) {
                        ticks.push(Tick { at: at(unit), label });
                    }
                }
            }
        }
        ticks
    }
}

/// A range with a width that can be drawn.
fn open_up(range: Option<(f64, f64)>) -> (f64, f64) {
    let Some((lo, hi)) = range else {
        return (0.0, 1.0);
    };
    let size = lo.abs().max(hi.abs());
    let least = (size * 1e-9).max(1e-150);
    if hi - lo > least {
        (lo, hi)
    } else if size <= 1e-150 {
        (-1.0, 1.0)
    } else {
        (lo - size * 0.1, hi + size * 0.1)
    }
}

/// Ten to the `exponent`, correctly rounded on every machine.
fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(1.0)
}

/// "0.01", "1", "100"; powers of ten beyond that.
fn plain(exponent: i32) -> String {
    times_power(1, exponent)
}

fn times_power(lead: u8, exponent: i32) -> String {
    match exponent {
        0..=4 => format!("{lead}{}", "0".repeat(exponent.unsigned_abs() as usize)),
        -4..=-1 => format!("0.{}{lead}", "0".repeat(exponent.unsigned_abs() as usize - 1)),
        _ if lead == 1 => format!("10{}", superscript(exponent)),
        _ => format!("{lead}\u{d7}10{}", superscript(exponent)),
    }
}

fn superscript(exponent: i32) -> String {
    let raised = |c| match c {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        c => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    };
    exponent.to_string().chars().map(raised).collect()
}

/// The typographic minus sign in place of the hyphen.
pub(super) fn with_minus(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// A value for a label or note, with at most three significant digits and a typographic minus.
pub(super) fn short_number(value: f64) -> String {
    if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&value.abs()) {
        let text = format!("{value:.1e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return with_minus(&format!(
            "{mantissa}\u{d7}10{}",
            superscript(exponent.parse().unwrap_or(0))
        ));
    }
    let decimals = usize::try_from(2 - libm::log10(value.abs()).floor() as i32).unwrap_or(0);
    let text = format!("{value:.decimals$}");
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    with_minus(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|tick| tick.label).filter(|label| !label.is_empty()).collect()
    }

    #[test]
    fn ticks_stand_at_one_two_five_steps_without_float_noise() {
        assert_eq!(
            labels(&Axis::linear(Some((-0.3, 0.3)), 0.0, 6)),
            ["\u{2212}0.3", "\u{2212}0.2", "\u{2212}0.1", "0", "0.1", "0.2", "0.3"]
        );
        assert_eq!(labels(&Axis::linear(Some((0.0, 20.0)), 0.0, 5)), ["0", "5", "10", "15", "20"]);
        assert_eq!(labels(&Axis::linear(Some((0.0, 1.6)), 0.0, 4)), ["0", "0.5", "1.0", "1.5"]);
    }

    #[test]
    fn very_small_and_very_large_numbers_are_written_as_powers_of_ten() {
        assert_eq!(
            labels(&Axis::linear(Some((0.0, 3e-7)), 0.0, 3)),
            ["0", "1\u{d7}10⁻⁷", "2\u{d7}10⁻⁷", "3\u{d7}10⁻⁷"]
        );
        assert_eq!(
            labels(&Axis::linear(Some((0.0, 2e12)), 0.0, 2)),
            ["0", "1\u{d7}10¹²", "2\u{d7}10¹²"]
        );
    }

    #[test]
    fn every_range_becomes_one_with_a_few_ticks() {
        let ends =
            [0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, 1.0 + 1e-15, 1e15, 5e-324, f64::MAX];
        for lo in ends {
            for hi in ends {
                for axis in [
                    Axis::linear(extent([lo, hi]), 0.05, 5),
                    Axis::logarithmic(extent([lo, hi]), 0.05),
                ] {
                    let labels = labels(&axis);
                    assert!(labels.len() <= 400, "{lo} {hi}: {labels:?}");
                    assert!(axis.log || labels.len() >= 2, "{lo} {hi}: {labels:?}");
                    assert!(
                        !labels.iter().any(|label| label.contains("NaN") || label == "\u{2212}0")
                    );
                }
            }
        }
    }

    #[test]
    fn a_logarithmic_axis_names_the_ones_twos_and_fives() {
        assert_eq!(
            labels(&Axis::logarithmic(Some((0.5, 20.0)), 0.0)),
            ["0.5", "1", "2", "5", "10", "20"]
        );
        assert_eq!(
            labels(&Axis::logarithmic(Some((0.5, 1.1)), 0.0)),
            ["0.5", "0.6", "0.7", "0.8", "0.9", "1"]
        );
    }

    #[test]
    fn angles_have_ticks_at_parts_of_a_turn() {
        assert_eq!(
            labels(&Axis::degrees(Some((-270.0, 0.0)), 0.0, 6)),
            [
                "\u{2212}270",
                "\u{2212}225",
                "\u{2212}180",
                "\u{2212}135",
                "\u{2212}90",
                "\u{2212}45",
                "0"
            ]
        );
        assert_eq!(labels(&Axis::degrees(Some((0.0, 4.0)), 0.0, 4)), ["0", "1", "2", "3", "4"]);
        let wide = labels(&Axis::degrees(Some((-900.0, 0.0)), 0.0, 5));
        assert_eq!(wide.last().map(String::as_str), Some("0"));
        assert!(wide.contains(&"\u{2212}180".to_owned()));
    }

    #[test]
    fn a_range_that_makes_no_sense_is_not_taken() {
        assert_eq!(Axis::fixed(Some((f64::NAN, 1.0)), 5), None);
        assert_eq!(Axis::fixed(Some((2.0, 1.0)), 5), None);
        assert!(Axis::fixed(Some((0.0, 1.0)), 5).is_some());
    }

    #[test]
    fn short_numbers_keep_three_digits() {
        assert_eq!(short_number(-1.666_6), "\u{2212}1.67");
        assert_eq!(short_number(1234.0), "1234");
        assert_eq!(short_number(-0.0), "0");
    }
}
