//! Flights of a campaign are those of `simulate`, whatever flies beside them.

use fspid_campaign::engine::{self, FlightResult};
use fspid_scenario::file::{Extra, NewValue, SettingPath, Study, Template};
use fspid_sim::batch::{Entrant, LANES, fly_group};
use fspid_study::simulation::Simulation;

const STEP: &str = include_str!("../../../scenarios/747-pitch-step.toml");
const REQUIREMENTS: &str = "
[[requirement]]
measure = \"overshoot_pct\"
most = 20.0
[[requirement]]
measure = \"elevator_rate_deg_s\"
most = 40.0
[[requirement]]
measure = \"phase_margin_deg\"
least = 30.0
[[requirement]]
measure = \"phugoid_damping\"
least = 0.04
";

fn template(text: &str) -> Template {
    let extra = Extra::default();
    Template::parse(text, "campaign.toml", None, &extra).unwrap_or_else(|error| panic!("{error}"))
}

fn path(text: &str) -> SettingPath {
    SettingPath::parse(text).expect("a path")
}

/// Gains from idle to wild, so that flights settle, swing and diverge side by side.
fn studies(template: &Template, count: u32) -> Vec<Study> {
    let (kp, rate, gain) = (
        path("controller.FSPID.nominal.kp"),
        path("controller.PC.kp"),
        path("plant.preset.numerator[0]"),
    );
    let study = |run: u32| {
        let x = f64::from(run);
        let values = [
            (&kp, NewValue::Number(0.2 + 1.7 * x)),
            (&rate, NewValue::Number(1.0 + 9.0 * x)),
            (&gain, NewValue::Number(-1.7 + 0.01 * x)),
        ];
        template.with(&values).unwrap_or_else(|error| panic!("{error}"))
    };
    (0..count).map(study).collect()
}

/// The same as the engine says it, from a simulation of the study alone.
fn alone(study: &Study) -> Vec<FlightResult> {
    engine::fly(std::slice::from_ref(study)).pop().expect("one study").expect("it flies")
}

#[test]
fn flights_side_by_side_are_measured_as_single_simulations_are() {
    let template = template(&format!("{STEP}{REQUIREMENTS}"));
    let studies = studies(&template, 19);
    let flown = engine::fly(&studies);
    let mut verdicts = Vec::new();
    for (study, flights) in studies.iter().zip(flown) {
        let flights = flights.expect("it flies");
        let simulation = Simulation::of(study).expect("it flies");
        // What is asked of the aircraft alone is judged once, and concerns every controller.
        let judgements: Vec<_> = flights.iter().flat_map(|it| it.judgements.clone()).collect();
        let of_aircraft = flights.len() - 1;
        assert_eq!(judgements.len(), simulation.judgements.len() + of_aircraft);
        assert!(judgements.iter().all(|judgement| simulation.judgements.contains(judgement)));
        assert!(simulation.judgements.iter().all(|judgement| judgements.contains(judgement)));
        for (flight, result) in flights.iter().zip(&simulation.results) {
            assert_eq!(flight.controller, result.name);
            assert_eq!(flight.metrics, result.metrics);
            assert_eq!(flight.faults, result.trace.faults);
            verdicts.push(flight.metrics.verdict.is_failure());
        }
        assert_eq!(flights, alone(study));
    }
    // All three kinds of company were there.
    assert!(verdicts.contains(&true) && verdicts.contains(&false));
}

#[test]
fn flights_of_different_lengths_and_orders_fly_in_one_call() {
    let template = template(STEP);
    let (duration, preset) = (path("loop.duration_s"), path("plant.preset"));
    let studies: Vec<Study> = [(20.0, "b747-paper"), (3.0, "b747-paper"), (20.0, "navion-full")]
        .map(|(length, plant)| {
            let values = [
                (&duration, NewValue::Number(length)),
                (&preset, NewValue::Text(plant.to_owned())),
            ];
            template.with(&values).expect("a scenario")
        })
        .into();
    for (study, flown) in studies.iter().zip(engine::fly(&studies)) {
        assert_eq!(flown.expect("it flies"), alone(study));
    }
}

