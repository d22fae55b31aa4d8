//! The numbers of a loop's plant and actuator, with slopes, and the plant that they make.

use fspid_aircraft::aerodynamics::derivatives::LongitudinalCoefficient;
use fspid_aircraft::data::Moment;
use fspid_aircraft::enclosure::{EnclosedFlight, EnclosedModel};
use fspid_lti::{Matrix, StateSpace};
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{ActuatorLag, ContinuousPlant, LagOf, NotProved, Sloped, printed};
use fspid_proof::{LoopDescription, ScaledSensor};
use fspid_scenario::file::{FlownDerivatives, Study};
use fspid_sim::ElevatorSign;
use fspid_sim::loop_model::Sensing;

use super::loop_number::{AircraftNumber, Coefficient, Derivative, LoopNumber};

/// The linear model that flies is made by differences of the equations, an enclosed one by their derivatives: their
/// coefficients may differ by this share of the largest.
const DIFFERENCED: f64 = 1e-6;

/// Numbers of plant and actuator.
#[derive(Clone, Debug)]
pub(super) struct Source {
    plant: PlantSource,
    elevator_sign: ElevatorSign,
    lag: LagOf<Sloped>,
    /// Between what the scales of the sensors of pitch and of pitch rate lie, where they differ.
    scales: [Option<[f64; 2]>; 2],
}

#[derive(Clone, Debug)]
enum PlantSource {
    /// Coefficients, highest power first.
    TransferFunction { numerator: Vec<Sloped>, denominator: Vec<Sloped> },
    /// A straight flight, and the centre of gravity of its derivatives as a share of the chord.
    Aircraft { flight: Box<EnclosedFlight<Sloped>>, cg_mac: f64 },
}

impl Source {
    /// Those of a loop of a study as it is, each with the decimals that round to it.
    pub(super) fn of(study: &Study, description: &LoopDescription) -> Self {
        let fixed = |value: f64| Sloped::fixed(printed(value));
        let all = |values: &[f64]| values.iter().map(|&it| fixed(it)).collect();
        let plant = match &study.derivatives {
            Some(FlownDerivatives { data, laws, environment, target }) => PlantSource::Aircraft {
                flight: Box::new(EnclosedFlight::of(data, *laws, *environment, *target)),
                cg_mac: data.reference.cg_mac.unwrap_or(0.0),
            },
            None => PlantSource::TransferFunction {
                numerator: all(&description.numerator),
                denominator: all(&description.denominator),
            },
        };
        let lag = match ActuatorLag::from(description.actuator.lag()) {
            ActuatorLag::None => LagOf::None,
            ActuatorLag::First { time_constant_s } => {
                LagOf::First(Sloped::fixed(Interval::ONE / printed(time_constant_s)))
            }
            ActuatorLag::Second { natural_frequency_rad_s, damping } => {
                LagOf::Second(fixed(natural_frequency_rad_s), fixed(damping))
            }
        };
        Self { plant, elevator_sign: description.elevator_sign, lag, scales: [None; 2] }
    }

    /// Puts the ends of a sensor's scale.
    pub(super) fn put_scale(&mut self, sensor: ScaledSensor, ends: [f64; 2]) {
        self.scales[usize::from(sensor == ScaledSensor::Rate)] = Some(ends);
    }

    /// Puts a number, if the loop has it. A time constant comes as one over it.
    pub(super) fn put(&mut self, number: LoopNumber, value: Sloped) -> Option<()> {
        let place = match (number, &mut self.plant, &mut self.lag) {
            (LoopNumber::Numerator(index), PlantSource::TransferFunction { numerator, .. }, _) => {
                numerator.get_mut(index)?
            }
            (
                LoopNumber::Denominator(index),
                PlantSource::TransferFunction { denominator, .. },
                _,
            ) => denominator.get_mut(index)?,
            (LoopNumber::Aircraft(number, unit), PlantSource::Aircraft { flight, cg_mac }, _) => {
                let value = value * Sloped::fixed(printed(unit));
                put_in_flight(flight, (number, *cg_mac), value);
                return Some(());
            }
            (LoopNumber::TimeConstant, _, LagOf::First(bandwidth)) => bandwidth,
            (LoopNumber::NaturalFrequency, _, LagOf::Second(frequency, _)) => frequency,
            (LoopNumber::Damping, _, LagOf::Second(_, damping)) => damping,
            _ => return None,
        };
        *place = value;
        Some(())
    }

