//! Dispersions as files have them, and whether a scenario can bear them.

use crate::dispersion::{
    Choice, Correlated, Dispersion, DispersionError, Distribution, LogUniform, Normal, Target,
    Uniform,
};
use crate::file::Template;
use crate::file::paths::{meant, row_at};
use crate::file::spec::dispersion as keys;
use crate::file::spec::dispersion::{
    DistributionWord, OWN_KEYS, keys_of, matrix_in_words, paths_in_words, values_in_words,
};
use crate::keyed::Section;
use crate::keyed::document::{Item, Value};
use crate::setting_path::{NewValue, SettingPath};
use fspid_diagnostics::{Problems, Report, Span};
use fspid_sim::Scenario;

/// Most values that a choice is made from.
const MOST_VALUES: usize = 1000;

/// The dispersions of a scenario.
pub(crate) fn dispersions(report: &mut Report, sections: &[Section]) -> Vec<Dispersion> {
    let mut dispersions: Vec<Dispersion> = Vec::new();
    for section in sections.iter().filter(|section| section.sound) {
        if let Some(found) = dispersion(report, section) {
            check_names(report, section, (&dispersions, &found));
            dispersions.push(found);
        }
    }
    dispersions
}

fn dispersion(report: &mut Report, section: &Section) -> Option<Dispersion> {
    let word: DistributionWord = section.get(keys::DISTRIBUTION)?;
    let before = report.count();
    check_keys(report, section, word);
    let paths = paths(report, section);
    let is_correlated = word == DistributionWord::Correlated;
    let is_choice = word == DistributionWord::Choice;
    let choices = if is_choice { values(report, section) } else { Some(Vec::new()) };
    let correlation = if is_correlated { matrix(report, section) } else { Some(Vec::new()) };
    let (paths, choices, correlation) = (paths?, choices?, correlation?);
    if is_correlated {
        check_lengths(report, section, paths.len());
    }
    if report.count() > before {
        return None;
    }
    let numbers = Numbers { section, choices: choices.len(), correlation };
    let distribution = match numbers.distribution(word)? {
        Ok(distribution) => distribution,
        Err(error) => {
            let key = match word {
                DistributionWord::Correlated => keys::CORRELATION.name,
                DistributionWord::Choice => keys::WEIGHTS.name,
                DistributionWord::Normal if !section.given(keys::LOWER) => keys::MEAN.name,
                DistributionWord::Normal
                | DistributionWord::Uniform
                | DistributionWord::LogUniform => keys::LOWER.name,
                DistributionWord::Seed => keys::DISTRIBUTION.name,
            };
            let text = error.to_string();
            let (message, allowed) = in_two(&text);
            section.problem(report, key, message, allowed);
            return None;
        }
    };
    let relative = section.get(keys::RELATIVE)?;
    if relative && (word == DistributionWord::Seed || choices.iter().any(|it| !is_number(it))) {
        section.wrong(report, keys::RELATIVE, "only numbers can be factors", "false");
        return None;
    }
    let targets = targets(report, section, paths, is_correlated)?;
    Some(Dispersion { targets, distribution, relative, choices })
}

/// An error's sentence in two: what is wrong, and what must be.
fn in_two(text: &str) -> (&str, &str) {
    text.rsplit_once("; ").unwrap_or((text, ""))
}

fn is_number(value: &NewValue) -> bool {
    matches!(value, NewValue::Number(_) | NewValue::Integer(_))
}

/// Refuses keys of other distributions, and misses those of this one.
fn check_keys(report: &mut Report, section: &Section, distribution: DistributionWord) {
    let [needed, allowed] = keys_of(distribution);
    let word = distribution.name();
    for key in needed.iter().copied().filter(|key| !section.given(*key)) {
        let message = format!("missing key; distribution \"{word}\" needs it");
        section.problem(report, key, message, "");
    }
    for key in OWN_KEYS.into_iter().filter(|key| section.given(*key)) {
        if !needed.contains(&key) && !allowed.contains(&key) {
            let message = format!("says nothing to distribution \"{word}\"");
            let may = needed.iter().chain(allowed).map(|key| key.as_str()).collect::<Vec<_>>();
            section.wrong(report, key, message, may.join(", "));
        }
    }
}

