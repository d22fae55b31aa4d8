//! First-order equations with named states, in the units of an answer.

use fspid_aircraft::VelocityForm;
use fspid_aircraft::data::LinearState;
use fspid_lti::{Matrix, StateSpace};
use serde_json::{Value, json};

use super::facts::key;
use super::table::table;
use fspid_scenario::aircraft::number::significant;
use fspid_scenario::aircraft::units::{Kind, Units};

/// Significant digits of an entry.
const DIGITS: usize = 7;

/// An entry below this part of the largest of its row is what rounding left of a difference.
const ROUNDING: f64 = 1e-11;

/// A state or input: its letter and what it measures; angles are in radians.
type Name = (&'static str, Kind);

/// A system with names.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StateModel {
    states: Vec<Name>,
    inputs: Vec<&'static str>,
    system: StateSpace,
}

/// An angle or rate, which is in radians in equations.
const fn radians(name: &'static str) -> Name {
    (name, Kind::Plain)
}

impl StateModel {
    /// Longitudinal motion of an aircraft that flies.
    pub(super) fn longitudinal(system: StateSpace, form: VelocityForm) -> Self {
        let (first, second) = match form {
            VelocityForm::Components => (("u", Kind::Speed), ("w", Kind::Speed)),
            VelocityForm::SpeedAndAngle => (("airspeed", Kind::Speed), radians("alpha_rad")),
        };
        let states = vec![first, second, radians("q_rad_s"), radians("theta_rad")];
        Self { states, inputs: vec!["elevator_rad", "throttle"], system }
    }

    /// Lateral motion of an aircraft that flies.
    pub(super) fn lateral(system: StateSpace, form: VelocityForm) -> Self {
        let first = match form {
            VelocityForm::Components => ("v", Kind::Speed),
            VelocityForm::SpeedAndAngle => radians("beta_rad"),
        };
        let states = vec![first, radians("p_rad_s"), radians("r_rad_s"), radians("phi_rad")];
        Self { states, inputs: vec!["aileron_rad", "rudder_rad"], system }
    }

    /// A longitudinal model as its source has it.
    pub(super) fn of_source(system: StateSpace, states: &[LinearState]) -> Self {
        let name = |state: &LinearState| match state {
            LinearState::ForwardVelocity => ("u", Kind::Speed),
            LinearState::DownwardVelocity => ("w", Kind::Speed),
            LinearState::Alpha => radians("alpha_rad"),
            LinearState::PitchRate => radians("q_rad_s"),
            LinearState::Theta => radians("theta_rad"),
        };
        Self { states: states.iter().map(name).collect(), inputs: vec!["elevator_rad"], system }
    }

    fn state_names(&self, units: Units) -> Vec<String> {
        self.states.iter().map(|&(name, kind)| key(name, kind, units)).collect()
    }

    /// Rates of change of the states by states and inputs, in the units of the answer.
    fn rows(&self, units: Units) -> Vec<Vec<f64>> {
        let sizes: Vec<f64> = self.states.iter().map(|&(_, kind)| units.of(kind).size).collect();
        let entry = |matrix: &Matrix, row, column| matrix.get(row, column).unwrap_or(f64::NAN);
        let row = |(row, rate): (usize, &f64)| {
            let by_state = |(column, size)| entry(self.system.a(), row, column) * size / rate;
            let by_input = |column| entry(self.system.b(), row, column) / rate;
            let states = sizes.iter().enumerate().map(by_state);
            states.chain((0..self.inputs.len()).map(by_input)).collect()
        };
        sizes.iter().enumerate().map(row).collect()
    }

    /// A line an equation.
    pub(super) fn text(&self, units: Units) -> String {
        let names = self.state_names(units);
        let columns = names.iter().map(String::as_str).chain(self.inputs.iter().copied());
        let headings: Vec<&str> = std::iter::once("rate of").chain(columns).collect();
        let cells = |(name, values): (&String, Vec<f64>)| {
            let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            let numbers = values.iter().map(|value| match value.abs() < ROUNDING * largest {
                true => "0".to_owned(),
                false => significant(*value, DIGITS),
            });
            std::iter::once(name.clone()).chain(numbers).collect()
        };
        let rows: Vec<Vec<String>> = names.iter().zip(self.rows(units)).map(cells).collect();
        table(&headings, &rows)
    }

    /// Names, state matrix and input matrix.
    pub(super) fn json(&self, units: Units) -> Value {
        let rows = self.rows(units);
        let states = self.states.len();
        let part = |from: usize, to: usize| -> Vec<&[f64]> {
            rows.iter().map(|row| row.get(from..to).unwrap_or_default()).collect()
        };
        json!({
            "states": self.state_names(units),
            "inputs": self.inputs,
            "a": part(0, states),
            "b": part(states, states + self.inputs.len()),
        })
    }
}
