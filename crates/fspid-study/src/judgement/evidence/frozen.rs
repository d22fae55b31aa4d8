//! The loops with the gains frozen at what the supervisor can produce, or an accumulating law may come to.

use fspid_core::Law;
use fspid_fuzzy::OutOfRange;
use fspid_proof::gain_set::IncrementMap;
use fspid_sim::Controller;

use super::linear::{PlantEvidence, of_margins, with_place};
use crate::analysis::{Frozen, FrozenGains, FrozenPoint, Margins};
use crate::judgement::{Case, CasePlace, FrozenAt, NotEvaluated};
use crate::metrics::Absent;
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::Requirement;

/// Refuses controllers whose gains go beyond what is looked at of frozen gains.
pub(super) fn require_whole_map(controller: &Controller) -> Result<(), NotEvaluated> {
    let Controller::SelfTuning(fspid) = controller else {
        return Ok(());
    };
    let tuner = fspid.tuner();
    if tuner.settings().law != Law::Memoryless {
        let why = "nothing bounds the gains of the accumulating law: give it a leakage above 0, or each gain both gain limits";
        return match IncrementMap::of(tuner, 1) {
            Ok(_) => Ok(()),
            Err(_) => Err(NotEvaluated::BeyondMap { why }),
        };
    }
    // Where rules conclude numbers, and of a network, answers beyond the range are those of its ends.
    let is_level = !tuner.supervisor().has_labels();
    if tuner.supervisor().out_of_range() == OutOfRange::Evaluate && !is_level {
        let why = "inputs beyond the supervisor's range are evaluated, and the map ends there";
        return Err(NotEvaluated::BeyondMap { why });
    }
    Ok(())
}

/// A case for each plant: that of the worst gains. Fixed gains are frozen as they are.
pub(super) fn cases(
    loops: &[PlantEvidence],
    requirement: &Requirement,
) -> Result<Vec<Case>, NotEvaluated> {
    let of_plant = |plant: &PlantEvidence| match &plant.at_rest.frozen {
        Some(Frozen::OfInputs(map)) => {
            let at =
                |point: &FrozenPoint| FrozenAt { gains: point.gains, inputs: Some(point.input) };
            worst(plant, map.all().map(|point| (at(point), point.margins)), requirement)
        }
        Some(Frozen::WithinReach(reach)) => {
            let at = |found: &FrozenGains| FrozenAt { gains: found.gains, inputs: None };
            worst(plant, reach.all().map(|found| (at(found), found.margins)), requirement)
        }
        None => case(plant.at_rest.margins, requirement, plant.place()),
    };
    loops.iter().map(of_plant).collect()
}

/// The least over all frozen gains with a plant.
fn worst(
    plant: &PlantEvidence,
    all: impl Iterator<Item = (FrozenAt, Result<Margins, Absent>)> + Clone,
    requirement: &Requirement,
) -> Result<Case, NotEvaluated> {
    let of = |(at, margins): (FrozenAt, Result<Margins, Absent>)| {
        case(margins, requirement, CasePlace { frozen: Some(at), ..plant.place() })
    };
    let unstable = all.clone().filter_map(|one| match one.1 {
        Err(Absent::Unstable { spectral_radius }) => Some((spectral_radius, one)),
        _ => None,
    });
    // Where some gains do not hold the plant, the least stable of them are the ones to be told.
    if let Some((_, one)) = unstable.max_by(|(one, _), (other, _)| one.total_cmp(other)) {
        return of(one);
    }
    let cases = all.map(of).collect::<Result<Vec<_>, _>>()?;
    let least = cases.into_iter().min_by(|one, other| one.value.total_cmp(&other.value));
    least.ok_or(NotEvaluated::Absent(Absent::NotFinite))
}

fn case(
    margins: Result<Margins, Absent>,
    requirement: &Requirement,
    place: CasePlace,
) -> Result<Case, NotEvaluated> {
    match margins {
        // Whether they are stable is known without margins.
        Ok(_) | Err(Absent::NotProved { .. }) if requirement.measure == Measure::FrozenStable => {
            Ok(Case { value: 1.0, place })
        }
        Ok(margins) => {
            let (value, frequency_rad_s) = of_margins(requirement.measure, &margins);
            Ok(Case { value, place: CasePlace { frequency_rad_s, ..place } })
        }
        Err(Absent::Unstable { spectral_radius })
            if requirement.measure == Measure::FrozenStable =>
        {
            let place = CasePlace { spectral_radius: Some(spectral_radius), ..place };
            Ok(Case { value: 0.0, place })
        }
        Err(reason) => Err(with_place(reason, place)),
    }
}
