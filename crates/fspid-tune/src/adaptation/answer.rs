//! What the flights tell: shares of the win, how gains move, and what they follow.

use fspid_campaign::rows::UNDECIDED;
use fspid_core::Gains;

use super::Adaptation;
use super::barred;
use super::best::Best;
use super::draws::{Draws, Estimate, Kind, Parts, Weights};
use super::flown::{First, Treated};
use super::means::{Means, Quantity, line};
use super::plants::Plants;
use super::treatment::Treatment;
use crate::source::in_commands;

/// What flew in the place of the self-tuner, beside the self-tuner as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What.
    pub treatment: Treatment,
    /// Mean ratio of the IAE to that of the flights as they are (geometric).
    pub iae: Option<Estimate>,
    /// The same of the travel of the elevator.
    pub travel: Option<Estimate>,
    /// Flights that were lost.
    pub lost: usize,
    /// Flights, shuffles counted each.
    pub flights: usize,
    /// Flights that break a requirement; none where they were not asked.
    pub broken: Option<usize>,
    /// Flights of loops that are unstable at rest; none where they were not asked, as with gains of other moments.
    pub unstable: Option<u64>,
    /// The same of loops of which nobody can tell.
    pub undecided: Option<u64>,
}

/// A part of the win.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// What comes in with it.
    pub treatment: Treatment,
    /// Ratio of the IAE with it to that without it.
    pub iae: Option<Estimate>,
    /// The same of the travel.
    pub travel: Option<Estimate>,
    /// Share of the whole win, in logarithms; none where there is no win.
    pub share: Option<Estimate>,
}

/// How one gain moves, as shares of its variance over flights and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// Its name.
    pub gain: &'static str,
    /// Nominal value, none where it differs from flight to flight.
    pub nominal: f64,
    /// Mean over all flights.
    pub mean: f64,
    /// Standard deviation over flights and time.
    pub deviation: f64,
    /// Variance of the means of plants, as a share.
    pub between_plants: Option<Estimate>,
    /// Variance of the means of flights of one plant.
    pub between_flights: Option<Estimate>,
    /// Variance within flights.
    pub within_flights: Option<Estimate>,
}

/// How a gain depends on something, in logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Followed {
    /// Correlation.
    pub correlation: Estimate,
    /// Per cent of the gain for a per cent of it.
    pub slope: Estimate,
}

/// What the mean gains of plants follow; none where a number is not positive, or nothing differs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following {
    /// Name of the gain.
    pub gain: &'static str,
    /// The effectiveness of the elevator.
    pub effectiveness: Option<Followed>,
    /// The best gain by the same.
    pub best_by_effectiveness: Option<Followed>,
    /// The airspeed.
    pub airspeed: Option<Followed>,
    /// The gain that is best for the plant; a slope of 1 is whole adaptation.
    pub best: Option<Followed>,
    /// Among flights of the same plant, the size of the command: per cent of the gain for a degree.
    pub amplitude: Option<Followed>,
}

/// A plant.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantRow {
    /// Its first case.
    pub name: String,
    /// In how many ways it is written; flights that are alike with either are of one plant.
    pub written: usize,
    /// Its flights.
    pub flights: usize,
    /// Those of which the win is made; without any it is no evidence.
    pub kept: usize,
    /// Change of pitch acceleration with the elevator, 1/s².
    pub effectiveness_1_s2: Option<f64>,
    /// True airspeed, m/s.
    pub airspeed_m_s: Option<f64>,
    /// Mean gains of its flights.
    pub mean: Gains<f64>,
    /// The gains that are best for it.
    pub best: Option<Gains<f64>>,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Name of the scenario.
    pub scenario: String,
    /// Its file, as commands name it.
    pub file: String,
    /// Changes from outside.
    pub overrides: Vec<String>,
    /// Its digest.
    pub digest: String,
    /// The self-tuner.
    pub controller: String,
    /// The controller that it is compared with.
    pub against: Option<String>,
    /// Shuffles, the first seed, candidates for each plant.
    pub effort: (u64, u64, usize),
    /// Draws of the dispersions that were asked for.
    pub runs: Option<u64>,
    /// Flights.
    pub flights: usize,
    /// Those that nobody lost of whom the win is made.
    pub kept: usize,
    /// Plants.
    pub plants: Vec<PlantRow>,
    /// Ratio of the IAE as it is to that of the one compared with.
    pub win: Option<Estimate>,
    /// The same of the travel.
    pub win_travel: Option<Estimate>,
    /// What the win is made of.
    pub steps: Vec<Step>,
    /// Everything that flew.
    pub rows: Vec<Row>,
    /// How kp, ki and kd move.
    pub moved: [Moved; 3],
    /// What they follow.
    pub following: [Following; 3],
    /// Why nothing is won, whatever the errors are, in a sentence; none where that stands in nobody's way.
    pub barred: Option<String>,
}

