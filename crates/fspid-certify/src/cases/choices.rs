//! What dispersions choose among, one combination after the other.

use fspid_scenario::dispersion::{Dispersion, Distribution};
use fspid_scenario::file::Study;

use super::{Change, NoCases};
use crate::family;

/// True of a dispersion that chooses among values that are no numbers of a family, and that a claim depends on: another aircraft,
/// another delay, another set-point or load.
pub(in super::super) fn is_chosen_apart(dispersion: &Dispersion) -> bool {
    matches!(dispersion.distribution, Distribution::Choice(_))
        && !dispersion.relative
        && !family::is_in_a_box(dispersion)
        && !family::is_in_no_claim(dispersion)
}

fn apart(study: &Study) -> impl Iterator<Item = &Dispersion> {
    study.dispersions.iter().filter(|it| is_chosen_apart(it))
}

/// True where nothing of a loop differs but by choices that are certified one by one.
pub(in super::super) fn only_choices_differ(study: &Study) -> bool {
    let is_settled = |it: &Dispersion| is_chosen_apart(it) || family::is_outside_of_the_loop(it);
    apart(study).next().is_some() && study.dispersions.iter().all(is_settled)
}

/// Refuses choices that would stay as they are in all combinations, beside the word that all are proved.
///
/// # Errors
/// [`NoCases::InAFamily`] with their names.
pub(super) fn all_are_apart(study: &Study) -> Result<(), NoCases> {
    let is_left = |it: &&Dispersion| {
        let is_chosen = matches!(it.distribution, Distribution::Choice(_));
        is_chosen && !is_chosen_apart(it) && !family::is_in_no_claim(it)
    };
    let left: Vec<&Dispersion> = study.dispersions.iter().filter(is_left).collect();
    // Where each is a factor of what stands there, nothing is to be set.
    let (factors, numbers): (Vec<&Dispersion>, Vec<&Dispersion>) =
        left.into_iter().partition(|it| it.relative && !family::is_in_a_box(it));
    match (factors.is_empty(), numbers.is_empty()) {
        (true, true) => Ok(()),
        (false, _) => Err(NoCases::Factors(named(&factors))),
        (true, false) => Err(NoCases::InAFamily(named(&numbers))),
    }
}

/// Their paths.
fn named(dispersions: &[&Dispersion]) -> String {
    let targets = dispersions.iter().flat_map(|it| &it.targets);
    let paths = targets.flat_map(|target| &target.paths);
    paths.map(|path| format!("`{}`", path.text())).collect::<Vec<_>>().join(", ")
}

/// How many combinations there are; 0 where nothing is chosen.
pub(super) fn count(study: &Study) -> usize {
    let each = || apart(study).map(|it| it.choices.len());
    if each().next().is_none() { 0 } else { each().fold(1, usize::saturating_mul) }
}

/// All combinations, the last dispersion changing fastest.
pub(super) fn all(study: &Study) -> Vec<Change> {
    let none = Change { name: String::new(), set: Vec::new() };
    let combined = apart(study).fold(vec![none], |before, dispersion| {
        before.iter().flat_map(|one| with_each(one, dispersion)).collect()
    });
    // Without a dispersion that chooses there is one combination, of nothing.
    combined.into_iter().filter(|it| !it.set.is_empty()).collect()
}

/// A combination with each choice of one more dispersion.
fn with_each(one: &Change, dispersion: &Dispersion) -> Vec<Change> {
    let targets = &dispersion.targets;
    let each = dispersion.choices.iter().map(|value| {
        let mut set = one.set.clone();
        let paths = targets.iter().flat_map(|target| &target.paths);
        set.extend(paths.map(|path| format!("{}={value}", path.text())));
        let told = targets.iter().map(|target| format!("{} {value}", target.name));
        let words = (!one.name.is_empty()).then(|| one.name.clone()).into_iter().chain(told);
        Change { name: words.collect::<Vec<_>>().join(", ").replace('"', ""), set }
    });
    each.collect()
}
