use super::*;
use crate::contest::{Case, Contestant, Design, Flight, MEASURES, OVERSHOOT, Quantity, TwoWay};
use crate::draw::Draw;

/// How much cases, seeds and single flights scatter, as standard deviations of the logarithm of the error.
#[derive(Clone, Copy)]
struct Scatter {
    cases: f64,
    seeds: f64,
    flights: f64,
}

const CASES_DOMINATE: Scatter = Scatter { cases: 0.05, seeds: 0.01, flights: 0.005 };
const SEEDS_DOMINATE: Scatter = Scatter { cases: 0.01, seeds: 0.05, flights: 0.005 };
const BOTH: Scatter = Scatter { cases: 0.05, seeds: 0.05, flights: 0.005 };

/// Rungs of a drawn front.
const RUNGS: usize = 5;

/// A number for each rung, straight in between: the same everywhere, or of each rung by itself.
fn drawn(random: &mut Draw, size: f64, by_rung: bool) -> Along {
    let first = random.normal();
    let rungs: [f64; RUNGS] =
        std::array::from_fn(|_| size * if by_rung { random.normal() } else { first });
    std::array::from_fn(|place| {
        let at = place as f64 * (RUNGS - 1) as f64 / (PLACES - 1) as f64;
        let (below, share) = (libm::floor(at), at - libm::floor(at));
        let index = (0..RUNGS).rev().find(|it| *it as f64 <= below).unwrap_or(0);
        let next = rungs[(index + 1).min(RUNGS - 1)];
        rungs[index] + share * (next - rungs[index])
    })
}

/// Cases whose difference is `shift` plus what cases, seeds and flights scatter.
fn cases(
    random: &mut Draw,
    (count, seeds): (usize, usize),
    (scatter, by_rung): (Scatter, bool),
    shift: impl Fn(usize) -> f64,
) -> Vec<OfCase> {
    let mut of = |size: f64| drawn(random, size, by_rung);
    let designs: [Vec<Along>; 2] = [0, 1].map(|_| (0..seeds).map(|_| of(scatter.seeds)).collect());
    (0..count)
        .map(|_| {
            let of_case = of(scatter.cases);
            let mut errors = designs.clone().map(|it| {
                let flown = |design: Along| {
                    let flight = of(scatter.flights);
                    std::array::from_fn(|place| design[place] + flight[place])
                };
                it.into_iter().map(flown).collect::<Vec<Along>>()
            });
            for own in &mut errors[0] {
                let moved = own.iter_mut().enumerate();
                moved.for_each(|(place, it)| *it += shift(place) + of_case[place]);
            }
            OfCase { range: [0.0, 1.0], errors }
        })
        .collect()
}

fn stands(cases: &[OfCase]) -> Dominance {
    let means = means(cases);
    allowed(&means.ends(1), &signs(&means.parts[0], &[], 1), [None; 2])
}

/// Whether a band between two that are alike leaves zero somewhere; ranks are not asked, so that the band is held alone.
fn leaves_zero(cases: &[OfCase]) -> bool {
    let [lower, upper] = means(cases).ends(1);
    lower.iter().any(|it| *it > 0.0) || upper.iter().any(|it| *it < 0.0)
}

/// Until 2026-11-28 bands came of a bootstrap, whose scatter of S seeds is too small by the root of (S - 1) / S, and which
/// knows no Student's distribution: between two that are alike they left zero in up to 20 % of fronts of three seeds and
/// 13 % of five.
#[test]
fn a_band_between_two_that_are_alike_leaves_zero_in_a_twentieth_of_fronts_whatever_scatters() {
    const FRONTS: usize = 160;
    // A twentieth is 8, and three standard errors are 8.3; of all 12 it is 96, and 29.
    const MOST: (usize, usize) = (16, 125);
    let mut random = Draw::of(7, 0);
    let mut whole = 0;
    for scatter in [CASES_DOMINATE, SEEDS_DOMINATE, BOTH] {
        for by_rung in [false, true] {
            for size in [(12, 3), (6, 5)] {
                let of_front =
                    |_: &usize| leaves_zero(&cases(&mut random, size, (scatter, by_rung), |_| 0.0));
                let told = (0..FRONTS).filter(of_front).count();
                assert!(told <= MOST.0, "{told} of {FRONTS}: {size:?} {by_rung} {}", scatter.seeds);
                whole += told;
            }
        }
    }
    assert!(whole <= MOST.1, "{whole}");
}