    /// The plant of all these numbers, in a form in which most of them enter linearly.
    pub(super) fn plant(&self) -> Result<ContinuousPlant<Sloped>, NotProved> {
        match &self.plant {
            PlantSource::TransferFunction { numerator, denominator } => {
                self.of_transfer_function(numerator, denominator)
            }
            PlantSource::Aircraft { flight, .. } => self.of_flight(flight),
        }
    }

    fn of_transfer_function(
        &self,
        numerator: &[Sloped],
        denominator: &[Sloped],
    ) -> Result<ContinuousPlant<Sloped>, NotProved> {
        let may_vanish = |it: &Sloped| it.value.contains(0.0);
        if denominator.first().is_none_or(may_vanish) {
            return Err(no_plant(
                "leading coefficient of the denominator",
                "ends on one side of 0",
            ));
        }
        let (sign, lag) = (self.elevator_sign, self.lag);
        // Coefficients before the first that is there are no part of the numerator.
        let there = numerator.iter().position(|it| it.value != Interval::ZERO).unwrap_or(0);
        let numerator = &numerator[there..];
        let normal =
            ContinuousPlant::in_normal_form(numerator, denominator, (sign, lag), may_vanish);
        // Without an effect of the elevator somewhere there is no normal form there.
        Ok(normal.unwrap_or_else(|| {
            ContinuousPlant::of_transfer_function(numerator, denominator, sign, lag)
        }))
    }

    fn of_flight(
        &self,
        flight: &EnclosedFlight<Sloped>,
    ) -> Result<ContinuousPlant<Sloped>, NotProved> {
        let allowed = "limits within which each flight is trimmed, and altitudes in one layer of the standard atmosphere";
        let model = flight.model().ok_or_else(|| no_plant("straight flights", allowed))?;
        let EnclosedModel { by_states, by_elevator } = model;
        let sign = Sloped::fixed(Interval::point(self.elevator_sign.per_nose_up()));
        let zero = Sloped::fixed(Interval::ZERO);
        let one = Sloped::fixed(Interval::ONE);
        Ok(ContinuousPlant {
            by_states: by_states.map(|row| row.to_vec()).to_vec(),
            by_elevator: by_elevator.map(|it| sign * it).to_vec(),
            pitch_rate: vec![zero, one, zero, zero, zero],
            lag: self.lag,
        })
    }

    /// True if the numbers here, which stand alone, are those of the loop `flown`, all else of which is as in `own`.
    pub(super) fn is_of(&self, flown: &LoopDescription, own: &LoopDescription) -> bool {
        let rest_is_own = LoopDescription {
            numerator: own.numerator.clone(),
            denominator: own.denominator.clone(),
            actuator: flown.actuator.with_lag(own.actuator.lag()),
            pitch: Sensing { scale: own.pitch.scale, ..flown.pitch },
            rate: Sensing { scale: own.rate.scale, ..flown.rate },
            ..flown.clone()
        } == *own;
        let scales = [(flown.pitch, own.pitch), (flown.rate, own.rate)];
        let is_seen = scales.into_iter().zip(self.scales).all(|((flown, own), ends)| {
            let [least, most] = ends.unwrap_or([own.scale; 2]);
            (least..=most).contains(&flown.scale)
        });
        rest_is_own && is_seen && self.lag_is_of(flown) && self.plant_is_of(flown).unwrap_or(false)
    }

