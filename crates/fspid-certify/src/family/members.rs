//! The members of a family: what the dispersions draw, the numbers of the loop that it changes, and the plants that come of
//! it.

use fspid_numeric::Scalar;
use fspid_proof::check::{ContinuousPlant, NotProved, ROUNDED, Sloped, printed};
use fspid_proof::{LoopDescription, MOST_PARAMETERS, NotProvable, Parameter, ScaledSensor};
use fspid_scenario::dispersion::{Dispersion, Distribution};
use fspid_scenario::file::{GainSource, NewValue, SettingPath, Study, Template};
use fspid_sim::LinearPlant;

use super::Chosen;
use super::loop_number::LoopNumber;
use super::source::Source;
use crate::cases::is_chosen_apart;
use fspid_study::analysis::lasting_plants;

/// Why no question can be asked of a family.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoFamily {
    /// No dispersion changes the loop.
    #[error("no [[dispersion]] changes the loop, so that there is nothing but the loop as it is")]
    NothingDiffers,
    /// A dispersion that draws what no interval holds.
    #[error("`{path}`: {why}")]
    NotBounded {
        /// Where.
        path: String,
        /// Why not, and what would do.
        why: &'static str,
    },
    /// Two dispersions of one number, of which the later one would have the say.
    #[error("`{path}` is drawn already, as `{other}`: each place once")]
    DrawnTwice {
        /// The later one's.
        path: String,
        /// The earlier one's.
        other: String,
    },
    /// Too many of them.
    #[error("{0} numbers of the loop differ; allowed are up to {MOST_PARAMETERS}")]
    TooMany(usize),
    /// The scenario with a value is none.
    #[error("`{path}` = {value}: {why}")]
    NoMember {
        /// Where.
        path: String,
        /// What was set.
        value: String,
        /// What is wrong then.
        why: String,
    },
}

/// A drawn number with the numbers of the loop that follow it.
struct Drawn {
    parameter: Parameter,
    /// Each with the number that stands there, where draws are factors of it.
    numbers: Vec<(LoopNumber, Option<f64>)>,
    /// Where they stand in the scenario.
    targets: Vec<SettingPath>,
}

/// All members of a loop.
pub(super) struct Members {
    drawn: Vec<Drawn>,
    parameters: Vec<Parameter>,
    source: Source,
}

impl Members {
    /// Those that a scenario's dispersions can draw of one of its loops.
    pub(super) fn of(
        (template, chosen): (&Template, Chosen),
        (description, plant): (&LoopDescription, &LinearPlant),
    ) -> Result<Self, NoFamily> {
        if let Some((_, [path, other])) = template.drawn_twice().into_iter().next() {
            return Err(NoFamily::DrawnTwice { path, other });
        }
        let mut drawn = Vec::new();
        let asking = Asking { template, description, plant };
        let differs = |it: &&Dispersion| chosen == Chosen::AsABox || !is_chosen_apart(it);
        for dispersion in template.study().dispersions.iter().filter(differs) {
            drawn.extend(asking.drawn(dispersion)?);
        }
        if drawn.is_empty() {
            return Err(NoFamily::NothingDiffers);
        }
        if drawn.len() > MOST_PARAMETERS {
            return Err(NoFamily::TooMany(drawn.len()));
        }
        if drawn.len() > 1 {
            asking.follow_together(&drawn)?;
        }
        let parameters = drawn.iter().map(|one| one.parameter.clone()).collect();
        let source = Source::of(template.study(), description);
        Ok(Self { drawn, parameters, source })
    }

    pub(super) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// What the numbers of a member set in the scenario.
    pub(super) fn values(&self, at: &[f64]) -> Vec<(&SettingPath, NewValue)> {
        self.drawn.iter().zip(at).flat_map(|(one, &at)| one.values(at)).collect()
    }

    /// The plant of parameters that are no sensor's, as [`fspid_proof::numbers`] has them.
    pub(super) fn plant(&self, at: &[Sloped]) -> Result<ContinuousPlant<Sloped>, NotProved> {
        let mut source = self.source.clone();
        let of_plant = self.drawn.iter().filter(|one| one.parameter.is_of_plant());
        for (drawn, &value) in of_plant.zip(at) {
            drawn.put(&mut source, value);
        }
        source.plant()
    }
}

