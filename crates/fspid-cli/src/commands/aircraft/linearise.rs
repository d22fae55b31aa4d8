//! `fspid aircraft linearise`: the linear model of a flight.

use clap::{Args, ValueEnum};

use super::{Answer, Flight};
use crate::argument::{OutFile, written};
use crate::exit::{Failure, wrote};
use fspid_study::aircraft::{VelocityForm, linearise};
use fspid_study::output;

/// Linearise an aircraft about a trim: state space, and pitch over elevator as polynomials.
///
/// An aircraft that is known by a linear model alone answers with that model.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    flight: Flight,
    /// The first states: forward and downward velocity, or airspeed and angle of attack.
    #[arg(long, value_enum, default_value_t = States::Components)]
    states: States,
    /// Write pitch over elevator as a plant file; a scenario names it under `[plant]` as `file = "OUT.toml"`.
    #[arg(value_parser = written(&["toml"]), long, value_name = "OUT.toml")]
    plant: Option<OutFile>,
    #[command(flatten)]
    answer: Answer,
}

/// How velocity is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum States {
    /// Along the body axes: u, w; sideways v.
    Components,
    /// Airspeed and angle of attack; sideways the sideslip.
    SpeedAndAngle,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let answer = arguments.answer;
    let form = match arguments.states {
        States::Components => VelocityForm::Components,
        States::SpeedAndAngle => VelocityForm::SpeedAndAngle,
    };
    let question = arguments.flight.question(answer.units());
    let linear = linearise(&question, form).map_err(Failure::input)?;
    if let Some(path) = &arguments.plant {
        output::write(path, linear.plant_file())?;
        wrote(path);
    }
    answer.print(|| linear.text(), || linear.json())
}
