//! The frequency response of an open loop, as the figures of loops take it.

use crate::style::SeriesStyle;

/// The frequency response of one open loop.
///
/// Points shall be in ascending order of frequency and so dense that the phase moves by less than
/// 180 deg from one to the next; a jump of more cannot be told from one in the other direction.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopCurve {
    /// Name in the legend.
    pub name: String,
    /// How the curve is drawn.
    pub style: SeriesStyle,
    /// Values of the open loop; one that is not finite interrupts the curve.
    pub points: Vec<LoopPoint>,
}

/// The value of an open loop at one frequency, $L(e^{j \omega T})$ for a sampled one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopPoint {
    /// Frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Real part.
    pub real: f64,
    /// Imaginary part.
    pub imaginary: f64,
}

/// Gain and unwrapped phase at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polar {
    /// Frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Gain (dB).
    pub gain_db: f64,
    /// Phase (deg).
    pub phase_deg: f64,
}

/// Where a margin is read off a curve, and how large it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarginMark {
    /// Position of the curve in its figure.
    pub curve: usize,
    /// Frequency of the crossing (rad/s).
    pub frequency_rad_s: f64,
    /// Its size.
    pub margin: Margin,
}

/// A margin of a loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Margin {
    /// By how many dB the gain may change until the loop is at its limit; negative where it may fall.
    GainDb(f64),
    /// By how many degrees the phase at a gain crossing is above -180 deg (modulo a full turn).
    PhaseDeg(f64),
}

impl LoopCurve {
    /// Gain and phase along the curve.
    ///
    /// The phase of the first point is taken between -270 and 90 deg, so that a loop with one or two
    /// integrators begins near -90 or -180 deg; each later point continues from the one before.
    #[must_use]
    pub fn polar(&self) -> Vec<Polar> {
        let mut before: Option<f64> = None;
        self.points
            .iter()
            .map(|point| {
                let polar = point.polar(before);
                before = Some(polar.phase_deg).filter(|phase| phase.is_finite()).or(before);
                polar
            })
            .collect()
    }

    /// The value at a frequency, between the points around it.
    pub(super) fn at(&self, frequency_rad_s: f64) -> Option<(f64, f64)> {
        let (a, b, part) = around(&self.points, frequency_rad_s, |point| point.frequency_rad_s)?;
        Some((a.real + (b.real - a.real) * part, a.imaginary + (b.imaginary - a.imaginary) * part))
    }
}

impl LoopPoint {
    fn polar(self, phase_before_deg: Option<f64>) -> Polar {
        let (re, im) = (self.real, self.imaginary);
        let gain_db = 20.0 * libm::log10(libm::hypot(re, im));
        let principal = libm::atan2(im, re).to_degrees();
        // The middle of the turn in which the phase is sought.
        let middle = phase_before_deg.unwrap_or(-90.0);
        let phase_deg = principal - 360.0 * libm::round((principal - middle) / 360.0);
        let phase_deg = if gain_db.is_finite() { phase_deg } else { f64::NAN };
        Polar { frequency_rad_s: self.frequency_rad_s, gain_db, phase_deg }
    }
}

/// Gain and phase at a frequency, between the points around it.
pub(super) fn polar_at(points: &[Polar], frequency_rad_s: f64) -> Option<Polar> {
    let (a, b, part) = around(points, frequency_rad_s, |point| point.frequency_rad_s)?;
    let gain_db = a.gain_db + (b.gain_db - a.gain_db) * part;
    let phase_deg = a.phase_deg + (b.phase_deg - a.phase_deg) * part;
    Some(Polar { frequency_rad_s, gain_db, phase_deg })
}

/// The two neighbours of a frequency and how far between them it lies on a logarithmic scale.
fn around<T: Copy>(
    points: &[T],
    frequency_rad_s: f64,
    of: impl Fn(&T) -> f64,
) -> Option<(T, T, f64)> {
    points.windows(2).find_map(|pair| {
        let (lo, hi) = (of(&pair[0]), of(&pair[1]));
        let inside = lo > 0.0 && lo < hi && lo <= frequency_rad_s && frequency_rad_s <= hi;
        let log = |ratio: f64| libm::log(ratio);
        inside.then(|| (pair[0], pair[1], log(frequency_rad_s / lo) / log(hi / lo)))
    })
}

/// Frequencies of 1, 2 and 5 times powers of ten (rad/s) between two of them, at most 60.
pub(super) fn round_frequencies(range: Option<(f64, f64)>) -> Vec<f64> {
    let Some((lo, hi)) = range.filter(|(lo, hi)| *lo > 0.0 && hi.is_finite() && lo <= hi) else {
        return Vec::new();
    };
    let first = (libm::floor(libm::log10(lo)) as i32).max(-12);
    (first..first + 20)
        .flat_map(|exponent| [1, 2, 5].map(|lead| format!("{lead}e{exponent}")))
        .filter_map(|text| text.parse::<f64>().ok())
        .filter(|frequency| *frequency >= lo && *frequency <= hi)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[(f64, f64, f64)]) -> LoopCurve {
        let point = |&(frequency_rad_s, real, imaginary): &(f64, f64, f64)| LoopPoint {
            frequency_rad_s,
            real,
            imaginary,
        };
        LoopCurve {
            name: String::new(),
            style: SeriesStyle::Numbered(0),
            points: points.iter().map(point).collect(),
        }
    }

    #[test]
    fn the_phase_goes_on_below_minus_180_deg() {
        let found =
            curve(&[(1.0, 0.0, -1.0), (2.0, -1.0, -0.01), (3.0, -1.0, 0.5), (4.0, 0.0, 1.0)]);
        let phases: Vec<f64> = found.polar().iter().map(|point| point.phase_deg).collect();
        assert!((phases[0] + 90.0).abs() < 1e-9);
        assert!((phases[2] + 206.565).abs() < 1e-3);
        assert!((phases[3] + 270.0).abs() < 1e-9);
    }

    #[test]
    fn the_phase_begins_near_minus_180_for_a_negative_loop_and_near_zero_for_a_positive_one() {
        let first = |re, im| curve(&[(1.0, re, im)]).polar()[0].phase_deg;
        assert!((first(-1.0, 0.0) + 180.0).abs() < 1e-9);
        assert!((first(-1.0, 1e-6) + 180.0).abs() < 1e-3);
        assert!(first(1.0, 0.0).abs() < 1e-9);
        assert!((first(1.0, 1.0) - 45.0).abs() < 1e-9);
    }

    #[test]
    fn zero_gain_interrupts_the_curve_and_the_phase_goes_on_behind_it() {
        let found = curve(&[(1.0, -1.0, -0.1), (2.0, 0.0, 0.0), (3.0, -1.0, 0.1)]).polar();
        assert!(!found[1].phase_deg.is_finite());
        assert!((found[2].phase_deg + 185.71).abs() < 0.01);
    }

    #[test]
    fn values_between_points_lie_between_them() {
        let found = curve(&[(1.0, 0.0, 0.0), (100.0, 2.0, -2.0)]);
        assert_eq!(found.at(10.0), Some((1.0, -1.0)));
        assert_eq!(found.at(0.5), None);
        assert_eq!(round_frequencies(Some((0.9, 12.0))), [1.0, 2.0, 5.0, 10.0]);
        assert!(round_frequencies(Some((0.0, 1.0))).is_empty());
    }
}
