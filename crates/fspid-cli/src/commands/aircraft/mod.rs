//! `fspid aircraft`: aircraft that fly, one file a subcommand.

mod derive;
mod envelope;
mod import;
mod linearise;
mod list;
mod modes;
mod qualities;
mod show;
mod trim;

use clap::{Args, Subcommand, ValueEnum};
use serde_json::Value;

use super::Format;
use crate::argument::Source;
use crate::exit::Failure;
use fspid_study::aircraft::{AirChoice, DragChoice, LoadingQuestion, Question, ThrustChoice};

/// Trim, linearise and judge aircraft anywhere in their envelope.
///
/// Numbers may have a unit: speeds m/s, km/h, ft/s, kt; altitudes m, km, ft; angles deg, rad.
/// A number without one is in the units of --units: m/s and m, or ft/s and ft.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    List(list::Arguments),
    Show(show::Arguments),
    Trim(trim::Arguments),
    Linearise(linearise::Arguments),
    Modes(modes::Arguments),
    Qualities(qualities::Arguments),
    Envelope(envelope::Arguments),
    Derive(derive::Arguments),
    Import(import::Arguments),
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::List(arguments) => list::run(arguments),
        Command::Show(arguments) => show::run(arguments),
        Command::Trim(arguments) => trim::run(arguments),
        Command::Linearise(arguments) => linearise::run(arguments),
        Command::Modes(arguments) => modes::run(arguments),
        Command::Qualities(arguments) => qualities::run(arguments),
        Command::Envelope(arguments) => envelope::run(arguments),
        Command::Derive(arguments) => derive::run(arguments),
        Command::Import(arguments) => import::run(arguments),
    }
}

/// How an answer is written.
#[derive(Clone, Copy, Debug, Args)]
struct Answer {
    /// Units of bare numbers and of the answer.
    #[arg(long, value_enum, default_value_t = Units::Si)]
    units: Units,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// A system of units.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Units {
    /// Metres, kilograms, newtons.
    Si,
    /// Feet, slugs, pounds of force.
    English,
}

impl Answer {
    fn units(self) -> fspid_scenario::aircraft::Units {
        match self.units {
            Units::Si => fspid_scenario::aircraft::Units::Si,
            Units::English => fspid_scenario::aircraft::Units::English,
        }
    }

    /// Prints the form that was asked for.
    fn print(
        self,
        text: impl FnOnce() -> String,
        json: impl FnOnce() -> Value,
    ) -> Result<(), Failure> {
        self.format.print(text, json)
    }
}

/// Which aircraft, and how it behaves away from the flight condition of its source.
#[derive(Debug, Args)]
struct Plane {
    /// An aircraft that the program carries (see `fspid aircraft list`), or an aircraft file.
    #[arg(value_name = "NAME or FILE")]
    name: Source,
    /// The air: the standard atmosphere (gravity is standard, for an aircraft of tables that of its file), or density and
    /// gravity of the aircraft's source everywhere.
    #[arg(long, value_enum, default_value_t = Air::Standard)]
    air: Air,
    /// How drag depends on lift: along the tangent at the source's condition, or by a parabola.
    #[arg(long, value_enum, default_value_t = Drag::Linear)]
    drag: Drag,
    /// How thrust depends on speed while the throttle is held.
    #[arg(long, value_enum, default_value_t = Thrust::Constant)]
    thrust: Thrust,
    /// Mass that flies, such as 907kg or 2000lb; the wing stays that of the source. That of the source if left out.
    #[arg(long, value_name = "MASS")]
    mass: Option<String>,
    /// Centre of gravity behind the leading edge of the mean chord as a share of it, such as 0.33; that of the source if
    /// left out.
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    cg: Option<String>,
    /// Moment of inertia in roll, as --iy.
    #[arg(long, value_name = "INERTIA")]
    ix: Option<String>,
    /// Moment of inertia in pitch, such as "4000 kg m2" or "3000 slug ft2"; that of the source if left out.
    #[arg(long, value_name = "INERTIA")]
    iy: Option<String>,
    /// Moment of inertia in yaw, as --iy.
    #[arg(long, value_name = "INERTIA")]
    iz: Option<String>,
}

/// Which air.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Air {
    /// The standard atmosphere and standard gravity; for tables the gravity of their file.
    Standard,
    /// Density and gravity of the source, at every altitude.
    Source,
}

/// Which drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Drag {
    /// Along the tangent.
    Linear,
    /// By a parabola with the same tangent.
    Polar,
}

/// Which thrust.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Thrust {
    /// The same at every speed.
    Constant,
    /// As the source's derivative by speed says.
    WithSpeed,
}

impl Plane {
    fn question(&self, units: fspid_scenario::aircraft::Units) -> Question<'_> {
        Question {
            aircraft: &self.name,
            loading: LoadingQuestion {
                mass: self.mass.as_deref(),
                cg: self.cg.as_deref(),
                ix: self.ix.as_deref(),
                iy: self.iy.as_deref(),
                iz: self.iz.as_deref(),
            },
            units,
            air: match self.air {
                Air::Standard => AirChoice::Standard,
                Air::Source => AirChoice::Source,
            },
            drag: match self.drag {
                Drag::Linear => DragChoice::Linear,
                Drag::Polar => DragChoice::Polar,
            },
            thrust: match self.thrust {
                Thrust::Constant => ThrustChoice::Constant,
                Thrust::WithSpeed => ThrustChoice::WithSpeed,
            },
            ..Question::default()
        }
    }
}

/// An aircraft in straight flight.
#[derive(Debug, Args)]
struct Flight {
    #[command(flatten)]
    plane: Plane,
    /// True airspeed, such as 53.6m/s, 176ft/s or 100kt; that of the source if left out.
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    speed: Option<String>,
    /// Altitude, such as 1500m or 5000ft; that of the source if left out.
    #[arg(long, value_name = "ALTITUDE", allow_hyphen_values = true)]
    altitude: Option<String>,
    /// Angle of the flight path over the horizon, such as 3deg; level if left out.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true)]
    climb_angle: Option<String>,
}

impl Flight {
    fn question(&self, units: fspid_scenario::aircraft::Units) -> Question<'_> {
        Question {
            speed: self.speed.as_deref(),
            altitude: self.altitude.as_deref(),
            climb_angle: self.climb_angle.as_deref(),
            ..self.plane.question(units)
        }
    }
}