/// Refuses lists that have not one number for each path.
fn check_lengths(report: &mut Report, section: &Section, paths: usize) {
    for key in [keys::MEANS, keys::STANDARD_DEVIATIONS, keys::LOWERS, keys::UPPERS] {
        let found = section.numbers(key).map_or(paths, |numbers| numbers.len());
        if found != paths {
            let message = format!("{found} numbers for {paths} paths");
            section.wrong(report, key, message, "one for each path");
        }
    }
}

/// The places, each with its steps.
fn paths(report: &mut Report, section: &Section) -> Option<Vec<SettingPath>> {
    if section.given(keys::PATH) == section.given(keys::PATHS) {
        let message = "exactly one of `path` and `paths` must be there";
        report.missing(section.place, &section.path(keys::PATH), message, "path or paths");
        return None;
    }
    let key = if section.given(keys::PATH) { keys::PATH.name } else { keys::PATHS.name };
    let texts = match section.get(keys::PATH) {
        Some(text) => Some(vec![(section.at(key), text.to_owned())]),
        None => section.get(keys::PATHS).and_then(placed_texts),
    };
    let Some(texts) = texts.filter(|texts| !texts.is_empty()) else {
        section.wrong(report, key, "wrong type", paths_in_words());
        return None;
    };
    let mut paths = Vec::new();
    for (place, text) in texts {
        let Some((path, renamed)) = SettingPath::renamed(&text) else {
            let allowed = "names joined by dots, such as controller[0].kp";
            let message = format!("the path `{text}` cannot be read");
            section.problem(report, key, message, allowed);
            return None;
        };
        if super::paths::NEVER_DRAWN.contains(&path.root()) {
            let message = format!("`{text}` cannot differ from run to run");
            let allowed = "a place of what flies or of what disturbs it";
            section.problem(report, key, message, allowed);
            return None;
        }
        if let Some(key) = renamed {
            key.warn(report, place, text.trim());
        }
        paths.push(path);
    }
    Some(paths)
}

/// A list of texts, if it is one.
pub(super) fn texts(item: &Item) -> Option<Vec<String>> {
    Some(placed_texts(item)?.into_iter().map(|(_, text)| text).collect())
}

/// A list of texts with their places, if it is one.
pub(super) fn placed_texts(item: &Item) -> Option<Vec<(Span, String)>> {
    let Value::Array(items) = &item.value else {
        return None;
    };
    let text = |item: &Item| match &item.value {
        Value::Text(text) => Some((item.place, text.clone())),
        _ => None,
    };
    items.iter().map(text).collect()
}

/// What a choice chooses from.
fn values(report: &mut Report, section: &Section) -> Option<Vec<NewValue>> {
    let item = section.get(keys::VALUES)?;
    let value = |item: &Item| match &item.value {
        Value::Integer(_, Some(whole)) => Some(NewValue::Integer(*whole)),
        Value::Float(number) if number.is_finite() => Some(NewValue::Number(*number)),
        Value::Text(text) => Some(NewValue::Text(text.clone())),
        Value::Boolean(boolean) => Some(NewValue::Boolean(*boolean)),
        _ => None,
    };
    let values: Option<Vec<NewValue>> = match &item.value {
        Value::Array(items) if (1..=MOST_VALUES).contains(&items.len()) => {
            items.iter().map(value).collect()
        }
        _ => None,
    };
    if values.is_none() {
        report.value(item.place, &section.path(keys::VALUES), "wrong values", values_in_words());
    }
    values
}

