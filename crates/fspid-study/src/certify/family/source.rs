//! The numbers of a loop's plant and actuator, each between bounds, and the plant that they make.

use fspid_numeric::scalar::Interval;
use fspid_proof::LoopDescription;
use fspid_proof::check::{ActuatorLag, EnclosedLag, EnclosedPlant, NotProved, printed};
use fspid_sim::ElevatorSign;

use super::loop_number::LoopNumber;

/// Numbers of plant and actuator.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    numerator: Vec<Interval>,
    denominator: Vec<Interval>,
    elevator_sign: ElevatorSign,
    lag: EnclosedLag,
}

impl Source {
    /// Those of a loop as it is.
    pub(super) fn of(description: &LoopDescription) -> Self {
        let points = |values: &[f64]| values.iter().map(|&it| Interval::point(it)).collect();
        Self {
            numerator: points(&description.numerator),
            denominator: points(&description.denominator),
            elevator_sign: description.elevator_sign,
            lag: lag_of(description),
        }
    }

    /// Puts a number between bounds; a place that the loop does not have stays without.
    pub(super) fn put(&mut self, number: LoopNumber, value: Interval) {
        let place = match (number, &mut self.lag) {
            (LoopNumber::Numerator(index), _) => self.numerator.get_mut(index),
            (LoopNumber::Denominator(index), _) => self.denominator.get_mut(index),
            (LoopNumber::TimeConstant, EnclosedLag::First(time_s)) => Some(time_s),
            (LoopNumber::NaturalFrequency, EnclosedLag::Second(frequency, _)) => Some(frequency),
            (LoopNumber::Damping, EnclosedLag::Second(_, damping)) => Some(damping),
            _ => None,
        };
        if let Some(place) = place {
            *place = value;
        }
    }

    /// True if these are the numbers of `flown`, and if all else of that loop is as in `own`.
    pub(super) fn is_of(&self, flown: &LoopDescription, own: &LoopDescription) -> bool {
        let with_plant_and_lag_of_own = LoopDescription {
            numerator: own.numerator.clone(),
            denominator: own.denominator.clone(),
            actuator: flown.actuator.with_lag(own.actuator.lag()),
            ..flown.clone()
        };
        *self == Self::of(flown) && with_plant_and_lag_of_own == *own
    }

    /// The plant of all these numbers, each with the decimals that round to it.
    pub(super) fn plant(&self) -> Result<EnclosedPlant, NotProved> {
        let all = |values: &[Interval]| values.iter().copied().map(rounded).collect::<Vec<_>>();
        let lag = match self.lag {
            EnclosedLag::None => EnclosedLag::None,
            EnclosedLag::First(time_s) => EnclosedLag::First(rounded(time_s)),
            EnclosedLag::Second(frequency, damping) => {
                EnclosedLag::Second(rounded(frequency), rounded(damping))
            }
        };
        let denominator = all(&self.denominator);
        if denominator.first().is_none_or(|leading| leading.contains(0.0)) {
            return Err(NotProved::Number {
                what: "leading coefficient of the denominator",
                found: 0.0,
                allowed: "ends on one side of 0",
            });
        }
        let numerator = all(&self.numerator);
        Ok(EnclosedPlant::of_transfer_function(&numerator, &denominator, self.elevator_sign, lag))
    }
}

fn rounded(value: Interval) -> Interval {
    printed(value.lower()).hull(printed(value.upper()))
}

fn lag_of(description: &LoopDescription) -> EnclosedLag {
    match ActuatorLag::from(description.actuator.lag()) {
        ActuatorLag::None => EnclosedLag::None,
        ActuatorLag::First { time_constant_s } => {
            EnclosedLag::First(Interval::point(time_constant_s))
        }
        ActuatorLag::Second { natural_frequency_rad_s, damping } => {
            EnclosedLag::Second(Interval::point(natural_frequency_rad_s), Interval::point(damping))
        }
    }
}