impl Answer {
    /// The same where this keeps it from being a win, if it does: of no win there are no shares.
    pub(super) fn barred_by(mut self, barred: Option<String>) -> Self {
        if barred.is_some() {
            self.steps.iter_mut().for_each(|step| step.share = None);
        }
        Self { barred, ..self }
    }
}

const GAINS: [&str; 3] = ["kp", "ki", "kd"];

/// Sizes of commands that are nearer to their mean are one, deg.
const STILL_DEG: f64 = 1e-9;

fn parts(gains: Gains<f64>) -> [f64; 3] {
    [gains.kp, gains.ki, gains.kd]
}

pub(super) fn answer(
    asked: &Adaptation,
    named: Vec<String>,
    (firsts, plants, parts): (&[First], &Plants, &Parts),
    treated: &[Treated],
    best: &[Option<Best>],
) -> Answer {
    let flown: Vec<(usize, &Treated)> = plants.of.iter().copied().zip(treated).collect();
    // Without another controller the chain begins at the nominal gains.
    let means = Means::of(&flown, parts);
    let seeds = usize::try_from(asked.options.seeds).unwrap_or(1);
    let told = Told { means: &means, draws: &Draws::of_win(parts, seeds), seeds };
    let facts = Facts { firsts, plants, best };
    let nominal = asked.flights.jobs().next().and_then(|(case, run)| {
        let study = asked.flights.study(&[], case, run).ok()?;
        Some(super::flown::tuner(&study)?.tuner().nominal())
    });
    let chain = &means.chain;
    Answer {
        scenario: asked.name.clone(),
        file: in_commands(&asked.source.path),
        overrides: asked.source.overrides.clone(),
        digest: asked.digest.clone(),
        controller: asked.controller.clone(),
        against: asked.against.clone(),
        effort: (asked.options.seeds, asked.options.seed, asked.options.budget),
        runs: asked.options.runs,
        flights: firsts.len(),
        kept: means.kept,
        plants: facts.rows(&named, &means),
        win: told.between(chain.first().copied(), Treatment::AsItIs, Quantity::Iae),
        win_travel: told.between(chain.first().copied(), Treatment::AsItIs, Quantity::Travel),
        steps: told.steps(chain),
        rows: rows(&told, treated, asked.against.is_some()),
        moved: facts.moved(nominal.unwrap_or(Gains::ZERO)),
        following: facts.following(),
        barred: None,
    }
}

/// Estimates from means.
struct Told<'a> {
    means: &'a Means,
    /// Of the plants in the win.
    draws: &'a Draws,
    seeds: usize,
}

impl Told<'_> {
    /// Logarithm of the ratio of one to another.
    fn logarithm(
        &self,
        from: Treatment,
        to: Treatment,
        quantity: Quantity,
        weights: &Weights,
    ) -> Option<f64> {
        let beyond = |treatment| self.means.beyond(treatment, quantity, weights);
        Some(beyond(to)? - beyond(from)?)
    }

    /// Ratio of one to another.
    fn between(
        &self,
        from: Option<Treatment>,
        to: Treatment,
        quantity: Quantity,
    ) -> Option<Estimate> {
        self.by(self.draws, (from?, to), quantity)
    }

    fn by(
        &self,
        draws: &Draws,
        (from, to): (Treatment, Treatment),
        quantity: Quantity,
    ) -> Option<Estimate> {
        let found = draws.estimate(Kind::Any, |it| self.logarithm(from, to, quantity, it))?;
        Some(found.map(libm::exp))
    }

    /// Ratio of one to the flights as they are. Some may be lost, or not be there, of plants that are in the win; what is of
    /// fewer plants has fewer for its interval.
    fn beside(&self, to: Treatment, quantity: Quantity) -> Option<Estimate> {
        let of = self.means.plants_of(to);
        let ratio = |draws: &Draws| self.by(draws, (Treatment::AsItIs, to), quantity);
        match of == self.means.plants_of(Treatment::AsItIs) {
            true => ratio(self.draws),
            false => ratio(&Draws::new(&Parts::of(&of), self.seeds)),
        }
    }

    fn steps(&self, chain: &[Treatment]) -> Vec<Step> {
        let first = chain.first().copied().unwrap_or(Treatment::Nominal);
        let whole =
            |weights: &Weights| self.logarithm(first, Treatment::AsItIs, Quantity::Iae, weights);
        let is_win = self.draws.estimate(Kind::Any, whole).is_some_and(|whole| whole.value < 0.0);
        let pairs = chain.iter().zip(chain.iter().skip(1));
        pairs
            .map(|(&from, &to)| {
                let part = |weights: &Weights| self.logarithm(from, to, Quantity::Iae, weights);
                Step {
                    treatment: to,
                    iae: self.between(Some(from), to, Quantity::Iae),
                    travel: self.between(Some(from), to, Quantity::Travel),
                    share: if is_win { self.draws.share(part, whole) } else { None },
                }
            })
            .collect()
    }
}