impl Drawn {
    /// What a drawn value sets in the scenario.
    fn values(&self, drawn: f64) -> impl Iterator<Item = (&SettingPath, NewValue)> {
        self.targets.iter().zip(&self.numbers).map(move |(path, (_, nominal))| {
            (path, NewValue::Number(nominal.map_or(drawn, |nominal| nominal * drawn)))
        })
    }

    fn does_not_stand_alone(&self) -> NoFamily {
        NoFamily::NotBounded {
            path: self.parameter.paths.join(", "),
            why: "the loop does not follow it as a family does: it changes gains that are designed or scheduled from it, or the aircraft has configurations, Mach rows or tables; allowed is a number that stands alone",
        }
    }

    /// Puts what a value between two ends is of a loop.
    fn put_between(
        &self,
        source: &mut Source,
        ends: [f64; 2],
        own: &LoopDescription,
    ) -> Option<()> {
        if self.parameter.is_of_plant() {
            return self.put(source, Sloped::fixed(self.parameter.number(ends)));
        }
        for &sensor in &self.parameter.sensors {
            let nominal = match sensor {
                ScaledSensor::Pitch => own.pitch.scale,
                ScaledSensor::Rate => own.rate.scale,
            };
            source.put_scale(sensor, self.parameter.scales(ends, nominal));
        }
        Some(())
    }

    /// Puts the numbers that follow from a value into a loop's; none where the loop has no such number.
    fn put(&self, source: &mut Source, value: Sloped) -> Option<()> {
        self.numbers.iter().try_for_each(|(number, factor_of)| {
            // Numbers stand for all decimals that round to them, and a product is rounded once more.
            let factor = |nominal: f64| Sloped::fixed(printed(nominal) * ROUNDED);
            let value = match (factor_of, self.parameter.inverse) {
                (None, _) => value * Sloped::fixed(ROUNDED),
                (Some(nominal), false) => factor(*nominal) * value,
                (Some(nominal), true) => value * (Sloped::one() / factor(*nominal)),
            };
            source.put(*number, value)
        })
    }
}

struct Asking<'a> {
    template: &'a Template,
    description: &'a LoopDescription,
    plant: &'a LinearPlant,
}