    fn lag_is_of(&self, flown: &LoopDescription) -> bool {
        let near = |own: Sloped, flown: f64| own.value.contains(flown);
        match (self.lag, ActuatorLag::from(flown.actuator.lag())) {
            (LagOf::None, ActuatorLag::None) => true,
            (LagOf::First(bandwidth), ActuatorLag::First { time_constant_s }) => {
                (Interval::ONE / bandwidth.value).contains(time_constant_s)
            }
            (
                LagOf::Second(frequency, own),
                ActuatorLag::Second { natural_frequency_rad_s, damping },
            ) => near(frequency, natural_frequency_rad_s) && near(own, damping),
            _ => false,
        }
    }

    fn plant_is_of(&self, flown: &LoopDescription) -> Option<bool> {
        match &self.plant {
            PlantSource::TransferFunction { numerator, denominator } => {
                let holds = |own: &[Sloped], flown: &[f64]| {
                    let each = own.iter().zip(flown);
                    own.len() == flown.len()
                        && each.into_iter().all(|(own, flown)| own.value.contains(*flown))
                };
                let same = holds(numerator, &flown.numerator);
                Some(same && holds(denominator, &flown.denominator))
            }
            PlantSource::Aircraft { flight, .. } => {
                let EnclosedModel { by_states, by_elevator } = flight.model()?;
                let middle = |it: Sloped| it.value.midpoint();
                let a = Matrix::from_rows(&by_states.map(|row| row.map(middle))).ok()?;
                let b = Matrix::from_rows(&by_elevator.map(|it| [middle(it)])).ok()?;
                let system =
                    StateSpace::new(a, b, Matrix::identity(4), Matrix::zeros(4, 1)).ok()?;
                let own = fspid_aircraft::transfer_function(&system, 0, 0).ok()?;
                let same = is_near(own.numerator().coefficients(), &flown.numerator);
                Some(same && is_near(own.denominator().coefficients(), &flown.denominator))
            }
        }
    }
}

fn no_plant(what: &'static str, allowed: &'static str) -> NotProved {
    NotProved::Number { what, found: f64::NAN, allowed }
}

/// Coefficients, but for differences and for zeros before the first.
fn is_near(own: &[f64], flown: &[f64]) -> bool {
    let largest = flown.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    let count = own.len().max(flown.len());
    let at = |values: &[f64], place: usize| {
        (place + values.len()).checked_sub(count).map_or(0.0, |index| values[index])
    };
    (0..count).all(|place| (at(own, place) - at(flown, place)).abs() <= DIFFERENCED * largest)
}

fn put_in_flight(
    flight: &mut EnclosedFlight<Sloped>,
    (number, cg_mac): (AircraftNumber, f64),
    value: Sloped,
) {
    match number {
        AircraftNumber::Mass => flight.mass_kg = value,
        AircraftNumber::Inertia => flight.inertia = Moment::Inertia(value),
        AircraftNumber::Gyration => flight.inertia = Moment::Gyration(value),
        AircraftNumber::CentreOfGravity => {
            flight.aft_chords = value - Sloped::fixed(printed(cg_mac));
        }
        AircraftNumber::Airspeed => flight.airspeed_m_s = value,
        AircraftNumber::Altitude => flight.altitude_m = value,
        AircraftNumber::Derivative(row, name) => {
            let row = match row {
                Coefficient::Lift => &mut flight.longitudinal.lift,
                Coefficient::Drag => &mut flight.longitudinal.drag,
                Coefficient::Pitch => &mut flight.longitudinal.pitch,
            };
            let LongitudinalCoefficient { alpha, alpha_rate, pitch_rate, speed, elevator, .. } =
                row;
            *match name {
                Derivative::Alpha => alpha,
                Derivative::AlphaRate => alpha_rate,
                Derivative::PitchRate => pitch_rate,
                Derivative::Speed => speed,
                Derivative::Elevator => elevator,
            } = value;
        }
    }
}
