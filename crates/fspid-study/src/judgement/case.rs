//! The worst case behind a judged value: which step, plant, frozen gains or frequency it was found at.

use std::fmt;

use fspid_core::Gains;
use fspid_sim::RestPoint;
use serde::Serialize;
use serde_json::{Value, json};

use crate::analysis::held_in_words;
use crate::json::present;
use fspid_diagnostics::digits::to_digits;
use fspid_scenario::units::degrees;

/// A step of the command.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StepAt {
    /// Which, counted from 1.
    pub number: usize,
    /// When, s.
    pub at_s: f64,
    /// Set-point before, deg.
    pub from_deg: f64,
    /// Set-point after, deg.
    pub to_deg: f64,
}

/// One of the plants of a flight whose plant changes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlantAt {
    /// 0 for the first, otherwise the change after which it is the plant.
    pub index: usize,
    /// When the change to it begins, s.
    pub from_s: f64,
}

/// Gains that the supervisor can produce, held still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrozenAt {
    /// The gains.
    pub gains: Gains<f64>,
    /// The supervisor's inputs that give them, error and change in its own units, where they are known.
    pub inputs: Option<[f64; 2]>,
}

/// Where a value was found, as far as there is a choice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CasePlace {
    /// The step.
    pub step: Option<StepAt>,
    /// The time, s.
    pub at_s: Option<f64>,
    /// The plant, where there are several.
    pub plant: Option<PlantAt>,
    /// What is held at rest, where the loop there differs from the one at the trim.
    pub rest: Option<RestPoint>,
    /// The frozen gains.
    pub frozen: Option<FrozenAt>,
    /// The frequency, rad/s.
    pub frequency_rad_s: Option<f64>,
    /// Spectral radius of a loop that is unstable there.
    pub spectral_radius: Option<f64>,
}

/// A value of a measure and where it was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The value, in the unit of the measure; infinite for a margin without an end.
    pub value: f64,
    /// Where.
    pub place: CasePlace,
}

impl CasePlace {
    /// True where there is nothing to say.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// For programs; only what there is.
    #[must_use]
    pub fn json(&self) -> Value {
        present(json!({
            "step": self.step,
            "at_s": self.at_s,
            "plant": self.plant,
            "setpoint_deg": self.rest.map(|at| degrees(at.setpoint_rad)),
            "load_deg": self.rest.map(|at| degrees(at.load_rad)),
            "frozen_gains": self.frozen.map(|frozen| frozen.json()),
            "frequency_rad_s": self.frequency_rad_s,
            "spectral_radius": self.spectral_radius,
        }))
    }
}

impl FrozenAt {
    fn json(&self) -> Value {
        let Gains { kp, ki, kd } = self.gains;
        present(json!({
            "kp": kp,
            "ki": ki,
            "kd": kd,
            "supervisor_error": self.inputs.map(|[error, _]| error),
            "supervisor_change": self.inputs.map(|[_, change]| change),
        }))
    }
}

impl fmt::Display for CasePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        if let Some(step) = self.step {
            parts.push(format!(
                "step {} at {} s, {} to {} deg",
                step.number,
                to_digits(step.at_s, 6),
                to_digits(step.from_deg, 6),
                to_digits(step.to_deg, 6),
            ));
        }
        parts.extend(self.at_s.map(|at_s| format!("at {} s", to_digits(at_s, 6))));
        parts.extend(self.plant.map(|plant| match plant.index {
            0 => "the first plant".to_owned(),
            _ => format!("the plant after the change at {} s", to_digits(plant.from_s, 6)),
        }));
        parts.extend(self.rest.map(held_in_words));
        parts.extend(self.frozen.map(frozen_in_words));
        parts.extend(self.frequency_rad_s.map(|omega| format!("at {} rad/s", to_digits(omega, 6))));
        parts.extend(self.spectral_radius.map(|radius| format!("spectral radius {radius:.6}")));
        f.write_str(&parts.join(", "))
    }
}

fn frozen_in_words(frozen: FrozenAt) -> String {
    let Gains { kp, ki, kd } = frozen.gains;
    let [kp, ki, kd] = [kp, ki, kd].map(|value| to_digits(value, 6));
    let gains = format!("gains frozen at kp {kp}, ki {ki}, kd {kd}");
    match frozen.inputs {
        Some([error, change]) => {
            format!(
                "{gains} (supervisor's error {}, change {})",
                to_digits(error, 6),
                to_digits(change, 6)
            )
        }
        None => gains,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_told_in_words_and_only_as_far_as_there_is_one() {
        assert_eq!(CasePlace::default().to_string(), "");
        assert!(CasePlace::default().is_empty());
        let first = PlantAt { index: 0, from_s: 0.0 };
        let place = CasePlace { plant: Some(first), ..CasePlace::default() };
        assert!(!place.is_empty() && place.to_string() == "the first plant", "{place}");
        let step = StepAt { number: 2, at_s: 5.0, from_deg: 1.0, to_deg: -1.0 };
        let place = CasePlace { step: Some(step), ..CasePlace::default() };
        assert_eq!(place.to_string(), "step 2 at 5 s, 1 to -1 deg");
        let frozen =
            FrozenAt { gains: Gains { kp: 1.25, ki: 0.5, kd: 0.1 }, inputs: Some([4.0, -0.2]) };
        let plant = PlantAt { index: 1, from_s: 20.0 };
        let place = CasePlace {
            plant: Some(plant),
            frozen: Some(frozen),
            frequency_rad_s: Some(2.5),
            ..CasePlace::default()
        };
        assert_eq!(
            place.to_string(),
            "the plant after the change at 20 s, gains frozen at kp 1.25, ki 0.5, kd 0.1 (supervisor's error 4, change -0.2), at 2.5 rad/s"
        );
        assert_eq!(place.json()["frozen_gains"]["kp"], 1.25);
        assert_eq!(place.json().get("step"), None);
    }
}