impl Asking<'_> {
    /// The numbers of the loop that a dispersion draws; none where the loop does not depend on it.
    fn drawn(&self, dispersion: &Dispersion) -> Result<Vec<Drawn>, NoFamily> {
        let ends = ends(dispersion);
        let mut found = Vec::new();
        for (target, ends) in
            dispersion.targets.iter().zip(ends.into_iter().chain(std::iter::repeat(None)))
        {
            let first = target.paths.first().map_or("", SettingPath::text);
            let numbers: Option<Vec<_>> = target.paths.iter().map(LoopNumber::at).collect();
            let Some(numbers) = numbers else {
                if target.paths.iter().all(is_outside) {
                    continue;
                }
                let why = "families know coefficients of a [plant]; mass, inertia in pitch, centre of gravity, airspeed, altitude and longitudinal derivatives of an [aircraft] of derivatives to which nothing is added; time constant, natural frequency and damping of the [actuator]; scale errors of sensors; other values are certified one by one: with --set, or, where a dispersion chooses among them, with --cases choices";
                return Err(NoFamily::NotBounded { path: first.to_owned(), why });
            };
            let why = "what it draws has no ends; allowed are lower and upper of a normal distribution, or a uniform one";
            let ends = ends.ok_or(NoFamily::NotBounded { path: first.to_owned(), why })?;
            let sensors: Vec<ScaledSensor> = numbers.iter().filter_map(|it| it.sensor()).collect();
            if !sensors.is_empty() && sensors.len() < numbers.len() {
                let why = "one draw changes the scale of a sensor and a number of the plant or the actuator; allowed is a [[dispersion]] for each";
                return Err(NoFamily::NotBounded { path: first.to_owned(), why });
            }
            let parameter = Parameter {
                name: target.name.clone(),
                paths: target.paths.iter().map(|path| path.text().to_owned()).collect(),
                relative: dispersion.relative,
                inverse: numbers.iter().all(|it| *it == LoopNumber::TimeConstant),
                sensors,
                ends,
            };
            let nominal = |path: &SettingPath| {
                dispersion.relative.then(|| self.template.number_at(path)).flatten()
            };
            let numbers = numbers.into_iter().zip(&target.paths);
            let numbers: Vec<_> = numbers.map(|(number, path)| (number, nominal(path))).collect();
            let drawn = Drawn { parameter, numbers, targets: target.paths.clone() };
            self.is_not_scheduled(&drawn)?;
            for end in drawn.parameter.ends {
                self.follow(&[(&drawn, end)])?;
            }
            found.push(drawn);
        }
        Ok(found)
    }

    /// Refuses what gains are scheduled by: they may stand still at the ends of each draw, where a factor has its limits, and
    /// move between them.
    fn is_not_scheduled(&self, drawn: &Drawn) -> Result<(), NoFamily> {
        let study = self.template.study();
        let is_own = |name: &str| {
            let mut all = study.scenario.controllers.iter();
            all.any(|it| it.name == name && it.controller == self.description.controller)
        };
        let is_scheduled = study.derived_gains.iter().any(|gains| {
            matches!(gains.source, GainSource::Schedule { .. }) && is_own(&gains.controller)
        });
        match is_scheduled && drawn.numbers.iter().any(|(number, _)| number.is_of_pressure()) {
            true => Err(drawn.does_not_stand_alone()),
            false => Ok(()),
        }
    }

    /// Holds numbers that are drawn at once against the scenario itself, all at their lower and all at their upper ends.
    fn follow_together(&self, drawn: &[Drawn]) -> Result<(), NoFamily> {
        for side in [0, 1] {
            let at: Vec<_> = drawn.iter().map(|one| (one, one.parameter.ends[side])).collect();
            self.follow(&at)?;
        }
        Ok(())
    }

    /// Holds drawn numbers against the scenario itself: with them the loop is the one that follows from them, and nothing
    /// else of it has changed.
    fn follow(&self, at: &[(&Drawn, f64)]) -> Result<(), NoFamily> {
        let values: Vec<(&SettingPath, NewValue)> =
            at.iter().flat_map(|it| it.0.values(it.1)).collect();
        let flown = self.described(&values)?;
        let mut source = Source::of(self.template.study(), self.description);
        let put = at.iter().try_for_each(|(drawn, value)| {
            drawn.put_between(&mut source, [*value; 2], self.description)
        });
        let follows = put.is_some() && source.is_of(&flown, self.description);
        match at.last() {
            Some((drawn, _)) if !follows => Err(drawn.does_not_stand_alone()),
            _ => Ok(()),
        }
    }

    /// The same controller's loop with other numbers.
    fn described(&self, values: &[(&SettingPath, NewValue)]) -> Result<LoopDescription, NoFamily> {
        let no_member = |why: String| {
            let path = values.iter().map(|(path, _)| path.text()).collect::<Vec<_>>().join(", ");
            let value = values.first().map_or(String::new(), |(_, value)| value.to_string());
            NoFamily::NoMember { path, value, why }
        };
        let study: Study =
            self.template.with(values).map_err(|problems| no_member(problems.first_in_a_line()))?;
        let place = place_of(self.template.study(), self.description);
        let plants =
            lasting_plants(&study.scenario).map_err(|error| no_member(error.to_string()))?;
        let ours = lasting_plants(&self.template.study().scenario)
            .map_err(|error| no_member(error.to_string()))?;
        let which = ours.iter().position(|(_, plant)| plant == self.plant).unwrap_or(0);
        let named = place.and_then(|place| study.scenario.controllers.get(place));
        let (Some(named), Some((_, plant))) = (named, plants.get(which)) else {
            return Err(no_member("its controllers are others".to_owned()));
        };
        LoopDescription::of(&study.scenario, plant, &named.controller)
            .map_err(|refused: NotProvable| no_member(refused.to_string()))
    }
}