/// The step of the 747 by aircraft of which files have linear models alone: groups of one of them fly in lanes, a mixed
/// one, whose orders differ, one by one.
#[test]
fn aircraft_known_by_linear_models_alone_fly_side_by_side_as_they_fly_alone() {
    let plant = "[plant]\npreset = \"b747-paper\"";
    let aircraft = "[aircraft]\nname = \"etkin-747\"\nairspeed_ft_s = 774.0\naltitude_ft = 40000.0";
    assert!(STEP.contains(plant));
    let template = template(&STEP.replace(plant, aircraft));
    let (name, kp) = (path("aircraft.name"), path("controller.PC.kp"));
    let moment = path("aircraft.name.equations[1].by_elevator");
    let study = |run: usize| {
        let changes = match run / LANES == 1 || run == 2 * LANES + 1 {
            true => (NewValue::Text("ctms-transport".to_owned()), 0.0203),
            false => (NewValue::Text("etkin-747".to_owned()), -17.85),
        };
        let x = run as f64;
        let changes = [
            (&name, changes.0),
            (&kp, NewValue::Number(0.5 + 0.3 * x)),
            (&moment, NewValue::Number(changes.1 * (1.0 + 0.01 * x))),
        ];
        template.with(&changes).unwrap_or_else(|error| panic!("{error}"))
    };
    let studies: Vec<Study> = (0..2 * LANES + 3).map(study).collect();
    for group in studies[..2 * LANES].chunks(LANES) {
        let prepared: Vec<_> =
            group.iter().map(|it| it.scenario.prepare().expect("it flies")).collect();
        let entrant = |(study, prepared)| {
            let study: &Study = study;
            Entrant { prepared, controller: &study.scenario.controllers[0].controller }
        };
        let entrants: Vec<_> = group.iter().zip(&prepared).map(entrant).collect();
        assert!(fly_group::<LANES>(&entrants, |_| ()).is_ok());
    }
    for (study, flown) in studies.iter().zip(engine::fly(&studies)) {
        let flown = flown.expect("it flies");
        assert_eq!(flown, alone(study));
        let simulation = Simulation::of(study).expect("it flies");
        for (flight, result) in flown.iter().zip(&simulation.results) {
            assert_eq!((&flight.metrics, flight.faults), (&result.metrics, result.trace.faults));
        }
    }
}

#[test]
fn aircraft_with_sensors_and_gusts_fly_in_a_campaign_too() {
    let text = include_str!("../../../scenarios/gallery/b747-turbulence.toml");
    let template = template(text);
    let seed = path("turbulence.seed");
    let study = |seed_of_run| {
        template.with(&[(&seed, NewValue::Integer(seed_of_run))]).expect("a scenario")
    };
    let studies: Vec<Study> = (1..=3).map(study).collect();
    let flown: Vec<_> = engine::fly(&studies).into_iter().map(|it| it.expect("it flies")).collect();
    for (study, flights) in studies.iter().zip(&flown) {
        let simulation = Simulation::of(study).expect("it flies");
        for (flight, result) in flights.iter().zip(&simulation.results) {
            assert_eq!((&flight.metrics, flight.exit), (&result.metrics, result.trace.exit));
        }
    }
    assert_ne!(flown[0], flown[1]);
}

/// What a flight allocates does not grow with its length: traces have room from the start.
#[test]
fn flights_allocate_nothing_while_they_fly() {
    let texts = [STEP, include_str!("../../../scenarios/gallery/b747-turbulence.toml")];
    for text in texts {
        let template = template(text);
        let length = path("loop.duration_s");
        let count = |duration_s: f64| {
            let study = template.with(&[(&length, NewValue::Number(duration_s))]).expect("sound");
            let studies = [study];
            allocation_counter::measure(|| drop(engine::fly(&studies))).count_total
        };
        // The first flight of a thread takes the room for its random numbers.
        count(1.0);
        // Both have come to rest: a flight that has not is flown on.
        assert_eq!(count(60.0), count(40.0));
    }
}

#[test]
fn an_aircraft_that_is_not_what_is_required_fails_every_controller() {
    let asked = "\n[[requirement]]\nmeasure = \"phugoid_damping\"\nleast = 0.99\n";
    let flights = alone(template(&format!("{STEP}{asked}")).study());
    assert_eq!(flights.len(), 3);
    assert!(flights.iter().all(FlightResult::is_failed), "{flights:?}");
}

/// It counted as well where nothing was asked of it.
#[test]
fn a_flight_that_does_not_settle_has_failed_where_nothing_is_required() {
    let short = template(STEP).with(&[(&path("loop.duration_s"), NewValue::Number(2.0))]);
    let flights = alone(&short.expect("a scenario"));
    for flight in &flights {
        assert!(flight.is_failed(), "{flight:?}");
        assert_eq!(flight.reasons(), ["not settled within 2 s"]);
    }
    let asked = format!("{STEP}\n[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 99.0\n");
    let short = template(&asked).with(&[(&path("loop.duration_s"), NewValue::Number(2.0))]);
    let flights = alone(&short.expect("a scenario"));
    assert!(flights.iter().all(|flight| !flight.is_failed() && flight.reasons().is_empty()));
}

/// One line about the short period, which no controller moves, made "0 flights failed" of twenty that did not settle.
#[test]
fn what_is_required_of_the_aircraft_alone_excuses_no_flight_that_does_not_settle() {
    let asked = format!("{STEP}\n[[requirement]]\nmeasure = \"phugoid_damping\"\nleast = 0.0\n");
    let short = template(&asked).with(&[(&path("loop.duration_s"), NewValue::Number(2.0))]);
    let flights = alone(&short.expect("a scenario"));
    for flight in &flights {
        assert!(flight.judgements.iter().all(|judgement| judgement.met), "{flight:?}");
        assert_eq!(flight.reasons(), ["not settled within 2 s"]);
        assert!(flight.is_failed());
    }
}

