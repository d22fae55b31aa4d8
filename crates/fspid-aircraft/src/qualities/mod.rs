//! Flying qualities: what the linear model of an aircraft is worth to a pilot.
//!
//! Each value exists or says why not; each level names the clause it comes from and how sure its numbers are. Not for
//! pilots' opinions of a whole aircraft: the standards ask for more than models can tell.

mod absent;
mod bandwidth;
mod c_star;
mod delay;
mod divergence;
mod dropback;
mod lateral;
mod level;
mod model;
mod phugoid;
mod short_period;

pub use absent::Absent;
pub use bandwidth::{Bandwidth, BandwidthLimit, bandwidth_level};
pub use c_star::{CROSSOVER_SPEED_M_S, c_star};
pub use delay::EquivalentDelay;
pub use divergence::Divergence;
pub use dropback::Dropback;
pub use lateral::lateral_level;
pub use level::{Category, Class, Confidence, Judgement, Level, Requirement};
pub use model::{CommandPath, PitchModel};
pub use phugoid::Phugoid;
pub use short_period::{ShortPeriod, cap_level, short_period_damping};

/// All requirements that are judged here, for reports.
pub const REQUIREMENTS: [&Requirement; 11] = [
    &short_period::DAMPING,
    &short_period::FREQUENCY,
    &short_period::CAP,
    &phugoid::DAMPING,
    &phugoid::SPEED,
    &bandwidth::BANDWIDTH,
    &delay::DELAY,
    &lateral::DUTCH_ROLL,
    &lateral::ROLL,
    &lateral::SPIRAL,
    &lateral::ROLL_SPIRAL,
];

/// Longitudinal flying qualities of a model.
///
/// # Example
/// The paper's Navion behind its servo:
/// ```
/// use fspid_aircraft::AircraftError;
/// use fspid_aircraft::qualities::{Category, CommandPath, Level, PitchModel, Qualities};
/// use fspid_lti::TransferFunction;
///
/// # fn main() -> Result<(), AircraftError> {
/// let plant = TransferFunction::new(&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.0])?;
/// let servo = Some(TransferFunction::new(&[10.0], &[1.0, 10.0])?);
/// let model = PitchModel::new(plant, 53.6448, 9.81456)?.behind(CommandPath { servo, delay_s: 0.05 });
/// let qualities = Qualities::of(&model, Category::B);
/// let short_period = qualities.short_period.expect("a stable pair");
/// assert_eq!(short_period.cap_level.level, Level::One);
/// assert!((qualities.bandwidth.expect("a crossing").bandwidth_rad_s - 3.071).abs() < 5e-4);
/// assert!(qualities.phugoid.is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Qualities {
    /// For what they were judged.
    pub category: Category,
    /// Short period, load factor and control anticipation.
    pub short_period: Result<ShortPeriod, Absent>,
    /// Damping of the short period; known also where its load is not, and where it swings and grows.
    pub short_period_damping: Result<Judgement, Absent>,
    /// Phugoid.
    pub phugoid: Result<Phugoid, Absent>,
    /// What runs away without a swing, if anything does.
    pub divergence: Option<Divergence>,
    /// Bandwidth and phase delay, with servo and dead time.
    pub bandwidth: Result<Bandwidth, Absent>,
    /// Delay of servo and dead time.
    pub equivalent_delay: Result<EquivalentDelay, Absent>,
    /// Dropback and overshoot of the pitch rate.
    pub dropback: Result<Dropback, Absent>,
}

impl Qualities {
    /// All longitudinal qualities of a model, judged for a category.
    #[must_use]
    pub fn of(model: &PitchModel, category: Category) -> Self {
        Self {
            category,
            short_period: ShortPeriod::of(model, category),
            short_period_damping: short_period_damping(model, category),
            phugoid: Phugoid::of(model),
            divergence: Divergence::of(model),
            bandwidth: Bandwidth::of(model, category),
            equivalent_delay: EquivalentDelay::of(model),
            dropback: Dropback::of(model),
        }
    }

    /// Every level that could be given.
    pub fn judgements(&self) -> impl Iterator<Item = Judgement> {
        let short_period = self.short_period.ok().into_iter();
        let short_period = short_period.flat_map(|found| [found.frequency_level, found.cap_level]);
        let damping = self.short_period_damping.ok();
        let divergence = self.divergence.map(|found| found.level);
        // One requirement is told once, by the worst that it is about.
        let is_told =
            |level: &Judgement| divergence.is_some_and(|it| it.requirement == level.requirement);
        let phugoid = self.phugoid.ok().map(|found| found.level()).filter(|level| !is_told(level));
        let bandwidth = self.bandwidth.ok().and_then(|found| found.level.ok());
        let delay = self.equivalent_delay.ok().map(|found| found.level);
        damping
            .into_iter()
            .chain(short_period)
            .chain(phugoid)
            .chain(divergence)
            .chain(bandwidth)
            .chain(delay)
    }

    /// The worst level that was given, if any was.
    #[must_use]
    pub fn worst(&self) -> Option<Judgement> {
        self.judgements().max_by_key(|judgement| judgement.level)
    }
}
