//! What flies: a linear model from elevator to pitch angle, a nonlinear aircraft, or one of another simulator.

use fspid_lti::{StateSpace, TransferFunction};

use crate::aircraft::AircraftPlant;
use crate::error::{SimError, not_negative};
use crate::external_plant::ExternalPlant;
use crate::gust_entry::GustEntry;

/// Which way the elevator of a plant's file is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElevatorSign {
    /// Positive is trailing edge down, which turns the nose down (the usual convention).
    NoseDownPositive,
    /// Positive turns the nose up.
    NoseUpPositive,
}

impl ElevatorSign {
    /// Elevator deflection per unit of a nose-up command: -1 or 1.
    #[must_use]
    pub fn per_nose_up(self) -> f64 {
        match self {
            Self::NoseDownPositive => -1.0,
            Self::NoseUpPositive => 1.0,
        }
    }
}

/// The plant.
#[derive(Clone, Debug, PartialEq)]
pub enum Plant {
    /// A transfer function.
    Linear(LinearPlant),
    /// A nonlinear aircraft in six degrees of freedom.
    Aircraft(Box<AircraftPlant>),
    /// An aircraft that another simulator flies.
    External(Box<ExternalPlant>),
}

impl Plant {
    /// The linear plant, if it is one.
    #[must_use]
    pub fn linear(&self) -> Option<&LinearPlant> {
        match self {
            Self::Linear(plant) => Some(plant),
            Self::Aircraft(_) | Self::External(_) => None,
        }
    }

    /// The aircraft, if it is one.
    #[must_use]
    pub fn aircraft(&self) -> Option<&AircraftPlant> {
        match self {
            Self::Linear(_) | Self::External(_) => None,
            Self::Aircraft(plant) => Some(plant),
        }
    }

    /// The aircraft of another simulator, if it is one.
    #[must_use]
    pub fn external(&self) -> Option<&ExternalPlant> {
        match self {
            Self::Linear(_) | Self::Aircraft(_) => None,
            Self::External(plant) => Some(plant),
        }
    }

    /// `Ok` for a plant that has equations here.
    ///
    /// # Errors
    /// [`SimError::OtherSimulator`] for one that has none.
    pub fn require_equations(&self) -> Result<(), SimError> {
        match self.external() {
            None => Ok(()),
            Some(plant) => Err(SimError::OtherSimulator { name: plant.simulator.name() }),
        }
    }
}

impl From<LinearPlant> for Plant {
    fn from(plant: LinearPlant) -> Self {
        Self::Linear(plant)
    }
}

impl From<ExternalPlant> for Plant {
    fn from(plant: ExternalPlant) -> Self {
        Self::External(Box::new(plant))
    }
}

impl From<AircraftPlant> for Plant {
    fn from(plant: AircraftPlant) -> Self {
        Self::Aircraft(Box::new(plant))
    }
}

/// Transfer function from elevator, rad, to pitch angle, rad, with the sign of its elevator.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearPlant {
    transfer_function: TransferFunction,
    elevator_sign: ElevatorSign,
    gusts: Option<GustEntry>,
    is_between_slopes: bool,
    away: Away,
}

/// How far the trim of an aircraft is from the one that its controllers count from, that of the start of the flight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Away {
    /// The command that holds it, rad, nose up positive.
    pub(crate) command_rad: f64,
    /// Its pitch, rad.
    pub(crate) pitch_rad: f64,
    /// Its throttle, in the measure of the model.
    pub(crate) throttle: f64,
}

impl LinearPlant {
    /// A plant from numerator and denominator, highest power of s first.
    ///
    /// # Errors
    /// [`SimError::Linear`] for coefficients that make no proper transfer function,
    /// [`SimError::NotStrictlyProper`] for one that would let the pitch angle jump.
    pub fn new(
        numerator: &[f64],
        denominator: &[f64],
        elevator_sign: ElevatorSign,
    ) -> Result<Self, SimError> {
        let transfer_function = TransferFunction::new(numerator, denominator)?;
        if transfer_function.relative_degree() == 0 {
            return Err(SimError::NotStrictlyProper);
        }
        let (gusts, is_between_slopes, away) = (None, false, Away::default());
        Ok(Self { transfer_function, elevator_sign, gusts, is_between_slopes, away })
    }

