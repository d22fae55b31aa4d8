use super::super::flight::{Flight, MEASURES};
use super::super::judged::{Case, Contestant, Design, Judged};
use super::super::outcome::Setting;
use super::super::summary::Summary;
use super::*;
use crate::draw::Draw;

/// A flight that came back, of which every measure is this.
fn flown(value: f64) -> Flight {
    Flight {
        measures: [Some(value); MEASURES.len()],
        counted: [Some(value); MEASURES.len()],
        cost: Some(value),
        lost: false,
        failed: false,
        ..Flight::refused(String::new())
    }
}

fn all(values: &[f64]) -> Vec<Flight> {
    values.iter().copied().map(flown).collect()
}

/// Controllers as they are written, each with so many flights a case.
fn judged(controllers: &[(&str, Vec<Flight>)], runs: usize, against: usize) -> Judged {
    let contestant = |(name, flights): &(&str, Vec<Flight>)| Contestant {
        name: (*name).to_owned(),
        is_tuned: false,
        designs: vec![Design { found: None, flights: flights.clone() }],
    };
    let case = |place: usize| Case {
        name: format!("case {place}"),
        group: String::new(),
        set: Vec::new(),
        weight: 1.0,
        runs,
        draws_seed: None,
        mirror_of: None,
    };
    let count = controllers.first().map_or(0, |it| it.1.len()) / runs;
    let contestants = controllers.iter().map(contestant).collect();
    Judged::new(contestants, (0..count).map(case).collect(), against)
}

/// The same with a flight a case, held against one of them.
fn held(controllers: &[(&str, Vec<Flight>)], against: usize) -> Outcome {
    let judged = judged(controllers, 1, against);
    let setting = Setting {
        scenario: String::new(),
        file: String::new(),
        overrides: Vec::new(),
        folder: String::new(),
        digest: String::new(),
        efforts: Vec::new(),
        training: Vec::new(),
        objectives: Vec::new(),
        limits: Vec::new(),
        training_runs: 0,
        runs: 0,
    };
    Outcome::new(judged, setting)
}

/// Errors about a middle, case by case.
fn about(middle: f64, random: &mut Draw) -> Vec<Flight> {
    let values: Vec<f64> = (0..10).map(|_| middle * libm::exp(0.1 * random.normal())).collect();
    all(&values)
}

/// Two that are equally good won by turns, 40 times of 40, where a third that is poor stood beside them: the first was held
/// against that one alone.
#[test]
fn of_two_that_are_alike_none_wins_whoever_is_compared_with() {
    const CONTESTS: u64 = 300;
    for against in 0..3 {
        let mut wins = 0;
        for seed in 0..CONTESTS {
            let mut random = Draw::of(seed, 0);
            let three = [
                ("PID", about(2.0, &mut random)),
                ("Y", about(1.0, &mut random)),
                ("Z", about(1.0, &mut random)),
            ];
            let head = headline(&held(&three, against));
            wins += u64::from(head.winner.is_some());
            if against == 0 && head.winner.is_none() {
                let told = "it is better than PID, and nothing decides between it and ";
                assert!(head.why.starts_with(told), "{head:?}");
            }
        }
        // A twentieth is 15, and three standard errors are 11.
        assert!(wins <= 26, "{wins} of {CONTESTS} against {against}");
    }
}

#[test]
fn who_is_better_than_every_other_wins_whoever_is_compared_with() {
    let mut random = Draw::of(5, 0);
    let three = [
        ("PID", about(2.0, &mut random)),
        ("Y", about(1.0, &mut random)),
        ("Z", about(0.5, &mut random)),
    ];
    for against in 0..3 {
        let outcome = held(&three, against);
        let head = headline(&outcome);
        assert_eq!(head.winner, Some(2), "{head:?}");
        let verdict = &outcome.json()["verdict"];
        assert_eq!((&verdict["winner"], &verdict["first"]), (&"Z".into(), &"Z".into()));
        let beside = verdict["beside_first"].as_array().expect("a list");
        assert!(beside.len() == 2 && beside.iter().all(|it| it["standing"] == "worse"));
    }
}

/// Cases that a third controller alone can tell apart, such as noise of a sensor that it alone reads: twelve copies of one
/// flight of two others made a winner with p = 0.0010.
#[test]
fn cases_that_two_fly_alike_are_one_between_them_whatever_a_third_makes_of_them() {
    let third: Vec<f64> = (0..12).map(|case| 1.5 + 0.01 * f64::from(case)).collect();
    let fails = |count: usize| -> Vec<Flight> {
        (0..12).map(|case| Flight { failed: case < count, ..flown(1.0) }).collect()
    };
    for (poor, good) in [
        (all(&[2.0; 12]), all(&[1.0; 12])),
        // By lost flights, and by those that fail.
        (vec![Flight::refused("diverged at t = 1 s".to_owned()); 12], all(&[1.0; 12])),
        (fails(12), all(&[0.5; 12])),
    ] {
        let outcome = held(&[("PID", poor), ("Y", good), ("third", all(&third))], 0);
        assert_eq!(headline(&outcome).winner, None);
        let found = outcome.comparison(1).expect("a comparison");
        assert!(found.evidence == 1 && !found.is_sure && found.p_adjusted >= 1.0, "{found:?}");
        assert!(found.lost.p_adjusted >= 1.0, "{found:?}");
        // The third is another one in every case.
        assert_eq!(outcome.comparison(2).map(|it| it.evidence), Some(12));
        let told = "Between Y and PID 1 of 12 cases is evidence";
        assert!(outcome.text().contains(told), "{}", outcome.text());
        let json = outcome.json();
        assert_eq!(json["controllers"][1]["compared"]["iae_deg_s"]["evidence_cases"], 1);
    }
}

#[test]
fn a_failure_that_copies_repeat_bars_nobody() {
    let third: Vec<f64> = (0..12).map(|case| 3.0 + 0.01 * f64::from(case)).collect();
    let copies: Vec<Flight> = (0..12)
        .map(|case| match case {
            0..8 => Flight { failed: true, ..flown(1.0) },
            _ => flown(1.0 + 0.01 * f64::from(case)),
        })
        .collect();
    let outcome = held(&[("PID", all(&[2.0; 12])), ("Y", copies), ("third", all(&third))], 0);
    // Eight flights that fail are one.
    assert_eq!(barred(&outcome.judged, 1, 0), None);
    assert_eq!(outcome.comparison(1).map(|it| it.evidence), Some(5));
}

/// Of ten draws of six cases each an interval of 95 % for independent flights held a known 30 % in 21 of 60.
#[test]
fn an_interval_of_what_fails_counts_cases_and_holds_the_truth() {
    const CONTESTS: u64 = 300;
    let mut holds = 0;
    for seed in 0..CONTESTS {
        let mut random = Draw::of(seed, 1);
        let flights: Vec<Flight> = (0..6)
            .flat_map(|case| {
                // The tail of a normal distribution beyond 0.5244 is 30 %; all draws of a case fail together.
                let failed = random.normal() > 0.524_400_512_708_041;
                (0..10).map(move |run| {
                    let value = 1.0 + f64::from(case) + 0.01 * f64::from(run);
                    Flight { failed, ..flown(value) }
                })
            })
            .collect();
        let judged = judged(&[("PID", flights)], 10, 0);
        let [lower, upper] = Summary::of(&judged, 0).failed;
        holds += u64::from((lower..=upper).contains(&0.3));
    }
    // 95 % are 285, less three standard errors of 4.
    assert!(holds >= 273, "{holds} of {CONTESTS}");
}
