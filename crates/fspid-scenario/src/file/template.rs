//! A scenario that is read once and built many times, each time with other numbers.

use std::path::{Path, PathBuf};

use super::build::{Built, loops, scenario};
use super::document::{Item, Value};
use super::extra::Extra;
use super::files::{Files, Kept};
use super::overrides::{self, Found, Setting};
use super::paths::{self, PathRow};
use crate::dispersion::Dispersion;
use crate::setting_path::{NewValue, SettingPath, Step, path_of, steps};
use crate::tuning::TunableParameter;
use fspid_diagnostics::{Problems, Report, Span};

use super::{LoadError, Study, changed_document, check, spec};

/// A scenario with everything that comes from outside, ready to be built with other numbers.
#[derive(Clone, Debug)]
pub struct Template {
    name: String,
    folder: Option<PathBuf>,
    report: Report,
    document: Item,
    /// Changes of files that the scenario names.
    changes: Vec<overrides::Change>,
    study: Study,
    /// The files that the digest is of.
    kept: Kept,
}

impl Template {
    /// Reads a scenario file, as [`load`](super::load).
    ///
    /// # Errors
    /// A file that cannot be read, or everything that is wrong with it.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self, LoadError> {
        let text = super::read_text(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let extra = Extra { overrides, ..Extra::default() };
        Self::parse(&text, &path.display().to_string(), Some(folder), &extra)
            .map_err(LoadError::Problems)
    }

    /// Reads a scenario from a text called `name` in messages, as [`parse_with`](super::parse_with).
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn parse(
        text: &str,
        name: &str,
        folder: Option<&Path>,
        extra: &Extra<'_>,
    ) -> Result<Self, Problems> {
        let kept = Kept::default();
        let study = super::parse_keeping(text, name, Files::of_kept(folder, &kept), extra)?;
        let (mut report, mut files) = (Report::default(), Files::of_kept(folder, &kept));
        let document = changed_document(&mut report, &mut files, text, extra).map(|(it, _)| it);
        Ok(Self {
            name: name.to_owned(),
            folder: folder.map(Path::to_owned),
            // The text was read once already.
            document: document.ok_or_else(|| Problems::new(name, Vec::new(), 0))?,
            changes: files.changes().cloned().collect(),
            report,
            study,
            kept,
        })
    }

    /// The scenario as it is written.
    #[must_use]
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// A report of its own about the texts that were read.
    pub(super) fn report(&self) -> Report {
        self.report.clone()
    }

    /// Where a part of the scenario stands; its beginning if it is not there.
    pub(super) fn place_of(&self, path: &str) -> Span {
        self.found(path).unwrap_or(self.document.place)
    }

    /// The same, if it is there.
    pub(super) fn found(&self, path: &str) -> Option<Span> {
        match overrides::find(&self.document, &steps(path)?, "") {
            Found::Here(item) => Some(item.place),
            Found::InFile(..) | Found::Nothing => None,
        }
    }

    /// Every path that the scenario has.
    pub(super) fn rows(&self) -> Vec<PathRow> {
        let (mut report, mut files) = (self.report.clone(), self.files());
        paths::rows(&mut report, &mut files, &self.document)
    }

    /// What the scenario is called in messages.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The scenario with other values at some places. It has neither settings nor a digest of its own.
    ///
    /// # Errors
    /// Everything that is wrong with it then.
    pub fn with(&self, values: &[(&SettingPath, NewValue)]) -> Result<Study, Problems> {
        let mut files = self.files();
        self.with_files(&mut files, values, Asked::Numbers)
    }

    /// As [`with`](Self::with), and every loop can be judged, as a scenario that is read is asked.
    pub(super) fn with_loops(
        &self,
        values: &[(&SettingPath, NewValue)],
    ) -> Result<Study, Problems> {
        let mut files = self.files();
        self.with_files(&mut files, values, Asked::Loops)
    }

    fn with_files(
        &self,
        files: &mut Files<'_>,
        values: &[(&SettingPath, NewValue)],
        asked: Asked,
    ) -> Result<Study, Problems> {
        let (mut report, mut document) = (self.report.clone(), self.document.clone());
        put_all(&mut report, files, &mut document, values);
        let built = build(&mut report, files, &document, asked);
        files.report_unused_changes(&mut report);
        report.finish(&self.name)?;
        let built = built.ok_or_else(|| Problems::new(&self.name, Vec::new(), 0))?;
        Ok(Study::without_text(built))
    }

