//! Requirements as files have them: single ones, and ready sets.

use crate::file::dispersion::texts;
use crate::file::files::Files;
use crate::file::spec::scenario::{CONTEST, REQUIREMENT, TUNING};
use crate::file::spec::tuning;
use crate::keyed::Section;
use crate::measure::Measure;
use crate::requirement::keys;
use crate::requirement::keys::names_in_words;
use crate::requirement::read::{check_conditions, check_signs, check_target, conditions, limits};
use crate::requirement::{
    Air, AskedIn, Choices, Conditions, Origin, Requirement, RequirementSet, SET_NAMES, set,
    set_text,
};
use fspid_diagnostics::Report;

/// The requirements of a scenario whose controllers have these names.
pub(crate) fn requirements(
    report: &mut Report,
    files: &mut Files<'_>,
    sections: &[Section],
    names: &[&str],
) -> Vec<Requirement> {
    let mut requirements = Vec::new();
    for section in sections {
        let controller = section.get(keys::CONTROLLER);
        if let Some(name) = controller
            && !names.contains(&name)
        {
            section.wrong(
                report,
                keys::CONTROLLER,
                "no controller has this name",
                names.join(", "),
            );
            check_signs(report, section, section.get(keys::MEASURE));
            continue;
        }
        let found = match section.get(keys::SET) {
            Some(name) => of_set(report, files, section, name),
            None => single(report, section).into_iter().collect(),
        };
        let asked = found.into_iter().map(|requirement| Requirement {
            controller: controller.map(str::to_owned),
            cases: asked_in(section),
            ..requirement
        });
        requirements.extend(asked);
    }
    check_ids(report, sections);
    number_ids(&mut requirements);
    requirements
}

/// Where it is asked; what is wrong with it is told by [`check_cases`].
fn asked_in(section: &Section) -> AskedIn {
    let names = |key| section.get(key).and_then(texts).unwrap_or_default();
    AskedIn { only: names(keys::ONLY_IN), not: names(keys::NOT_IN) }
}

/// Refuses names of cases that there are not, and lists of anything else; warns of what the scenario as it is
/// written is not asked.
pub(crate) fn check_cases(report: &mut Report, scenario: &Section) {
    let cases = [TUNING, CONTEST].into_iter().filter_map(|key| scenario.get(key));
    let cases: Vec<&Section> = cases.flat_map(|part| part.sections(tuning::CASE)).collect();
    let known = |name: &str| {
        let is_it = |case: &&&Section| {
            [case.get(tuning::NAME), case.get(tuning::GROUP)].contains(&Some(name))
        };
        cases.iter().any(|case| is_it(&case))
    };
    for section in scenario.sections(REQUIREMENT) {
        for key in [keys::ONLY_IN, keys::NOT_IN] {
            let Some(item) = section.get(key) else {
                continue;
            };
            let path = section.path(key);
            match texts(item).filter(|names| !names.is_empty()) {
                None => report.value(item.place, &path, "no list of names", names_in_words()),
                Some(names) => {
                    for name in names.iter().filter(|name| !known(name)) {
                        let message = format!("no case and no group is called \"{name}\"");
                        report.missing(item.place, &path, message, names_in_words());
                    }
                }
            }
        }
        if let Some(only) = section.get(keys::ONLY_IN) {
            let asked = asked_in(section);
            let is_asked = |case: &&Section| {
                let text = |key| case.get(key).unwrap_or_default();
                asked.case(text(tuning::NAME), text(tuning::GROUP))
            };
            if !asked.only.is_empty()
                && asked.only.iter().all(|name| known(name))
                && !cases.iter().any(is_asked)
            {
                let message = "`not_in` takes every case away again: it would be asked nowhere";
                report.missing(only.place, &section.path(keys::ONLY_IN), message, names_in_words());
            }
            let measure = section.get(keys::MEASURE).map(Measure::name);
            let measure = measure.or(section.get(keys::SET)).unwrap_or_default();
            report.warn(format!("{}: {measure} {}", section.path, AskedIn::NOT_AS_WRITTEN));
        }
    }
}

/// Refuses an id that an earlier requirement was given.
fn check_ids(report: &mut Report, sections: &[Section]) {
    for (index, section) in sections.iter().enumerate() {
        let Some(id) = section.get(keys::ID) else {
            continue;
        };
        let earlier = sections.get(..index).unwrap_or_default();
        if let Some(twin) = earlier.iter().find(|other| other.get(keys::ID) == Some(id)) {
            let message = format!("the id is taken by {}", twin.path);
            section.wrong(report, keys::ID, message, "an id of its own");
        }
    }
}