#[test]
fn at_each_place_a_front_has_the_error_of_the_contest_there_and_its_band_is_wider() {
    let mut random = Draw::of(9, 0);
    let cases = cases(&mut random, (8, 3), (BOTH, true), |_| 0.0);
    let means = means(&cases);
    let [lower, upper] = means.ends(1);
    for place in 0..PLACES {
        let of = |who: usize| -> Vec<Vec<f64>> {
            let seed = |seed: usize| cases.iter().map(|it| it.errors[who][seed][place]).collect();
            (0..3).map(seed).collect()
        };
        let contest = TwoWay::of(&of(0), &of(1)).expect("an estimate");
        let here = means.at(place);
        assert!((here.estimate - contest.estimate).abs() < 1e-12, "{here:?} {contest:?}");
        assert!((here.freedom - contest.freedom).abs() < 1e-9, "{here:?} {contest:?}");
        let [below, above] = contest.interval(CONFIDENCE).expect("an interval");
        assert!(lower[place] <= below && above <= upper[place], "{place}: {below} {above}");
    }
}

#[test]
fn a_front_that_is_better_everywhere_dominates_and_one_that_crosses_does_not() {
    let mut random = Draw::of(8, 0);
    let scatter = Scatter { cases: 0.05, seeds: 0.015, flights: 0.0 };
    let mut of = |shift: &dyn Fn(usize) -> f64| {
        stands(&cases(&mut random, (12, 3), (scatter, false), shift))
    };
    assert_eq!(of(&|_| -0.3), Dominance::Dominates);
    assert_eq!(of(&|_| 0.3), Dominance::Dominated);
    assert_eq!(of(&|place| 0.1 * (place as f64 - 4.0)), Dominance::Crosses);
    assert_eq!(of(&|place| if place < 4 { -0.3 } else { 0.0 }), Dominance::BetterInPart);
}

/// A flight with this travel and error.
fn flown(travel_deg: f64, error_deg_s: f64) -> Flight {
    let mut counted = [Some(1.0); MEASURES.len()];
    for (quantity, value) in [(Quantity::ACTIVITY, travel_deg), (Quantity::ERROR, error_deg_s)] {
        let Quantity::Measure(index) = quantity else { unreachable!("both are measures") };
        counted[index] = Some(value);
    }
    Flight {
        measures: counted,
        counted,
        lost: false,
        failed: false,
        ..Flight::refused(String::new())
    }
}

/// Two controllers on ladders of travels: the flight of a controller, rung, seed, case and run.
struct Ladder<F: Fn(usize, usize, usize, usize, usize) -> Flight> {
    seeds: usize,
    cases: usize,
    runs: usize,
    weight: fn(usize) -> f64,
    flight: F,
}

impl<F: Fn(usize, usize, usize, usize, usize) -> Flight> Ladder<F> {
    /// How the second stands beside the first.
    fn band(&self) -> Band {
        let all: Vec<Judged> = (0..3).map(|rung| self.rung(rung)).collect();
        let [band] = super::all(&all.iter().collect::<Vec<_>>()).try_into().expect("one");
        band
    }

    fn rung(&self, rung: usize) -> Judged {
        let design = |who: usize, seed: usize| {
            let flights = (0..self.cases).flat_map(|case| {
                (0..self.runs).map(move |run| {
                    let mut flight = (self.flight)(who, rung, seed, case, run);
                    // Cases that are flown alike are one: something tells them apart.
                    let mark = flight.measures.get_mut(OVERSHOOT).filter(|_| !flight.lost);
                    mark.into_iter().for_each(|it| *it = Some(case as f64));
                    flight
                })
            });
            Design { found: None, flights: flights.collect() }
        };
        let contestant = |who: usize| Contestant {
            name: ["first", "second"][who].to_owned(),
            is_tuned: true,
            designs: (0..self.seeds).map(|seed| design(who, seed)).collect(),
        };
        let case = |place: usize| Case {
            name: place.to_string(),
            group: String::new(),
            set: Vec::new(),
            weight: (self.weight)(place),
            runs: self.runs,
            draws_seed: None,
            mirror_of: None,
        };
        let contestants = vec![contestant(0), contestant(1)];
        Judged::new(contestants, (0..self.cases).map(case).collect(), 0)
    }
}

