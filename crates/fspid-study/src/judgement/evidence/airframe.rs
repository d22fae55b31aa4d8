//! The aircraft alone: its modes, behind servo and dead time.

use fspid_aircraft::modes::Growth;
use fspid_aircraft::qualities::{
    Category, CommandPath, EquivalentDelay, Phugoid, PitchModel, ShortPeriod, short_period_damping,
};
use fspid_sim::{LinearPlant, Scenario, SimError};

use super::linear::CHANGED;
use crate::analysis::asked_plants;
use crate::judgement::{Case, CasePlace, NotEvaluated, PlantAt};
use fspid_scenario::file::{Airframe, Study};
use fspid_scenario::measure::Measure;
use fspid_scenario::requirement::Requirement;

/// A case for each plant of the scenario.
pub(super) fn cases(study: &Study, requirement: &Requirement) -> Result<Vec<Case>, NotEvaluated> {
    let scenario = &study.scenario;
    let path = command_path(scenario)?;
    let plants = asked_plants(scenario)?;
    let several = plants.len() > 1;
    let mut cases = Vec::new();
    for (index, asked) in plants.into_iter().enumerate() {
        let plant = asked.plant.ok_or(NotEvaluated::Absent(CHANGED))?;
        // What a nonlinear aircraft comes to be is trimmed at the airspeed of the start.
        let known = study.airframes.get(index);
        let airframe = known.or(study.airframes.first()).ok_or(SimError::NotLinear)?;
        let value = value(requirement.measure, &plant, airframe, &path)?;
        let at = PlantAt { index, from_s: asked.from_s };
        let place = CasePlace { plant: several.then_some(at), ..CasePlace::default() };
        cases.push(Case { value, place });
    }
    Ok(cases)
}

/// Servo, whole samples of delay, and half a sample for which the hold keeps a command on average.
fn command_path(scenario: &Scenario) -> Result<CommandPath, SimError> {
    let actuator = scenario.actuator;
    let samples = actuator.delay_samples() as f64 + 0.5;
    let servo = actuator.lag().transfer_function()?;
    Ok(CommandPath { servo, delay_s: samples * scenario.timing.dt_s() })
}

fn value(
    measure: Measure,
    plant: &LinearPlant,
    airframe: &Airframe,
    path: &CommandPath,
) -> Result<f64, NotEvaluated> {
    let needs_speed = measure == Measure::ControlAnticipation;
    // Modes do not depend on the speed that the loads are computed with; any will do for them.
    let speed_m_s = match airframe.airspeed_m_s {
        Some(speed_m_s) => speed_m_s,
        None if needs_speed => return Err(NotEvaluated::SpeedUnknown),
        None => 1.0,
    };
    let transfer = plant.transfer_function().clone();
    let model = PitchModel::new(transfer, speed_m_s, airframe.gravity_m_s2)
        .map_err(NotEvaluated::Aircraft)?
        .behind(path.clone());
    // Categories differ in their limits, which are the requirement's here, and not in the values.
    Ok(match measure {
        Measure::ShortPeriodDamping => short_period_damping(&model, Category::B)?.value,
        Measure::ControlAnticipation => ShortPeriod::of(&model, Category::B)?.cap,
        Measure::PhugoidDamping => phugoid_damping(&Phugoid::of(&model)?),
        Measure::PhugoidDoubling => doubling_s(&Phugoid::of(&model)?, |_| true),
        Measure::PhugoidOscillationDoubling => doubling_s(&Phugoid::of(&model)?, swings),
        Measure::PhugoidDivergenceDoubling => doubling_s(&Phugoid::of(&model)?, |it| !swings(it)),
        // The equivalent delay, and nothing else comes here.
        _ => EquivalentDelay::of(&model)?.delay_s,
    })
}

/// Damping of a phugoid; one that creeps has real poles, whose damping is 1 or -1.
fn phugoid_damping(phugoid: &Phugoid) -> f64 {
    match phugoid {
        Phugoid::Oscillation { mode, .. } => mode.damping_ratio,
        Phugoid::Creep { real_rad_s, .. } if *real_rad_s < 0.0 => 1.0,
        Phugoid::Creep { .. } => -1.0,
    }
}

const fn swings(phugoid: &Phugoid) -> bool {
    matches!(phugoid, Phugoid::Oscillation { .. })
}

/// Time to double; infinite for a phugoid that does not grow, or is not asked.
fn doubling_s(phugoid: &Phugoid, is_asked: impl Fn(&Phugoid) -> bool) -> f64 {
    let (Phugoid::Oscillation { growth, .. } | Phugoid::Creep { growth, .. }) = phugoid;
    match growth {
        Growth::Doubles(time_s) if is_asked(phugoid) => *time_s,
        Growth::Doubles(_) | Growth::Halves(_) | Growth::Stays => f64::INFINITY,
    }
}
