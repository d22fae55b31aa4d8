use super::super::judged::{Case, Design};
use super::*;
use crate::contest::flight::{Flight, MEASURES};

/// A flight of which every measure is this.
fn flown(value: f64) -> Flight {
    Flight {
        counted: [Some(value); MEASURES.len()],
        cost: Some(value),
        lost: false,
        failed: false,
        ..Flight::refused(String::new())
    }
}

fn lost() -> Flight {
    Flight::refused("lost".to_owned())
}

/// Flights of one measure, the first of which fail.
fn failing(count: usize, of: usize) -> Vec<Flight> {
    (0..of).map(|case| Flight { failed: case < count, ..flown(1.0) }).collect()
}

fn all(values: &[f64]) -> Vec<Flight> {
    values.iter().copied().map(flown).collect()
}

/// A controller of a design for each list of flights, one flight a case; tuned if there are several designs.
fn controller(designs: &[Vec<Flight>]) -> Contestant {
    let design = |flights: &Vec<Flight>| Design { found: None, flights: flights.clone() };
    Contestant {
        name: String::new(),
        is_tuned: designs.len() > 1,
        designs: designs.iter().map(design).collect(),
    }
}

/// A contest against the first; the first half of the cases is a group, and the last case counts three times.
fn contest(contestants: Vec<Contestant>) -> Judged {
    let count = contestants[0].designs[0].flights.len();
    let case = |place: usize| Case {
        name: format!("case {place}"),
        group: if 2 * place < count { "first" } else { "second" }.to_owned(),
        set: Vec::new(),
        weight: if place + 1 == count { 3.0 } else { 1.0 },
        runs: 1,
        draws_seed: None,
        mirror_of: None,
    };
    Judged::new(contestants, (0..count).map(case).collect(), 0)
}

fn error(judged: &Judged) -> Vec<Comparison> {
    compared(judged, Quantity::ERROR).expect("all errors are above 0")
}

/// How the second stands against the first, each with one design.
fn duel(theirs: &[Flight], mine: &[Flight]) -> Comparison {
    let [mine, theirs] = [mine, theirs].map(|it| controller(&[it.to_vec()]));
    error(&contest(vec![theirs, mine])).remove(0)
}

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-12 * expected.abs().max(1.0)
}

#[test]
fn ratios_are_geometric_means_over_cases_and_designs_and_means_count_by_weight() {
    let theirs = [[1.0, 2.0, 4.0, 8.0], [4.0, 8.0, 16.0, 32.0]];
    let mine = [[2.0, 2.0, 2.0, 32.0], [8.0, 8.0, 8.0, 128.0]];
    let [theirs, mine] = [theirs, mine].map(|it| controller(&it.map(|values| all(&values))));
    let judged = contest(vec![theirs, mine]);
    let [found] = error(&judged).try_into().expect("one other");
    assert_eq!(found.contestant, 1);
    // Twice, once, half and four times.
    let expected = [2.0, 1.0, 0.5, 4.0];
    assert!(found.cases.iter().zip(expected).all(|(a, b)| close(*a, libm::log(b))), "{found:?}");
    assert!(found.ratio.mean.is_some_and(|it| close(it, libm::sqrt(2.0))), "{found:?}");
    assert_eq!(found.ratio.cases, 4);
    let groups: Vec<f64> = found.groups.iter().filter_map(|it| it.mean).collect();
    assert!(groups.len() == 2 && groups.iter().all(|it| close(*it, libm::sqrt(2.0))), "{groups:?}");
    assert!(found.groups.iter().all(|it| it.cases == 2 && it.interval.is_none()));
    // (2 + 2 + 2 + 3 x 32) over (1 + 2 + 4 + 3 x 8); the other design is four times both.
    assert!(found.ratio_of_means.is_some_and(|it| close(it, 102.0 / 31.0)), "{found:?}");
    assert_eq!(found.lost, Lost { cases: 0, p: 1.0, p_adjusted: 1.0 });
}

