//! The short period: how fast, how damped, and how much load it brings.

use fspid_lti::Mode;

use super::absent::Absent;
use super::level::{Category, Confidence, Judgement, Level, Requirement};
use super::model::PitchModel;
use crate::modes::{AircraftMode, ModeName};

/// Damping alone.
pub(super) const DAMPING: Requirement = Requirement {
    title: "short-period damping",
    clause: "MIL-F-8785C 3.2.2.1.2, table IV",
    confidence: Confidence::Transcribed,
    note: "level 3 may be less above 20 000 ft if approved; its 0.15 is printed as 0.10 in category B by others",
};

/// Frequency for the load that comes with it.
pub(super) const FREQUENCY: Requirement = Requirement {
    title: "short-period frequency",
    clause: "MIL-F-8785C 3.2.2.1.1, figures 1 to 3",
    confidence: Confidence::Disputed,
    note: "lines of constant frequency squared over n/alpha, which is that of the lift's zero (11 % below that at constant speed for a Boeing 747 in approach); levels 2 and 3 share the lower one. In category C it is 0.096 (others read 0.036). The least frequency and n/alpha of figures 1 and 3 are not applied",
};

/// Damping and frequency together.
pub(super) const CAP: Requirement = Requirement {
    title: "control anticipation parameter",
    clause: "MIL-STD-1797A 4.2.1.2, figure 13",
    confidence: Confidence::Disputed,
    note: "boxes in damping and CAP; level 3 asks for damping alone. In category C level 2 begins at 0.05 (0.096 in some printings)",
};

/// Bounds of the damping at levels 1 to 3.
const DAMPING_BOUNDS: [[(f64, f64); 3]; 3] = [
    [(0.35, 1.30), (0.25, 2.0), (0.15, f64::INFINITY)],
    [(0.30, 2.0), (0.20, 2.0), (0.15, f64::INFINITY)],
    [(0.35, 1.30), (0.25, 2.0), (0.15, f64::INFINITY)],
];

/// Bounds of frequency squared over n/α in the figures of MIL-F-8785C.
const FREQUENCY_BOUNDS: [[(f64, f64); 3]; 3] = [
    [(0.28, 3.6), (0.16, 10.0), (0.16, f64::INFINITY)],
    [(0.085, 3.6), (0.038, 10.0), (0.038, f64::INFINITY)],
    [(0.16, 3.6), (0.096, 10.0), (0.096, f64::INFINITY)],
];

/// Bounds of CAP in the boxes of MIL-STD-1797A.
const CAP_BOUNDS: [[(f64, f64); 3]; 3] = [
    [(0.28, 3.6), (0.16, 10.0), (0.0, f64::INFINITY)],
    [(0.085, 3.6), (0.038, 10.0), (0.0, f64::INFINITY)],
    [(0.16, 3.6), (0.05, 10.0), (0.0, f64::INFINITY)],
];

/// Short period of an aircraft and what it is worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShortPeriod {
    /// Frequency and damping; of two real poles those of their product and sum.
    pub mode: Mode,
    /// Time constant of the lift: lag of the flight path behind the attitude.
    pub lift_lag_s: f64,
    /// Load factor for each radian of angle of attack, in multiples of gravity.
    pub load_per_alpha_g_rad: f64,
    /// Control anticipation parameter in rad²/s² for each multiple of gravity.
    pub cap: f64,
    /// Frequency alone.
    pub frequency_level: Judgement,
    /// The two together.
    pub cap_level: Judgement,
}

impl ShortPeriod {
    /// Short period of a model, judged for a category.
    ///
    /// $$ \frac{n}{\alpha} = \frac{V}{g} \frac{1}{T_{\theta_2}}, \quad
    ///    \mathrm{CAP} = \frac{\omega_n^2}{n / \alpha} $$
    ///
    /// # Source
    /// W. Bihrle, A handling qualities theory for precise flight path control, AFFDL-TR-65-198 (1966), for CAP.
    ///
    /// # Errors
    /// A fast motion that is not a stable mode of two poles; a numerator without the zero of the lift.
    pub fn of(model: &PitchModel, category: Category) -> Result<Self, Absent> {
        let (mode, lift_rate) = (short_period_mode(&model.modes()?)?, model.lift_zero_rad_s()?);
        let load_per_alpha_g_rad = model.airspeed_m_s / model.gravity_m_s2 * lift_rate;
        let frequency = mode.natural_frequency_rad_s;
        let cap = frequency * frequency / load_per_alpha_g_rad;
        Ok(Self {
            mode,
            lift_lag_s: 1.0 / lift_rate,
            load_per_alpha_g_rad,
            cap,
            frequency_level: Judgement::new(
                &FREQUENCY,
                cap,
                Level::within(cap, category.pick(FREQUENCY_BOUNDS)),
            ),
            cap_level: Judgement::new(&CAP, cap, cap_level(mode.damping_ratio, cap, category)),
        })
    }
}

/// Damping of the short period alone, which asks for no load, judged for a category; of a pair that swings and grows, in whatever
/// half of the motion but the phugoid, its negative one.
///
/// # Errors
/// A fast motion that is not a mode of two poles.
pub fn short_period_damping(model: &PitchModel, category: Category) -> Result<Judgement, Absent> {
    let modes = model.modes()?;
    let swings = modes.iter().filter(|mode| mode.name != ModeName::Phugoid && mode.oscillates());
    let growing = swings.filter(|mode| mode.pole.re >= 0.0);
    let fastest = growing.max_by(|one, other| one.pole.re.total_cmp(&other.pole.re));
    let damping = match fastest {
        Some(mode) => mode.mode()?.damping_ratio,
        None => short_period_mode(&modes)?.damping_ratio,
    };
    let level = Level::within(damping, category.pick(DAMPING_BOUNDS));
    Ok(Judgement::new(&DAMPING, damping, level))
}

/// Level of a damping and a control anticipation parameter in the boxes of MIL-STD-1797A.
#[must_use]
pub fn cap_level(damping_ratio: f64, cap: f64, category: Category) -> Level {
    let by_damping = Level::within(damping_ratio, category.pick(DAMPING_BOUNDS));
    by_damping.max(Level::within(cap, category.pick(CAP_BOUNDS)))
}

/// Frequency and damping of the two fast poles.
///
/// $$ \omega_n = \sqrt{p_1 p_2}, \quad \zeta = -\frac{p_1 + p_2}{2 \omega_n} $$
pub(super) fn short_period_mode(modes: &[AircraftMode]) -> Result<Mode, Absent> {
    if modes.iter().any(|mode| mode.name == ModeName::ThirdOscillation) {
        return Err(Absent::ThirdOscillation);
    }
    let fast = modes.iter().filter(|mode| mode.name == ModeName::ShortPeriod);
    let poles: Vec<_> = fast.map(|mode| mode.pole).collect();
    if let Some(pole) = poles.iter().find(|pole| !(pole.re < 0.0)) {
        let doubles_s = core::f64::consts::LN_2 / pole.re;
        return Err(Absent::ShortPeriodDiverges { real_rad_s: pole.re, doubles_s });
    }
    match poles[..] {
        [pair] => Ok(Mode::of_pole(pair)?),
        [first, second] => {
            let natural_frequency_rad_s = (first.re * second.re).sqrt();
            let damping_ratio = -0.5 * (first.re + second.re) / natural_frequency_rad_s;
            Ok(Mode { natural_frequency_rad_s, damping_ratio })
        }
        _ => Err(Absent::OtherModel { found: poles.len() }),
    }
}