/// A matrix by its rows.
fn matrix(report: &mut Report, section: &Section) -> Option<Vec<Vec<f64>>> {
    let item = section.get(keys::CORRELATION)?;
    let number = |item: &Item| match &item.value {
        Value::Float(number) | Value::Integer(number, _) if number.is_finite() => Some(*number),
        _ => None,
    };
    let row = |item: &Item| match &item.value {
        Value::Array(items) => items.iter().map(number).collect::<Option<Vec<f64>>>(),
        _ => None,
    };
    let rows = match &item.value {
        Value::Array(items) => items.iter().map(row).collect::<Option<Vec<_>>>(),
        _ => None,
    };
    if rows.is_none() {
        report.value(item.place, &section.path(keys::CORRELATION), "no matrix", matrix_in_words());
    }
    rows
}

/// The numbers of a section, for its distribution.
struct Numbers<'a> {
    section: &'a Section,
    choices: usize,
    correlation: Vec<Vec<f64>>,
}

impl Numbers<'_> {
    fn distribution(
        &self,
        word: DistributionWord,
    ) -> Option<Result<Distribution, DispersionError>> {
        let section = self.section;
        let number = |key| section.get(key);
        Some(match word {
            DistributionWord::Normal => {
                let (mean, deviation) = (number(keys::MEAN)?, number(keys::STANDARD_DEVIATION)?);
                normal(mean, deviation, [number(keys::LOWER), number(keys::UPPER)])
                    .map(Distribution::Normal)
            }
            DistributionWord::Uniform => {
                Uniform::new(number(keys::LOWER)?, number(keys::UPPER)?).map(Distribution::Uniform)
            }
            DistributionWord::LogUniform => {
                LogUniform::new(number(keys::LOWER)?, number(keys::UPPER)?)
                    .map(Distribution::LogUniform)
            }
            DistributionWord::Choice => {
                let weights = section.numbers(keys::WEIGHTS);
                Choice::new(self.choices, weights.as_deref()).map(Distribution::Choice)
            }
            DistributionWord::Seed => Ok(Distribution::Seed),
            DistributionWord::Correlated => self.correlated()?,
        })
    }

    fn correlated(&self) -> Option<Result<Distribution, DispersionError>> {
        let numbers = |key| self.section.numbers(key);
        let (means, deviations) = (numbers(keys::MEANS)?, numbers(keys::STANDARD_DEVIATIONS)?);
        let [lowers, uppers] =
            [keys::LOWERS, keys::UPPERS].map(|key| numbers(key).unwrap_or_default());
        let entry = |(index, (mean, deviation)): (usize, (f64, f64))| {
            normal(mean, deviation, [lowers.get(index).copied(), uppers.get(index).copied()])
        };
        let entries = means.into_iter().zip(deviations).enumerate().map(entry);
        let entries: Result<Vec<Normal>, _> = entries.collect();
        let made = entries.and_then(|entries| Correlated::new(entries, &self.correlation));
        Some(made.map(Distribution::Correlated))
    }
}

fn normal(
    mean: f64,
    deviation: f64,
    [lower, upper]: [Option<f64>; 2],
) -> Result<Normal, DispersionError> {
    Normal::new(mean, deviation)?.truncated(lower, upper)
}

fn targets(
    report: &mut Report,
    section: &Section,
    paths: Vec<SettingPath>,
    correlated: bool,
) -> Option<Vec<Target>> {
    if correlated && section.given(keys::NAME) {
        let message = "correlated numbers are called by their paths";
        section.wrong(report, keys::NAME, message, "nothing; leave it out");
        return None;
    }
    if correlated {
        let target = |path: SettingPath| Target { name: path.text().to_owned(), paths: vec![path] };
        return Some(paths.into_iter().map(target).collect());
    }
    let first = paths.first().map(|path| path.text().to_owned());
    let name = section.get(keys::NAME).map(str::to_owned).or(first)?;
    Some(vec![Target { name, paths }])
}

