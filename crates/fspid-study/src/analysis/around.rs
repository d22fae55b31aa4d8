//! Whether the outer loops around a pitch loop are stable about the trim.

use fspid_diagnostics::digits::to_digits;
use fspid_sim::{Controller, Scenario, SimError};
use serde_json::{Value, json};

use super::{AnalysedMode, Stability, equilibrium};

/// The modes of a scenario's autopilot around one controller, each around the trim with all that it engages.
///
/// A certificate is about the pitch loop alone. Whether the loops around it hold at rest is known from their poles, and a
/// loop that is proved is not called so where one of them is not held: the flight would refute it.
#[derive(Clone, Debug, PartialEq)]
pub struct Around {
    /// One for each mode; none where the controller has no gains at rest, which says nothing of any.
    modes: Vec<AnalysedMode>,
}

impl Around {
    /// Of a controller; none without an autopilot.
    ///
    /// # Errors
    /// [`SimError`] where a mode has no linear model.
    pub fn of(scenario: &Scenario, controller: &Controller) -> Result<Option<Self>, SimError> {
        if scenario.autopilot.is_none() {
            return Ok(None);
        }
        let modes = match equilibrium(controller).gains() {
            Some(gains) => AnalysedMode::all(scenario, controller, gains)?,
            None => Vec::new(),
        };
        Ok(Some(Self { modes }))
    }

    /// True if every mode is held at rest.
    #[must_use]
    pub fn is_held(&self) -> bool {
        !self.modes.is_empty() && self.growing().next().is_none()
    }

    fn growing(&self) -> impl Iterator<Item = &AnalysedMode> {
        self.modes.iter().filter(|mode| mode.stability() != Stability::Stable)
    }

    /// Which modes are not held, or that this is not known; none where all are.
    #[must_use]
    pub fn trouble(&self) -> Option<String> {
        if self.modes.is_empty() {
            return Some(
                "its gains have no rest, so that nothing is known of the outer loops around it"
                    .to_owned(),
            );
        }
        let each = self.growing().map(|mode| {
            if mode.stability() == Stability::Undecided {
                return (Stability::Undecided, mode.name.clone());
            }
            let radius = to_digits(mode.poles.spectral_radius, 7);
            (Stability::Unstable, format!("{} (spectral radius {radius})", mode.name))
        });
        let each: Vec<(Stability, String)> = each.collect();
        let worst = Stability::of_all(each.iter().map(|(stability, _)| *stability));
        let names = each.iter().filter(|(stability, _)| *stability == worst);
        let names: Vec<&str> = names.map(|(_, name)| name.as_str()).collect();
        let modes = if names.len() == 1 { "mode" } else { "modes" };
        let word = worst.word().to_uppercase();
        (!names.is_empty())
            .then(|| format!("{word} with the outer loops of {modes} {}", names.join(", ")))
    }

    /// For answers of programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let mode = |mode: &AnalysedMode| {
            let is_stable = mode.stability().known();
            json!({ "name": mode.name, "stable": is_stable, "spectral_radius": mode.poles.spectral_radius })
        };
        json!({ "held": self.is_held(), "modes": self.modes.iter().map(mode).collect::<Vec<_>>() })
    }
}
