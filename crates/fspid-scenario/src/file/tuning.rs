//! Tuning and contest as files have them.

use crate::file::dispersion::placed_texts;
use crate::file::overrides;
use crate::file::requirement::{limit_requirement, objective_requirement};
use crate::file::spec::FRONT;
use crate::file::spec::tuning as keys;
use crate::file::spec::tuning::{ConstantLoadWord, OverWord};
use crate::keyed::{Key, Section};
use crate::measure::Measure;
use crate::requirement::Requirement;
use crate::setting_path::renamed;
use crate::tuning::{Case, Contest, Objective, Over, Tuning};
use fspid_diagnostics::Report;

/// Share of the flights that counts in a tail, unless another is asked for.
const USUAL_SHARE: f64 = 0.2;

/// The tuning of a scenario whose controllers have these names.
pub(crate) fn tuning(report: &mut Report, section: &Section, names: &[&str]) -> Option<Tuning> {
    check_controller(report, section, keys::CONTROLLER, names);
    let sections = section.sections(keys::OBJECTIVE);
    let objectives: Vec<Objective> = sections
        .iter()
        .filter(|part| part.sound)
        .enumerate()
        .filter_map(|(index, part)| objective(report, part, index))
        .collect();
    let optimiser = section.get(keys::OPTIMISER)?.to_owned();
    if optimiser == FRONT && objectives.len() < 2 && sections.len() < 2 {
        let message = "a front needs two objectives";
        section.wrong(report, keys::OPTIMISER, message, "two [[tuning.objective]] or more");
    }
    let over = match section.get(keys::OVER)? {
        OverWord::Mean => Over::Mean,
        OverWord::Worst => Over::Worst,
        OverWord::Tail => Over::Tail { share: section.get(keys::SHARE).unwrap_or(USUAL_SHARE) },
    };
    if section.given(keys::SHARE) && !matches!(over, Over::Tail { .. }) {
        let message = "says nothing where `over` is not \"tail\"";
        section.wrong(report, keys::SHARE, message, "over = \"tail\"");
    }
    Some(Tuning {
        optimiser,
        budget: section.get(keys::BUDGET)? as usize,
        seed: section.get(keys::SEED)? as u64,
        controller: section.get(keys::CONTROLLER).map(str::to_owned),
        over,
        runs: section.get(keys::RUNS)? as u64,
        run_seed: section.get(keys::RUN_SEED)? as u64,
        cases: cases(report, section.sections(keys::CASE), |_| None),
        objectives,
        limits: limits(report, section),
        removes_constant_load: section.get(keys::CONSTANT_LOAD)? == ConstantLoadWord::Removed,
    })
}

/// The contest of a scenario whose controllers have these names.
pub(crate) fn contest(report: &mut Report, section: &Section, names: &[&str]) -> Option<Contest> {
    check_controller(report, section, keys::AGAINST, names);
    check_mirrors(report, section.sections(keys::CONTEST_CASE));
    Some(Contest {
        seeds: section.get(keys::SEEDS)? as u64,
        cases: cases(report, section.sections(keys::CONTEST_CASE), mirror),
        runs: section.get(keys::RUNS)? as u64,
        run_seed: section.get(keys::RUN_SEED)? as u64,
        against: section.get(keys::AGAINST).map(str::to_owned),
    })
}

fn check_controller(report: &mut Report, section: &Section, key: Key<str>, names: &[&str]) {
    if let Some(name) = section.get(key)
        && !names.contains(&name)
    {
        let message = "no controller has this name";
        section.wrong(report, key, message, names.join(", "));
    }
}

fn objective(report: &mut Report, section: &Section, index: usize) -> Option<Objective> {
    let weight = section.get(keys::OBJECTIVE_WEIGHT)?;
    if weight == 0.0 {
        let message = "an objective that costs nothing";
        section.wrong(report, keys::OBJECTIVE_WEIGHT, message, "a finite number other than 0");
        return None;
    }
    let requirement = objective_requirement(report, section, (index, weight > 0.0))?;
    Some(Objective { requirement, weight, reference: section.get(keys::REFERENCE) })
}

/// Limits of means.
fn limits(report: &mut Report, section: &Section) -> Vec<Requirement> {
    for part in section.sections(keys::LIMIT) {
        if part.get(keys::LIMIT_MEASURE).is_some_and(Measure::is_yes_or_no) {
            let message = "has no mean that could be limited: it is yes or no";
            let allowed = "a measure with a unit or a number; as a [[requirement]] it is asked of each flight";
            part.wrong(report, keys::LIMIT_MEASURE, message, allowed);
        }
    }
    let sound = section.sections(keys::LIMIT).iter().filter(|part| part.sound).enumerate();
    sound.filter_map(|(index, part)| limit_requirement(report, part, index)).collect()
}

/// Name of the case that a case of a contest is the mirror image of.
fn mirror(section: &Section) -> Option<String> {
    section.get(keys::MIRROR_OF).map(str::to_owned)
}

fn cases(
    report: &mut Report,
    sections: &[Section],
    mirror_of: fn(&Section) -> Option<String>,
) -> Vec<Case> {
    for (index, section) in sections.iter().enumerate() {
        let earlier = sections.get(..index).unwrap_or_default();
        let name = section.get(keys::NAME);
        if let Some(twin) = earlier.iter().find(|it| name.is_some() && it.get(keys::NAME) == name) {
            let message = format!("the name is taken by {}", twin.path);
            section.wrong(report, keys::NAME, message, "a name of its own");
        }
    }
    sections
        .iter()
        .filter(|section| section.sound)
        .filter_map(|it| Some(Case { mirror_of: mirror_of(it), ..case(report, it)? }))
        .collect()
}

fn case(report: &mut Report, section: &Section) -> Option<Case> {
    let item = section.get(keys::SET)?;
    let set = placed_texts(item);
    if set.is_none() {
        let allowed = overrides::listed_in_words();
        report.value(item.place, &section.path(keys::SET), "no list of changes", allowed);
    }
    Some(Case {
        name: section.get(keys::NAME)?.to_owned(),
        group: section.get(keys::GROUP).unwrap_or_default().to_owned(),
        set: set?.into_iter().map(|(place, it)| renamed::in_change(report, place, it)).collect(),
        weight: section.get(keys::CASE_WEIGHT)?,
        mirror_of: None,
    })
}

fn check_mirrors(report: &mut Report, sections: &[Section]) {
    for section in sections {
        let Some(mirrored) = section.get(keys::MIRROR_OF) else {
            continue;
        };
        let is_other = |it: &&Section| it.get(keys::NAME) != section.get(keys::NAME);
        let mut others = sections.iter().filter(is_other).filter_map(|it| it.get(keys::NAME));
        if !others.any(|name| name == mirrored) {
            let message = "no other case has this name";
            let allowed = "the name of another [[contest.case]]";
            section.wrong(report, keys::MIRROR_OF, message, allowed);
        }
    }
}
