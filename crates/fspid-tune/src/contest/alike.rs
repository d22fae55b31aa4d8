//! Cases that some controllers have flown alike to the last bit: they are evidence once.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::flight::{Flight, MEASURES};
use super::judged::{Contestant, Judged};

/// What shows that a flight is another one.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Mark<'a> {
    failed: bool,
    /// Bits of the measures; none of a lost flight, which has its verdict and its reasons.
    measures: Option<[Option<u64>; MEASURES.len()]>,
    verdict: &'a str,
    reasons: &'a [String],
}

impl<'a> Mark<'a> {
    /// None of a flight that came back without a measure: of such nobody knows.
    fn of(flight: &'a Flight) -> Option<Self> {
        let failed = flight.failed;
        if flight.lost {
            let (verdict, reasons) = (flight.verdict.as_str(), flight.reasons.as_slice());
            return Some(Self { failed, measures: None, verdict, reasons });
        }
        let measures = flight.measures.map(|value| value.map(f64::to_bits));
        let is_measured = measures.iter().any(Option::is_some);
        is_measured.then_some(Self { failed, measures: Some(measures), verdict: "", reasons: &[] })
    }
}

/// Of each case the first earlier one that all designs of some controllers have flown alike, if there is one. What others
/// make of it is no matter: a case that only a third controller can tell from another is one case between two.
pub(super) fn twins(judged: &Judged, contestants: &[&Contestant]) -> Vec<Option<usize>> {
    let mut firsts = BTreeMap::new();
    let twin = |case: usize| match firsts.entry(marks(judged, contestants, case)?) {
        Entry::Occupied(first) => Some(*first.get()),
        Entry::Vacant(place) => {
            place.insert(case);
            None
        }
    };
    judged.all().into_iter().map(twin).collect()
}

/// The marks of all flights of a case; none where nobody came back, for lost flights alone show too little.
fn marks<'a>(
    judged: &Judged,
    contestants: &[&'a Contestant],
    case: usize,
) -> Option<Vec<Mark<'a>>> {
    let designs = contestants.iter().flat_map(|it| &it.designs);
    let flights = designs.flat_map(|design| judged.flights(design, case));
    let marks: Vec<Mark<'_>> = flights.map(Mark::of).collect::<Option<_>>()?;
    marks.iter().any(|mark| mark.measures.is_some()).then_some(marks)
}
