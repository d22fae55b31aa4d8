//! What a certificate's file says of steps from rest.

use fspid_proof::{NearGains, Steps, Terminal};
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    gains: Option<RememberedFile>,
}

/// Gains that remember: least and most of kp, ki and kd, and how far their reference model may be off.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RememberedFile {
    least: [f64; 3],
    most: [f64; 3],
    model_rad: f64,
}

impl RememberedFile {
    fn of(near: NearGains) -> Self {
        let NearGains { gains, model_rad } = near;
        Self { least: gains.map(|[least, _]| least), most: gains.map(|[_, most]| most), model_rad }
    }

    fn build(self) -> NearGains {
        let Self { least, most, model_rad } = self;
        NearGains { gains: [0, 1, 2].map(|gain: usize| [least[gain], most[gain]]), model_rad }
    }
}

impl StepsFile {
    pub(super) fn of(steps: &Steps) -> Self {
        let Steps { setpoint_rad, load_rad, terminal, ends, loads } = steps;
        let Terminal { form, rate, level, gains } = terminal;
        Self {
            setpoint_rad: *setpoint_rad,
            load_rad: *load_rad,
            ends: ends.clone(),
            loads: *loads,
            near_rest: NearRest {
                rate: *rate,
                form: rows(form),
                level: *level,
                gains: gains.map(RememberedFile::of),
            },
        }
    }

    pub(super) fn build(&self) -> Result<Steps, String> {
        let NearRest { rate, form, level, gains } = &self.near_rest;
        Ok(Steps {
            setpoint_rad: self.setpoint_rad,
            load_rad: self.load_rad,
            terminal: Terminal {
                form: matrix(form)?,
                rate: *rate,
                level: *level,
                gains: gains.map(RememberedFile::build),
            },
            ends: self.ends.clone(),
            loads: self.loads,
        })
    }
}
