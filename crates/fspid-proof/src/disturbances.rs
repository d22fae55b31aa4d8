//! Input-output bounds from rest: the worst-case effect of an arbitrary disturbance on pitch and command (L2 gain and peak).
//!
//! A certificate of stability speaks of loads that stand still and of calm air. Here a disturbance w is any signal,
//! between samples too. Over a sample it adds $E u$ to the state of the plant, with $|u|^2$ no more than its energy over
//! the sample ([`crate::check::driven`]), so that with a form P of its own and $V = z^T P z$
//!
//! $$ V_{k+1} \le \alpha V_k + \beta |u_k|^2 - T y_k^2 $$
//!
//! for all gains that the claim is made for, however they move. Where the claim is about gains of a bounded rate, the form
//! moves with them, $V_k = z_k^T P(\kappa_k) z_k$, and the inequality is that of every motion that is as slow as the law
//! keeps to in every flight, whatever disturbs it ([`crate::check::grows_no_faster_while_moving`]). From rest, $V_0 = 0$:
//!
//! - with $\alpha = 1$, $\sum_k T y_k^2 \le \beta \int w^2 dt$: the gain from energy to energy ("L2 gain") is at most
//!   $\sqrt \beta$;
//! - with $\alpha < 1$ and without the last term, where $|w| \le W$ always, $V_k \le \beta T W^2 / (1 - \alpha)$, and
//!   $|y_k| = |c z_k| \le \sqrt{c P^{-1} c^T V_k}$.
//!
//! What is seen, y, is the pitch angle of the plant, or the command, at the samples, counted from where the loop rests.
//! Loops are linear in what disturbs them once the gains of a flight are given, so that disturbances together do no more
//! than the sum of what each does.

use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_sim::LinearPlant;

use crate::check::{IntervalMatrix, NotProved};
use crate::description::LoopDescription;

/// Where a disturbance has a way into the plant.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// Added to the elevator behind the actuator, rad.
    Elevator,
    /// The air moves.
    Air {
        /// How.
        part: AirPart,
        /// From there to pitch angle: coefficients over the plant's denominator with a leading 1, highest power of s
        /// first, as many as the plant's order. That they are those of an aircraft is no part of the proof.
        numerator: Vec<f64>,
    },
}

/// Motion of the air as a linear plant feels it, in the axes from which its angle of attack is measured; away from the condition of
/// its coefficients these are not along and across the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirPart {
    /// Along the body, m/s.
    Forward,
    /// Across it, up or down, m/s, through the angle of attack.
    Vertical,
    /// Turning as a body that pitches does, rad/s: a vertical gust that changes along the aircraft.
    Turning,
}

impl AirPart {
    /// All, in the order of the air's axes.
    pub const ALL: [Self; 3] = [Self::Forward, Self::Vertical, Self::Turning];
}

impl Way {
    /// Name in files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Elevator => "elevator",
            Self::Air { part: AirPart::Forward, .. } => "forward-gust",
            Self::Air { part: AirPart::Vertical, .. } => "vertical-gust",
            Self::Air { part: AirPart::Turning, .. } => "turning-gust",
        }
    }
}

/// What is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The plant's pitch angle at the samples, rad.
    Pitch,
    /// The controller's command, rad.
    Command,
    /// All that is limited, as shares of the limits: a form for the largest disturbance up to which none acts.
    Limits,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Pitch, Self::Command, Self::Limits];

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pitch => "pitch",
            Self::Command => "command",
            Self::Limits => "limits",
        }
    }
}

/// In which measure a disturbance is given, and what it does is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The root of the integral of its square; of the sum over all samples of the square times the period.
    Energy,
    /// Its largest magnitude.
    Peak,
}

impl Extent {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Energy, Self::Peak];

    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Energy => "energy",
            Self::Peak => "peak",
        }
    }
}