    /// The scenario with one controller alone, and without what it says of tuning and of other controllers. What differs from
    /// run to run is drawn of the whole scenario, so that everybody gets the same: of one controller alone nothing is.
    ///
    /// Its digest is of what is left and of the files that this names: of what decides about its flights.
    ///
    /// # Errors
    /// A controller that there is not.
    pub fn only(&self, controller: &str) -> Result<Self, Problems> {
        let mut one = self.clone();
        if let Value::Table(members) = &mut one.document.value {
            members.retain(|member| !["tuning", "contest"].contains(&member.name.as_str()));
            for member in members {
                let Value::Array(items) = &mut member.item.value else {
                    continue;
                };
                match member.name.as_str() {
                    "controller" => items.retain(|item| text_at(item, "name") == Some(controller)),
                    "requirement" => items.retain(|item| {
                        text_at(item, "controller").is_none_or(|name| name == controller)
                    }),
                    _ => {}
                }
            }
        }
        let is_mine =
            |mark: &&TunableParameter| mark.controller().is_none_or(|name| name == controller);
        let tunable_parameters =
            self.study.tunable_parameters.iter().filter(is_mine).cloned().collect();
        let mut files = one.files();
        let study = one.with_files(&mut files, &[], Asked::Numbers)?;
        files.digest(&one.document.meaning());
        one.changes.iter().for_each(|change| files.digest(&change.meaning()));
        let digest = files.finish();
        one.study = Study { tunable_parameters, digest, dispersions: Vec::new(), ..study };
        Ok(one)
    }

    /// The number at a place, in the scenario or in a file that it names; `None` where there is none.
    #[must_use]
    pub fn number_at(&self, path: &SettingPath) -> Option<f64> {
        let (key, rest) = match overrides::find(&self.document, path.steps(), "") {
            Found::Here(item) => return number(item),
            Found::InFile(key, rest) => (key, rest),
            Found::Nothing => return None,
        };
        let (mut report, mut files) = (self.report.clone(), self.files());
        files.keep_documents();
        build(&mut report, &mut files, &self.document, Asked::Numbers)?;
        match overrides::find(files.document(&key)?, rest, "") {
            Found::Here(item) => number(item),
            _ => None,
        }
    }

    /// The number at a place of the scenario itself once other values are put into it; `None` where there is none.
    #[must_use]
    pub fn number_with(
        &self,
        values: &[(&SettingPath, NewValue)],
        path: &SettingPath,
    ) -> Option<f64> {
        let (mut report, mut files) = (self.report.clone(), self.files());
        let mut document = self.document.clone();
        put_all(&mut report, &mut files, &mut document, values);
        match overrides::find(&document, path.steps(), "") {
            Found::Here(item) => number(item),
            _ => None,
        }
    }

    /// A path in the one way of all that lead to its place: entries of lists by their numbers.
    pub(super) fn place_in_words(&self, path: &SettingPath) -> String {
        path_of(&self.numbered(path))
    }

    /// The same by its steps.
    pub(super) fn numbered(&self, path: &SettingPath) -> Vec<Step> {
        overrides::numbered(&self.document, path.steps())
    }

    /// Name of a controller by its number.
    pub(super) fn controller_at(&self, index: usize) -> Option<String> {
        let steps = [Step::Name("controller".to_owned()), Step::Index(index)];
        match overrides::find(&self.document, &steps, "") {
            Found::Here(item) => text_at(item, "name").map(str::to_owned),
            _ => None,
        }
    }

    fn files(&self) -> Files<'_> {
        let mut files = Files::of_kept(self.folder.as_deref(), &self.kept);
        self.changes.iter().for_each(|change| files.change(change.clone()));
        files
    }
}

/// What a scenario is asked.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Asked {
    /// Whether its numbers are allowed.
    Numbers,
    /// And whether its loops can be judged, which takes longer.
    Loops,
}

/// Reads the files that only what a dispersion chooses among names, so that the digest is of them as well.
pub(super) fn read_chosen(
    report: &Report,
    files: &mut Files<'_>,
    document: &Item,
    dispersions: &[Dispersion],
) {
    for dispersion in dispersions {
        let texts = dispersion.choices.iter().filter(|it| matches!(it, NewValue::Text(_)));
        for value in texts {
            let (mut report, mut document, mut again) =
                (report.clone(), document.clone(), files.again());
            for path in dispersion.targets.iter().flat_map(|target| &target.paths) {
                let set = setting(&mut report, path, value);
                overrides::put(&mut report, &mut again, &mut document, (path.steps(), &set));
            }
            // What is wrong with it is told where it is drawn.
            build(&mut report, &mut again, &document, Asked::Numbers);
            files.join(again);
        }
    }
}

