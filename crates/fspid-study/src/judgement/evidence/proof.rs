//! The loop while its gains move, proved.

use fspid_proof::{Asked, Effort, LoopDescription, is_proved};
use fspid_sim::NamedController;

use crate::analysis::Around;
use crate::analysis::lasting_plants;
use crate::judgement::{Case, CasePlace, NotEvaluated, PlantAt};
use fspid_scenario::file::Study;

/// A case for each plant that lasts: 1 where it is proved for all that the scenario commands, as `certify` proves it.
pub(super) fn cases(study: &Study, named: &NamedController) -> Result<Vec<Case>, NotEvaluated> {
    let scenario = &study.scenario;
    // A proof is one of the pitch loop: with outer loops that do not hold at rest it says nothing of the flight.
    let around = Around::of(scenario, &named.controller)?;
    if around.is_some_and(|around| !around.is_held()) {
        return Ok(vec![Case { value: 0.0, place: CasePlace::default() }]);
    }
    let plants = lasting_plants(scenario)?;
    let several = plants.len() > 1;
    let mut cases = Vec::new();
    for (index, (from_s, plant)) in plants.iter().enumerate() {
        let why =
            |error: fspid_proof::NotProvable| NotEvaluated::NotProvable { why: error.to_string() };
        let description = LoopDescription::of(scenario, plant, &named.controller).map_err(why)?;
        let asked = Asked::of(scenario, plant, &description);
        let proved = is_proved(&description, &asked, &Effort::default()).map_err(why)?;
        let plant = several.then_some(PlantAt { index, from_s: *from_s });
        let place = CasePlace { plant, ..CasePlace::default() };
        cases.push(Case { value: f64::from(u8::from(proved)), place });
        if !proved {
            // One that is not proved decides: nobody has to wait for the others.
            break;
        }
    }
    Ok(cases)
}
