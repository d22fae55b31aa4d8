//! Requirements as files have them: single ones, and ready sets.

use crate::file::dispersion::texts;
use crate::file::files::Files;
use crate::file::spec::requirement as keys;
use crate::file::spec::requirement::{SET_FILE, names_in_words};
use crate::file::spec::scenario::{CONTEST, REQUIREMENT, TUNING};
use crate::file::spec::tuning;
use crate::keyed::check;
use crate::keyed::document;
use crate::keyed::{Key, KeyName, Section};
use crate::measure::Measure;
use crate::requirement::{
    Air, AskedIn, Choices, Conditions, Origin, Requirement, RequirementSet, SET_NAMES, SetLine,
    set, set_text,
};
use fspid_diagnostics::{Problems, Report};

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
    let measure = section.get(keys::MEASURE)?;
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

/// The limits; a measure that is 1 or 0 has its own.
fn limits(report: &mut Report, section: &Section, measure: Measure) -> (Option<f64>, Option<f64>) {
    let (least, most) = (section.get(keys::LEAST), section.get(keys::MOST));
    let written = section.given(keys::LEAST) || section.given(keys::MOST);
    if measure.is_yes_or_no() {
        return if written { (least, most) } else { (Some(1.0), None) };
    }
    // A limit that is written wrongly is told already, and so is a table with an unknown key.
    if !written && section.sound {
        let message = "missing key; a requirement has a limit";
        section.problem(report, keys::MOST, message, "`least`, `most` or both");
    }
    if let (Some(least), Some(most)) = (least, most)
        && most < least
    {
        section.wrong(report, keys::MOST, "below `least`", format!("{least:?} or above"));
    }
    (least, most)
}

/// What counts, in whatever air.
fn conditions(section: &Section) -> Conditions {
    Conditions {
        step_deg: section.get(keys::STEP_DEG),
        within_deg: section.get(keys::WITHIN_DEG),
        from_s: section.get(keys::FROM_S),
        to_s: section.get(keys::TO_S),
        from_hz: section.get(keys::FROM_HZ),
        to_hz: section.get(keys::TO_HZ),
        air: None,
    }
}

fn check_conditions(
    report: &mut Report,
    section: &Section,
    measure: Measure,
    conditions: &Conditions,
) {
    let are_asked = keys::CONDITIONS.iter().map(|key| key.name()).chain([keys::AIR.name]);
    let is_given = |key: &KeyName| section.entries.iter().any(|it| it.name == *key && it.given);
    for key in are_asked.filter(|key| is_given(key) && !measure.takes(key.as_str())) {
        let owners = Measure::ALL.into_iter().filter(|measure| measure.takes(key.as_str()));
        let owners: Vec<&str> = owners.map(Measure::name).collect();
        let message = format!("says nothing about `{}`", measure.name());
        let allowed = format!("with {}", owners.join(", "));
        section.wrong(report, key, message, allowed);
    }
    if measure == Measure::RecoveryTime && conditions.within_deg.is_none() {
        let message = "missing key; it goes with `recovery_time_s`";
        let allowed = "a finite number above 0, in deg";
        section.problem(report, keys::WITHIN_DEG, message, allowed);
    }
    if conditions.from_s.is_some() && conditions.step_deg.is_some() {
        let message = "not together with `step_deg`, from which the time counts";
        section.wrong(report, keys::FROM_S, message, "one of the two");
    }
    check_order(report, section, [keys::FROM_S, keys::TO_S]);
    check_order(report, section, [keys::FROM_HZ, keys::TO_HZ]);
}

/// Refuses an end that is not after its beginning.
fn check_order(report: &mut Report, section: &Section, [from, to]: [Key<f64>; 2]) {
    if let (Some(first), Some(last)) = (section.get(from), section.get(to))
        && !(last > first)
    {
        let message = format!("not above `{}`", from.name);
        section.wrong(report, to, message, format!("above {first:?}"));
    }
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
    set.requirements(&choices(section))
}

fn choices(section: &Section) -> Choices {
    let text = |key, default: &str| section.get(key).unwrap_or(default).to_owned();
    Choices {
        level: section.get(keys::LEVEL).unwrap_or(Choices::DEFAULT_LEVEL),
        category: text(keys::CATEGORY, Choices::DEFAULT_CATEGORY),
        speed: text(keys::SPEED, Choices::DEFAULT_SPEED),
        air: section.get(keys::AIR).unwrap_or(Air::Smooth),
        first_aeroelastic_mode_hz: section.get(keys::FIRST_AEROELASTIC_MODE_HZ),
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
    ];
    for key in keys.into_iter().filter(|it| section.given(*it) && !chosen.takes(it.as_str())) {
        let takes = |name: &&&str| set(name).is_some_and(|set| set.takes(key.as_str()));
        let owners: Vec<String> =
            SET_NAMES.iter().filter(takes).map(|name| format!("\"{name}\"")).collect();
        let message = format!("the set \"{}\" leaves no such choice", chosen.name);
        let allowed = format!("with {}", owners.join(" or "));
        section.wrong(report, key, message, allowed);
    }
}

/// Reads a set from its file.
///
/// # Errors
/// Everything that is wrong with it.
pub(crate) fn requirement_set(text: &str, name: &str) -> Result<RequirementSet, Problems> {
    let mut report = Report::default();
    let section = document::read(&mut report, None, text)
        .and_then(|item| check::table(&mut report, &SET_FILE, &item, ""));
    if let Some(section) = &section {
        section.sections(keys::LINE).iter().for_each(|line| check_line(&mut report, line));
    }
    report.finish(name)?;
    section.as_ref().and_then(set_of).ok_or_else(|| Problems::new(name, Vec::new(), 0))
}

fn check_line(report: &mut Report, line: &Section) {
    if let Some(measure) = line.get(keys::MEASURE) {
        limits(report, line, measure);
        check_conditions(report, line, measure, &conditions(line));
    }
}

fn set_of(section: &Section) -> Option<RequirementSet> {
    let text = |key| section.get::<str>(key).unwrap_or_default().to_owned();
    let lines = section.sections(keys::LINE).iter().map(line).collect::<Option<Vec<_>>>()?;
    Some(RequirementSet {
        name: text(keys::SET_NAME),
        title: text(keys::TITLE),
        source: text(keys::SET_SOURCE),
        notes: text(keys::NOTES),
        lines,
    })
}

fn line(section: &Section) -> Option<SetLine> {
    let measure = section.get(keys::LINE_MEASURE)?;
    let least = section.get(keys::LEAST).or_else(|| measure.is_yes_or_no().then_some(1.0));
    let text = |key| section.get::<str>(key).map(str::to_owned);
    Some(SetLine {
        id: text(keys::LINE_ID)?,
        measure,
        least,
        most: section.get(keys::MOST),
        conditions: Conditions { air: section.get(keys::LINE_AIR), ..conditions(section) },
        clause: text(keys::LINE_CLAUSE)?,
        source: text(keys::LINE_SOURCE)?,
        confidence: section.get(keys::LINE_CONFIDENCE)?,
        note: text(keys::NOTE),
        level: section.get(keys::LINE_LEVEL),
        category: text(keys::LINE_CATEGORY),
        speed: text(keys::LINE_SPEED),
        below_aeroelastic_mode: section.get(keys::BELOW_AEROELASTIC_MODE).unwrap_or(false),
        above_aeroelastic_mode: section.get(keys::ABOVE_AEROELASTIC_MODE).unwrap_or(false),
    })
}
