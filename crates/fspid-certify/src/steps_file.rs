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

/// The form near rest, in which flights end.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NearRest {
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

impl NearRest {
    pub(super) fn of(terminal: &Terminal) -> Self {
        let Terminal { form, rate, level, gains } = terminal;
        let gains = gains.map(RememberedFile::of);
        Self { rate: *rate, form: rows(form), level: *level, gains }
    }

    pub(super) fn build(&self) -> Result<Terminal, String> {
        let Self { form, rate, level, gains } = self;
        let gains = gains.map(RememberedFile::build);
        Ok(Terminal { form: matrix(form)?, rate: *rate, level: *level, gains })
    }
}

impl StepsFile {
    pub(super) fn of(steps: &Steps) -> Self {
        let Steps { setpoint_rad, load_rad, terminal, ends, loads } = steps;
        Self {
            setpoint_rad: *setpoint_rad,
            load_rad: *load_rad,
            ends: ends.clone(),
            loads: *loads,
            near_rest: NearRest::of(terminal),
        }
    }

    pub(super) fn build(&self) -> Result<Steps, String> {
        let Self { setpoint_rad, load_rad, ends, loads, near_rest } = self;
        let (setpoint_rad, load_rad, ends, loads) =
            (*setpoint_rad, *load_rad, ends.clone(), *loads);
        Ok(Steps { setpoint_rad, load_rad, terminal: near_rest.build()?, ends, loads })
    }
}