/// Travels of a ladder, deg.
const TRAVEL_DEG: [f64; 3] = [10.0, 14.0, 20.0];

/// A flight whose error falls with travel; the second controller has less by some share.
fn usual(share: f64, who: usize, rung: usize, seed: usize, case: usize) -> Flight {
    let noise = 1.0 + 0.01 * ((7 * seed + 3 * case + 5 * who) % 5) as f64;
    let less = if who == 1 { 1.0 - share } else { 1.0 };
    flown(TRAVEL_DEG[rung], 40.0 / TRAVEL_DEG[rung] * noise * less)
}

const EVEN: fn(usize) -> f64 = |_| 1.0;

/// Until 2026-11-28 all runs of a case were one curve, sorted by travel: of a controller that travels twice as far as the
/// other in each flight, with more error, light draws stood beside hard ones of the other, and it was called better on the
/// whole front.
#[test]
fn draws_of_different_size_are_no_efforts_and_who_is_worse_in_every_flight_is_not_better() {
    for climbs in [false, true] {
        let flight = |who: usize, rung: usize, seed: usize, case: usize, run: usize| {
            let size = [0.3, 0.6, 1.0, 1.6, 3.0][run];
            let noise = 1.0 + 0.002 * ((2 * seed + case) % 3) as f64;
            let (twice, worse) = if who == 1 { (2.0, 1.07) } else { (1.0, 1.0) };
            let effort = if climbs { 1.0 + 0.01 * rung as f64 } else { 1.0 };
            flown(10.0 * size * twice * effort * noise, 5.0 * size * worse)
        };
        let band = Ladder { seeds: 3, cases: 8, runs: 5, weight: EVEN, flight }.band();
        assert_eq!(band.cases, Cases { compared: 0, lost: 0, apart: 8, alike: 0 });
        assert_eq!(band.dominance, Dominance::NotTold(Missing::Cases));
    }
    // Means over the runs have a common range where efforts do.
    let flight = |who: usize, rung: usize, seed: usize, case: usize, run: usize| {
        let size = [0.5, 1.0, 1.5][run];
        let it = usual(0.3, who, rung, seed, case);
        let [travel, error] = [Quantity::ACTIVITY, Quantity::ERROR].map(|quantity| {
            let Quantity::Measure(index) = quantity else { unreachable!("both are measures") };
            it.measures[index].expect("flown")
        });
        flown(size * travel, size * error)
    };
    let band = Ladder { seeds: 3, cases: 8, runs: 3, weight: EVEN, flight }.band();
    assert_eq!(band.dominance, Dominance::Dominates);
    let travel = band.travel.expect("a common range");
    for ends in [travel.mean_deg, travel.narrowest_deg] {
        assert!((ends[0] - 10.0).abs() < 1e-9 && (ends[1] - 20.0).abs() < 1e-9, "{ends:?}");
    }
}

/// How the second stands where that of the two has 30 % less error or so, and its flights are changed.
fn changed(change: impl Fn(usize, usize, &mut Flight), of: usize) -> Band {
    let flight = |who: usize, rung: usize, seed: usize, case: usize, _: usize| {
        let share = if of == 1 { 0.3 } else { -0.3 };
        let mut it = usual(share, who, rung, seed, case);
        if who == of {
            change(rung, case, &mut it);
        }
        it
    };
    Ladder { seeds: 3, cases: 12, runs: 1, weight: EVEN, flight }.band()
}