/// The Navion at 300 ft with a step of -10 deg flew on to -276 m, and none of 20 such flights failed.
#[test]
fn flights_into_the_ground_and_beyond_the_data_fail_and_say_why() {
    let text = include_str!("../../../scenarios/gallery/navion-step.toml");
    let text = text.replace("duration_s = 10.0", "duration_s = 30.0");
    let low = template(&text);
    let (step, altitude) = (path("setpoint.amplitude_deg"), path("aircraft.altitude_ft"));
    let study = |step_deg, altitude_ft| {
        let changes =
            [(&step, NewValue::Number(step_deg)), (&altitude, NewValue::Number(altitude_ft))];
        low.with(&changes).unwrap_or_else(|error| panic!("{error}"))
    };
    let studies = [study(-10.0, 300.0), study(2.0, 1000.0), study(25.0, 1000.0)];
    let flown: Vec<_> = engine::fly(&studies).into_iter().map(|it| it.expect("it flies")).collect();
    let [down, well, far] = [&flown[0][0], &flown[1][0], &flown[2][0]];
    assert!(down.is_failed() && down.hit_ground_at_s().is_some_and(|at_s| at_s < 13.0));
    assert!(down.reasons()[0].starts_with("hit the ground at t = 1"), "{:?}", down.reasons());
    assert!(!well.is_failed(), "{:?}", well.reasons());
    let left =
        |reason: &String| reason.contains("left the range") && reason.contains("outside for");
    assert!(far.is_failed() && far.reasons().iter().any(left), "{:?}", far.reasons());
    let allowed = template(&text.replace("[actuator]", "validity = \"warn\"\n\n[actuator]"));
    let allowed = allowed.with(&[(&step, NewValue::Number(25.0))]).expect("a scenario");
    let flown = engine::fly(&[allowed]);
    let flight = &flown[0].as_ref().expect("it flies")[0];
    assert!(flight.exit.is_some() && !flight.reasons().iter().any(left), "{:?}", flight.reasons());
}

/// It used to be asked of fixed gains alone: a self-tuning loop that grows slowly counted as measured.
#[test]
fn a_self_tuning_loop_that_is_unstable_at_rest_fails_without_measures() {
    // Shorter than the flight until one of them diverges.
    let turned = STEP.replace("preset = \"b747-paper\"", TURNED);
    let short = template(&turned).with(&[(&path("loop.duration_s"), NewValue::Number(5.0))]);
    let studies = [short.expect("a scenario")];
    let flown = engine::fly(&studies);
    for flight in flown[0].as_ref().expect("it flies") {
        let reasons = flight.reasons();
        assert!(flight.is_failed() && flight.metrics.effort.is_err(), "{}", flight.controller);
        assert!(reasons[0].starts_with("unstable at rest (doubles every"), "{reasons:?}");
        // The question of the sign is no reason of a failure.
        assert!(reasons.len() == 1 && flight.metrics.wrong_way, "{reasons:?}");
    }
}

/// The plant of the step, its elevator counted the wrong way.
const TURNED: &str = "numerator = [1.15101, 0.17742]\ndenominator = [1.0, 0.739, 0.921468, 0.0]\nelevator_sign = \"nose-down-positive\"";

/// Loads, altitude and airspeed of an aircraft are judged in a campaign as they are by `verify`.
#[test]
fn requirements_on_the_flight_of_an_aircraft_are_judged_in_campaigns_as_alone() {
    let text = include_str!("../../../scenarios/gallery/navion-step.toml").to_owned()
        + "[[requirement]]\nmeasure = \"altitude_deviation_ft\"\nmost = 1e6\n\
           [[requirement]]\nmeasure = \"least_load_factor_g\"\nleast = -3.0\n\
           [[requirement]]\nmeasure = \"airspeed_deviation_kt\"\nmost = 0.001\n";
    let study = template(&text).with(&[]).expect("as it is");
    let simulated = Simulation::of(&study).expect("it flies").judgements;
    let [flight] = alone(&study).try_into().expect("one controller");
    let judged = |id: &str| flight.judgements.iter().find(|it| it.requirement.id == id);
    for (id, met) in [
        ("altitude_deviation_ft", true),
        ("least_load_factor_g", true),
        ("airspeed_deviation_kt", false),
    ] {
        let ours = judged(id).expect("asked");
        let theirs = simulated.iter().find(|it| it.requirement.id == id).expect("asked");
        assert_eq!(ours, theirs);
        assert!(ours.found.is_ok() && ours.met == met, "{id}: {ours:?}");
    }
}
