//! Cases that some controllers have flown alike: they are evidence once.

use super::flight::Flight;
use super::judged::{Contestant, Judged};

/// Of each case the first earlier one that all designs of some controllers have flown alike, if there is one. What others
/// make of it is no matter: a case that only a third controller can tell from another is one case between two.
pub(super) fn twins(judged: &Judged, contestants: &[&Contestant]) -> Vec<Option<usize>> {
    let mut firsts: Vec<(usize, Vec<&Flight>)> = Vec::new();
    let twin = |case: usize| {
        let flights = flights(judged, contestants, case)?;
        let are_copies = |first: &[&Flight]| {
            first.len() == flights.len()
                && first.iter().zip(&flights).all(|(one, other)| other.is_copy_of(one))
        };
        let first = firsts.iter().find(|(_, first)| are_copies(first)).map(|(place, _)| *place);
        if first.is_none() {
            firsts.push((case, flights));
        }
        first
    };
    judged.all().into_iter().map(twin).collect()
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