/// Until 2026-11-28 the sum of the failed flights was all that was asked.
#[test]
fn what_bars_the_winner_of_a_contest_bars_who_is_better_on_a_front() {
    fn lost(it: &mut Flight) {
        *it = Flight::refused("lost".to_owned());
    }
    type Change = fn(usize, usize, &mut Flight);
    let bars: [(Change, Option<FrontBar>); 7] = [
        (|_, _, _| {}, None),
        (|_, _, it| it.failed = true, Some(FrontBar::AllFail)),
        // On one effort is enough: the whole front is said of each.
        (|rung, _, it| it.failed |= rung == 0, Some(FrontBar::AllFail)),
        (|rung, case, it| it.unstable |= rung == 2 && case == 4, Some(FrontBar::Unstable)),
        (
            |_, case, it| {
                if case > 8 {
                    lost(it);
                }
            },
            Some(FrontBar::LosesMore),
        ),
        (|_, case, it| it.failed |= case < 6, Some(FrontBar::FailsMore)),
        // Of five cases signed ranks say nothing.
        (|_, case, it| it.failed |= case < 5, None),
    ];
    for (place, (change, bar)) in bars.into_iter().enumerate() {
        let expected = bar.map_or(Dominance::Dominates, Dominance::Barred);
        let band = changed(change, 1);
        assert_eq!(band.dominance, expected, "{place}");
        let expected = bar.map_or(Dominance::Dominated, Dominance::OtherBarred);
        assert_eq!(changed(change, 0).dominance, expected, "{place}");
        if bar == Some(FrontBar::LosesMore) {
            assert_eq!(band.cases, Cases { compared: 9, lost: 3, apart: 0, alike: 0 });
            assert_eq!((band.flights[0].lost, band.flights[1].lost), (27, 0));
        }
    }
}

#[test]
fn lost_cases_of_one_are_not_set_off_in_the_ranks_by_others_of_the_other() {
    // Each loses four of twelve cases, and not the same; of the four that are left the second has less error.
    let flight = |who: usize, rung: usize, seed: usize, case: usize, _: usize| match (who, case) {
        (0, 0..3) | (1, 3..6) => Flight::refused("lost".to_owned()),
        _ => usual(0.3, who, rung, seed, case),
    };
    let band = Ladder { seeds: 3, cases: 12, runs: 1, weight: EVEN, flight }.band();
    assert_eq!(band.cases, Cases { compared: 6, lost: 6, apart: 0, alike: 0 });
    assert!(band.ends[1].iter().all(|it| *it < 0.0), "{band:?}");
    assert_eq!(band.dominance, Dominance::OpenByRanks);
}

/// Twelve copies of one case, which a third controller alone can tell apart, were twelve cases between two others.
#[test]
fn cases_that_two_fly_alike_on_a_front_are_one_whatever_a_third_makes_of_them() {
    let flight =
        |who: usize, rung: usize, seed: usize, _: usize, _: usize| usual(0.3, who, rung, seed, 0);
    let ladder = Ladder { seeds: 3, cases: 12, runs: 1, weight: EVEN, flight };
    let rung = |rung: usize| {
        let Judged { mut contestants, cases, .. } = ladder.rung(rung);
        contestants.push(contestants[1].clone());
        // What tells cases apart is left to the third.
        let two = contestants[..2].iter_mut().flat_map(|it| &mut it.designs);
        let marks =
            two.flat_map(|it| &mut it.flights).filter_map(|it| it.measures.get_mut(OVERSHOOT));
        marks.for_each(|mark| *mark = None);
        Judged::new(contestants, cases, 0)
    };
    let all: Vec<Judged> = (0..3).map(rung).collect();
    let [two, third] =
        super::all(&all.iter().collect::<Vec<_>>()).try_into().expect("two beside the first");
    assert_eq!(two.cases, Cases { compared: 1, lost: 0, apart: 0, alike: 11 });
    assert_eq!(two.dominance, Dominance::NotTold(Missing::Cases));
    assert_eq!((third.cases.compared, third.cases.alike), (12, 0));
}

#[test]
fn with_two_seeds_there_is_no_band_and_no_claim() {
    let flight = |who: usize, rung: usize, seed: usize, case: usize, _: usize| {
        usual(0.3, who, rung, seed, case)
    };
    let band = Ladder { seeds: 2, cases: 12, runs: 1, weight: EVEN, flight }.band();
    assert!(band.ends[0].is_empty() && band.middle.len() == PLACES);
    assert_eq!(band.dominance, Dominance::NotTold(Missing::Seeds));
}

#[test]
fn the_weight_of_a_case_changes_no_band() {
    let of = |weight: fn(usize) -> f64| {
        let flight = |who: usize, rung: usize, seed: usize, case: usize, _: usize| {
            usual(if case == 0 { -3.0 } else { 0.1 }, who, rung, seed, case)
        };
        Ladder { seeds: 3, cases: 8, runs: 1, weight, flight }.band()
    };
    assert_eq!(of(EVEN), of(|case| if case == 0 { 100.0 } else { 1.0 }));
}
