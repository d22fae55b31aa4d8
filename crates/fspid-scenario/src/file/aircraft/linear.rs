//! The linear model of an aircraft file.

use fspid_aircraft::data::{LinearCondition, LinearData, LinearElevator, LinearState};
use fspid_lti::Matrix;
use fspid_sim::ElevatorSign;

use super::quantity;
use crate::file::spec::aircraft as keys;
use crate::file::spec::aircraft::StateWord;
use crate::keyed::Section;
use crate::units::FOOT_M;
use fspid_diagnostics::Report;

/// Velocities become metres in the states and in their rates; angles stay.
pub(super) fn model(report: &mut Report, section: &Section) -> Option<LinearData> {
    let equations = section.sections(keys::EQUATIONS);
    check_states(report, equations)?;
    let words: Vec<StateWord> = equations.iter().filter_map(|row| row.get(keys::STATE)).collect();
    let sizes: Vec<f64> = words.iter().copied().map(state_size).collect();
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for (row, rate) in equations.iter().zip(&sizes) {
        let values = row.numbers(keys::BY_STATES)?;
        if values.len() != sizes.len() {
            let message = format!("{} numbers for {} states", values.len(), sizes.len());
            let allowed = "one number a state".to_owned();
            row.wrong(report, keys::BY_STATES, message, allowed);
            return None;
        }
        let scaled = values.iter().zip(&sizes).map(|(value, state)| value * rate / state);
        a.push(scaled.collect::<Vec<_>>());
        b.push([row.get(keys::BY_ELEVATOR)? * rate]);
    }
    let states: Vec<LinearState> = words.into_iter().map(state).collect();
    check_pitch(report, equations, &states)?;
    Some(LinearData {
        states,
        a: Matrix::from_rows(&a).ok()?,
        b: Matrix::from_rows(&b).ok()?,
        elevator: match section.get(keys::ELEVATOR_SIGN).unwrap_or(ElevatorSign::NoseDownPositive) {
            ElevatorSign::NoseUpPositive => LinearElevator::NoseUpPositive,
            ElevatorSign::NoseDownPositive => LinearElevator::NoseDownPositive,
        },
        by_pitch_gust: by_pitch_gust(equations, &sizes),
        condition: section.get(keys::CONDITION).and_then(condition),
        span_m: section.get(keys::GEOMETRY).and_then(|part| quantity(part, keys::SPAN)),
    })
}

/// Refuses a state that an earlier equation is for, in whatever unit, and w beside alpha, which is w over the airspeed.
fn check_states(report: &mut Report, equations: &[Section]) -> Option<()> {
    let before = report.count();
    let of = |row: &Section| row.get(keys::STATE).map(state);
    for (index, row) in equations.iter().enumerate() {
        let earlier = equations.get(..index).unwrap_or_default();
        if let Some(twin) = earlier.iter().find(|twin| of(twin).map(axis) == of(row).map(axis)) {
            let message = match of(twin) == of(row) {
                true => format!("the state is that of {}", twin.path),
                false => format!("w and alpha are one state, which is that of {}", twin.path),
            };
            row.wrong(report, keys::STATE, message, "one equation a state");
        }
    }
    (report.count() == before).then_some(())
}

/// What a state is a measure of: the velocity down is one by the angle of attack as well.
fn axis(state: LinearState) -> LinearState {
    match state {
        LinearState::Alpha => LinearState::DownwardVelocity,
        other => other,
    }
}

/// Refuses air that turns the nose at once: it acts by forces and moments, and the pitch angle follows the pitch rate.
fn check_pitch(report: &mut Report, equations: &[Section], states: &[LinearState]) -> Option<()> {
    let before = report.count();
    let rows = || equations.iter().zip(states);
    // Without any, no gust can act on the model.
    let felt = rows().any(|(row, _)| row.given(keys::BY_PITCH_GUST));
    for (row, _) in rows().filter(|(_, state)| felt && **state == LinearState::Theta) {
        if row.get(keys::BY_PITCH_GUST).is_some_and(|by_gust| by_gust != 0.0) {
            let message = "the air turns the aircraft by its moment, and does not change the pitch angle at once";
            let key = keys::BY_PITCH_GUST;
            row.wrong(report, key, message, "0, or leave it out");
        }
        let moves = |(value, state): (&f64, &LinearState)| *value != 0.0 && is_by_air(*state);
        if row.numbers(keys::BY_STATES)?.iter().zip(states).any(moves) {
            let message = "a gust would change the pitch angle at once, without a moment";
            let allowed = "0 by u, w and alpha, or no by_pitch_gust in any equation";
            row.wrong(report, keys::BY_STATES, message, allowed);
        }
    }
    (report.count() == before).then_some(())
}

/// True for a motion through the air, which a gust changes.
fn is_by_air(state: LinearState) -> bool {
    matches!(
        state,
        LinearState::ForwardVelocity | LinearState::DownwardVelocity | LinearState::Alpha
    )
}

/// Known as soon as one equation has it.
fn by_pitch_gust(equations: &[Section], sizes: &[f64]) -> Option<Vec<f64>> {
    let given: Vec<Option<f64>> =
        equations.iter().map(|row| row.get(keys::BY_PITCH_GUST)).collect();
    let known = given.iter().any(Option::is_some);
    let scaled = given.iter().zip(sizes).map(|(value, rate)| value.unwrap_or(0.0) * rate);
    known.then(|| scaled.collect())
}

fn condition(section: &Section) -> Option<LinearCondition> {
    Some(LinearCondition {
        airspeed_m_s: quantity(section, keys::CONDITION_AIRSPEED)?,
        altitude_m: quantity(section, keys::CONDITION_ALTITUDE)?,
        mach: section.get(keys::CONDITION_MACH),
    })
}

fn state(word: StateWord) -> LinearState {
    match word {
        StateWord::ForwardFeet | StateWord::ForwardMetres => LinearState::ForwardVelocity,
        StateWord::DownwardFeet | StateWord::DownwardMetres => LinearState::DownwardVelocity,
        StateWord::Alpha => LinearState::Alpha,
        StateWord::PitchRate => LinearState::PitchRate,
        StateWord::Theta => LinearState::Theta,
    }
}

/// A unit of the state in SI units.
fn state_size(word: StateWord) -> f64 {
    match word {
        StateWord::ForwardFeet | StateWord::DownwardFeet => FOOT_M,
        StateWord::ForwardMetres
        | StateWord::DownwardMetres
        | StateWord::Alpha
        | StateWord::PitchRate
        | StateWord::Theta => 1.0,
    }
}
