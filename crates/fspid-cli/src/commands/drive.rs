//! `fspid drive`: a controller of a scenario flies a live autopilot over MAVLink.

use std::net::{SocketAddr, UdpSocket};

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::external_controller::Beside;
use super::show::{address, between};
use super::{Format, interrupt, json_text};
use crate::argument::{NamedFile, OutFile, written};
use crate::exit::{Failure, note, print};
use fspid_external::drive::{Drive, Driven, Ending, Way, drive};
use fspid_scenario::units::radians;
use fspid_study::fly::Hand;
use fspid_study::output;

/// Let a controller of a scenario fly a live autopilot: ArduPilot or PX4, in simulation or in the air.
///
/// ATTITUDE is heard by UDP at --listen; at each sample of the scenario, by the clock, its controller is asked and what
/// --send says is sent back: to --to, or else to where attitudes come from if that is this machine, and nowhere else.
/// Set-point and sample period are the scenario's; its aircraft, servo and disturbances are not used. Pitch counts from
/// --trim. Where attitudes stay out the command is held and then given back; Ctrl-C and SIGTERM give it back, too.
///
/// The autopilot has to be in a mode that takes what is sent. Nobody here arms it or changes its mode.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fspid drive pitch.toml --controller PID --send override --channel 2 --full 20\n  fspid drive pitch.toml --controller PID --send target --listen 127.0.0.1:14540 --thrust 0.6\nExit codes: 0 done; 1 it ended before its time; 2 the input is wrong, or the address cannot be listened at; 130 interrupted."
)]
pub(crate) struct Arguments {
    /// The scenario file.
    file: NamedFile,
    /// Which controller flies, if there are several.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// Set a value before flying, e.g. `--set loop.sample_period_s=0.02`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    #[command(flatten)]
    beside: Beside,
    /// What is sent.
    #[arg(long, value_enum)]
    send: Send,
    /// Where ATTITUDE comes, an address of this machine; ArduPilot and PX4 send to port 14550, PX4 to 14540 as well.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:14550", value_parser = address)]
    listen: SocketAddr,
    /// Where it is sent, and whose attitudes alone are heard then.
    #[arg(long, value_name = "HOST:PORT", value_parser = address)]
    to: Option<SocketAddr>,
    /// Channel of the remote control, from 1, for --send override.
    #[arg(long, value_name = "NUMBER", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=8))]
    channel: u8,
    /// Command at the end of the channel or the stick, degrees, from 0.1 to 90.
    #[arg(long, value_name = "DEG", default_value_t = 20.0, value_parser = between::<100, 90_000>)]
    full: f64,
    /// Turn the sign of what is sent: where 2000 microseconds or the stick back turn the nose down.
    #[arg(long)]
    reversed: bool,
    /// Thrust from 0 to 1 for --send target; without it the autopilot keeps its own.
    #[arg(long, value_name = "FRACTION", value_parser = between::<0, 1_000>)]
    thrust: Option<f64>,
    /// Pitch that counts as 0, degrees, from -45 to 45.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = between::<-45_000, 45_000>, allow_negative_numbers = true)]
    trim: f64,
    /// Longest time until the first ATTITUDE, s, from 0.1 to 3600.
    #[arg(long = "connect-limit", value_name = "S", default_value_t = 30.0, value_parser = between::<100, 3_600_000>)]
    connect_limit_s: f64,
    /// Age of an attitude from which on the command is held, s, from 0.02 to 10; four times that ends the flight.
    #[arg(long = "stale", value_name = "S", default_value_t = 0.25, value_parser = between::<20, 10_000>)]
    stale_s: f64,
    /// Write each sample to this CSV file.
    #[arg(value_parser = written(&["csv"]), long, value_name = "OUT.csv")]
    trace: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// A way to an autopilot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Send {
    /// SET_ATTITUDE_TARGET of the set-point; the controller runs beside it and moves nothing.
    Target,
    /// RC_CHANNELS_OVERRIDE of the command, for ArduPilot.
    Override,
    /// MANUAL_CONTROL of the command, for PX4.
    Manual,
}

impl Arguments {
    fn way(&self) -> Way {
        let full_rad = radians(if self.reversed { -self.full } else { self.full });
        match self.send {
            Send::Target => Way::AttitudeTarget { thrust: self.thrust },
            Send::Override => Way::Override { channel: usize::from(self.channel) - 1, full_rad },
            Send::Manual => Way::Manual { full_rad },
        }
    }
}

/// So many times its first limit an attitude may be old before the flight ends.
const ENDS: f64 = 4.0;

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.beside.study(&arguments.file, &arguments.overrides)?;
    let wrong = |problem: &dyn std::fmt::Display| {
        Failure::input(format_args!("{}: {problem}", arguments.file.display()))
    };
    let scenario = &study.scenario;
    let name = arguments.controller.clone().or_else(|| arguments.beside.only());
    let mut hand = Hand::new(scenario, name.as_deref()).map_err(|problem| wrong(&problem))?;
    let prepared = scenario.prepare().map_err(|problem| wrong(&problem))?;
    let flight = Drive {
        to: arguments.to,
        way: arguments.way(),
        period_s: scenario.timing.dt_s(),
        setpoint_rad: prepared.setpoint_rad(),
        trim_rad: radians(arguments.trim),
        connect_limit_s: arguments.connect_limit_s,
        stale_s: [arguments.stale_s, ENDS * arguments.stale_s],
    };
    let unheard = |error: std::io::Error| {
        Failure::input(format_args!("cannot listen at {}: {error}", arguments.listen))
    };
    let socket = UdpSocket::bind(arguments.listen).map_err(unheard)?;
    let address = socket.local_addr().map_err(unheard)?;
    note(format_args!("listening for ATTITUDE at {address}"));
    interrupt::watch();
    let answer = |sample| hand.answer(sample).map_err(|loss| loss.to_string());
    let driven = drive(socket, &flight, answer, interrupt::asked).map_err(unheard)?;
    if let Some(path) = &arguments.trace {
        output::write(path, driven.csv())?;
    }
    let printed = match arguments.format {
        Format::Text => print(&text(&driven)),
        Format::Json => print(&json_text(&answer_json(&driven))),
    };
    match &driven.ending {
        None => printed,
        // A terminal that has closed takes no answer, and whether the command was given back is told all the same.
        Some(ending @ Ending::Stopped { .. }) => Err(Failure::interrupted(ending)),
        Some(ending) => printed.and(Err(Failure::not_met(ending))),
    }
}

fn text(driven: &Driven) -> String {
    let Driven { rows, late, latest_s, heard, damaged, .. } = driven;
    format!(
        "samples {}, held {}, late {late}, the latest by {:.1} ms; attitudes {heard}, damaged packets {damaged}\n",
        rows.len(),
        driven.held(),
        latest_s * 1e3
    )
}

fn answer_json(driven: &Driven) -> Value {
    json!({
        "samples": driven.rows.len(),
        "held": driven.held(),
        "late": driven.late,
        "latest_s": driven.latest_s,
        "attitudes": driven.heard,
        "damaged": driven.damaged,
        "ending": driven.ending.as_ref().map(ToString::to_string),
    })
}
