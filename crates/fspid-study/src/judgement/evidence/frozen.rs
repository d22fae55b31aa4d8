//! The loops with the gains frozen at what the supervisor can produce.

use fspid_core::Law;
use fspid_fuzzy::OutOfRange;
use fspid_sim::Controller;

use super::linear::{PlantEvidence, of_margins, with_place};
use crate::analysis::{FrozenMap, FrozenPoint, Margins};
use crate::judgement::{Case, CasePlace, FrozenAt, NotEvaluated};
use crate::metrics::Absent;
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::Requirement;

/// Refuses controllers whose gains go beyond what a map of frozen gains shows.
pub(super) fn require_whole_map(controller: &Controller) -> Result<(), NotEvaluated> {
    let Controller::SelfTuning(fspid) = controller else {
        return Ok(());
    };
    let tuner = fspid.tuner();
    if matches!(tuner.settings().law, Law::Accumulating { .. }) {
        let why = "the accumulating law adds increments up, so that the gains go beyond the map";
        return Err(NotEvaluated::BeyondMap { why });
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
    let of_plant = |plant: &PlantEvidence| match &plant.at_rest.map {
        Some(map) => mapped(plant, map, requirement),
        None => case(plant.at_rest.margins, requirement, plant.place()),
    };
    loops.iter().map(of_plant).collect()
}

/// The least of the frozen-gain map, the cells of numbers, and the worst gains between them.
fn mapped(
    plant: &PlantEvidence,
    map: &FrozenMap,
    requirement: &Requirement,
) -> Result<Case, NotEvaluated> {
    let of = |point: &FrozenPoint| case(point.margins, requirement, place(plant, point));
    let unstable = map.all().filter_map(|point| match point.margins {
        Err(Absent::Unstable { spectral_radius }) => Some((spectral_radius, point)),
        _ => None,
    });
    // Where some gains do not hold the plant, the least stable of them are the ones to be told.
    if let Some((_, point)) = unstable.max_by(|(one, _), (other, _)| one.total_cmp(other)) {
        return of(point);
    }
    let cases = map.all().map(of).collect::<Result<Vec<_>, _>>()?;
    let least = cases.into_iter().min_by(|one, other| one.value.total_cmp(&other.value));
    least.ok_or(NotEvaluated::Absent(Absent::NotFinite))
}

fn place(plant: &PlantEvidence, point: &FrozenPoint) -> CasePlace {
    let frozen = FrozenAt { gains: point.gains, inputs: Some(point.input) };
    CasePlace { frozen: Some(frozen), ..plant.place() }
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
