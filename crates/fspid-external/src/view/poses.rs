//! Where an aircraft is and how it lies, of a trace that has neither place nor heading.

use std::fmt;

/// Where it is and how it lies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Time of the flight, s.
    pub time_s: f64,
    /// Latitude, deg.
    pub latitude_deg: f64,
    /// Longitude, deg.
    pub longitude_deg: f64,
    /// Altitude, m.
    pub altitude_m: f64,
    /// Clockwise from north, deg.
    pub heading_deg: f64,
    /// Pitch over the horizon, deg.
    pub pitch_deg: f64,
    /// Bank, deg.
    pub bank_deg: f64,
    /// Elevator, deg.
    pub elevator_deg: f64,
    /// Aileron, deg.
    pub aileron_deg: f64,
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
}

/// What a trace does not say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Where the flight begins, deg.
    pub latitude_deg: f64,
    /// Where the flight begins, deg.
    pub longitude_deg: f64,
    /// Where it goes, clockwise from north, deg.
    pub heading_deg: f64,
    /// For a trace without altitude, m.
    pub altitude_m: f64,
    /// For a trace without airspeed, m/s.
    pub airspeed_m_s: f64,
}

/// What is wrong with a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TraceError {
    /// Columns that it has not; these are the controllers that it has.
    NoColumns {
        /// The column that was looked for.
        column: String,
        /// Controllers of the trace, none if it is of one.
        controllers: Vec<String>,
    },
    /// A field that is no finite number.
    NoNumber {
        /// Line of the file, from 1.
        line: usize,
        /// Name of the column.
        column: String,
        /// What stands there.
        found: String,
    },
    /// A time that is not behind the one before.
    NotInOrder {
        /// Line of the file, from 1.
        line: usize,
    },
    /// No flight.
    Empty,
}

impl fmt::Display for TraceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoColumns { column, controllers } if controllers.is_empty() => write!(
                f,
                "the trace has no column `{column}`; allowed is what `fspid simulate --trace` writes"
            ),
            Self::NoColumns { column, controllers } => write!(
                f,
                "the trace has no column `{column}`; allowed is --controller with one of {}",
                controllers.join(", ")
            ),
            Self::NoNumber { line, column, found } => {
                write!(f, "line {line}, {column}: `{found}` is no number; allowed are finite ones")
            }
            Self::NotInOrder { line } => {
                write!(
                    f,
                    "line {line}: its time is not behind the one before; allowed are rising times"
                )
            }
            Self::Empty => {
                f.write_str("the trace holds no sample; allowed is a flight of one or more")
            }
        }
    }
}

impl std::error::Error for TraceError {}

/// Length of a degree of latitude on a sphere of the Earth's mean radius, 6371.0088 km, m.
const DEGREE_M: f64 = 6_371_008.8 * std::f64::consts::PI / 180.0;

/// The columns of a controller.
struct Columns {
    time: usize,
    theta: usize,
    elevator: usize,
    airspeed: Option<usize>,
    altitude: Option<usize>,
    alpha: Option<usize>,
    bank: Option<usize>,
    aileron: Option<usize>,
}

impl Columns {
    fn of(names: &[&str], controller: Option<&str>) -> Result<Self, TraceError> {
        let prefix = controller.map_or(String::new(), |name| format!("{name}."));
        let place = |name: &str| names.iter().position(|it| *it == name);
        let optional = |name: &str| place(&format!("{prefix}{name}"));
        let required = |name: &str| {
            optional(name).ok_or_else(|| TraceError::NoColumns {
                column: format!("{prefix}{name}"),
                controllers: controllers(names),
            })
        };
        let time = place("time_s").ok_or_else(|| TraceError::NoColumns {
            column: "time_s".to_owned(),
            controllers: Vec::new(),
        })?;
        Ok(Self {
            time,
            theta: required("theta_deg")?,
            elevator: required("elevator_deg")?,
            airspeed: optional("airspeed_m_s"),
            altitude: optional("altitude_m"),
            alpha: optional("alpha_deg"),
            bank: optional("bank_deg"),
            aileron: optional("aileron_deg"),
        })
    }
}

fn controllers(names: &[&str]) -> Vec<String> {
    let ends = names.iter().filter_map(|name| name.strip_suffix(".theta_deg"));
    ends.map(str::to_owned).collect()
}

/// The poses of a trace as `fspid simulate --trace` writes it, of the controller of that name where there are several. A
/// flight that ended early has empty fields from there on.
///
/// Along a straight course at the airspeed; the pitch of an aircraft counts from its trim, at which it is taken to fly
/// level, so that its angle of attack at the start is its pitch there.
///
/// # Errors
/// [`TraceError`] names the first thing that is wrong.
pub fn poses(text: &str, controller: Option<&str>, start: &Start) -> Result<Vec<Pose>, TraceError> {
    let mut lines = text.lines().enumerate();
    let names: Vec<&str> = lines.next().map_or(Vec::new(), |(_, line)| line.split(',').collect());
    let columns = Columns::of(&names, controller)?;
    let mut poses: Vec<Pose> = Vec::new();
    let (mut trim_deg, mut way_m) = (None, 0.0);
    let (sine, cosine) = start.heading_deg.to_radians().sin_cos();
    for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let fields: Vec<&str> = line.split(',').collect();
        if fields.get(columns.theta).is_none_or(|field| field.is_empty()) {
            break;
        }
        let number = |place: usize| number(&fields, place, (index + 1, &names));
        let or = |place: Option<usize>, other: f64| place.map_or(Ok(other), number);
        let airspeed_m_s = or(columns.airspeed, start.airspeed_m_s)?;
        let time_s = number(columns.time)?;
        if let Some(before) = poses.last() {
            if time_s <= before.time_s {
                return Err(TraceError::NotInOrder { line: index + 1 });
            }
            way_m += before.airspeed_m_s * (time_s - before.time_s);
        }
        let trim_deg = *trim_deg.get_or_insert(or(columns.alpha, 0.0)?);
        // Near the poles nothing is drawn well; there the way stays finite.
        let round = start.latitude_deg.to_radians().cos().max(0.01);
        poses.push(Pose {
            time_s,
            latitude_deg: start.latitude_deg + way_m * cosine / DEGREE_M,
            longitude_deg: start.longitude_deg + way_m * sine / (DEGREE_M * round),
            altitude_m: or(columns.altitude, start.altitude_m)?,
            heading_deg: start.heading_deg,
            pitch_deg: trim_deg + number(columns.theta)?,
            bank_deg: or(columns.bank, 0.0)?,
            elevator_deg: number(columns.elevator)?,
            aileron_deg: or(columns.aileron, 0.0)?,
            airspeed_m_s,
        });
    }
    if poses.is_empty() { Err(TraceError::Empty) } else { Ok(poses) }
}

fn number(
    fields: &[&str],
    place: usize,
    (line, names): (usize, &[&str]),
) -> Result<f64, TraceError> {
    let found = fields.get(place).copied().unwrap_or_default();
    let number = found.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| TraceError::NoNumber {
        line,
        column: names.get(place).copied().unwrap_or_default().to_owned(),
        found: found.to_owned(),
    })
}
