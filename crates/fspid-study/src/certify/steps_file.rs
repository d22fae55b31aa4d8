//! What a certificate's file says of steps from rest.

use fspid_proof::{Steps, Terminal};
use serde::{Deserialize, Serialize};

use super::file::{Rows, matrix, rows};

/// Steps with the boxes that they are flown in and the form near rest.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StepsFile {
    setpoint_rad: f64,
    load_rad: f64,
    ends: Vec<f64>,
    loads: usize,
    near_rest: NearRest,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct NearRest {
    rate: f64,
    form: Rows,
    level: f64,
}

impl StepsFile {
    pub(super) fn of(steps: &Steps) -> Self {
        let Steps { setpoint_rad, load_rad, terminal, ends, loads } = steps;
        let Terminal { form, rate, level } = terminal;
        Self {
            setpoint_rad: *setpoint_rad,
            load_rad: *load_rad,
            ends: ends.clone(),
            loads: *loads,
            near_rest: NearRest { rate: *rate, form: rows(form), level: *level },
        }
    }

    pub(super) fn build(&self) -> Result<Steps, String> {
        let NearRest { rate, form, level } = &self.near_rest;
        Ok(Steps {
            setpoint_rad: self.setpoint_rad,
            load_rad: self.load_rad,
            terminal: Terminal { form: matrix(form)?, rate: *rate, level: *level },
            ends: self.ends.clone(),
            loads: self.loads,
        })
    }
}
