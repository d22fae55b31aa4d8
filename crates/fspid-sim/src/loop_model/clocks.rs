//! Sample ages of sensors that run at rates of their own: the periodic sequence of delays until it repeats.

use super::{LoopModel, Sensing};
use crate::scenario::Scenario;
use crate::sensor::SensorModel;
use crate::timing::{Age, SAME_SAMPLE};

/// Longest time after which ages have to come again, samples.
const MOST_PHASES: usize = 1000;
/// The same where they only nearly do.
const MOST_NEAR_PHASES: usize = 200;
/// Periods of a sensor that are so near to a number of samples, in periods, make that number: what rounding leaves.
const COMES_AGAIN: f64 = 1e-12;
/// Ages that only nearly come again move on slowly: these parts of a sample are looked at.
const PARTS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// How a loop's sensors, pitch and rate, look at each sample of a time after which they look so again.
pub(crate) type Phases = Vec<[Sensing; 2]>;

/// All ages of what sensors with clocks of their own show, in the order in which they come.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Clocks {
    /// They come again, exactly.
    Period(Phases),
    /// They nearly do; each of these is how they look for a while.
    Nearly(Vec<Phases>),
}

/// A sensor's clock, in samples of the loop.
#[derive(Clone, Copy)]
struct Clock {
    period: f64,
    delay: f64,
}

impl Clock {
    /// The age of what is shown at sample `k` of the loop, begun a part of a sample late.
    fn age(self, k: f64) -> f64 {
        let shown = ((k - self.delay) / self.period + SAME_SAMPLE).floor();
        (k - shown * self.period).max(0.0)
    }

    /// How far so many samples are from a number of periods, periods.
    fn misses(self, samples: usize) -> f64 {
        let periods = samples as f64 / self.period;
        // Less than one period is no period.
        if periods < 0.5 { 1.0 } else { (periods - periods.round()).abs() }
    }
}

/// Samples after which ages come again of sensors with these periods, samples of the loop; none where they do not.
pub(crate) fn comes_again_after(periods: &[f64]) -> Option<usize> {
    let clocks = || periods.iter().map(|&period| Clock { period, delay: 0.0 });
    (1..=MOST_PHASES).find(|samples| clocks().all(|it| it.misses(*samples) <= COMES_AGAIN))
}

impl Clocks {
    /// Those of a loop's sensors in a scenario; none where no age changes.
    pub(crate) fn of(scenario: &Scenario, model: &LoopModel<f64>) -> Option<Self> {
        let (surroundings, settings) = (&scenario.surroundings, model.settings());
        let sensors = [&surroundings.pitch_sensor, &surroundings.rate_sensor];
        let sensings = [settings.pitch, settings.rate];
        let changes = [true, model.uses_rate()];
        let clock = |sensor: &SensorModel| Clock {
            period: sensor.period_s / settings.config.dt_s,
            delay: sensor.delay_s / settings.config.dt_s,
        };
        let clocks = [0, 1].map(|place| {
            let own = changes[place] && sensings[place].at_largest_age;
            let sensor = sensors[place].as_ref().filter(|_| own);
            sensor.map(|sensor| clock(sensor.model()))
        });
        let misses = |samples: usize| {
            let each = clocks.iter().flatten().map(|clock| clock.misses(samples));
            each.reduce(f64::max)
        };
        misses(1)?;
        let misses = |samples: &usize| misses(*samples).unwrap_or(0.0);
        if let Some(samples) = (1..=MOST_PHASES).find(|it| misses(it) <= COMES_AGAIN) {
            return Some(Self::Period(phases(samples, clocks, sensings, [0.0; 2])));
        }
        let nearest = |one: &usize, other: &usize| misses(one).total_cmp(&misses(other));
        let samples = (1..=MOST_NEAR_PHASES).min_by(nearest)?;
        let late = |clock: Option<Clock>| if clock.is_some() { &PARTS[..] } else { &PARTS[..1] };
        let [pitch, rate] = clocks.map(late);
        let parts = pitch.iter().flat_map(|one| rate.iter().map(move |other| [*one, *other]));
        Some(Self::Nearly(parts.map(|it| phases(samples, clocks, sensings, it)).collect()))
    }
}

/// How sensors look at so many samples, with clocks that are so late, samples.
fn phases(
    samples: usize,
    clocks: [Option<Clock>; 2],
    sensings: [Sensing; 2],
    late: [f64; 2],
) -> Phases {
    // Long after the start.
    let past = clocks.iter().flatten().map(|it| it.delay + it.period).fold(0.0, f64::max);
    let begin = (past / samples as f64).ceil() * samples as f64;
    let look = |place: usize, k: usize| match clocks[place] {
        Some(clock) => aged(sensings[place], clock.age(begin + k as f64 + late[place])),
        None => sensings[place],
    };
    let mut phases: Phases = (0..samples).map(|k| [look(0, k), look(1, k)]).collect();
    for place in 0..2 {
        let keeps = phases.iter().map(|it| it[place].remembered()).max().unwrap_or(0);
        phases.iter_mut().for_each(|it| it[place].keeps = keeps);
    }
    phases
}

/// A sensor that is taken at its largest age as it looks at another one.
fn aged(oldest: Sensing, age: f64) -> Sensing {
    let Age { whole, part } = Age::of(age);
    Sensing { samples: whole, part, at_largest_age: false, ..oldest }
}