fn build(
    report: &mut Report,
    files: &mut Files<'_>,
    document: &Item,
    asked: Asked,
) -> Option<Built> {
    let section = check::table(report, &spec::SCENARIO, document, "")?;
    let built = scenario(report, files, &section)?;
    if asked == Asked::Loops && report.count() == 0 {
        loops::check(report, &section, &built.scenario);
    }
    Some(built)
}

/// Puts values into a document.
fn put_all(
    report: &mut Report,
    files: &mut Files<'_>,
    document: &mut Item,
    values: &[(&SettingPath, NewValue)],
) {
    for (path, value) in values {
        let set = setting(report, path, value);
        overrides::put(report, files, document, (path.steps(), &set));
    }
}

/// A new value with the words that a problem quotes.
fn setting(report: &mut Report, path: &SettingPath, value: &NewValue) -> Setting {
    let text = value.to_string();
    let origin = format!("--set {}={text}", path.text());
    let source = report.add_source(Some(origin.clone()), &text);
    let place = Span { source, start: 0, end: text.len() };
    Setting { origin, item: Item { place, value: value.value(place) } }
}

fn text_at<'a>(item: &'a Item, key: &str) -> Option<&'a str> {
    let Value::Table(members) = &item.value else {
        return None;
    };
    match members.iter().find(|member| member.name == key).map(|member| &member.item.value) {
        Some(Value::Text(text)) => Some(text),
        _ => None,
    }
}

fn number(item: &Item) -> Option<f64> {
    match item.value {
        Value::Float(number) | Value::Integer(number, _) => Some(number),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::parse;

    const SCENARIO: &str = include_str!("../../../../scenarios/747-pitch-step.toml");

    fn path(text: &str) -> SettingPath {
        SettingPath::parse(text).expect("a path")
    }

    fn template() -> Template {
        Template::parse(SCENARIO, "step.toml", None, &Extra::default()).expect("a scenario")
    }

    #[test]
    fn a_template_with_new_values_is_the_scenario_with_those_changes() {
        let (gain, zero) = (path("controller.FSPID.nominal.kp"), path("plant.preset.numerator[0]"));
        let values = [(&gain, NewValue::Number(0.1 + 0.2)), (&zero, NewValue::Number(-1.7))];
        let built = template().with(&values).expect("a scenario");
        let texts = values.map(|(path, value)| format!("{}={value}", path.text()));
        let parsed = parse(SCENARIO, "step.toml", None, &texts).expect("a scenario");
        assert_eq!(built.scenario, parsed.scenario);
        assert_ne!(built.scenario, template().study().scenario);
    }

    #[test]
    fn a_number_is_found_in_the_scenario_and_in_the_plant_that_it_names() {
        let found = |text: &str| template().number_at(&path(text));
        assert_eq!(found("controller[2].nominal.ki"), Some(0.5));
        assert_eq!(found("plant.preset.numerator[0]"), Some(-1.69144));
        for nothing in ["plant.preset.nominator[0]", "name", "loop.x", "controller[9].kp"] {
            assert_eq!(found(nothing), None, "{nothing}");
        }
    }

    #[test]
    fn a_value_that_is_not_allowed_is_refused_with_its_path_and_number() {
        let period = path("loop.sample_period_s");
        let problems = template().with(&[(&period, NewValue::Number(-1.0))]).expect_err("negative");
        let text = problems.to_string();
        assert!(text.contains("loop.sample_period_s") && text.contains("-1"), "{text}");
    }

    #[test]
    fn a_path_into_a_file_that_is_none_is_refused() {
        let name = path("name.x");
        let problems = template().with(&[(&name, NewValue::Number(1.0))]).expect_err("no file");
        assert!(problems.to_string().contains("has no `x` in it"), "{problems}");
    }

    #[test]
    fn a_file_that_changes_meanwhile_changes_no_scenario_that_is_built_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let program = folder.path().join("own.so");
        std::fs::write(&program, "as it was hashed").expect("a file");
        let external =
            "\n[[controller]]\nname = \"own\"\nkind = \"external\"\nlibrary = \"own.so\"\n";
        let (text, extra) = (format!("{SCENARIO}{external}"), Extra::default());
        let template = Template::parse(&text, "step.toml", Some(folder.path()), &extra);
        let template = template.expect("a scenario");
        for change in [Some("another"), None] {
            match change {
                Some(bytes) => std::fs::write(&program, bytes).expect("a file"),
                None => std::fs::remove_file(&program).expect("it was there"),
            }
            let again = template.with(&[]).expect("the same scenario");
            assert_eq!(again.scenario, template.study().scenario);
        }
    }
}