fn rows(told: &Told<'_>, treated: &[Treated], against: bool) -> Vec<Row> {
    let row = |treatment: Treatment| {
        let flown = || treated.iter().flat_map(|it| &it.values[treatment.place()]);
        let is_asked = flown().next().is_some_and(|it| it.broken.is_some());
        Row {
            treatment,
            iae: told.beside(treatment, Quantity::Iae),
            travel: told.beside(treatment, Quantity::Travel),
            lost: flown().filter(|it| it.lost).count(),
            flights: flown().count(),
            broken: is_asked.then(|| flown().filter(|it| it.broken != Some(false)).count()),
            unstable: barred::count(flown(), barred::UNSTABLE),
            undecided: barred::count(flown(), UNDECIDED),
        }
    };
    let asked = |treatment: &Treatment| against || *treatment != Treatment::Against;
    Treatment::ALL.into_iter().filter(asked).map(row).collect()
}

/// What is known of flights and plants.
struct Facts<'a> {
    firsts: &'a [First],
    plants: &'a Plants,
    best: &'a [Option<Best>],
}

impl Facts<'_> {
    /// Something of the first flight of a plant.
    fn of_first<T>(&self, plant: usize, of: impl Fn(&First) -> T) -> Option<T> {
        let place = self.plants.of.iter().position(|it| *it == plant)?;
        self.firsts.get(place).map(of)
    }

    fn rows(&self, named: &[String], means: &Means) -> Vec<PlantRow> {
        let row = |(plant, kept): (usize, usize)| {
            let place = self.plants.of.iter().position(|it| *it == plant).unwrap_or(0);
            PlantRow {
                name: named.get(place).cloned().unwrap_or_default(),
                written: self.plants.written[plant],
                kept,
                flights: self.plants.of.iter().filter(|it| **it == plant).count(),
                effectiveness_1_s2: self.of_first(plant, |it| it.effectiveness_1_s2).flatten(),
                airspeed_m_s: self.of_first(plant, |it| it.airspeed_m_s).flatten(),
                mean: self.plants.means.get(plant).copied().unwrap_or(Gains::ZERO),
                best: self.best_of(plant),
            }
        };
        means.flights_of(Treatment::AsItIs).enumerate().map(row).collect()
    }

    fn best_of(&self, plant: usize) -> Option<Gains<f64>> {
        self.best.get(plant)?.as_ref().map(|best| best.gains)
    }

    /// Flights that are not lost, each with its plant.
    fn kept(&self) -> impl Iterator<Item = (&First, usize)> + Clone {
        let all = self.firsts.iter().zip(self.plants.of.iter().copied());
        all.filter(|(first, _)| !first.lost)
    }

    /// Those of some plants alone: of gains there are no seeds, and nothing is flown again.
    fn draws(&self, is_in: impl Fn(usize) -> bool) -> Draws {
        let is_in: Vec<bool> = (0..self.plants.count()).map(is_in).collect();
        Draws::new(&Parts::of(&is_in), 1)
    }

    fn moved(&self, nominal: Gains<f64>) -> [Moved; 3] {
        let draws = self.draws(|plant| self.kept().any(|(_, of)| of == plant));
        let of = |gain: usize| {
            let share = |part: usize| {
                draws.estimate(Kind::Share, |weights| {
                    let parts = self.variances(gain, weights)?;
                    let whole: f64 = parts.iter().sum();
                    (whole > 0.0).then(|| parts[part] / whole)
                })
            };
            let deviation = draws.estimate(Kind::Any, |weights| {
                self.variances(gain, weights).map(|it| libm::sqrt(it.iter().sum()))
            });
            Moved {
                gain: GAINS[gain],
                nominal: parts(nominal)[gain],
                mean: parts(self.plants.all)[gain],
                deviation: deviation.map_or(0.0, |it| it.value),
                between_plants: share(0),
                between_flights: share(1),
                within_flights: share(2),
            }
        };
        [of(0), of(1), of(2)]
    }

    /// Variance of a gain between plants, between the flights of a plant, and within flights; each flight counts alike.
    fn variances(&self, gain: usize, weights: &Weights) -> Option<[f64; 3]> {
        let weight = |plant: usize| weights.plants.get(plant).copied().unwrap_or(0.0);
        let mean_of = |plant: usize| self.plants.means.get(plant).map(|it| parts(*it)[gain]);
        let (mut whole, mut sum) = (0.0, 0.0);
        for (first, plant) in self.kept() {
            whole += weight(plant);
            sum += weight(plant) * first.moments[gain][0];
        }
        let mean = sum / whole;
        let mut found = [0.0; 3];
        for (first, plant) in self.kept() {
            let of_plant = mean_of(plant)?;
            let [of_flight, within] = first.moments[gain];
            let square = |by: f64| by * by;
            let parts = [square(of_plant - mean), square(of_flight - of_plant), within];
            for (found, part) in found.iter_mut().zip(parts) {
                *found += weight(plant) * part / whole;
            }
        }
        (whole > 0.0).then_some(found)
    }

    fn following(&self) -> [Following; 3] {
        let of = |gain: usize| {
            // A plant all of whose flights are lost has none of its own.
            let is_flown = |plant: &usize| self.kept().any(|(_, of)| of == *plant);
            let mean = |plant: usize| {
                let means = self.plants.means.get(plant).filter(|_| is_flown(&plant));
                means.map(|it| parts(*it)[gain])
            };
            let best = |plant: usize| self.best_of(plant).map(|it| parts(it)[gain]);
            let effectiveness =
                |plant: usize| self.of_first(plant, |it| it.effectiveness_1_s2).flatten();
            let airspeed = |plant: usize| self.of_first(plant, |it| it.airspeed_m_s).flatten();
            Following {
                gain: GAINS[gain],
                effectiveness: self.by(effectiveness, mean),
                best_by_effectiveness: self.by(effectiveness, best),
                airspeed: self.by(airspeed, mean),
                best: self.by(best, mean),
                amplitude: self.by_amplitude(gain),
            }
        };
        [of(0), of(1), of(2)]
    }

    /// How something of a plant follows something else, both in logarithms.
    fn by(
        &self,
        x: impl Fn(usize) -> Option<f64>,
        y: impl Fn(usize) -> Option<f64>,
    ) -> Option<Followed> {
        let logarithm =
            |value: Option<f64>| value.filter(|it| *it > 0.0 && it.is_finite()).map(libm::log);
        let pairs: Vec<(f64, f64, usize)> = (0..self.plants.count())
            .filter_map(|plant| Some((logarithm(x(plant))?, logarithm(y(plant))?, plant)))
            .collect();
        let draws = self.draws(|plant| pairs.iter().any(|(_, _, of)| *of == plant));
        followed(&draws, &pairs)
    }

    /// How the mean gain of a flight follows the size of its command, beside the other flights of its plant.
    fn by_amplitude(&self, gain: usize) -> Option<Followed> {
        let logarithm = |first: &First| {
            let mean = first.moments[gain][0];
            (mean > 0.0).then(|| libm::log(mean))
        };
        let mut pairs = Vec::new();
        for plant in 0..self.plants.count() {
            let mine = || self.kept().filter(|(_, of)| *of == plant).map(|(first, _)| first);
            let logs: Option<Vec<f64>> = mine().map(logarithm).collect();
            let (logs, count) = (logs?, mine().count() as f64);
            let of_logs = logs.iter().sum::<f64>() / count;
            let amplitude = mine().map(|it| it.amplitude_deg).sum::<f64>() / count;
            pairs.extend(
                mine()
                    .zip(logs)
                    .map(|(it, log)| (it.amplitude_deg - amplitude, log - of_logs, plant)),
            );
        }
        // Commands of one size say nothing of a slope.
        let says = |plant, &(x, _, of): &(f64, f64, usize)| of == plant && x.abs() > STILL_DEG;
        let draws = self.draws(|plant| pairs.iter().any(|pair| says(plant, pair)));
        followed(&draws, &pairs)
    }
}

/// Pairs with the number of their plant; three at least make a line that could be none.
fn followed(draws: &Draws, pairs: &[(f64, f64, usize)]) -> Option<Followed> {
    if pairs.len() < 3 {
        return None;
    }
    let part = |which: usize, kind: Kind| {
        draws.estimate(kind, |weights| {
            let often = |plant: usize| weights.plants.get(plant).copied().unwrap_or(0.0);
            let pairs = pairs.iter().map(|&(x, y, plant)| (x, y, often(plant)));
            line(pairs).map(|found| found[which])
        })
    };
    let (correlation, slope) = (part(0, Kind::Correlation)?, part(1, Kind::Any)?);
    Some(Followed { correlation, slope })
}
