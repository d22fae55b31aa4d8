//! The search for the worst case finds the corner where it must be, and is the same each time.

use std::path::Path;

use fspid_campaign::sample::Sampling;
use fspid_campaign::search::{self, Worst};
use fspid_campaign::{Campaign, CampaignError, Folder, Question, Shards, local, plan};
use fspid_scenario::dispersion::Drawn;

fn campaign() -> Campaign {
    campaign_of("campaign.toml", &["loop.duration_s=5.0"])
}

fn campaign_of(name: &str, set: &[&str]) -> Campaign {
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(name);
    let question = Question {
        scenario: &scenario,
        overrides: &set.iter().map(|it| (*it).to_owned()).collect::<Vec<_>>(),
        runs: 1,
        seed: 1,
        sampling: Sampling::Random,
        shards: Shards::ForThreads,
    };
    plan(&question, &Folder::new(Path::new("."))).unwrap_or_else(|error| panic!("{error}"))
}

fn asked(measure: &str) -> search::Question {
    search::Question {
        measure: measure.to_owned(),
        lowest: false,
        controller: Some("FSPID".to_owned()),
        budget: 600,
        seed: 3,
    }
}

fn worst(question: &search::Question, threads: usize) -> Worst {
    let campaign = campaign();
    let found = local::in_threads(threads, || search::search(&campaign, question));
    found.and_then(|found| found).unwrap_or_else(|error| panic!("{error}"))
}

