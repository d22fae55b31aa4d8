//! Where an aircraft is and how it lies, of what a flight shows.

use std::fmt;

use crate::earth::EARTH_RADIUS_M;

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

/// What a flight does not say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Where the flight begins, deg.
    pub latitude_deg: f64,
    /// Where the flight begins, deg.
    pub longitude_deg: f64,
    /// Where it goes, clockwise from north, deg; a flight that knows its heading is turned by it.
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
    /// A line that ends before its last column.
    TooShort {
        /// Line of the file, from 1.
        line: usize,
        /// Its fields.
        found: usize,
        /// Columns of the file.
        needed: usize,
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
            Self::TooShort { line, found, needed } => write!(
                f,
                "line {line}: {found} of {needed} fields; the file is damaged, or is still being written"
            ),
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

/// Length of a degree of latitude on a sphere of the Earth's mean radius, m.
const DEGREE_M: f64 = EARTH_RADIUS_M * std::f64::consts::PI / 180.0;

/// What a flight shows at an instant; what a plant shows that is pitch alone is the rest of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Moment {
    pub(super) time_s: f64,
    /// From the trim.
    pub(super) theta_deg: f64,
    pub(super) elevator_deg: f64,
    pub(super) airspeed_m_s: Option<f64>,
    pub(super) altitude_m: Option<f64>,
    pub(super) alpha_deg: Option<f64>,
    pub(super) bank_deg: Option<f64>,
    pub(super) aileron_deg: Option<f64>,
    /// Way over ground to the north and to the east, m.
    pub(super) place_m: Option<[f64; 2]>,
    /// Clockwise from north, deg.
    pub(super) heading_deg: Option<f64>,
    /// Pitch above the horizon, deg.
    pub(super) attitude_deg: Option<f64>,
}

/// The way of a flight from instant to instant.
#[derive(Clone, Debug)]
pub(super) struct Way {
    start: Start,
    /// Place and trim of the first instant, and the instant before with the airspeed there.
    first_m: Option<[f64; 2]>,
    trim_deg: Option<f64>,
    before: Option<(f64, f64)>,
    /// To the north and to the east, m.
    gone_m: [f64; 2],
}

impl Way {
    pub(super) fn new(start: Start) -> Self {
        Self { start, first_m: None, trim_deg: None, before: None, gone_m: [0.0; 2] }
    }

    /// The pose of the next instant. A flight that knows no place goes straight along its course at its airspeed; one that
    /// knows no pitch above the horizon is taken to fly level at its trim, so that its angle of attack is its pitch there.
    pub(super) fn pose(&mut self, moment: &Moment) -> Pose {
        let airspeed_m_s = moment.airspeed_m_s.unwrap_or(self.start.airspeed_m_s);
        let (sine, cosine) = self.start.heading_deg.to_radians().sin_cos();
        match (moment.place_m, self.before) {
            (Some([north_m, east_m]), _) => {
                let [first_north_m, first_east_m] = *self.first_m.get_or_insert([north_m, east_m]);
                let (north_m, east_m) = (north_m - first_north_m, east_m - first_east_m);
                self.gone_m = [north_m * cosine - east_m * sine, north_m * sine + east_m * cosine];
            }
            (None, Some((time_s, airspeed_m_s))) => {
                let gone_m = airspeed_m_s * (moment.time_s - time_s);
                self.gone_m[0] += gone_m * cosine;
                self.gone_m[1] += gone_m * sine;
            }
            (None, None) => {}
        }
        self.before = Some((moment.time_s, airspeed_m_s));
        let trim_deg = *self.trim_deg.get_or_insert(moment.alpha_deg.unwrap_or(0.0));
        // Near the poles nothing is drawn well; there the way stays finite.
        let round = self.start.latitude_deg.to_radians().cos().max(0.01);
        let [north_m, east_m] = self.gone_m;
        Pose {
            time_s: moment.time_s,
            latitude_deg: self.start.latitude_deg + north_m / DEGREE_M,
            longitude_deg: self.start.longitude_deg + east_m / (DEGREE_M * round),
            altitude_m: moment.altitude_m.unwrap_or(self.start.altitude_m),
            heading_deg: (self.start.heading_deg + moment.heading_deg.unwrap_or(0.0))
                .rem_euclid(360.0),
            pitch_deg: moment.attitude_deg.unwrap_or(trim_deg + moment.theta_deg),
            bank_deg: moment.bank_deg.unwrap_or(0.0),
            elevator_deg: moment.elevator_deg,
            aileron_deg: moment.aileron_deg.unwrap_or(0.0),
            airspeed_m_s,
        }
    }
}

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
    north: Option<usize>,
    east: Option<usize>,
    heading: Option<usize>,
    attitude: Option<usize>,
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
            north: optional("north_m"),
            east: optional("east_m"),
            heading: optional("heading_deg"),
            attitude: optional("attitude_deg"),
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
/// A trace of a plant that shows pitch alone goes along a straight course at the airspeed.
///
/// # Errors
/// [`TraceError`] names the first thing that is wrong.
pub fn poses(text: &str, controller: Option<&str>, start: &Start) -> Result<Vec<Pose>, TraceError> {
    let mut lines = text.lines().enumerate();
    let names: Vec<&str> = lines.next().map_or(Vec::new(), |(_, line)| line.split(',').collect());
    let columns = Columns::of(&names, controller)?;
    let mut poses: Vec<Pose> = Vec::new();
    let mut way = Way::new(*start);
    for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let fields: Vec<&str> = line.split(',').collect();
        let (found, needed) = (fields.len(), names.len());
        if found < needed {
            return Err(TraceError::TooShort { line: index + 1, found, needed });
        }
        if fields.get(columns.theta).is_none_or(|field| field.is_empty()) {
            break;
        }
        let moment = moment(&columns, &fields, (index + 1, &names))?;
        if poses.last().is_some_and(|before| moment.time_s <= before.time_s) {
            return Err(TraceError::NotInOrder { line: index + 1 });
        }
        poses.push(way.pose(&moment));
    }
    if poses.is_empty() { Err(TraceError::Empty) } else { Ok(poses) }
}

fn moment(columns: &Columns, fields: &[&str], at: (usize, &[&str])) -> Result<Moment, TraceError> {
    let told = |place: Option<usize>| place.map(|place| number(fields, place, at)).transpose();
    Ok(Moment {
        time_s: number(fields, columns.time, at)?,
        theta_deg: number(fields, columns.theta, at)?,
        elevator_deg: number(fields, columns.elevator, at)?,
        airspeed_m_s: told(columns.airspeed)?,
        altitude_m: told(columns.altitude)?,
        alpha_deg: told(columns.alpha)?,
        bank_deg: told(columns.bank)?,
        aileron_deg: told(columns.aileron)?,
        place_m: told(columns.north)?.zip(told(columns.east)?).map(|(north, east)| [north, east]),
        heading_deg: told(columns.heading)?,
        attitude_deg: told(columns.attitude)?,
    })
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