/// Refuses a name or a place that an earlier dispersion, or the same one, has already.
fn check_names(
    report: &mut Report,
    section: &Section,
    (earlier, new): (&[Dispersion], &Dispersion),
) {
    let of = |dispersion: &Dispersion| -> (Vec<String>, Vec<String>) {
        let names = dispersion.names().map(str::to_owned).collect();
        let paths = dispersion.targets.iter().flat_map(|target| &target.paths);
        (names, paths.map(|path| path.text().to_owned()).collect())
    };
    let (names, paths) = of(new);
    let (mut known_names, mut known_paths) = (Vec::new(), Vec::new());
    for dispersion in earlier {
        let (names, paths) = of(dispersion);
        known_names.extend(names);
        known_paths.extend(paths);
    }
    let twice = |list: &[String], known: &[String]| {
        let is_twice = |(at, text): &(usize, &String)| {
            known.contains(text) || list.get(..*at).is_some_and(|before| before.contains(text))
        };
        list.iter().enumerate().find(is_twice).map(|(_, text)| text.clone())
    };
    if let Some(path) = twice(&paths, &known_paths) {
        let message = format!("`{path}` is drawn already");
        report.missing(section.place, &section.path, message, "each place once");
    } else if let Some(name) = twice(&names, &known_names) {
        let message = format!("the name `{name}` is taken");
        report.missing(section.place, &section.path, message, "a name of its own");
    }
}

impl Template {
    /// Tries each dispersion alone at the ends of what it can draw (untruncated normals at three standard
    /// deviations), so that a campaign does not begin that its numbers make wrong. Answers the numbers
    /// that stand at the paths of each relative dispersion.
    ///
    /// # Errors
    /// Everything that is wrong then, each with the value that made it so.
    pub fn check_dispersions(&self) -> Result<Vec<Vec<f64>>, Problems> {
        let mut report = self.report();
        self.check_places(&mut report);
        let mut nominal = Vec::new();
        for (index, dispersion) in self.study().dispersions.iter().enumerate() {
            let path = format!("dispersion[{index}]");
            let wrong = match self.nominal(dispersion) {
                Ok(numbers) => {
                    let wrong = self.at_ends(dispersion, &numbers);
                    nominal.push(numbers);
                    wrong
                }
                Err(path) => Some((
                    format!("there is no number at `{path}` that a factor could go with"),
                    "a path to a number that is written in the scenario or in a file that it names; or relative = false",
                )),
            };
            let Some((message, allowed)) = wrong else { continue };
            if !self.told_misspelt(&mut report, &path, dispersion) {
                report.missing(self.place_of(&path), &path, message, allowed);
            }
        }
        report.finish(self.name()).map(|_| nominal)
    }

    /// Refuses dispersions whose paths are nowhere in the scenario, and nothing else of what
    /// [`check_dispersions`](Self::check_dispersions) does.
    ///
    /// # Errors
    /// The first of each such dispersion.
    pub fn check_paths_of_dispersions(&self) -> Result<(), Problems> {
        let mut report = self.report();
        for (index, dispersion) in self.study().dispersions.iter().enumerate() {
            self.told_misspelt(&mut report, &format!("dispersion[{index}]"), dispersion);
        }
        report.finish(self.name()).map(drop)
    }

    /// Tells of the first path of a dispersion at `at` that is nowhere in the scenario: no limit mends that. False without one.
    fn told_misspelt(&self, report: &mut Report, at: &str, dispersion: &Dispersion) -> bool {
        let rows = self.rows();
        let paths = dispersion.targets.iter().flat_map(|target| &target.paths);
        let is_nowhere = |path: &str| row_at(&rows, path).is_none() && self.found(path).is_none();
        let mut paths = paths.map(SettingPath::text).enumerate();
        let Some((number, path)) = paths.find(|(_, path)| is_nowhere(path)) else {
            return false;
        };
        let keys = [format!("{at}.paths[{number}]"), format!("{at}.path")];
        let [in_list, alone] = &keys;
        let key = if self.found(in_list).is_some() { in_list } else { alone };
        let near = meant(&rows, path).map(|near| format!("; did you mean `{near}`?"));
        let message = format!("there is no `{path}`{}", near.unwrap_or_default());
        let allowed = "a path that `fspid check FILE --paths` calls drawn";
        report.missing(self.place_of(key), key, message, allowed);
        true
    }

