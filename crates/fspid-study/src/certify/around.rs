//! What flies around the loop that a certificate is about: the outer loops of an autopilot, the rest of an aircraft, what it
//! comes to later.

use fspid_diagnostics::digits::to_digits;
use fspid_sim::stability::Unstable;
use fspid_sim::{Controller, Scenario, SimError};
use serde_json::{Value, json};

use crate::analysis::{AnalysedMode, AtRest, Stability, equilibrium, held_in_words};
use crate::metrics::{Absent, short};

/// That a flight grows at rest, with a plant or an aircraft of later, by what is no pitching or with the outer loops around the
/// certified one, of which a certificate does not speak; that this is not known counts as well. None where everything holds.
pub(super) fn not_held_in_words(scenario: &Scenario, controller: &Controller) -> Option<String> {
    let at_rest = AtRest::stability(scenario, controller);
    let beyond = at_rest.undecided.filter(|it| it.doubt.is_beyond_the_loop());
    match (at_rest.unstable, beyond) {
        (Some(unstable), _) => Some(grows_in_words(scenario, &unstable)),
        (None, Some(undecided)) => Some(Absent::Undecided(undecided.doubt).to_string()),
        (None, None) => None,
    }
}

/// Where a flight grows at rest.
fn grows_in_words(scenario: &Scenario, unstable: &Unstable) -> String {
    let mode = unstable.mode.and_then(|mode| scenario.autopilot.as_ref()?.modes().get(mode));
    let with = match mode {
        Some(mode) => format!("with the outer loops of mode {}", mode.name),
        None => held_in_words(unstable.at),
    };
    let from = match unstable.from_s {
        0.0 => String::new(),
        from_s => format!(", with the plant from {} s on", short(from_s)),
    };
    let radius = to_digits(unstable.spectral_radius, 7);
    format!("UNSTABLE {with}{from} (spectral radius {radius})")
}

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
    pub(crate) fn of(
        scenario: &Scenario,
        controller: &Controller,
    ) -> Result<Option<Self>, SimError> {
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
    pub(crate) fn is_held(&self) -> bool {
        !self.modes.is_empty() && self.growing().next().is_none()
    }

    fn growing(&self) -> impl Iterator<Item = &AnalysedMode> {
        self.modes.iter().filter(|mode| mode.stability() != Stability::Stable)
    }

    /// Which modes are not held, or that this is not known; none where all are.
    pub(super) fn trouble(&self) -> Option<String> {
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

    pub(super) fn json(&self) -> Value {
        let mode = |mode: &AnalysedMode| {
            let is_stable = mode.stability().known();
            json!({ "name": mode.name, "stable": is_stable, "spectral_radius": mode.poles.spectral_radius })
        };
        json!({ "held": self.is_held(), "modes": self.modes.iter().map(mode).collect::<Vec<_>>() })
    }
}

#[cfg(test)]
mod tests;