fn number(drawn: &Drawn) -> f64 {
    match drawn {
        Drawn::Number(number) => *number,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_largest_overshoot_is_in_the_corner_of_least_damping_and_slowest_servo() {
    let found = worst(&asked("overshoot_pct"), 0);
    let [_, damping, _, servo] = found.drawn.as_slice() else { panic!("{found:?}") };
    assert!(number(damping) < 0.72 && number(servo) > 0.19, "{found:?}");
    // Chance does not come there: no run of two hundred is as bad.
    let by_chance = {
        let campaign = campaign();
        let drawn = (0..200).map(|run| {
            let mut point = vec![0.0; campaign.draws().dimensions()];
            let cube = fspid_campaign::sample::Cube::new(Sampling::Random, point.len(), 200, 9);
            cube.expect("a cube").point(run, &mut point);
            (run, campaign.draws().drawn_at(&point))
        });
        let runs = campaign.fly_together(drawn).expect("no external controllers");
        let overshoot = runs.iter().map(|run| {
            let flights = run.flights.as_ref().expect("flown");
            flights[1].metrics.first_step().overshoot_pct.expect("measured")
        });
        overshoot.fold(0.0, f64::max)
    };
    assert!(found.value > Some(by_chance) && found.nominal < Some(by_chance), "{found:?}");
    assert!(found.flown <= 600, "{}", found.flown);
}

/// Amplitudes of a step of a nonlinear aircraft, by large ones of which it leaves the range of its data.
fn leaving(measure: &str, lowest: bool, set: &[&str]) -> Worst {
    let step = "dispersion[]={ name = \"step\", path = \"setpoint.amplitude_deg\", distribution = \"uniform\", lower = 1.0, upper = 25.0 }";
    let campaign = campaign_of("gallery/uav-pitch-step.toml", &[&[step], set].concat());
    let question = search::Question {
        measure: measure.to_owned(),
        lowest,
        controller: None,
        budget: 60,
        seed: 1,
    };
    search::search(&campaign, &question).unwrap_or_else(|error| panic!("{error}"))
}

/// "worst … none s" at the least amplitude, of a box in which 69 of 100 flights leave their range.
#[test]
fn a_flight_that_leaves_the_range_of_its_data_is_worse_than_one_that_does_not() {
    for (measure, lowest) in [("left_validity_at_s", true), ("rise_time_s", false)] {
        for rule in ["fail", "warn"] {
            let found = leaving(measure, lowest, &[&format!("aircraft.validity={rule}")]);
            let leaves = measure == "left_validity_at_s" || rule == "fail";
            assert!(!leaves || number(&found.drawn[0]) > 10.0, "{measure} {rule} {found:?}");
            assert_eq!(
                found.reasons.iter().any(|it| it.contains("left the range")),
                rule == "fail"
            );
            assert!(measure != "left_validity_at_s" || found.value.is_some(), "{found:?}");
            assert!(found.counts.failed > 10 || rule == "warn", "{found:?}");
        }
    }
}

/// A final error is positive below the set-point: one of -30 % is no better than one of 10 %.
#[test]
fn the_worst_final_error_is_the_largest_whatever_its_sign() {
    let short = "dispersion[]={ name = \"end\", path = \"loop.duration_s\", distribution = \"uniform\", lower = 1.5, upper = 4.0 }";
    let (campaign, found) = searched(short, "final_error_pct");
    let found = found.expect("found").value.expect("a value");
    let of = |lowest: bool| {
        let asked = search::Question { lowest, budget: 40, ..asked("final_error_pct") };
        search::search(&campaign, &asked).expect("found").value.expect("a value")
    };
    assert!(found.abs() >= of(true).abs(), "{found} {}", of(true));
}

/// What is found of the campaign with one more change, by a few flights.
fn searched(change: &str, measure: &str) -> (Campaign, Result<Worst, CampaignError>) {
    let campaign = campaign_of("campaign.toml", &["loop.duration_s=5.0", change]);
    let found = search::search(&campaign, &search::Question { budget: 40, ..asked(measure) });
    (campaign, found)
}

/// "worst overshoot_pct found in 300 flights: none": the requirement was that of another controller.
#[test]
fn a_requirement_of_another_controller_is_not_asked_of_this_one() {
    let required = "requirement[]={ id = \"overshoot_pct\", measure = \"overshoot_pct\", most = 10.0, controller = \"CPID\" }";
    let (_, found) = searched(required, "overshoot_pct");
    let found = found.expect("it is searched");
    assert!(found.value.is_some_and(|it| it > 0.0), "{found:?}");
    let required = required.replace("id = \"overshoot_pct\"", "id = \"of CPID\"");
    let (_, refused) = searched(&required, "of CPID");
    assert!(matches!(refused, Err(CampaignError::Unknown { what: "measure", .. })), "{refused:?}");
}

/// Nothing said that of most of these flights nobody can tell whether their loop is stable.
#[test]
fn what_no_measure_tells_is_counted_beside_the_worst() {
    let bounded = "controller.FSPID.output_limits_deg=[-0.02, 0.02]";
    let (campaign, found) = searched(bounded, "iae_deg_s");
    let found = found.expect("it is searched");
    let text = found.text(&campaign);
    assert!(found.counts.undecided + found.counts.failed > 0, "{text}");
    assert!(text.contains("Of all that were asked"), "{text}");
    assert_eq!(found.undecided.is_some(), text.contains("stability at rest"), "{text}");
    assert_eq!(found.json(&campaign)["undecided"], found.counts.undecided);
}

#[test]
fn the_search_is_the_same_on_any_number_of_threads() {
    let question = search::Question { budget: 150, ..asked("phase_margin_deg") };
    let alone = worst(&question, 1);
    assert_eq!(worst(&question, 3), alone);
    assert!(alone.value < alone.nominal, "{alone:?}");
}

#[test]
fn what_cannot_be_asked_is_refused_with_what_can() {
    let refused = |question: search::Question| {
        let found = search::search(&campaign(), &question);
        match found.expect_err("refused") {
            CampaignError::Count(error) => (error.count.what, error.to_string()),
            CampaignError::Unknown { what, known, .. } => (what, known),
            other => panic!("{other}"),
        }
    };
    let (what, allowed) = refused(asked("overshot"));
    assert!(what == "measure" && allowed.contains("overshoot_pct"), "{allowed}");
    let nobody = Some("nobody".to_owned());
    let (what, allowed) = refused(search::Question { controller: nobody, ..asked("iae_deg_s") });
    assert!(what == "controller" && allowed.contains("CPID, FSPID"), "{what}: {allowed}");
    for budget in [0, usize::MAX] {
        let (what, _) = refused(search::Question { budget, ..asked("iae_deg_s") });
        assert_eq!(what, "the number of flights");
    }
}