/// The place of a loop's controller among those of its scenario, which no number of a family changes.
pub(super) fn place_of(study: &Study, description: &LoopDescription) -> Option<usize> {
    let mut known = study.scenario.controllers.iter();
    known.position(|it| it.controller == description.controller)
}

/// True for a dispersion that no loop depends on.
pub(in super::super) fn is_outside_of_the_loop(dispersion: &Dispersion) -> bool {
    dispersion.targets.iter().flat_map(|target| &target.paths).all(is_outside)
}

/// True for a dispersion that draws something on which no loop depends, which acts on it.
pub(in super::super) fn reaches_outside_of_the_loop(dispersion: &Dispersion) -> bool {
    dispersion.targets.iter().flat_map(|target| &target.paths).any(is_outside)
}

/// True for a dispersion of which a box of the loop's numbers is made.
pub(in super::super) fn is_in_a_box(dispersion: &Dispersion) -> bool {
    let mut paths = dispersion.targets.iter().flat_map(|target| &target.paths);
    paths.all(|path| LoopNumber::at(path).is_some()) && ends(dispersion).iter().all(Option::is_some)
}

/// True for places that have no way into the loop: what it is asked to do, what disturbs it, and noise.
/// True of a dispersion of moving air and noise, which no claim speaks of.
pub(in super::super) fn is_in_no_claim(dispersion: &Dispersion) -> bool {
    dispersion.targets.iter().flat_map(|target| &target.paths).all(|path| match table(path) {
        "wind" | "gust" | "turbulence" => true,
        "disturbance" => ["seed", "standard_deviation"].iter().any(|it| path.text().contains(it)),
        // A seed brings a bias, which is a load.
        "sensor" => is_outside(path) && !path.text().contains("seed"),
        _ => false,
    })
}

/// The table of a scenario in which a path lies.
fn table(path: &SettingPath) -> &str {
    let text = path.text();
    text.split(['.', '[']).next().unwrap_or(text)
}

fn is_outside(path: &SettingPath) -> bool {
    let text = path.text();
    let is_noise = || ["noise", "drift", "seed"].iter().any(|word| text.contains(word));
    match table(path) {
        "setpoint" | "disturbance" | "wind" | "gust" | "turbulence" => true,
        "sensor" => is_noise(),
        _ => false,
    }
}

/// Between what a dispersion's numbers lie, one by one; none where there is an open end.
fn ends(dispersion: &Dispersion) -> Vec<Option<[f64; 2]>> {
    match &dispersion.distribution {
        Distribution::Normal(normal) => {
            vec![normal.lower().zip(normal.upper()).map(|(lower, upper)| [lower, upper])]
        }
        Distribution::Uniform(uniform) => vec![Some([uniform.lower(), uniform.upper()])],
        Distribution::LogUniform(uniform) => vec![Some([uniform.lower(), uniform.upper()])],
        Distribution::Correlated(correlated) => {
            let normals = correlated.entries().iter();
            normals
                .map(|normal| {
                    normal.lower().zip(normal.upper()).map(|(lower, upper)| [lower, upper])
                })
                .collect()
        }
        Distribution::Choice(_) => vec![chosen(dispersion)],
        Distribution::Seed => vec![None],
    }
}

/// The least and the most of numbers to choose from: everything between them holds them all.
fn chosen(dispersion: &Dispersion) -> Option<[f64; 2]> {
    let number = |value: &NewValue| match value {
        NewValue::Number(number) => Some(*number),
        NewValue::Integer(whole) => Some(*whole as f64),
        NewValue::Text(_) | NewValue::Boolean(_) | NewValue::Rows(_) => None,
    };
    let numbers: Option<Vec<f64>> = dispersion.choices.iter().map(number).collect();
    let numbers = numbers.filter(|numbers| !numbers.is_empty())?;
    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some([least, most])
}