    /// The plant with transfer functions from the air's motion to pitch angle: numerators for
    /// $u_g$, $w_g$ (rad per m/s) and $q_g$ (rad per rad/s) over the same denominator, highest power
    /// of s first, none for no effect. Senses are those of [`air`](crate::air).
    ///
    /// # Errors
    /// [`SimError::GustMovesRate`] for a numerator not shorter than the denominator by two,
    /// [`SimError::Number`] for a coefficient that is not finite.
    pub fn with_gusts(self, numerators: [&[f64]; 3]) -> Result<Self, SimError> {
        let denominator = self.transfer_function.denominator().coefficients();
        let gusts = GustEntry::new(denominator, numerators)?;
        Ok(Self { gusts: Some(gusts), ..self })
    }

    /// The plant as one that is linearised right on a kink of an aircraft's data, or not.
    #[must_use]
    pub(crate) fn between_slopes(self, is_between_slopes: bool) -> Self {
        Self { is_between_slopes, ..self }
    }

    /// The plant of a trim that is so far from the one that is counted from.
    #[must_use]
    pub(crate) fn being_away(self, away: Away) -> Self {
        Self { away, ..self }
    }

    /// Command, rad from the trim of the start and nose up positive, that holds the pitch of the start about the plant's own trim:
    /// 0 but for an aircraft that has become another or is led elsewhere.
    ///
    /// $$ u = u_{trim} - \frac{\theta_{trim}}{G(0)} $$
    #[must_use]
    pub fn held_away_rad(&self) -> f64 {
        let Away { command_rad, pitch_rad, .. } = self.away;
        if pitch_rad == 0.0 { command_rad } else { command_rad - pitch_rad / self.steady_gain() }
    }

    /// The plant whose elevator turns it so many times as much: what a gain in the loop makes of it.
    ///
    /// # Errors
    /// [`SimError::Linear`] where its coefficients leave the range of numbers.
    pub fn with_gain(&self, factor: f64) -> Result<Self, SimError> {
        let (numerator, denominator) =
            (self.transfer_function.numerator(), self.transfer_function.denominator());
        let numerator: Vec<f64> = numerator.coefficients().iter().map(|it| factor * it).collect();
        let transfer_function = TransferFunction::new(&numerator, denominator.coefficients())?;
        Ok(Self { transfer_function, ..self.clone() })
    }

    /// True where its slopes are means over a kink of an aircraft's data, so that no small motion is its.
    #[must_use]
    pub fn is_between_slopes(&self) -> bool {
        self.is_between_slopes
    }

    /// True if the plant says how gusts act on it.
    #[must_use]
    pub fn feels_gusts(&self) -> bool {
        self.gusts.is_some()
    }

    /// Numerators from $u_g$, $w_g$ (rad per m/s) and $q_g$ (rad per rad/s) to pitch angle, for a plant that says how
    /// gusts act on it: as many coefficients as the plant's order, highest power of s first, over the denominator with a
    /// leading 1.
    #[must_use]
    pub fn gust_numerators(&self) -> Option<&[Vec<f64>; 3]> {
        self.gusts.as_ref().map(GustEntry::numerators)
    }

    /// Input columns of $u_g, w_g, q_g$ over the states of [`state_space`](Self::state_space).
    pub(crate) fn gust_columns(&self) -> Option<[Vec<f64>; 3]> {
        self.gusts.as_ref().map(GustEntry::columns)
    }

    /// From elevator to pitch angle, in the plant's own elevator sign.
    #[must_use]
    pub fn transfer_function(&self) -> &TransferFunction {
        &self.transfer_function
    }

    /// Which way the elevator is counted.
    #[must_use]
    pub fn elevator_sign(&self) -> ElevatorSign {
        self.elevator_sign
    }

    /// Order of the model.
    #[must_use]
    pub fn order(&self) -> usize {
        self.transfer_function.denominator().degree()
    }

    /// States whose first is the pitch angle and, for a plant whose elevator does not move the
    /// pitch rate at once, whose second is the pitch rate.
    pub(crate) fn state_space(&self) -> StateSpace {
        self.transfer_function.to_state_space()
    }