/// Makes ids that were not given differ: the second one of a name gets "-2", and so on.
fn number_ids(requirements: &mut [Requirement]) {
    for index in 1..requirements.len() {
        let (earlier, rest) = requirements.split_at_mut(index);
        let Some(this) = rest.first_mut() else {
            continue;
        };
        let is_taken = |id: &str| earlier.iter().any(|other| other.id == id);
        let mut id = this.id.clone();
        let mut number = 2;
        while is_taken(&id) {
            id = format!("{}-{number}", this.id);
            number += 1;
        }
        this.id = id;
    }
}

fn single(report: &mut Report, section: &Section) -> Option<Requirement> {
    let Some(measure) = section.get(keys::MEASURE) else {
        check_signs(report, section, None);
        return None;
    };
    let limits = limits(report, section, measure);
    let conditions = Conditions { air: section.get(keys::AIR), ..conditions(section) };
    check_conditions(report, section, measure, &conditions);
    let text = |key| section.get::<str>(key).map(str::to_owned);
    let id = text(keys::ID).unwrap_or_else(|| measure.name().to_owned());
    let origin = Origin {
        set: None,
        clause: text(keys::CLAUSE),
        source: text(keys::SOURCE),
        confidence: section.get(keys::CONFIDENCE),
        note: text(keys::NOTE),
    };
    Some(Requirement { origin, ..bare(id, measure, limits, conditions) })
}

/// A requirement of every controller in every case, of which nobody says where it is from.
fn bare(
    id: String,
    measure: Measure,
    (least, most): (Option<f64>, Option<f64>),
    conditions: Conditions,
) -> Requirement {
    let (origin, cases) = (Origin::default(), AskedIn::default());
    Requirement { id, controller: None, measure, least, most, conditions, origin, cases }
}

/// The measure of an objective; its limit says which side is bad, so that the worst case is the one that
/// counts.
pub(crate) fn objective_requirement(
    report: &mut Report,
    section: &Section,
    (index, is_minimised): (usize, bool),
) -> Option<Requirement> {
    let measure = section.get(keys::MEASURE)?;
    let conditions = conditions(section);
    check_conditions(report, section, measure, &conditions);
    let limits = ((!is_minimised).then_some(0.0), is_minimised.then_some(0.0));
    Some(bare(format!("objective[{index}]"), measure, limits, conditions))
}

/// A limit of the mean of a measure over many flights.
pub(crate) fn limit_requirement(
    report: &mut Report,
    section: &Section,
    index: usize,
) -> Option<Requirement> {
    let measure = section.get(keys::MEASURE)?;
    let limits = limits(report, section, measure);
    let conditions = conditions(section);
    check_conditions(report, section, measure, &conditions);
    Some(bare(format!("limit[{index}]"), measure, limits, conditions))
}

/// The requirements of a ready set under the choices of a section.
fn of_set(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    name: &str,
) -> Vec<Requirement> {
    let (Some(text), Some(set)) = (set_text(name), set(name)) else {
        return Vec::new();
    };
    files.digest(text);
    check_choices(report, section, &set);
    let asked = set.requirements(&choices(section));
    if asked.is_empty() && section.sound {
        let message = format!(
            "no line of `{name}` is asked with these choices, so that nothing would be required"
        );
        section.problem(
            report,
            keys::SET,
            message,
            "choices with which a line of the set is asked",
        );
    }
    asked
}

fn choices(section: &Section) -> Choices {
    let text = |key, default: &str| section.get(key).unwrap_or(default).to_owned();
    Choices {
        level: section.get(keys::LEVEL).unwrap_or(Choices::DEFAULT_LEVEL),
        category: text(keys::CATEGORY, Choices::DEFAULT_CATEGORY),
        speed: text(keys::SPEED, Choices::DEFAULT_SPEED),
        air: section.get(keys::AIR).unwrap_or(Air::Smooth),
        first_aeroelastic_mode_hz: section.get(keys::FIRST_AEROELASTIC_MODE_HZ),
        target_ft: section.get(keys::TARGET_FT),
        target_m: section.get(keys::TARGET_M),
    }
}

/// Refuses a choice that the set does not leave.
fn check_choices(report: &mut Report, section: &Section, chosen: &RequirementSet) {
    let keys = [
        keys::LEVEL.name,
        keys::CATEGORY.name,
        keys::SPEED.name,
        keys::AIR.name,
        keys::FIRST_AEROELASTIC_MODE_HZ.name,
        keys::TARGET_FT.name,
        keys::TARGET_M.name,
    ];
    check_target(report, section);
    for key in keys.into_iter().filter(|it| section.given(*it) && !chosen.takes(it.as_str())) {
        let takes = |name: &&&str| set(name).is_some_and(|set| set.takes(key.as_str()));
        let owners: Vec<String> =
            SET_NAMES.iter().filter(takes).map(|name| format!("\"{name}\"")).collect();
        let message = format!("the set \"{}\" leaves no such choice", chosen.name);
        let allowed = format!("with {}", owners.join(" or "));
        section.wrong(report, key, message, allowed);
    }
}