#[test]
fn intervals_of_all_controllers_hold_together_and_those_of_groups_each_by_itself() {
    let theirs = all(&[1.0; 8]);
    let values = [0.7, 0.8, 0.9, 0.75, 0.6, 0.85, 0.8, 0.7];
    let more = values.map(|it| 1.1 * it);
    let judged = contest(vec![
        controller(&[theirs]),
        controller(&[all(&values)]),
        controller(&[all(&more)]),
    ]);
    let found = error(&judged);
    assert_eq!(found.iter().map(|it| it.contestant).collect::<Vec<_>>(), [1, 2]);
    let logarithms =
        |values: &[f64]| vec![values.iter().map(|it| libm::log(*it)).collect::<Vec<_>>()];
    let expected = |values: &[f64], confidence| {
        let over = TwoWay::of(&logarithms(values), &[vec![0.0; values.len()]]).expect("finite");
        over.interval(confidence).expect("enough cases").map(libm::exp)
    };
    for (found, values) in found.iter().zip([values, more]) {
        let all = [
            (found.ratio, expected(&values, 0.975)),
            (found.groups[0], expected(&values[..4], 0.95)),
            (found.groups[1], expected(&values[4..], 0.95)),
        ];
        for (ratio, expected) in all {
            let interval = ratio.interval.expect("an interval");
            assert!(interval.iter().zip(expected).all(|(a, b)| close(*a, b)), "{interval:?}");
        }
        let typical = found.typical.expect("cases");
        // All eight are below: 2 / 2⁸.
        assert!(close(typical.p, 2.0 / 256.0), "{typical:?}");
        let over = TwoWay::of(&logarithms(&values), &[vec![0.0; 8]]).expect("finite");
        assert!(close(found.p, over.p().max(typical.p)), "{found:?}");
    }
    let adjusted = holm(&found.iter().map(|it| it.p).collect::<Vec<_>>());
    assert_eq!(found.iter().map(|it| it.p_adjusted).collect::<Vec<_>>(), adjusted);
    assert!(found[0].p_adjusted > found[0].p);
}

#[test]
fn one_other_controller_has_the_whole_confidence() {
    let values = [0.7, 0.8, 0.9, 0.75, 0.6, 0.85];
    let found = duel(&all(&[1.0; 6]), &all(&values));
    let logarithms = values.map(libm::log).to_vec();
    let over = TwoWay::of(&[logarithms], &[vec![0.0; 6]]).expect("finite");
    let expected = over.interval(0.95).expect("enough cases").map(libm::exp);
    let interval = found.ratio.interval.expect("an interval");
    assert!(interval.iter().zip(expected).all(|(a, b)| close(*a, b)), "{interval:?}");
}

#[test]
fn tests_that_point_in_different_directions_have_found_nothing() {
    // Eleven small gains and a large loss: the mean is a loss, the typical case a gain.
    let mut mine = [0.9; 12];
    mine[11] = 20.0;
    let found = duel(&all(&[1.0; 12]), &all(&mine));
    let typical = found.typical.expect("cases");
    assert!(typical.estimate < 0.0 && found.ratio.mean.is_some_and(|it| it > 1.0), "{found:?}");
    assert!(typical.p < 0.05 && close(found.p, 1.0), "{found:?}");
    assert_eq!(found.standing, Standing::Open);
    // The typical case is none at all: that is no other direction.
    let mut mine = [1.0; 13];
    mine[..3].fill(0.5);
    let found = duel(&all(&[1.0; 13]), &all(&mine));
    let typical = found.typical.expect("cases");
    assert!(close(typical.estimate, 0.0) && close(typical.p, 0.25), "{typical:?}");
    assert!(close(found.p, 0.25), "{found:?}");
}

