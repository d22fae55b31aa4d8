//! Dutch roll, roll and spiral: how good the lateral motion is.

use super::absent::Absent;
use super::level::{Category, Class, Confidence, Judgement, Level, Requirement};
use crate::modes::{AircraftMode, Growth, ModeName};

/// Damping and frequency of the Dutch roll; judged is the damping.
pub(super) const DUTCH_ROLL: Requirement = Requirement {
    title: "Dutch roll",
    clause: "MIL-F-8785C 3.3.1.1, table VI",
    confidence: Confidence::Transcribed,
    note: "damping, its product with the frequency, and the frequency; the more damping that large ratios of roll to sideslip take (3.3.1.1, frequency squared times ratio above 20) is NOT ASKED FOR here",
};

/// Time constant of the roll.
pub(super) const ROLL: Requirement = Requirement {
    title: "roll mode",
    clause: "MIL-F-8785C 3.3.1.2, table VII",
    confidence: Confidence::Transcribed,
    note: "time constant in s",
};

/// Time to double of the spiral.
pub(super) const SPIRAL: Requirement = Requirement {
    title: "spiral",
    clause: "MIL-F-8785C 3.3.1.3, table VIII",
    confidence: Confidence::Transcribed,
    note: "time to double in s; a spiral that dies out is infinitely good",
};

/// Roll and spiral coupled.
pub(super) const ROLL_SPIRAL: Requirement = Requirement {
    title: "coupled roll and spiral",
    clause: "MIL-F-8785C 3.3.1.4",
    confidence: Confidence::Transcribed,
    note: "product of damping and frequency in rad/s; not allowed in category A",
};

/// Level of a lateral mode.
///
/// # Errors
/// A mode at the origin, which has no damping; a longitudinal mode.
pub fn lateral_level(
    mode: &AircraftMode,
    class: Class,
    category: Category,
) -> Result<Judgement, Absent> {
    match mode.name {
        ModeName::DutchRoll => dutch_roll(mode, class, category),
        ModeName::Roll => Ok(roll(mode, class, category)),
        ModeName::Spiral => Ok(spiral(mode, category)),
        ModeName::RollSpiral => Ok(roll_spiral(mode, category)),
        ModeName::ShortPeriod | ModeName::Phugoid | ModeName::ThirdOscillation => {
            Err(Absent::OtherModel { found: 4 })
        }
    }
}

/// Category A does not allow one at all.
fn roll_spiral(mode: &AircraftMode, category: Category) -> Judgement {
    let rate = -mode.pole.re;
    let level = match category {
        Category::A => Level::Worse,
        Category::B | Category::C => Level::at_least(rate, [0.5, 0.3, 0.15]),
    };
    Judgement::new(&ROLL_SPIRAL, rate, level)
}

fn dutch_roll(mode: &AircraftMode, class: Class, category: Category) -> Result<Judgement, Absent> {
    let found = mode.mode()?;
    let (damping, rate) = (found.damping_ratio, -mode.pole.re);
    let quick = if class.quick() { 1.0 } else { 0.4 };
    let first = category.pick([
        [0.19, 0.35, quick],
        [0.08, 0.15, 0.4],
        [0.08, if class.quick() { 0.15 } else { 0.10 }, quick],
    ]);
    let bounds = [first, [0.02, 0.05, 0.4], [0.0, f64::NEG_INFINITY, 0.4]];
    let level = Level::best(|level| {
        let [least_damping, least_rate, least_frequency] = bounds[level];
        let enough = damping >= least_damping && rate >= least_rate;
        enough && found.natural_frequency_rad_s >= least_frequency
    });
    Ok(Judgement::new(&DUTCH_ROLL, damping, level))
}

/// A roll that grows has a negative time constant, and is judged as infinitely slow.
fn roll(mode: &AircraftMode, class: Class, category: Category) -> Judgement {
    let found_s = mode.time_constant_s();
    let time_s = if found_s > 0.0 { found_s } else { f64::INFINITY };
    let quick = class.quick() && category != Category::B;
    let bounds_s = if quick { [1.0, 1.4, 10.0] } else { [1.4, 3.0, 10.0] };
    Judgement::new(&ROLL, time_s, Level::at_most(time_s, bounds_s))
}

fn spiral(mode: &AircraftMode, category: Category) -> Judgement {
    let doubles_s = match mode.growth() {
        Growth::Doubles(time_s) => time_s,
        Growth::Halves(_) | Growth::Stays => f64::INFINITY,
    };
    let first_s = category.pick([12.0, 20.0, 12.0]);
    Judgement::new(&SPIRAL, doubles_s, Level::at_least(doubles_s, [first_s, 8.0, 4.0]))
}
