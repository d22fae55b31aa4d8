//! The linear model of an aircraft file.

use fspid_aircraft::data::{LinearCondition, LinearData, LinearElevator, LinearState};
use fspid_lti::Matrix;

use super::quantity;
use crate::file::report::Report;
use crate::file::section::Section;
use crate::units::FOOT_M;

/// Velocities become metres in the states and in their rates; angles stay.
pub(super) fn model(report: &mut Report, section: &Section) -> Option<LinearData> {
    let equations = section.sections("equations");
    let names: Vec<&str> = equations.iter().filter_map(|row| row.text("state")).collect();
    let sizes: Vec<f64> = names.iter().map(|name| state_size(name)).collect();
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for (row, rate) in equations.iter().zip(&sizes) {
        let values = row.numbers("by_states")?;
        if values.len() != sizes.len() {
            let message = format!("{} numbers for {} states", values.len(), sizes.len());
            let allowed = "one number a state".to_owned();
            report.value(row.at("by_states"), &row.path("by_states"), message, allowed);
            return None;
        }
        let scaled = values.iter().zip(&sizes).map(|(value, state)| value * rate / state);
        a.push(scaled.collect::<Vec<_>>());
        b.push([row.number("by_elevator")? * rate]);
    }
    Some(LinearData {
        states: names.iter().filter_map(|name| state(name)).collect(),
        a: Matrix::from_rows(&a).ok()?,
        b: Matrix::from_rows(&b).ok()?,
        elevator: match section.text("elevator_sign") {
            Some("nose-up-positive") => LinearElevator::NoseUpPositive,
            _ => LinearElevator::NoseDownPositive,
        },
        by_pitch_gust: by_pitch_gust(equations, &sizes),
        condition: section.section("condition").and_then(condition),
        span_m: section.section("geometry").and_then(|part| quantity(part, "span")),
    })
}

/// Known as soon as one equation has it.
fn by_pitch_gust(equations: &[Section], sizes: &[f64]) -> Option<Vec<f64>> {
    let given: Vec<Option<f64>> = equations.iter().map(|row| row.number("by_pitch_gust")).collect();
    let known = given.iter().any(Option::is_some);
    let scaled = given.iter().zip(sizes).map(|(value, rate)| value.unwrap_or(0.0) * rate);
    known.then(|| scaled.collect())
}

fn condition(section: &Section) -> Option<LinearCondition> {
    Some(LinearCondition {
        airspeed_m_s: quantity(section, "airspeed")?,
        altitude_m: quantity(section, "altitude")?,
        mach: section.number("mach"),
    })
}

fn state(name: &str) -> Option<LinearState> {
    Some(match name {
        "u_ft_s" | "u_m_s" => LinearState::ForwardVelocity,
        "w_ft_s" | "w_m_s" => LinearState::DownwardVelocity,
        "alpha_rad" => LinearState::Alpha,
        "q_rad_s" => LinearState::PitchRate,
        "theta_rad" => LinearState::Theta,
        _ => return None,
    })
}

fn state_size(name: &str) -> f64 {
    if name.ends_with("_ft_s") { FOOT_M } else { 1.0 }
}
