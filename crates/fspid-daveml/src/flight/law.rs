//! A control law from a model: what a flight shows in, where every control is to stand out.

use crate::flight::error::FlightError;
use crate::flight::port::{self, ROOM};
use crate::flight::quantity::{self, ANGLE, LENGTH, PART, RATE, SPEED, Units};
use crate::model::{Model, Port};

/// What a control law can hear of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heard {
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
    /// Equivalent airspeed, m/s: that of the same dynamic pressure at sea level.
    pub equivalent_airspeed_m_s: f64,
    /// Mach number.
    pub mach: f64,
    /// Altitude above sea level, m.
    pub altitude_m: f64,
    /// Angle of attack, rad.
    pub alpha_rad: f64,
    /// Angle of sideslip, air from the right positive, rad.
    pub sideslip_rad: f64,
    /// Bank, pitch and heading, rad.
    pub attitude_rad: [f64; 3],
    /// Body rates of roll, pitch and yaw, rad/s.
    pub rates_rad_s: [f64; 3],
    /// Distance to the right of the course line, m.
    pub right_of_course_m: f64,
}

/// Where a control law wants the controls, in the signs of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Elevator, rad.
    pub elevator_rad: f64,
    /// Aileron, rad; nothing of a law that leaves it alone.
    pub aileron_rad: Option<f64>,
    /// Rudder, rad.
    pub rudder_rad: Option<f64>,
    /// Power of the engine, as a fraction: its lever's angle in percent, over 100.
    pub power: Option<f64>,
}

/// A control that an input of a law can trim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// The elevator, rad.
    Elevator,
    /// The power of the engine, as a fraction.
    Power,
}

impl Control {
    fn of(self, wanted: &Wanted) -> Result<f64, FlightError> {
        let [.., (power, _)] = CONTROLS;
        match self {
            Self::Elevator => Ok(wanted.elevator_rad),
            Self::Power => wanted.power.ok_or(FlightError::Output { name: power }),
        }
    }
}

/// Every quantity that a law can hear by its name in the standard, with its units, in the order of [`Heard::values`].
const QUANTITIES: [(&str, Units); 13] = [
    ("trueAirspeed", SPEED),
    ("equivalentAirspeed", SPEED),
    ("mach", PART),
    ("altitudeMsl", LENGTH),
    ("angleOfAttack", ANGLE),
    ("angleOfSideslip", ANGLE),
    ("eulerAngle_Roll", ANGLE),
    ("eulerAngle_Pitch", ANGLE),
    ("eulerAngle_Yaw", ANGLE),
    ("bodyAngularRate_Roll", RATE),
    ("bodyAngularRate_Pitch", RATE),
    ("bodyAngularRate_Yaw", RATE),
    ("lateralDeviationError", LENGTH),
];

/// Every output that moves something; the first has to be there.
const CONTROLS: [(&str, Units); 4] = [
    ("elevatorDeflection", ANGLE),
    ("aileronDeflection", ANGLE),
    ("rudderDeflection", ANGLE),
    ("powerLeverAngle", PART),
];

impl Heard {
    fn values(&self) -> [f64; QUANTITIES.len()] {
        let ([bank, pitch, heading], [roll, pitching, yaw]) = (self.attitude_rad, self.rates_rad_s);
        [
            self.airspeed_m_s,
            self.equivalent_airspeed_m_s,
            self.mach,
            self.altitude_m,
            self.alpha_rad,
            self.sideslip_rad,
            bank,
            pitch,
            heading,
            roll,
            pitching,
            yaw,
            self.right_of_course_m,
        ]
    }
}

/// A control law without a memory: what it wants depends on what it hears now, and on numbers that are set.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlLaw {
    model: Model,
    wires: Vec<Wire>,
    outputs: usize,
    controls: [Option<(usize, f64)>; CONTROLS.len()],
}

/// Where one input comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wire {
    /// A quantity of the flight by its place, divided by what one unit of the model is, and what is added then.
    Heard { place: usize, unit: f64, added: f64 },
    /// A number that is set, in the unit of the model.
    Set(f64),
}

impl ControlLaw {
    /// The law of a model, with numbers that are set for inputs by name, in the units of the model. An input that is set
    /// is not heard; one that is neither keeps the initial value of its file.
    ///
    /// # Errors
    /// An input that a flight does not have, that is not set and has no initial value; a set number for no input; no
    /// elevator; units that are not known; too many inputs or outputs.
    pub fn new(model: Model, set: &[(String, f64)]) -> Result<Self, FlightError> {
        let wires = model.inputs().map(|port| wire(port, set)).collect::<Result<Vec<_>, _>>()?;
        let outputs = model.outputs().count();
        port::few(wires.len())?;
        port::few(outputs)?;
        let mut controls = [None; CONTROLS.len()];
        for (control, (name, units)) in controls.iter_mut().zip(CONTROLS) {
            let found = model.outputs().enumerate().find(|(_, port)| port.name == name);
            *control = match found {
                Some((index, port)) => Some((index, quantity::factor(port, units)?)),
                None => None,
            };
        }
        let [elevator, ..] = CONTROLS;
        if controls[0].is_none() {
            return Err(FlightError::Output { name: elevator.0 });
        }
        let mut law = Self { model, wires, outputs, controls };
        set.iter().try_for_each(|(name, value)| law.set(name, *value))?;
        Ok(law)
    }