    /// Coefficients with a leading denominator coefficient of 1, the numerator filled up to the
    /// denominator's length.
    fn normalised(&self) -> (Vec<f64>, Vec<f64>) {
        let denominator = self.transfer_function.denominator().coefficients();
        let numerator = self.transfer_function.numerator().coefficients();
        let lead = denominator.first().copied().unwrap_or(1.0);
        let mut padded = vec![0.0; denominator.len() - numerator.len()];
        padded.extend(numerator.iter().map(|c| c / lead));
        (padded, denominator.iter().map(|c| c / lead).collect())
    }
}

/// Up to so far apart two coefficients pass zero at one place of a ramp: what rounding leaves of numbers in a file.
const SAME_FRACTION: f64 = 1e-9;

/// A change of the plant's coefficients in flight.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantChange {
    at_s: f64,
    ramp_s: f64,
    target: LinearPlant,
}

impl PlantChange {
    /// From `at_s` on the coefficients move in a straight line to those of `target`, which they
    /// reach `ramp_s` later (at once for 0).
    ///
    /// # Errors
    /// [`SimError::Number`] for a time that is negative or not finite.
    pub fn new(at_s: f64, ramp_s: f64, target: LinearPlant) -> Result<Self, SimError> {
        let at_s = not_negative("at_s", at_s)?;
        let ramp_s = not_negative("ramp_s", ramp_s)?;
        Ok(Self { at_s, ramp_s, target })
    }

    /// Start of the change, s.
    #[must_use]
    pub fn at_s(&self) -> f64 {
        self.at_s
    }

    /// Length of the change, s.
    #[must_use]
    pub fn ramp_s(&self) -> f64 {
        self.ramp_s
    }

    /// The plant afterwards.
    #[must_use]
    pub fn target(&self) -> &LinearPlant {
        &self.target
    }

    /// The fraction of the way from `before` at which nothing is left of the elevator's effect; none where some always is.
    pub(crate) fn without_effect(&self, before: &LinearPlant) -> Option<f64> {
        let sign = before.elevator_sign.per_nose_up() * self.target.elevator_sign.per_nose_up();
        let (from, _) = before.normalised();
        let (to, _) = self.target.normalised();
        let pairs = from.iter().zip(&to).map(|(from, to)| (sign * from, *to));
        let mut moved = pairs.filter(|(from, to)| *from != 0.0 || *to != 0.0);
        let fraction = |(from, to): (f64, f64)| (from * to < 0.0).then(|| from / (from - to));
        let first = fraction(moved.next()?)?;
        let all_there = moved
            .all(|pair| fraction(pair).is_some_and(|other| (other - first).abs() < SAME_FRACTION));
        all_there.then_some(first)
    }

    /// The plant a `fraction` of the way from `before`, in the sign of the target's elevator.
    ///
    /// # Errors
    /// [`SimError::OrderChanges`] where the orders differ.
    pub(crate) fn between(
        &self,
        before: &LinearPlant,
        fraction: f64,
    ) -> Result<LinearPlant, SimError> {
        let (before_order, after_order) = (before.order(), self.target.order());
        if before_order != after_order {
            return Err(SimError::OrderChanges { before: before_order, after: after_order });
        }
        if fraction >= 1.0 {
            return Ok(self.target.clone());
        }
        let sign = before.elevator_sign.per_nose_up() * self.target.elevator_sign.per_nose_up();
        let (from_numerator, from_denominator) = before.normalised();
        let (to_numerator, to_denominator) = self.target.normalised();
        let blend = |from: &[f64], to: &[f64], sign: f64| -> Vec<f64> {
            from.iter().zip(to).map(|(a, b)| sign * a + fraction * (b - sign * a)).collect()
        };
        let numerator: Vec<f64> = blend(&from_numerator, &to_numerator, sign)
            .into_iter()
            .skip_while(|&coefficient| coefficient == 0.0)
            .collect();
        let denominator = blend(&from_denominator, &to_denominator, 1.0);
        let gusts = GustEntry::between(before.gusts.as_ref(), self.target.gusts.as_ref(), fraction);
        let plant = LinearPlant::new(&numerator, &denominator, self.target.elevator_sign)?;
        Ok(LinearPlant { gusts, ..plant })
    }
}
