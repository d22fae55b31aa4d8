//! Files that replay a line: the scenario with one controller, one requirement and what makes the worst case.

use std::path::{Component, Path, PathBuf};

use fspid_sim::{Controller, ElevatorSign, LinearPlant};

use super::Verification;
use crate::judgement::{Judgement, NotEvaluated, is_of_aircraft};
use fspid_scenario::file::{Extra, Replay, replay};
use fspid_scenario::measure::Family;

/// A scenario that gives the number of one line again, bit for bit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReplayFile {
    /// Name of the file.
    pub name: String,
    /// What is in it.
    pub text: String,
}

/// Longest part of a file name that a requirement or a controller gives, in characters.
const LONGEST: usize = 48;

impl Verification {
    /// One file for each judgement, in their order, to be written into a folder that exists: files that the scenario
    /// refers to are named from there. None for one that lacks what a file has to say, so that it could not be read.
    #[must_use]
    pub fn replays(&self, folder: &Path) -> Vec<ReplayFile> {
        let base = Path::new(&self.path).parent().unwrap_or(Path::new(""));
        let moved = |path: &str| moved(base, folder, path);
        let file = |(number, judgement): (usize, &Judgement)| {
            let (id, controller) = (slug(&judgement.requirement.id), slug(&judgement.controller));
            let name = format!("{number:02}-{id}-{controller}.toml");
            let body = self.replay(judgement, &moved);
            ReplayFile { name, text: format!("{}{body}", self.head(number, judgement)) }
        };
        let is_whole =
            |it: &(usize, &Judgement)| !matches!(it.1.found, Err(NotEvaluated::NoTarget));
        (1..).zip(&self.judgements).filter(is_whole).map(file).collect()
    }

    fn replay(&self, judgement: &Judgement, moved: &dyn Fn(&str) -> String) -> String {
        let scenario = &self.study.scenario;
        let place = judgement.place();
        let named = scenario.controllers.iter().find(|named| named.name == judgement.controller);
        let frozen = place.frozen.zip(named).map(|(frozen, named)| {
            let Controller::SelfTuning(_) = named.controller else {
                return (named.controller.nominal(), *named.controller.config());
            };
            (frozen.gains, named.controller.config_at(frozen.gains))
        });
        // A flight needs every plant; the loops and the aircraft are looked at one by one.
        let flown = matches!(
            judgement.requirement.measure.family(),
            Family::Step | Family::Flight | Family::Aircraft
        );
        let is_linear_unstable = place.spectral_radius.is_some() || judgement.found.is_err();
        let plant = place.plant.filter(|_| !flown || is_linear_unstable).map(|plant| plant.index);
        let sign = scenario.plant.linear().map(LinearPlant::elevator_sign);
        let asked = Replay {
            requirement: &judgement.requirement,
            controller: (!is_of_aircraft(&judgement.requirement))
                .then_some(judgement.controller.as_str()),
            frozen,
            plant,
            own_step_deg: judgement.own_step_deg,
            sign: sign.unwrap_or(ElevatorSign::NoseDownPositive),
        };
        let extra = Extra { overrides: &self.overrides, ..Extra::default() };
        // The text was read before, so that there is a replay.
        replay(&self.scenario_text, &extra, &asked, moved).unwrap_or_default()
    }

    fn head(&self, number: usize, judgement: &Judgement) -> String {
        let requirement = &judgement.requirement;
        let mut lines = vec![
            format!(
                "Replays line {number} of `fspid verify {}`: {} of {}.",
                self.path, requirement.id, judgement.controller
            ),
            format!(
                "{}: {}, {}.",
                if judgement.met { "PASS" } else { "FAIL" },
                match &judgement.found {
                    Ok(case) => format!("found {} ({:?})", judgement.value_in_words(), case.value),
                    Err(reason) => format!("could not be evaluated: {reason}"),
                },
                requirement.limits_in_words(),
            ),
        ];
        let place = judgement.place();
        if !place.is_empty() {
            lines.push(format!("Worst case: {place}."));
        }
        lines.push("`fspid verify` with this file gives the same number.".to_owned());
        lines.iter().map(|line| format!("# {}\n", one_line(line))).collect()
    }
}

/// A text without control characters, which no comment may hold.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// What a file name can hold everywhere.
fn slug(text: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    let slug: String = text.chars().take(LONGEST).map(safe).collect();
    slug.trim_matches('-').to_owned()
}

/// The path of a file as it is from another folder.
fn moved(base: &Path, folder: &Path, path: &str) -> String {
    let target = base.join(path);
    let relative = match (target.canonicalize(), folder.canonicalize()) {
        (Ok(target), Ok(folder)) => relative(&folder, &target),
        _ => target,
    };
    relative.to_string_lossy().into_owned()
}

/// The way from a folder to a file, both of them absolute; the file's own path where there is none.
fn relative(folder: &Path, target: &Path) -> PathBuf {
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (folder.components().collect(), target.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return target.to_owned();
    }
    let up = from.iter().skip(shared).map(|_| Component::ParentDir);
    up.chain(to.into_iter().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_from_a_folder_to_a_file_goes_up_to_what_they_share() {
        let way = |folder: &str, target: &str| relative(Path::new(folder), Path::new(target));
        assert_eq!(way("/a/b/replay", "/a/b/plant.toml"), Path::new("../plant.toml"));
        assert_eq!(way("/a/b", "/a/b/c/plant.toml"), Path::new("c/plant.toml"));
        assert_eq!(way("/x/y", "/a/plant.toml"), Path::new("../../a/plant.toml"));
    }

    #[test]
    fn a_file_name_holds_nothing_that_a_file_system_could_mind() {
        assert_eq!(slug("mil-f-9490d/phase margin ä:*"), "mil-f-9490d-phase-margin");
        assert_eq!(slug(&"x".repeat(100)).len(), LONGEST);
        assert_eq!(one_line("a\nb\u{7f}"), "a b ");
    }
}
