//! Tuning and contest as files have them.

use crate::file::dispersion::placed_texts;
use crate::file::requirement::{limit_requirement, objective_requirement};
use crate::file::section::Section;
use crate::file::spec::FRONT;
use crate::file::spec::tuning::{ConstantLoadWord, OverWord};
use crate::file::{overrides, renamed};
use crate::measure::Measure;
use crate::requirement::Requirement;
use crate::tuning::{Case, Contest, Objective, Over, Tuning};
use fspid_diagnostics::Report;

/// Share of the flights that counts in a tail, unless another is asked for.
const USUAL_SHARE: f64 = 0.2;

/// The tuning of a scenario whose controllers have these names.
pub(crate) fn tuning(report: &mut Report, section: &Section, names: &[&str]) -> Option<Tuning> {
    check_controller(report, section, "controller", names);
    let sections = section.sections("objective");
    let objectives: Vec<Objective> = sections
        .iter()
        .filter(|part| part.sound)
        .enumerate()
        .filter_map(|(index, part)| objective(report, part, index))
        .collect();
    let optimiser = section.text("optimiser")?.to_owned();
    if optimiser == FRONT && objectives.len() < 2 && sections.len() < 2 {
        let message = "a front needs two objectives";
        report.value(
            section.at("optimiser"),
            &section.path("optimiser"),
            message,
            "two [[tuning.objective]] or more",
        );
    }
    let over = match section.word("over")? {
        OverWord::Mean => Over::Mean,
        OverWord::Worst => Over::Worst,
        OverWord::Tail => Over::Tail { share: section.number("share").unwrap_or(USUAL_SHARE) },
    };
    if section.given("share") && !matches!(over, Over::Tail { .. }) {
        let message = "says nothing where `over` is not \"tail\"";
        report.value(section.at("share"), &section.path("share"), message, "over = \"tail\"");
    }
    Some(Tuning {
        optimiser,
        budget: section.integer("budget")? as usize,
        seed: section.integer("seed")? as u64,
        controller: section.text("controller").map(str::to_owned),
        over,
        runs: section.integer("runs")? as u64,
        run_seed: section.integer("run_seed")? as u64,
        cases: cases(report, section.sections("case")),
        objectives,
        limits: limits(report, section),
        removes_constant_load: section.word::<ConstantLoadWord>("constant_load")?
            == ConstantLoadWord::Removed,
    })
}

/// The contest of a scenario whose controllers have these names.
pub(crate) fn contest(report: &mut Report, section: &Section, names: &[&str]) -> Option<Contest> {
    check_controller(report, section, "against", names);
    check_mirrors(report, section.sections("case"));
    Some(Contest {
        seeds: section.integer("seeds")? as u64,
        cases: cases(report, section.sections("case")),
        runs: section.integer("runs")? as u64,
        run_seed: section.integer("run_seed")? as u64,
        against: section.text("against").map(str::to_owned),
    })
}

fn check_controller(report: &mut Report, section: &Section, key: &str, names: &[&str]) {
    if let Some(name) = section.text(key)
        && !names.contains(&name)
    {
        let message = "no controller has this name";
        report.value(section.at(key), &section.path(key), message, names.join(", "));
    }
}

fn objective(report: &mut Report, section: &Section, index: usize) -> Option<Objective> {
    let weight = section.number("weight")?;
    if weight == 0.0 {
        let message = "an objective that costs nothing";
        report.value(
            section.at("weight"),
            &section.path("weight"),
            message,
            "a finite number other than 0",
        );
        return None;
    }
    let requirement = objective_requirement(report, section, (index, weight > 0.0))?;
    Some(Objective { requirement, weight, reference: section.number("reference") })
}

/// Limits of means.
fn limits(report: &mut Report, section: &Section) -> Vec<Requirement> {
    for part in section.sections("limit") {
        if part.text("measure").and_then(Measure::from_name).is_some_and(Measure::is_yes_or_no) {
            let message = "has no mean that could be limited: it is yes or no";
            let allowed = "a measure with a unit or a number; as a [[requirement]] it is asked of each flight";
            report.value(part.at("measure"), &part.path("measure"), message, allowed);
        }
    }
    let sound = section.sections("limit").iter().filter(|part| part.sound).enumerate();
    sound.filter_map(|(index, part)| limit_requirement(report, part, index)).collect()
}

fn cases(report: &mut Report, sections: &[Section]) -> Vec<Case> {
    for (index, section) in sections.iter().enumerate() {
        let earlier = sections.get(..index).unwrap_or_default();
        let name = section.text("name");
        if let Some(twin) = earlier.iter().find(|it| name.is_some() && it.text("name") == name) {
            let message = format!("the name is taken by {}", twin.path);
            report.value(section.at("name"), &section.path("name"), message, "a name of its own");
        }
    }
    sections.iter().filter(|section| section.sound).filter_map(|it| case(report, it)).collect()
}

fn case(report: &mut Report, section: &Section) -> Option<Case> {
    let item = section.item("set")?;
    let set = placed_texts(item);
    if set.is_none() {
        let allowed = overrides::listed_in_words();
        report.value(item.place, &section.path("set"), "no list of changes", allowed);
    }
    Some(Case {
        name: section.text("name")?.to_owned(),
        group: section.text("group").unwrap_or_default().to_owned(),
        set: set?.into_iter().map(|(place, it)| renamed::in_change(report, place, it)).collect(),
        weight: section.number("weight")?,
        mirror_of: section.text("mirror_of").map(str::to_owned),
    })
}

fn check_mirrors(report: &mut Report, sections: &[Section]) {
    for section in sections {
        let Some(mirrored) = section.text("mirror_of") else {
            continue;
        };
        let is_other = |it: &&Section| it.text("name") != section.text("name");
        let mut others = sections.iter().filter(is_other).filter_map(|it| it.text("name"));
        if !others.any(|name| name == mirrored) {
            let message = "no other case has this name";
            let allowed = "the name of another [[contest.case]]";
            report.value(section.at("mirror_of"), &section.path("mirror_of"), message, allowed);
        }
    }
}
