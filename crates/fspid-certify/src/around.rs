//! Why a flight does not hold although its loop may be proved: the outer loops of an autopilot, the rest of an aircraft, what
//! it comes to later, the limits that it flies at.

use fspid_diagnostics::digits::{to_digits, to_six_decimals};
use fspid_sim::stability::{Unstable, doubt_when_flown};
use fspid_sim::{NamedController, Scenario};

use fspid_study::analysis::{Around, AtRest, held_in_words};
use fspid_study::metrics::Absent;

/// Why a flight may not hold: outer loops around the pitch loop, or anything else of it; that it has no linear model as well.
pub(super) fn trouble_in_words(scenario: &Scenario, named: &NamedController) -> Option<String> {
    let of_modes = match Around::of(scenario, &named.controller) {
        Ok(around) => around.as_ref().and_then(Around::trouble),
        Err(error) => Some(error.to_string()),
    };
    of_modes.or_else(|| not_held_in_words(scenario, named))
}

/// That a flight grows at rest, with a plant or an aircraft of later, by what is no pitching or with the outer loops around the
/// certified one, of which a certificate does not speak; that this is not known, at rest or at the limits that it flies at, counts
/// as well. None where everything holds.
pub(super) fn not_held_in_words(scenario: &Scenario, named: &NamedController) -> Option<String> {
    let at_rest = AtRest::stability(scenario, &named.controller);
    let beyond = at_rest.undecided.map(|it| it.doubt).filter(|doubt| {
        // What is certified is certified for all gains.
        doubt.is_beyond_the_loop() && !doubt.is_of_gains_without_rest()
    });
    if let Some(unstable) = at_rest.unstable {
        return Some(grows_in_words(scenario, &unstable));
    }
    let doubt = beyond.or_else(|| doubt_when_flown(scenario, named))?;
    Some(Absent::Undecided(doubt).to_string())
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
        from_s => format!(", with the plant from {} s on", to_six_decimals(from_s)),
    };
    let radius = to_digits(unstable.spectral_radius, 7);
    format!("UNSTABLE {with}{from} (spectral radius {radius})")
}

#[cfg(test)]
mod tests;