    /// Sets another number, in the unit of the model.
    ///
    /// # Errors
    /// A name that no input has; the names that there are.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), FlightError> {
        *self.wire_mut(name)? = Wire::Set(value);
        Ok(())
    }

    /// Adds a number to what an input hears, in the unit of the model.
    ///
    /// # Errors
    /// A name that no input has, and one that hears nothing of the flight.
    pub fn add(&mut self, name: &str, more: f64) -> Result<(), FlightError> {
        match self.wire_mut(name)? {
            Wire::Heard { added, .. } => *added = more,
            Wire::Set(_) => return Err(FlightError::NotHeard { name: name.to_owned() }),
        }
        Ok(())
    }

    fn wire_mut(&mut self, name: &str) -> Result<&mut Wire, FlightError> {
        let place = self.model.inputs().position(|port| port.name == name);
        let known = || {
            let known: Vec<&str> = self.model.inputs().map(|port| port.name.as_str()).collect();
            known.join(", ")
        };
        let missing = FlightError::NoSuchInput { name: name.to_owned(), known: known() };
        place.and_then(|place| self.wires.get_mut(place)).ok_or(missing)
    }

    /// Where the law wants the controls. It does not use the heap.
    #[must_use]
    pub fn wanted(&self, heard: &Heard) -> Wanted {
        let (values, mut inputs, mut outputs) = (heard.values(), [0.0; ROOM], [f64::NAN; ROOM]);
        for (input, wire) in inputs.iter_mut().zip(&self.wires) {
            *input = match *wire {
                Wire::Heard { place, unit, added } => {
                    values.get(place).copied().unwrap_or(f64::NAN) / unit + added
                }
                Wire::Set(value) => value,
            };
        }
        let (given, room) = (inputs.get(..self.wires.len()), outputs.get_mut(..self.outputs));
        let computed = self.model.evaluate(given.unwrap_or_default(), room.unwrap_or_default());
        debug_assert!(computed.is_ok(), "inputs and outputs were counted before");
        let read = |control: Option<(usize, f64)>| {
            control.map(|(index, unit)| outputs.get(index).copied().unwrap_or(f64::NAN) * unit)
        };
        let [elevator, aileron, rudder, power] = self.controls;
        Wanted {
            elevator_rad: read(elevator).unwrap_or(f64::NAN),
            aileron_rad: read(aileron),
            rudder_rad: read(rudder),
            power: read(power),
        }
    }

    /// Sets an input so that one of the controls stands where a flight at rest has it: what a law calls its trim.
    ///
    /// Between two values around what the file has, at which the control stands on either side of there, by regula falsi
    /// with half of what stays (Illinois).
    ///
    /// # Errors
    /// [`FlightError::NoSuchInput`], [`FlightError::Output`] where the law does not move that control, and
    /// [`FlightError::NoTrim`] where the input does not lead there.
    pub fn trim(
        &mut self,
        name: &str,
        heard: &Heard,
        (control, stands): (Control, f64),
    ) -> Result<f64, FlightError> {
        let port = self.model.inputs().find(|port| port.name == name);
        let begin = port.and_then(|port| port.initial).unwrap_or(0.0);
        let mut off = |value: f64| -> Result<(f64, f64), FlightError> {
            self.set(name, value)?;
            Ok((value, control.of(&self.wanted(heard))? - stands))
        };
        let middle = off(begin)?;
        let (mut ends, mut width) = (None, NEAR);
        for _ in 0..MOST_DOUBLINGS {
            let [below, above] = [off(begin - width)?, off(begin + width)?];
            ends = [below, above].into_iter().find(|end| (end.1 < 0.0) != (middle.1 < 0.0));
            if ends.is_some() {
                break;
            }
            width *= 2.0;
        }
        let (mut before, mut after) = (middle, ends.unwrap_or(middle));
        for _ in 0..MOST_TRIES {
            if after.1.abs() <= CLOSE {
                return off(after.0).map(|(value, _)| value);
            }
            let slope = (after.1 - before.1) / (after.0 - before.0);
            let next = off(after.0 - after.1 / slope)?;
            if !next.1.is_finite() {
                break;
            }
            if (next.1 < 0.0) == (after.1 < 0.0) {
                before.1 *= 0.5;
            } else {
                before = after;
            }
            after = next;
        }
        Err(FlightError::NoTrim { name: name.to_owned(), off: after.1 })
    }
}

/// The narrowest look around what the file has for an input, in its unit, and how often it is doubled: to a million.
const NEAR: f64 = 1e-3;
const MOST_DOUBLINGS: usize = 30;
/// How near to a trim is at it, rad or a fraction of power.
const CLOSE: f64 = 1e-13;
/// Most steps of a search; one halves what is left at least every other time.
const MOST_TRIES: usize = 200;

fn wire(port: &Port, set: &[(String, f64)]) -> Result<Wire, FlightError> {
    let is_set = set.iter().any(|(name, _)| *name == port.name);
    let heard = QUANTITIES.iter().position(|(name, _)| name.eq_ignore_ascii_case(&port.name));
    match (heard.filter(|_| !is_set), port.initial) {
        (Some(place), _) => {
            let units = QUANTITIES.get(place).map_or(PART, |(_, units)| *units);
            Ok(Wire::Heard { place, unit: quantity::factor(port, units)?, added: 0.0 })
        }
        (None, Some(value)) => Ok(Wire::Set(value)),
        (None, None) if is_set => Ok(Wire::Set(0.0)),
        (None, None) => {
            let known = QUANTITIES.map(|(name, _)| name).join(", ");
            Err(FlightError::Unset { name: port.name.clone(), known })
        }
    }
}
