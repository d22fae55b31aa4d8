//! Margins as they are answered: in dB, degrees and seconds.

use fspid_lti::{Bracket, Proved, SampledMargins};

use fspid_scenario::units::degrees;

/// Margins of a loop that is stable. A margin without an end is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// How far the gain may fall (negative) and rise (positive), dB.
    pub gain_margin_db: [f64; 2],
    /// Frequencies at which the loop is undamped there, rad/s; none at an infinite end.
    pub phase_crossover_rad_s: [Option<f64>; 2],
    /// Smallest distance of the phase from ± 180° over all crossovers, deg.
    pub phase_margin_deg: f64,
    /// Frequency of that crossover, rad/s.
    pub gain_crossover_rad_s: Option<f64>,
    /// Smallest dead time that makes the loop unstable, s.
    pub delay_margin_s: f64,
    /// Size of the largest disk of gains and phases without skew that the loop bears.
    pub disk_margin: f64,
    /// Gain factors within that disk, dB.
    pub disk_gain_db: [f64; 2],
    /// Phase within that disk, deg.
    pub disk_phase_deg: f64,
    /// Where the disk margin is reached, rad/s.
    pub disk_rad_s: f64,
    /// Largest gain from disturbances of the output to the output.
    pub sensitivity_peak: f64,
    /// Where, rad/s.
    pub sensitivity_peak_rad_s: f64,
    /// Largest gain from the command to the output of the broken loop.
    pub complementary_peak: f64,
    /// Largest modulus of a pole of the closed loop.
    pub spectral_radius: f64,
    /// What is proved of the peaks and the disk margin; where its ends do not meet, the numbers above are the worse
    /// ones. Of points of a map that were asked in the quick way nothing is proved.
    pub proved: Proved,
}

/// A gain factor in dB.
#[must_use]
pub fn decibels(factor: f64) -> f64 {
    20.0 * libm::log10(factor)
}

impl Margins {
    /// The margins of a stable loop.
    #[must_use]
    pub fn of(found: &SampledMargins) -> Self {
        let low = found.gain_low.as_ref();
        let high = found.gain_high.as_ref();
        let phase = found.phase_margin.as_ref();
        Self {
            gain_margin_db: [
                low.map_or(f64::NEG_INFINITY, |limit| decibels(limit.factor)),
                high.map_or(f64::INFINITY, |limit| decibels(limit.factor)),
            ],
            phase_crossover_rad_s: [low, high].map(|limit| limit.map(|limit| limit.omega_rad_s)),
            phase_margin_deg: phase
                .map_or(f64::INFINITY, |crossover| degrees(crossover.phase_margin_rad.abs())),
            gain_crossover_rad_s: phase.map(|crossover| crossover.omega_rad_s),
            delay_margin_s: found.delay_margin_s.unwrap_or(f64::INFINITY),
            disk_margin: found.disk.size,
            disk_gain_db: found.disk.gain.map(decibels),
            disk_phase_deg: degrees(found.disk.phase_rad),
            disk_rad_s: found.disk.omega_rad_s,
            sensitivity_peak: found.sensitivity_peak.value,
            sensitivity_peak_rad_s: found.sensitivity_peak.omega_rad_s,
            complementary_peak: found.complementary_peak.value,
            spectral_radius: found.spectral_radius,
            proved: found.proved,
        }
    }

    /// Of each margin the worse of two, with its frequency.
    #[must_use]
    pub(super) fn or_worse(mut self, other: &Self) -> Self {
        let [low, high] = other.gain_margin_db;
        if low > self.gain_margin_db[0] {
            self.gain_margin_db[0] = low;
            self.phase_crossover_rad_s[0] = other.phase_crossover_rad_s[0];
        }
        if high < self.gain_margin_db[1] {
            self.gain_margin_db[1] = high;
            self.phase_crossover_rad_s[1] = other.phase_crossover_rad_s[1];
        }
        if other.phase_margin_deg < self.phase_margin_deg {
            self.phase_margin_deg = other.phase_margin_deg;
            self.gain_crossover_rad_s = other.gain_crossover_rad_s;
        }
        self.delay_margin_s = self.delay_margin_s.min(other.delay_margin_s);
        if other.disk_margin < self.disk_margin {
            self.disk_margin = other.disk_margin;
            self.disk_gain_db = other.disk_gain_db;
            self.disk_phase_deg = other.disk_phase_deg;
            self.disk_rad_s = other.disk_rad_s;
            self.proved.disk = other.proved.disk;
        }
        if other.sensitivity_peak > self.sensitivity_peak {
            self.sensitivity_peak = other.sensitivity_peak;
            self.sensitivity_peak_rad_s = other.sensitivity_peak_rad_s;
            self.proved.sensitivity = other.proved.sensitivity;
        }
        if other.complementary_peak > self.complementary_peak {
            self.complementary_peak = other.complementary_peak;
            self.proved.complementary = other.proved.complementary;
        }
        self.spectral_radius = self.spectral_radius.max(other.spectral_radius);
        self
    }

    /// The smaller distance of the two ends of the gain margin from 0 dB, dB.
    #[must_use]
    pub fn smaller_gain_margin_db(&self) -> f64 {
        let [low, high] = self.gain_margin_db;
        (-low).min(high)
    }

    /// Names and brackets of what is proved only to lie between two numbers that differ; none as a rule.
    #[must_use]
    pub fn open_brackets(&self) -> Vec<(&'static str, Bracket)> {
        let Proved { sensitivity, complementary, disk } = self.proved;
        let all = [
            ("disk_margin", disk),
            ("sensitivity_peak", sensitivity),
            ("complementary_peak", complementary),
        ];
        let open = |(_, bracket): &(_, Bracket)| bracket.is_known() && !bracket.is_tight();
        all.into_iter().filter(open).collect()
    }

    /// True below 6 dB or 45 deg, what MIL-F-9490D asks of a rigid aircraft in normal operation
    /// (3.1.3.6): such a loop is stable, and should not be called good.
    #[must_use]
    pub fn are_poor(&self) -> bool {
        // Written so that NaN is poor.
        !(self.smaller_gain_margin_db() >= LEAST_DB && self.phase_margin_deg >= LEAST_DEG)
    }
}

const LEAST_DB: f64 = 6.0;
const LEAST_DEG: f64 = 45.0;

/// What is said of a stable loop whose margins are poor: which of the two is, with any of its plants; nothing of good ones.
pub(super) fn poor_in_words(all: &[Margins]) -> Option<&'static str> {
    // Written so that NaN is poor.
    let gain = all.iter().any(|it| !(it.smaller_gain_margin_db() >= LEAST_DB));
    let phase = all.iter().any(|it| !(it.phase_margin_deg >= LEAST_DEG));
    match (gain, phase) {
        (true, true) => Some("gain margin below 6 dB, phase margin below 45 deg"),
        (true, false) => Some("gain margin below 6 dB"),
        (false, true) => Some("phase margin below 45 deg"),
        (false, false) => None,
    }
}

/// Why an end of the gain margin is infinite, in words.
pub(super) const NO_LOWER_LIMIT: &str = "no smaller gain makes the loop unstable";
/// As [`NO_LOWER_LIMIT`].
pub(super) const NO_UPPER_LIMIT: &str = "no larger gain makes the loop unstable";
/// Why there is no phase margin.
pub(super) const NO_CROSSOVER: &str = "the gain of the loop is 1 at no frequency";
