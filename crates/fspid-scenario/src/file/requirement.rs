//! Requirements as files have them: single ones, and ready sets.

use crate::file::check;
use crate::file::dispersion::texts;
use crate::file::document;
use crate::file::files::Files;
use crate::file::section::Section;
use crate::file::spec::{NOT_IN, ONLY_IN, SET_FILE, names_in_words};
use crate::measure::Measure;
use crate::requirement::{
    Air, AskedIn, Choices, Conditions, Confidence, Origin, Requirement, RequirementSet, SET_NAMES,
    SetLine, set, set_text,
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
        let controller = section.text("controller");
        if let Some(name) = controller
            && !names.contains(&name)
        {
            let (place, path) = (section.at("controller"), section.path("controller"));
            report.value(place, &path, "no controller has this name", names.join(", "));
            continue;
        }
        let found = match section.text("set") {
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
    let names = |key| section.item(key).and_then(texts).unwrap_or_default();
    AskedIn { only: names(ONLY_IN), not: names(NOT_IN) }
}

/// Refuses names of cases that there are not, and lists of anything else; warns of what the scenario as it is
/// written is not asked.
pub(crate) fn check_cases(report: &mut Report, scenario: &Section) {
    let cases = ["tuning", "contest"].into_iter().filter_map(|key| scenario.section(key));
    let cases: Vec<&Section> = cases.flat_map(|part| part.sections("case")).collect();
    let known = |name: &str| {
        let is_it =
            |case: &&&Section| [case.text("name"), case.text("group")].contains(&Some(name));
        cases.iter().any(|case| is_it(&case))
    };
    for section in scenario.sections("requirement") {
        for key in [ONLY_IN, NOT_IN] {
            let Some(item) = section.item(key) else {
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
        if let Some(only) = section.item(ONLY_IN) {
            let asked = asked_in(section);
            let is_asked = |case: &&Section| {
                let text = |key| case.text(key).unwrap_or_default();
                asked.case(text("name"), text("group"))
            };
            if !asked.only.is_empty()
                && asked.only.iter().all(|name| known(name))
                && !cases.iter().any(is_asked)
            {
                let message = "`not_in` takes every case away again: it would be asked nowhere";
                report.missing(only.place, &section.path(ONLY_IN), message, names_in_words());
            }
            let measure = section.text("measure").or(section.text("set")).unwrap_or_default();
            report.warn(format!("{}: {measure} {}", section.path, AskedIn::NOT_AS_WRITTEN));
        }
    }
}

/// Refuses an id that an earlier requirement was given.
fn check_ids(report: &mut Report, sections: &[Section]) {
    for (index, section) in sections.iter().enumerate() {
        let Some(id) = section.text("id") else {
            continue;
        };
        let earlier = sections.get(..index).unwrap_or_default();
        if let Some(twin) = earlier.iter().find(|other| other.text("id") == Some(id)) {
            let message = format!("the id is taken by {}", twin.path);
            report.value(section.at("id"), &section.path("id"), message, "an id of its own");
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
    let measure = section.text("measure").and_then(Measure::from_name)?;
    let (least, most) = limits(report, section, measure);
    let conditions = conditions(section);
    check_conditions(report, section, measure, &conditions);
    let text = |key| section.text(key).map(str::to_owned);
    Some(Requirement {
        id: text("id").unwrap_or_else(|| measure.name().to_owned()),
        controller: None,
        measure,
        least,
        most,
        conditions,
        origin: Origin {
            set: None,
            clause: text("clause"),
            source: text("source"),
            confidence: section.text("confidence").and_then(Confidence::from_name),
            note: text("note"),
        },
        cases: AskedIn::default(),
    })
}

/// The measure of an objective; its limit says which side is bad, so that the worst case is the one that
/// counts.
pub(crate) fn objective_requirement(
    report: &mut Report,
    section: &Section,
    (index, is_minimised): (usize, bool),
) -> Option<Requirement> {
    let measure = section.text("measure").and_then(Measure::from_name)?;
    let conditions = conditions(section);
    check_conditions(report, section, measure, &conditions);
    Some(Requirement {
        id: format!("objective[{index}]"),
        controller: None,
        measure,
        least: (!is_minimised).then_some(0.0),
        most: is_minimised.then_some(0.0),
        conditions,
        origin: Origin::default(),
        cases: AskedIn::default(),
    })
}

/// A limit of the mean of a measure over many flights.
pub(crate) fn limit_requirement(
    report: &mut Report,
    section: &Section,
    index: usize,
) -> Option<Requirement> {
    single(report, section)
        .map(|requirement| Requirement { id: format!("limit[{index}]"), ..requirement })
}

/// The limits; a measure that is 1 or 0 has its own.
fn limits(report: &mut Report, section: &Section, measure: Measure) -> (Option<f64>, Option<f64>) {
    let (least, most) = (section.number("least"), section.number("most"));
    let written = section.given("least") || section.given("most");
    if measure.is_yes_or_no() {
        return if written { (least, most) } else { (Some(1.0), None) };
    }
    // A limit that is written wrongly is told already, and so is a table with an unknown key.
    if !written && section.sound {
        let message = "missing key; a requirement has a limit";
        report.missing(section.place, &section.path("most"), message, "`least`, `most` or both");
    }
    if let (Some(least), Some(most)) = (least, most)
        && most < least
    {
        let (place, path) = (section.at("most"), section.path("most"));
        report.value(place, &path, "below `least`", format!("{least:?} or above"));
    }
    (least, most)
}

fn conditions(section: &Section) -> Conditions {
    Conditions {
        step_deg: section.number("step_deg"),
        within_deg: section.number("within_deg"),
        from_s: section.number("from_s"),
        to_s: section.number("to_s"),
        from_hz: section.number("from_hz"),
        to_hz: section.number("to_hz"),
        air: section.text("air").and_then(Air::from_name),
    }
}

fn check_conditions(
    report: &mut Report,
    section: &Section,
    measure: Measure,
    conditions: &Conditions,
) {
    let keys = ["step_deg", "within_deg", "from_s", "to_s", "from_hz", "to_hz", "air"];
    for key in keys.into_iter().filter(|key| section.given(key) && !measure.takes(key)) {
        let owners = Measure::ALL.into_iter().filter(|measure| measure.takes(key));
        let owners: Vec<&str> = owners.map(Measure::name).collect();
        let message = format!("says nothing about `{}`", measure.name());
        let allowed = format!("with {}", owners.join(", "));
        report.value(section.at(key), &section.path(key), message, allowed);
    }
    if measure == Measure::RecoveryTime && conditions.within_deg.is_none() {
        let message = "missing key; it goes with `recovery_time_s`";
        let allowed = "a finite number above 0, in deg";
        report.missing(section.place, &section.path("within_deg"), message, allowed);
    }
    if conditions.from_s.is_some() && conditions.step_deg.is_some() {
        let message = "not together with `step_deg`, from which the time counts";
        report.value(section.at("from_s"), &section.path("from_s"), message, "one of the two");
    }
    check_order(report, section, ["from_s", "to_s"]);
    check_order(report, section, ["from_hz", "to_hz"]);
}

/// Refuses an end that is not after its beginning.
fn check_order(report: &mut Report, section: &Section, [from, to]: [&str; 2]) {
    if let (Some(first), Some(last)) = (section.number(from), section.number(to))
        && !(last > first)
    {
        let message = format!("not above `{from}`");
        let (place, path) = (section.at(to), section.path(to));
        report.value(place, &path, message, format!("above {first:?}"));
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
    let text = |key: &str, default: &str| section.text(key).unwrap_or(default).to_owned();
    Choices {
        level: section.integer("level").unwrap_or(Choices::DEFAULT_LEVEL),
        category: text("category", Choices::DEFAULT_CATEGORY),
        speed: text("speed", Choices::DEFAULT_SPEED),
        air: section.text("air").and_then(Air::from_name).unwrap_or(Air::Smooth),
        first_aeroelastic_mode_hz: section.number("first_aeroelastic_mode_hz"),
    }
}

/// Refuses a choice that the set does not leave.
fn check_choices(report: &mut Report, section: &Section, chosen: &RequirementSet) {
    let keys = ["level", "category", "speed", "air", "first_aeroelastic_mode_hz"];
    for key in keys.into_iter().filter(|key| section.given(key) && !chosen.takes(key)) {
        let takes = |name: &&&str| set(name).is_some_and(|set| set.takes(key));
        let owners: Vec<String> =
            SET_NAMES.iter().filter(takes).map(|name| format!("\"{name}\"")).collect();
        let message = format!("the set \"{}\" leaves no such choice", chosen.name);
        let allowed = format!("with {}", owners.join(" or "));
        report.value(section.at(key), &section.path(key), message, allowed);
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
        section.sections("line").iter().for_each(|line| check_line(&mut report, line));
    }
    report.finish(name)?;
    section.as_ref().and_then(set_of).ok_or_else(|| Problems::new(name, Vec::new(), 0))
}

fn check_line(report: &mut Report, line: &Section) {
    if let Some(measure) = line.text("measure").and_then(Measure::from_name) {
        limits(report, line, measure);
        check_conditions(report, line, measure, &conditions(line));
    }
}

fn set_of(section: &Section) -> Option<RequirementSet> {
    let text = |key| section.text(key).unwrap_or_default().to_owned();
    let lines = section.sections("line").iter().map(line).collect::<Option<Vec<_>>>()?;
    Some(RequirementSet {
        name: text("name"),
        title: text("title"),
        source: text("source"),
        notes: text("notes"),
        lines,
    })
}

fn line(section: &Section) -> Option<SetLine> {
    let measure = Measure::from_name(section.text("measure")?)?;
    let least = section.number("least").or_else(|| measure.is_yes_or_no().then_some(1.0));
    let text = |key| section.text(key).map(str::to_owned);
    Some(SetLine {
        id: text("id")?,
        measure,
        least,
        most: section.number("most"),
        conditions: conditions(section),
        clause: text("clause")?,
        source: text("source")?,
        confidence: Confidence::from_name(section.text("confidence")?)?,
        note: text("note"),
        level: section.integer("level"),
        category: text("category"),
        speed: text("speed"),
        below_aeroelastic_mode: section.boolean("below_aeroelastic_mode").unwrap_or(false),
        above_aeroelastic_mode: section.boolean("above_aeroelastic_mode").unwrap_or(false),
    })
}