    /// Refuses a place that is drawn twice.
    fn check_places(&self, report: &mut Report) {
        for (index, [path, other]) in self.drawn_twice() {
            let at = format!("dispersion[{index}]");
            let message = format!("`{path}` is drawn already, as `{other}`");
            report.missing(self.place_of(&at), &at, message, "each place once");
        }
    }

    /// Places that are drawn twice in other words, such as the name and the number of a list's entry: the number of the later
    /// dispersion, its path, and that of the earlier one.
    #[must_use]
    pub fn drawn_twice(&self) -> Vec<(usize, [String; 2])> {
        let dispersions = self.study().dispersions.iter().enumerate();
        let paths = dispersions.flat_map(|(index, dispersion)| {
            let paths = dispersion.targets.iter().flat_map(|target| &target.paths);
            paths.map(move |path| (index, path))
        });
        let mut known: Vec<(String, &str)> = Vec::new();
        let mut twice = Vec::new();
        for (index, path) in paths {
            let place = self.place_in_words(path);
            if let Some((_, other)) = known.iter().find(|(it, _)| *it == place) {
                twice.push((index, [path.text().to_owned(), (*other).to_owned()]));
            }
            known.push((place, path.text()));
        }
        twice
    }

    /// The numbers at all paths of a relative dispersion, or the path without one.
    fn nominal(&self, dispersion: &Dispersion) -> Result<Vec<f64>, String> {
        if !dispersion.relative {
            return Ok(Vec::new());
        }
        let paths = dispersion.targets.iter().flat_map(|target| &target.paths);
        let number =
            |path: &SettingPath| self.number_at(path).ok_or_else(|| path.text().to_owned());
        paths.map(number).collect()
    }

    /// What is wrong at an end of what is drawn, and what would be right.
    fn at_ends(&self, dispersion: &Dispersion, nominal: &[f64]) -> Option<(String, &'static str)> {
        let (ends, mut heard) = (dispersion.ends(), Vec::new());
        for drawn in &ends {
            let values = dispersion.values(drawn, nominal);
            let shown: Vec<String> =
                values.iter().map(|(path, value)| format!("{}={value}", path.text())).collect();
            let shown = shown.join(", ");
            match self.with_loops(&values) {
                Err(problems) => {
                    let message = format!("{shown} is not allowed: {}", problems.first_in_a_line());
                    let allowed = "limits (`lower`, `upper`) within what the scenario allows";
                    return Some((message, allowed));
                }
                Ok(study) if !same_shape(self.study(), &study) => {
                    let message = format!("{shown} changes the controllers");
                    return Some((message, "numbers and names of what flies"));
                }
                Ok(study) => heard.push((shown, study.scenario)),
            }
        }
        unheard(&heard)
    }
}

/// What is wrong where values that differ make the same flight, such as seeds of an air that a mixture of seeds makes.
fn unheard(ends: &[(String, Scenario)]) -> Option<(String, &'static str)> {
    let (one, flown) = ends.first()?;
    let (other, _) = ends.iter().find(|(shown, _)| shown != one)?;
    ends.iter().all(|(_, it)| it == flown).then(|| {
        let message = format!("{one} and {other} are the same flight: another key has the say there");
        (message, "a place that the flight depends on; without `turbulence.mixture` where its seed is drawn")
    })
}

/// True if both have the same controllers by name.
fn same_shape(one: &crate::file::Study, other: &crate::file::Study) -> bool {
    let names = |study: &crate::file::Study| -> Vec<String> {
        study.scenario.controllers.iter().map(|named| named.name.clone()).collect()
    };
    names(one) == names(other)
}
