//! `fspid show`: a flight in FlightGear or X-Plane, of a trace or live.

use std::net::{SocketAddr, ToSocketAddrs as _};
use std::ops::ControlFlow;

use clap::Args;
use serde_json::json;

use super::{Format, json_text};
use crate::argument::{InFile, OutFile, written};
use crate::exit::{Failure, note, print};
use fspid_external::view::{LATE, Live, Shown, Start, Viewer, flightgear_protocol, poses, show};
use fspid_scenario::file::{self, read_text};
use fspid_sim::flown::Perturbation;
use fspid_sim::{Flyer, Outcome, Scenario};
use fspid_study::output;

/// Show a flight in FlightGear or X-Plane: poses of a trace, or of a scenario that is flown meanwhile, sent by UDP at the
/// pace of the flight.
///
/// Nothing is sent but to what is named, and to this machine where no host is. The flight begins at --from, turned by
/// --heading. A plant that shows pitch alone goes straight along --heading, at the airspeed and the altitude that are
/// given.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fspid simulate pitch.toml --trace flown.csv; fspid show flown.csv --controller FSPID --x-plane\n  fspid show flown.csv --flightgear --protocol fspid.xml --speed 2\n  fspid show scenarios/gallery/turn.toml --x-plane\nFlightGear: copy fspid.xml to Protocol in its data, then fgfs --fdm=null --generic=socket,in,60,,5505,udp,fspid\nExit codes: 0 done; 2 the input is wrong, or nothing can be sent there."
)]
pub(crate) struct Arguments {
    /// The trace, as `fspid simulate --trace` writes it; or a scenario (.toml), which is flown while it is shown.
    file: InFile,
    /// The controller whose flight is shown, where there are several.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// Send to FlightGear, by its generic protocol.
    #[arg(long, value_name = "HOST:PORT", num_args = 0..=1, default_missing_value = "127.0.0.1:5505", value_parser = address)]
    flightgear: Option<SocketAddr>,
    /// Send to X-Plane 11 or 12, by its message VEHX.
    #[arg(long = "x-plane", value_name = "HOST:PORT", num_args = 0..=1, default_missing_value = "127.0.0.1:49000", value_parser = address)]
    x_plane: Option<SocketAddr>,
    /// Write the file that tells FlightGear what is sent.
    #[arg(long, value_name = "OUT.xml", value_parser = written(&["xml"]))]
    protocol: Option<OutFile>,
    /// So many times as fast as it was flown, from 0.01 to 1000.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = between::<10, 1_000_000>)]
    speed: f64,
    /// Poses a second, at most; from 1 to 1000.
    #[arg(long, value_name = "HZ", default_value_t = 60.0, value_parser = between::<1_000, 1_000_000>)]
    rate: f64,
    /// Where the flight begins: latitude and longitude, degrees.
    #[arg(long, value_name = "LAT,LON", default_value = "37.6189,-122.375", value_parser = place, allow_hyphen_values = true)]
    from: [f64; 2],
    /// How far it is turned, degrees clockwise; without a heading of its own it goes there from north.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = between::<0, 360_000>)]
    heading: f64,
    /// Altitude of a flight that has none, m.
    #[arg(long = "altitude", value_name = "M", default_value_t = 1000.0, value_parser = between::<0, 100_000_000>)]
    altitude_m: f64,
    /// True airspeed of a flight that has none, m/s.
    #[arg(long = "airspeed", value_name = "M/S", default_value_t = 100.0, value_parser = between::<0, 10_000_000>)]
    airspeed_m_s: f64,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// A number between two, in thousandths.
pub(super) fn between<const LEAST: i32, const MOST: i32>(text: &str) -> Result<f64, String> {
    let [least, most] = [LEAST, MOST].map(|end| f64::from(end) / 1000.0);
    let number = text.parse().ok().filter(|number: &f64| *number >= least && *number <= most);
    number.ok_or_else(|| format!("allowed is a number from {least} to {most}"))
}

fn place(text: &str) -> Result<[f64; 2], String> {
    let numbers = text.split_once(',').and_then(|(one, other)| {
        Some([one.trim().parse::<f64>().ok()?, other.trim().parse::<f64>().ok()?])
    });
    let is_there = |place: &[f64; 2]| place[0].abs() <= 90.0 && place[1].abs() <= 180.0;
    let allowed = "allowed is LAT,LON in degrees, such as 47.5,-122.3";
    numbers.filter(is_there).ok_or_else(|| allowed.to_owned())
}

pub(super) fn address(text: &str) -> Result<SocketAddr, String> {
    let said =
        |reason: std::io::Error| format!("{reason}; allowed is HOST:PORT, such as 127.0.0.1:5505");
    let mut found = text.to_socket_addrs().map_err(said)?;
    found.next().ok_or_else(|| "the host has no address; allowed is HOST:PORT".to_owned())
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let flightgear = arguments.flightgear.map(|address| (Viewer::FlightGear, address));
    let x_plane = arguments.x_plane.map(|address| (Viewer::XPlane, address));
    let viewers: Vec<_> = flightgear.into_iter().chain(x_plane).collect();
    if viewers.is_empty() && arguments.protocol.is_none() {
        return Err(Failure::input(
            "nobody is named who shows it; allowed are --flightgear and --x-plane, and --protocol for FlightGear's file",
        ));
    }
    let is_scenario = arguments.file.extension().is_some_and(|it| it.eq_ignore_ascii_case("toml"));
    let shown = match is_scenario {
        true => live(arguments, &viewers)?,
        false => recorded(arguments, &viewers)?,
    };
    let late_ms = LATE.as_secs_f64() * 1e3;
    if shown.late > 0 {
        note(format_args!(
            "{} of {} poses were sent more than {late_ms:.0} ms late, the latest {:.0} ms: this machine was busy",
            shown.late,
            shown.sent,
            shown.latest_s * 1e3
        ));
    }
    match arguments.format {
        Format::Text => {
            print(&format!("sent {} poses of {:.1} s of flight\n", shown.sent, shown.flight_s))
        }
        Format::Json => print(&json_text(&json!({
            "sent": shown.sent,
            "flight_s": shown.flight_s,
            "late": shown.late,
            "latest_s": shown.latest_s,
            "viewers": viewers.iter().map(|(_, address)| address.to_string()).collect::<Vec<_>>(),
        }))),
    }
}

fn start(arguments: &Arguments) -> Start {
    let [latitude_deg, longitude_deg] = arguments.from;
    Start {
        latitude_deg,
        longitude_deg,
        heading_deg: arguments.heading,
        altitude_m: arguments.altitude_m,
        airspeed_m_s: arguments.airspeed_m_s,
    }
}

fn unsent(error: std::io::Error) -> Failure {
    Failure::input(format_args!("cannot send: {error}"))
}

fn write_protocol(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.protocol {
        Some(path) => Ok(output::write(path, flightgear_protocol())?),
        None => Ok(()),
    }
}

/// Shows a trace.
fn recorded(arguments: &Arguments, viewers: &[(Viewer, SocketAddr)]) -> Result<Shown, Failure> {
    let text = read_text(&arguments.file).map_err(Failure::load)?;
    let name = arguments.file.display();
    let poses = poses(&text, arguments.controller.as_deref(), &start(arguments))
        .map_err(|error| Failure::input(format_args!("{name}: {error}")))?;
    write_protocol(arguments)?;
    match viewers.is_empty() {
        true => Ok(Shown::default()),
        false => show(&poses, viewers, arguments.speed, arguments.rate).map_err(unsent),
    }
}

/// Flies a scenario and shows it meanwhile.
fn live(arguments: &Arguments, viewers: &[(Viewer, SocketAddr)]) -> Result<Shown, Failure> {
    let study = file::load(&arguments.file, &[]).map_err(Failure::load)?;
    for warning in &study.warnings {
        note(format_args!("warning: {warning}"));
    }
    let scenario = &study.scenario;
    let flyer = flyer(scenario, arguments.controller.as_deref())?;
    let prepared = scenario.prepare().map_err(Failure::input)?;
    write_protocol(arguments)?;
    let pace = [arguments.speed, arguments.rate];
    let mut view = Live::new(start(arguments), scenario.timing, viewers, pace).map_err(unsent)?;
    let mut broken = None;
    let flown = flyer.respondent().fly(&prepared, &Perturbation::NONE, |instant| {
        match viewers.is_empty() {
            true => ControlFlow::Break(()),
            false => match view.show(&instant) {
                Ok(()) => ControlFlow::Continue(()),
                Err(error) => {
                    broken = Some(error);
                    ControlFlow::Break(())
                }
            },
        }
    });
    let outcome = flown.map_err(Failure::input)?;
    if let Some(error) = broken {
        return Err(unsent(error));
    }
    if outcome != Outcome::Completed {
        note(format_args!(
            "the flight of {} ended early or is not the one that the scenario describes; `fspid simulate` says how",
            flyer.name()
        ));
    }
    Ok(view.shown())
}

/// The controller of that name, or the only one.
fn flyer<'a>(scenario: &'a Scenario, name: Option<&str>) -> Result<Flyer<'a>, Failure> {
    let all: Vec<Flyer<'a>> = scenario.flyers().collect();
    let found = match (name, all.as_slice()) {
        (None, [only]) => Some(*only),
        (None, _) => None,
        (Some(name), all) => all.iter().find(|flyer| flyer.name() == name).copied(),
    };
    let names: Vec<&str> = all.iter().map(|flyer| flyer.name()).collect();
    found.ok_or_else(|| {
        let names = names.join(", ");
        Failure::input(format_args!("allowed is --controller with one of {names}"))
    })
}