#[test]
fn flights_that_one_loses_stand_at_the_end_of_all_cases_and_out_of_the_ratio() {
    let theirs = [lost(), flown(1.0), lost(), flown(1.0), flown(1.0), flown(2.0)];
    let mine = [flown(1.0), lost(), lost(), flown(0.5), flown(0.5), flown(1.0)];
    let found = duel(&theirs, &mine);
    let half = libm::log(0.5);
    assert_eq!(found.cases[..3], [f64::NEG_INFINITY, f64::INFINITY, 0.0]);
    assert!(found.cases[3..].iter().all(|it| close(*it, half)), "{found:?}");
    assert!(found.ratio.cases == 3 && found.ratio.mean.is_some_and(|it| close(it, 0.5)));
    assert_eq!(found.lost.cases, 2);
    assert!(close(found.lost.p, 1.0), "one each");
    // Nothing is left of the first group but its last case, and where both lose a flight there are no means.
    assert_eq!(found.groups.iter().map(|it| it.cases).collect::<Vec<_>>(), [0, 3]);
    assert_eq!((found.groups[0].mean, found.groups[0].interval), (None, None));
    assert_eq!(found.ratio_of_means, None);
    let found = duel(&all(&[1.0; 6]), &mine);
    assert_eq!(found.ratio_of_means, Some(f64::INFINITY));
    // Of designs that lose the same share on a case nobody is better there.
    let one_of_two = [vec![lost(), flown(1.0)], vec![flown(1.0), flown(1.0)]];
    let other_of_two = [vec![flown(3.0), flown(2.0)], vec![lost(), flown(2.0)]];
    let judged = contest(vec![controller(&one_of_two), controller(&other_of_two)]);
    assert_eq!(error(&judged)[0].cases, [0.0, libm::log(2.0)]);
}

#[test]
fn who_loses_more_flights_is_behind_whatever_the_error() {
    let with_lost = |count: usize, value: f64| -> Vec<Flight> {
        (0..8).map(|case| if case < count { lost() } else { flown(value) }).collect()
    };
    // Half the error, and flights that are lost.
    for (theirs, mine, standing, p) in [
        (0, 6, Standing::Worse, 2.0 / 64.0),
        (6, 0, Standing::Better, 2.0 / 64.0),
        (2, 1, Standing::Better, 1.0),
        (1, 2, Standing::Worse, 1.0),
    ] {
        let found = duel(&with_lost(theirs, 1.0), &with_lost(mine, 0.5));
        assert_eq!((found.standing, found.by_flights), (standing, true), "{theirs} {mine}");
        assert!(close(found.lost.p, p) && found.lost.cases == theirs.abs_diff(mine), "{found:?}");
        assert!(close(found.lost.p_adjusted, p) && found.is_sure == (p < 0.05), "{found:?}");
    }
    // As many, and not the same: the error decides.
    let found = duel(&with_lost(1, 1.0), &with_lost(1, 0.5));
    assert_eq!((found.standing, found.by_flights), (Standing::Better, false));
    // Of two others each has twice the p-value to be sure of it.
    let judged = contest(
        [with_lost(0, 1.0), with_lost(6, 0.5), with_lost(6, 0.5)]
            .map(|it| controller(&[it]))
            .to_vec(),
    );
    for found in error(&judged) {
        assert!(close(found.lost.p_adjusted, 4.0 / 64.0) && !found.is_sure, "{found:?}");
        assert_eq!((found.standing, found.by_flights), (Standing::Worse, true));
    }
}

#[test]
fn what_is_significant_is_ahead_or_behind_and_sure_where_it_was_tuned_more_than_once() {
    let values = [0.7, 0.8, 0.9, 0.75, 0.6, 0.85];
    let (ones, over) = (all(&[1.0; 6]), values.map(|it| 1.0 / it));
    let ahead = duel(&ones, &all(&values));
    assert_eq!((ahead.standing, ahead.is_sure, ahead.bar), (Standing::Better, true, None));
    let behind = duel(&ones, &all(&over));
    assert_eq!((behind.standing, behind.is_sure, behind.bar), (Standing::Worse, true, None));
    // Five cases say too little, whatever they say.
    let few = duel(&ones[..5], &all(&values[..5]));
    assert!(few.p > 0.05 && few.p < 0.1, "{few:?}");
    assert_eq!((few.standing, few.is_sure), (Standing::Open, false));
    let tuned =
        |designs: usize| Contestant { is_tuned: true, ..controller(&vec![all(&values); designs]) };
    for (designs, is_sure) in [(1, false), (2, true)] {
        let judged = contest(vec![controller(std::slice::from_ref(&ones)), tuned(designs)]);
        let found = error(&judged).remove(0);
        assert_eq!((found.standing, found.is_sure), (Standing::Better, is_sure));
    }
}