/// A bound with the form that carries it.
#[derive(Clone, Debug, PartialEq)]
pub struct DisturbanceBound {
    /// Where the disturbance enters.
    pub way: Way,
    /// What is bounded.
    pub quantity: Quantity,
    /// In which measure.
    pub extent: Extent,
    /// α, 1 for an energy, below 1 for a peak.
    pub decay: f64,
    /// β, above 0.
    pub gain: f64,
    /// P; of a loop whose gains move at a bounded rate $P_0$, at the centre of the claim's box.
    pub form: Matrix,
    /// What each gain adds to P per half width of the claim's box, where the claim is about a bounded rate, and only there.
    pub by_gain: Option<[Matrix; 3]>,
}

impl DisturbanceBound {
    /// Whether it asks something of every sample: of an energy, but not where its largest values count.
    pub(crate) fn is_seen(&self) -> bool {
        self.extent == Extent::Energy && self.quantity != Quantity::Limits
    }

    /// All matrices of the form.
    pub(crate) fn forms(&self) -> impl Iterator<Item = &Matrix> {
        core::iter::once(&self.form).chain(self.by_gain.iter().flatten())
    }
}

/// A bound that was proved.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbed {
    /// Where the disturbance enters.
    pub way: Way,
    /// What is bounded.
    pub quantity: Quantity,
    /// In which measure.
    pub extent: Extent,
    /// A disturbance of no larger measure that enters at the servo does no more: the servo follows at once, or with a lag of
    /// first order, which makes it neither larger nor of more energy.
    pub at_servo: bool,
    /// What a disturbance of measure 1 does at most: rad per rad, per m/s, or per rad/s; of limits the largest share of one.
    pub per_unit: f64,
    /// Up to this measure of the disturbance no limit acts, by the best of the forms for this way and measure; infinite without limits, none where limits are not covered. Of a
    /// peak it is so at the servo as well, of an energy at the elevator alone.
    pub unlimited_up_to: Option<f64>,
}

impl Way {
    /// E over the state of a loop of so many states.
    ///
    /// # Errors
    /// [`NotProved`] for a plant that cannot be enclosed over a sample, and for a way that has no effect.
    pub(crate) fn entry(
        &self,
        description: &LoopDescription,
        states: usize,
    ) -> Result<Matrix, NotProved> {
        let numerator = match self {
            Self::Elevator => None,
            Self::Air { numerator, .. } => Some(&numerator[..]),
        };
        let own = description.printed().driven(numerator)?;
        let mut entry = Matrix::zeros(states, own.columns());
        for (place, value) in own.data().iter().enumerate() {
            entry.set(place / own.columns(), place % own.columns(), *value)?;
        }
        Ok(entry)
    }

    /// True at the elevator behind an actuator that makes no disturbance larger.
    pub(crate) fn is_at_servo_too(&self, description: &LoopDescription) -> bool {
        let order = description.actuator.lag().order();
        *self == Self::Elevator && order < 2
    }

    /// Why nothing is said of a way in a loop, if so.
    pub(crate) fn not_covered(&self, description: &LoopDescription) -> Option<&'static str> {
        let at_once = *self == Self::Elevator
            && description.settings().uses_rate()
            && description.printed().moves_rate_at_once();
        at_once.then_some(
            "the elevator moves the pitch rate at once, so that the rate sensor sees what the disturbance is at the very sample, which no energy bounds",
        )
    }
}

/// The ways into one of a scenario's plants: its elevator, and the air where the plant feels it.
#[must_use]
pub fn ways_of(plant: &LinearPlant) -> Vec<Way> {
    let air = plant.gust_numerators().into_iter().flatten();
    let felt = AirPart::ALL.into_iter().zip(air).filter(|(_, numerator)| {
        // A way without effect is none.
        numerator.iter().any(|coefficient| *coefficient != 0.0)
    });
    let felt = felt.map(|(part, numerator)| Way::Air { part, numerator: numerator.clone() });
    core::iter::once(Way::Elevator).chain(felt).collect()
}

/// A row from a state to its first entry.
pub(crate) fn first_of(states: usize) -> Vec<Interval> {
    let mut row = vec![Interval::ZERO; states];
    if let Some(first) = row.first_mut() {
        *first = Interval::ONE;
    }
    row
}

/// A matrix of points.
pub(crate) fn exact(matrix: &Matrix) -> IntervalMatrix {
    IntervalMatrix::from(matrix)
}
