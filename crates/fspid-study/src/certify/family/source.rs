//! The numbers of a loop's plant and actuator, with slopes, and the plant that they make.

use fspid_numeric::scalar::Interval;
use fspid_proof::LoopDescription;
use fspid_proof::check::{ActuatorLag, ContinuousPlant, LagOf, NotProved, Sloped, printed};
use fspid_sim::ElevatorSign;
use fspid_sim::actuator::Lag;

use super::loop_number::LoopNumber;

/// Numbers of plant and actuator.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    numerator: Vec<Sloped>,
    denominator: Vec<Sloped>,
    elevator_sign: ElevatorSign,
    lag: LagOf<Sloped>,
}

impl Source {
    /// Those of a loop as it is, each with the decimals that round to it.
    pub(super) fn of(description: &LoopDescription) -> Self {
        let fixed = |value: f64| Sloped::fixed(printed(value));
        let all = |values: &[f64]| values.iter().map(|&it| fixed(it)).collect();
        let lag = match ActuatorLag::from(description.actuator.lag()) {
            ActuatorLag::None => LagOf::None,
            ActuatorLag::First { time_constant_s } => {
                LagOf::First(Sloped::fixed(Interval::ONE / printed(time_constant_s)))
            }
            ActuatorLag::Second { natural_frequency_rad_s, damping } => {
                LagOf::Second(fixed(natural_frequency_rad_s), fixed(damping))
            }
        };
        Self {
            numerator: all(&description.numerator),
            denominator: all(&description.denominator),
            elevator_sign: description.elevator_sign,
            lag,
        }
    }

    /// Puts a number; one that the loop does not have stays without. A time constant comes as one over it.
    pub(super) fn put(&mut self, number: LoopNumber, value: Sloped) {
        let place = match (number, &mut self.lag) {
            (LoopNumber::Numerator(index), _) => self.numerator.get_mut(index),
            (LoopNumber::Denominator(index), _) => self.denominator.get_mut(index),
            (LoopNumber::TimeConstant, LagOf::First(bandwidth)) => Some(bandwidth),
            (LoopNumber::NaturalFrequency, LagOf::Second(frequency, _)) => Some(frequency),
            (LoopNumber::Damping, LagOf::Second(_, damping)) => Some(damping),
            _ => None,
        };
        if let Some(place) = place {
            *place = value;
        }
    }

    /// The plant of all these numbers: in the form in which most of them enter linearly, if the elevator has an effect
    /// everywhere.
    pub(super) fn plant(&self) -> Result<ContinuousPlant<Sloped>, NotProved> {
        let may_vanish = |it: &Sloped| it.value.contains(0.0);
        if self.denominator.first().is_none_or(may_vanish) {
            return Err(NotProved::Number {
                what: "leading coefficient of the denominator",
                found: 0.0,
                allowed: "ends on one side of 0",
            });
        }
        let (sign, lag) = (self.elevator_sign, self.lag);
        // Coefficients before the first that is there are no part of the numerator.
        let there = self.numerator.iter().position(|it| it.value != Interval::ZERO).unwrap_or(0);
        let numerator = &self.numerator[there..];
        let normal =
            ContinuousPlant::in_normal_form(numerator, &self.denominator, (sign, lag), may_vanish);
        Ok(normal.unwrap_or_else(|| {
            ContinuousPlant::of_transfer_function(numerator, &self.denominator, sign, lag)
        }))
    }
}

/// A loop with another number in it; the loop as it is where it has no such number.
pub(super) fn with_number(
    description: &LoopDescription,
    number: LoopNumber,
    value: f64,
) -> Option<LoopDescription> {
    let mut other = description.clone();
    match number {
        LoopNumber::Numerator(index) => *other.numerator.get_mut(index)? = value,
        LoopNumber::Denominator(index) => *other.denominator.get_mut(index)? = value,
        LoopNumber::TimeConstant => {
            other.actuator.lag().time_constant_s()?;
            other.actuator = other.actuator.with_lag(Lag::first_order(value).ok()?);
        }
        LoopNumber::NaturalFrequency | LoopNumber::Damping => {
            let (frequency, damping) = other.actuator.lag().second_order_parameters()?;
            let lag = match number {
                LoopNumber::Damping => Lag::second_order(frequency, value),
                _ => Lag::second_order(value, damping),
            };
            other.actuator = other.actuator.with_lag(lag.ok()?);
        }
    }
    Some(other)
}