#[test]
fn who_fails_more_is_not_called_better() {
    let better = |flights: Vec<Flight>| -> Vec<Flight> {
        let values = [0.7, 0.8, 0.9, 0.75, 0.6, 0.85, 0.8, 0.7, 0.65, 0.9];
        let halved = |(flight, value): (Flight, f64)| Flight {
            failed: flight.failed,
            unstable: flight.unstable,
            ..flown(value)
        };
        flights.into_iter().zip(values).map(halved).collect()
    };
    let unstable = |count: usize| -> Vec<Flight> {
        (0..10).map(|case| Flight { unstable: case < count, ..flown(1.0) }).collect()
    };
    let last = |count: usize| -> Vec<Flight> {
        (0..10).map(|case| Flight { failed: case + count >= 10, ..flown(1.0) }).collect()
    };
    let barred_by = |bar| (Standing::Barred, Some((true, bar)));
    let sound = (Standing::Better, None);
    for (theirs, mine, expected) in [
        (failing(0, 10), failing(0, 10), sound),
        // All of it, even where the other fails all too.
        (failing(0, 10), failing(10, 10), barred_by(Bar::AllFail)),
        (failing(10, 10), failing(10, 10), barred_by(Bar::AllFail)),
        (failing(10, 10), failing(9, 10), sound),
        // Six of the same sign are significant, five are not.
        (failing(0, 10), failing(6, 10), barred_by(Bar::FailsMore)),
        (failing(0, 10), failing(5, 10), sound),
        (failing(6, 10), failing(0, 10), sound),
        // Five on one side and three on the other.
        (last(3), failing(5, 10), sound),
        // One of a loop that is unstable is enough.
        (unstable(0), unstable(1), barred_by(Bar::Unstable)),
        (unstable(1), unstable(1), sound),
        (unstable(2), unstable(1), sound),
    ] {
        let found = duel(&theirs, &better(mine.clone()));
        assert_eq!((found.standing, found.bar), expected, "{found:?}");
        assert_eq!(found.is_sure, expected.1.is_none());
        // The other way round it is the one that is compared with who is barred.
        let found = duel(&better(mine), &theirs);
        let bar = expected.1.map(|(_, bar)| (false, bar));
        let standing = if bar.is_some() { Standing::Barred } else { Standing::Worse };
        assert_eq!((found.standing, found.bar), (standing, bar), "{found:?}");
        assert_eq!(found.is_sure, bar.is_none());
    }
    // What is not ahead needs no bar.
    let found = duel(&failing(0, 10), &failing(10, 10));
    assert_eq!((found.standing, found.bar), (Standing::Open, None));
}

#[test]
fn a_quantity_that_is_zero_or_missing_somewhere_has_no_ratios() {
    let ones = controller(&[all(&[1.0; 4])]);
    let with = |flight: Flight| {
        let mut flights = all(&[1.0; 4]);
        flights[2] = flight;
        compared(&contest(vec![ones.clone(), controller(&[flights])]), Quantity::ERROR)
    };
    assert!(with(flown(1e-300)).is_some());
    assert!(with(flown(0.0)).is_none());
    assert!(with(Flight { counted: [None; MEASURES.len()], ..flown(1.0) }).is_none());
    // The cost of a flight without one is infinite.
    let costless = Flight { cost: None, ..flown(1.0) };
    let flights = vec![flown(0.5), costless, flown(0.5), flown(0.5)];
    let judged = contest(vec![ones, controller(&[flights])]);
    let found = compared(&judged, Quantity::Cost).expect("above 0").remove(0);
    assert_eq!(found.cases[1], f64::INFINITY);
    assert_eq!((found.ratio.mean, found.ratio.cases), (None, 4));
    assert_eq!(found.ratio_of_means, Some(f64::INFINITY));
    // Of both infinite nobody knows.
    let mut judged = judged;
    judged.contestants[0].designs[0].flights[1].cost = None;
    let found = compared(&judged, Quantity::Cost).expect("above 0").remove(0);
    assert_eq!(found.cases[1].to_bits(), 0.0_f64.to_bits());
}
