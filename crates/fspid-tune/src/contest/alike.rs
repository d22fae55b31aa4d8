//! Cases that some controllers have flown alike, or in another size: they are evidence once.

use super::flight::Flight;
use super::judged::{Contestant, Judged};

/// Of each case the first earlier one that all designs of some controllers have flown alike, or in one other size. What others
/// make of it is no matter: a case that only a third controller can tell from another is one case between two.
pub(super) fn twins(judged: &Judged, contestants: &[&Contestant]) -> Vec<Option<usize>> {
    let mut firsts: Vec<(usize, Vec<&Flight>)> = Vec::new();
    let twin = |case: usize| {
        let flights = flights(judged, contestants, case)?;
        let are_copies = |first: &[&Flight]| are_copies(&flights, first);
        let first = firsts.iter().find(|(_, first)| are_copies(first)).map(|(place, _)| *place);
        if first.is_none() {
            firsts.push((case, flights));
        }
        first
    };
    judged.all().into_iter().map(twin).collect()
}

/// True for flights that show nothing that others, one by one, do not: each is a copy, or all are in one other size, as a linear
/// loop flies a step of another size.
fn are_copies(flights: &[&Flight], others: &[&Flight]) -> bool {
    let pairs = || flights.iter().zip(others);
    flights.len() == others.len()
        && (pairs().all(|(one, other)| one.is_copy_of(other))
            || are_in_another_size(flights, others))
}

/// The same of flights that are all in one other size.
pub(super) fn are_in_another_size(flights: &[&Flight], others: &[&Flight]) -> bool {
    let mut pairs = flights.iter().zip(others);
    let size = pairs.clone().find_map(|(one, other)| one.size_beside(other));
    size.is_some_and(|size| pairs.all(|(one, other)| one.is_copy_in_size(other, size)))
}

/// All flights of a case; none where one came back without a measure, of which nobody knows, or nobody came back at all, for
/// lost flights alone show too little.
fn flights<'a>(
    judged: &Judged,
    contestants: &[&'a Contestant],
    case: usize,
) -> Option<Vec<&'a Flight>> {
    let designs = contestants.iter().flat_map(|it| &it.designs);
    let flights: Vec<&Flight> = designs.flat_map(|design| judged.flights(design, case)).collect();
    let is_measured = |it: &&Flight| it.measures.iter().any(Option::is_some);
    let are_told = flights.iter().all(|it| it.lost || is_measured(it));
    (are_told && flights.iter().any(|it| !it.lost)).then_some(flights)
}
