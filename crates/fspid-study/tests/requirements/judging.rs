//! How requirements are judged: the worst case, the limit itself, and what cannot be evaluated.

use fspid_scenario::file;
use fspid_scenario::measure::{Family, Measure};
use fspid_scenario::requirement::Requirement;
use fspid_sim::gradient::{Flown, Slopes};
use fspid_sim::{External, ExternalSource, Flyer, NamedExternal, Trace};
use fspid_study::judgement::{Evidence, NotEvaluated, SlopeOf, Sloped, add_slopes, of_loop};
use fspid_study::metrics::Absent;
use fspid_study::simulation::Simulation;

use crate::requirements::{JUMBO, judged, of, one, study, values};

#[test]
fn a_value_that_equals_its_limit_meets_it_and_the_next_number_does_not() {
    // What is left of a step has to be within its limit before its last sample, too.
    let is_left =
        |measure: &Measure| matches!(measure, Measure::FinalError | Measure::FinalErrorAngle);
    let is_here = |measure: &Measure| {
        !measure.is_yes_or_no() && measure.family() != Family::Aircraft && !is_left(measure)
    };
    for measure in Measure::ALL.into_iter().filter(is_here) {
        let conditions = match measure {
            Measure::RecoveryTime => "within_deg = 0.5",
            _ => "",
        };
        let value =
            values(JUMBO, measure, &format!("controller = \"FSPID\"\n{conditions}"), &[])[0];
        if !(value > 0.0 && value.is_finite()) {
            continue;
        }
        let met = |word: &str, limit: f64| {
            let requirement =
                format!("measure = \"{}\"\n{word} = {limit:?}\n{conditions}", measure.name());
            of("FSPID", &requirement, &[]).met
        };
        assert!(met("least", value) && met("most", value), "{}", measure.name());
        assert!(!met("least", value.next_up()), "{}", measure.name());
        assert!(!met("most", value.next_down()), "{}", measure.name());
    }
}

#[test]
fn a_step_of_another_size_is_not_what_was_asked_for() {
    let judgement = of("P", "measure = \"overshoot_pct\"\nmost = 99.0\nstep_deg = 2.0", &[]);
    assert!(!judgement.met);
    let told = judgement.value_in_words();
    assert_eq!(told, "the command has no step of 2 deg; its steps are of 5 deg");
    // A square wave has steps of 5 and of 10 degrees: only the second kind counts.
    let square =
        JUMBO.replace("kind = \"step\"", "kind = \"square\"\nhalf_period_s = 5.0\nbipolar = true");
    let one_size = one(
        &square,
        "measure = \"overshoot_pct\"\nmost = 99.0\nstep_deg = 10.0\ncontroller = \"P\"",
        &[],
    );
    let step = one_size.place().step.expect("it is of a step");
    assert!(step.number >= 2 && (step.to_deg - step.from_deg).abs() > 9.9, "{step:?}");
}

#[test]
fn a_command_that_never_moves_has_no_step_but_is_held() {
    let held = ["setpoint.amplitude_deg=0.0"];
    let overshoot = of("P", "measure = \"overshoot_pct\"\nmost = 99.0", &held);
    assert_eq!(overshoot.found, Err(NotEvaluated::Absent(Absent::NoStep)));
    let left = of("P", "measure = \"final_error_deg\"\nmost = 0.5", &held);
    assert!(left.met && left.found.expect("held").value == 0.0);
}

/// Looked up in the trace by the definition, to a sample.
#[test]
fn the_recovery_lasts_until_the_error_stays_within_its_band() {
    let study = study(JUMBO, &[]);
    let simulation = Simulation::of(&study).expect("it flies");
    // The proportional controller leaves more of its error than the self-tuning one.
    for (result, band) in simulation.results.iter().zip([4.0, 0.5]) {
        let conditions = format!("within_deg = {band:?}\ncontroller = \"{}\"", result.name);
        let found = values(JUMBO, Measure::RecoveryTime, &conditions, &[])[0];
        let errors = result.trace.theta_rad.iter().map(|theta| (5.0 - theta.to_degrees()).abs());
        let last = errors.enumerate().rfind(|(_, error)| *error > band).expect("at first").0;
        let last_s = last as f64 * 0.01;
        assert!(last_s <= found && found <= last_s + 0.01, "{} {last_s} {found}", result.name);
    }
}

#[test]
fn an_error_that_leaves_its_band_again_is_no_recovery() {
    let judgement = of("P", "measure = \"recovery_time_s\"\nmost = 99.0\nwithin_deg = 0.001", &[]);
    assert!(!judgement.met);
    assert!(matches!(judgement.found, Err(NotEvaluated::NotRecovered { .. })), "{judgement:?}");
}

#[test]
fn only_the_time_that_is_asked_for_counts() {
    let error = |measure, time: &str| {
        values(JUMBO, measure, &format!("controller = \"FSPID\"\n{time}"), &[])[0]
    };
    let whole = error(Measure::LargestError, "");
    assert!((whole - 5.0).abs() < 1e-9, "the step itself: {whole}");
    let late = error(Measure::LargestError, "from_s = 10.0\nto_s = 20.0");
    assert!(late < 0.1 * whole, "{late}");
    assert!(error(Measure::RmsError, "from_s = 10.0") <= late);
    // One sample alone: the error at its time.
    let trace = &Simulation::of(&study(JUMBO, &[])).expect("it flies").results[1].trace;
    let expected = ((trace.setpoint_rad[1000] - trace.theta_rad[1000]).abs()).to_degrees();
    let at_ten = error(Measure::LargestError, "from_s = 10.0\nto_s = 10.001");
    assert!((at_ten - expected).abs() < 1e-15 * expected.max(1.0) * 10.0, "{at_ten} {expected}");
}

#[test]
fn a_time_after_the_end_of_the_flight_was_not_flown() {
    let judgement = of("P", "measure = \"rms_error_deg\"\nmost = 99.0\nto_s = 20.5", &[]);
    assert!(!judgement.met);
    assert_eq!(
        judgement.value_in_words(),
        "nothing was flown from 0 s to 20.5 s: the flight ends at 20 s"
    );
}

#[test]
fn a_line_for_turbulence_is_not_met_in_calm_air_and_the_other_way_round() {
    let judgement = of("P", "measure = \"rms_error_deg\"\nmost = 99.0\nair = \"turbulent\"", &[]);
    assert_eq!(
        judgement.value_in_words(),
        "asked for turbulent air, but the flight has no turbulence"
    );
    let windy = r#"
schema = 1
name = "windy"
[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 1000.0
[loop]
sample_period_s = 0.01
duration_s = 2.0
[setpoint]
kind = "step"
amplitude_deg = 0.0
[turbulence]
intensity = "light"
seed = 1
[[controller]]
name = "P"
kind = "p"
kp = 0.8
"#;
    let requirement =
        |air: &str| format!("measure = \"rms_error_deg\"\nmost = 99.0\nair = \"{air}\"");
    assert!(one(windy, &requirement("turbulent"), &[]).met);
    let smooth = one(windy, &requirement("smooth"), &[]);
    assert_eq!(smooth.value_in_words(), "asked for smooth air, but the flight has turbulence");
    let steady = windy.replace(
        "[turbulence]\nintensity = \"light\"\nseed = 1",
        "[wind]\nkind = \"steady\"\nspeed_m_s = 5.0\nfrom_deg = 0.0",
    );
    assert!(one(&steady, &requirement("smooth"), &[]).met, "steady wind is smooth air");
    let gust = windy.replace(
        "[turbulence]\nintensity = \"light\"\nseed = 1",
        "[[gust]]\nkind = \"full-cycle\"\nup_m_s = 6.0\ngradient_m = 30.0\nat_s = 0.5",
    );
    let gusty = one(&gust, &requirement("smooth"), &[]);
    assert_eq!(gusty.value_in_words(), "asked for smooth air, but the flight has gusts");
    let load = "measure = \"largest_load_factor_g\"\nleast = 0.99\nmost = 1.01";
    assert!(one(&steady, load, &[]).met, "a level flight carries its weight");
    assert!(!one(&gust, load, &[]).met);
}

/// An aircraft that runs away by itself, held at rest, whose elevator does not suffice for the step: every linear loop is
/// stable, and the flight is lost.
#[test]
fn a_flight_that_is_lost_meets_nothing_though_its_loop_is_stable_at_rest() {
    let text = JUMBO
        .replace(
            "preset = \"b747-paper\"",
            "numerator = [1.0]\ndenominator = [1.0, -1.0, 0.0]\nelevator_sign = \"nose-up-positive\"",
        )
        .replace("time_constant_s = 0.1", "time_constant_s = 0.01")
        .replace(
            "kind = \"pid\"\nkp = 1.0",
            "kind = \"pid\"\nkp = 2.0\nkd = 3.0\noutput_limits_deg = [-0.5, 0.5]",
        );
    let of_step = |measure: &str, limit: &str, set: &[&str]| {
        one(&text, &format!("controller = \"P\"\nmeasure = \"{measure}\"\n{limit}"), set)
    };
    let small = ["setpoint.amplitude_deg=0.01"];
    for measure in ["rms_error_deg", "largest_error_deg", "elevator_travel_deg", "iae_deg_s"] {
        let lost = of_step(measure, "most = 1e300", &[]);
        assert!(!lost.met, "{measure}");
        assert!(lost.value_in_words().contains("diverged"), "{}", lost.value_in_words());
        assert!(of_step(measure, "most = 1e300", &small).met, "{measure}: near enough to rest");
    }
    let stable = of_step("stable", "", &[]);
    assert_eq!((stable.met, stable.value_in_words()), (false, "unstable".to_owned()));
    assert!(stable.place().at_s.is_some() && of_step("stable", "", &small).met, "{stable:?}");
    // A margin is one of the loop at rest, of the only plant that there is, and none of a flight that limits take from it.
    let disk = of_step("disk_margin", "least = 0.0", &small);
    assert!(disk.met && disk.place().plant.is_none(), "{disk:?}");
    assert!(!of_step("disk_margin", "least = 0.0", &[]).met);
}

/// A flight of 20 s at a gain of 5 looks wild, one of half a second does not: the loop is unstable in both.
#[test]
fn an_unstable_loop_meets_nothing_however_short_its_window() {
    for window in ["loop.duration_s=20.0", "loop.duration_s=0.5"] {
        let set = ["controller.P.kp=5.0", window];
        for measure in Measure::ALL {
            // The aircraft alone is what it is: its phugoid never doubles.
            let limit = match (measure.is_yes_or_no(), measure.family()) {
                (true, _) => "",
                (false, Family::Airframe) => "least = 0.0",
                (false, _) => "least = 0.0\nmost = 1e300",
            };
            let conditions = match measure {
                Measure::RecoveryTime => "within_deg = 1e6",
                Measure::AltitudeOvershoot => "target_ft = 0.0",
                _ => "",
            };
            let requirement = format!("measure = \"{}\"\n{limit}\n{conditions}", measure.name());
            let judgement = of("P", &requirement, &set);
            let is_of_aircraft = measure.family() == Family::Airframe;
            assert_eq!(judgement.met, is_of_aircraft, "{} {window}", measure.name());
        }
        let stable = of("P", "measure = \"stable\"", &set);
        assert_eq!(stable.value_in_words(), "unstable");
        assert!(stable.place().spectral_radius.expect("it is told") > 1.0);
    }
}

/// The supervisor's gains at rest hold the plant only at the wrong sign: the window is too short to show it.
#[test]
fn a_self_tuning_loop_that_is_unstable_at_rest_is_not_believed() {
    let set = [
        "controller.FSPID.nominal={kp=-0.02,ki=0.0,kd=0.0}",
        "controller.FSPID.supervisor.output_scale={kp=0.0,ki=0.0,kd=0.0}",
        "setpoint.amplitude_deg=0.1",
        "loop.duration_s=5.0",
    ];
    let judgement = of("FSPID", "measure = \"largest_error_deg\"\nmost = 99.0", &set);
    assert!(!judgement.met);
    // There is one plant, and the trim is where the others are counted from.
    let Err(NotEvaluated::Unstable { place, .. }) = judgement.found else {
        panic!("{judgement:?}");
    };
    assert_eq!((place.plant, place.rest), (None, None));
}

#[test]
fn the_worst_of_all_steps_and_all_plants_counts() {
    let changing = format!(
        "{}\n[[plant_change]]\nat_s = 10.0\nnumerator = [-3.38, -1.69, -0.02]\ndenominator = [1.0, 1.17103, 1.55405, 0.012538, 0.0072771]\n",
        JUMBO
    );
    let judgement =
        one(&changing, "measure = \"phase_margin_deg\"\nleast = 0.0\ncontroller = \"P\"", &[]);
    let plant = judgement.place().plant.expect("there are two");
    assert_eq!((plant.index, plant.from_s), (1, 10.0), "twice the elevator's effect, less margin");
    let alone =
        values(JUMBO, Measure::PhaseMargin, "controller = \"P\"", &["controller.P.kp=2.0"])[0];
    let found = judgement.found.expect("stable").value;
    // Twice the printed coefficients, rounded to three digits.
    assert!((found - alone).abs() < 0.2, "{found} {alone}");
}

#[test]
fn efforts_are_those_of_the_trace() {
    let simulation = Simulation::of(&study(JUMBO, &[])).expect("it flies");
    let largest = |values: &[f64], dt_s: f64| {
        let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs() / dt_s);
        steps.fold(0.0, f64::max).to_degrees()
    };
    let rates = values(JUMBO, Measure::ElevatorRate, "", &[]);
    let commands = values(JUMBO, Measure::CommandRate, "", &[]);
    let sizes = values(JUMBO, Measure::LargestCommand, "", &[]);
    for (index, result) in simulation.results.iter().enumerate() {
        let trace = &result.trace;
        assert!((rates[index] - largest(&trace.elevator_rad, 0.01)).abs() < 1e-9);
        assert!((commands[index] - largest(&trace.command_rad, 0.01)).abs() < 1e-9);
        let size = trace.command_rad.iter().fold(0.0, |a: f64, u| a.max(u.abs())).to_degrees();
        assert!((sizes[index] - size).abs() < 1e-12);
    }
    assert_eq!(values(JUMBO, Measure::Saturated, "", &[]), [0.0, 0.0]);
    let limited = JUMBO.replace("kp = 1.0", "kp = 1.0\noutput_limits_deg = [-1.0, 1.0]");
    let cut = values(&limited, Measure::Saturated, "controller = \"P\"", &[])[0];
    let samples =
        Simulation::of(&study(&limited, &[])).expect("it flies").results[0].trace.saturated_samples;
    assert!(samples > 0);
    assert_eq!(cut, 100.0 * samples as f64 / 2001.0);
}

#[test]
fn an_old_file_of_requirements_means_what_it_meant() {
    let old = "[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 20.0\n[[requirement]]\ncontroller = \"P\"\nmeasure = \"final_error_pct\"\nmost = 50.0\n";
    let judgements = judged(JUMBO, old, &[]);
    let told: Vec<(&str, &str)> =
        judgements.iter().map(|j| (j.requirement.id.as_str(), j.controller.as_str())).collect();
    assert_eq!(
        told,
        [("overshoot_pct", "P"), ("overshoot_pct", "FSPID"), ("final_error_pct", "P")]
    );
}

#[test]
fn a_measure_that_is_differentiated_has_the_value_that_is_judged() {
    let square =
        JUMBO.replace("kind = \"step\"", "kind = \"square\"\nhalf_period_s = 5.0\nbipolar = true");
    let mut compared = 0;
    for (text, conditions) in
        [(JUMBO, ""), (&square, ""), (&square, "step_deg = 10.0"), (&square, "from_s = 3.0")]
    {
        for measure in Measure::ALL {
            if SlopeOf::measure(measure) != Some(SlopeOf::Flight) {
                continue;
            }
            let asked = format!(
                "{text}\n[[requirement]]\nmeasure = \"{}\"\nmost = 1e4\n{conditions}\n",
                measure.name()
            );
            // A condition that the measure does not know.
            let Ok(study) = file::parse(&asked, "test.toml", None, &[]) else { continue };
            let prepared = study.scenario.prepare().expect("a loop");
            let simulation = Simulation::of(&study).expect("it flies");
            for (result, judgement) in simulation.results.iter().zip(&simulation.judgements) {
                let Trace { setpoint_rad, theta_rad, elevator_rad, command_rad, .. } =
                    result.trace.clone();
                let flown = Flown { setpoint_rad, theta_rad, elevator_rad, command_rad };
                let (edges, timing) = (prepared.edges(), prepared.timing());
                let mut slopes = Slopes::zero(flown.theta_rad.len());
                let flight = Sloped { flown: &flown, edges, timing };
                let found =
                    add_slopes(flight, &study.requirements[0], 1.0, &mut slopes).expect("a value");
                let judged = judgement.found.as_ref().expect("evaluated").value;
                let judged = measure.compared(judged);
                let off = (found - judged).abs();
                assert!(off <= 1e-12 * judged.abs(), "{measure:?} {conditions}: {found} {judged}");
                compared += 1;
            }
        }
    }
    assert!(compared >= 50, "{compared} values compared");
}

/// The jumbo with one of its controllers and a requirement.
fn alone(controller: usize, requirement: &str) -> file::Study {
    let mut study = study(&format!("{JUMBO}\n[[requirement]]\n{requirement}\n"), &[]);
    study.scenario.controllers = vec![study.scenario.controllers.remove(controller)];
    study
}

#[test]
fn a_measure_of_a_loop_without_a_flight_is_the_one_that_is_judged() {
    let mut compared = 0;
    for measure in Measure::ALL {
        if SlopeOf::measure(measure) != Some(SlopeOf::Loop) {
            continue;
        }
        for controller in [0, 1] {
            let limit = format!("measure = \"{}\"\nleast = 0.0", measure.name());
            let study = alone(controller, &limit);
            let judged = Simulation::of(&study).expect("it flies").judgements.remove(0);
            let theirs = judged.found.map(|case| measure.compared(case.value));
            let ours = of_loop(&study, &study.requirements[0]);
            assert_eq!(ours, theirs, "{} of controller {controller}", measure.name());
            compared += usize::from(ours.is_ok());
        }
    }
    assert!(compared >= 20, "{compared} values compared");
}

#[test]
fn of_no_controller_with_equations_a_loop_has_no_measure() {
    let mut study = alone(0, "measure = \"phase_margin_deg\"\nleast = 0.0");
    study.scenario.controllers.clear();
    assert_eq!(of_loop(&study, &study.requirements[0]), Err(NotEvaluated::External));
}

/// Of fixed gains without limits the flight itself says that the loop is unstable, and of one loop alone.
#[test]
fn an_unstable_loop_of_fixed_gains_is_told_by_its_flight() {
    let judgement = of("P", "measure = \"iae_deg_s\"\nmost = 1e300", &["controller.P.kp=5.0"]);
    let Err(NotEvaluated::Absent(Absent::Unstable { spectral_radius })) = judgement.found else {
        panic!("{judgement:?}")
    };
    assert!(spectral_radius > 1.0 && judgement.place().is_empty(), "{spectral_radius}");
}

#[test]
fn what_an_external_controller_says_of_its_own_limits_is_no_measure() {
    let study = alone(0, "measure = \"saturated_pct\"\nmost = 1.0");
    let result = Simulation::of(&study).expect("it flies").results.remove(0);
    let source = ExternalSource::Library("controller.so".into());
    let (contents, renamed) = (None, Vec::new());
    let external = External { source, contents, answer_limit_s: 1.0, dt_s: 0.01, renamed };
    let external = NamedExternal { name: "theirs".to_owned(), external };
    let evidence = Evidence::new(&study, Flyer::External(&external), &result);
    assert_eq!(evidence.cases(&study.requirements[0]), Err(NotEvaluated::OwnWord));
    // What is measured of it counts, and what its equations would say does not.
    let asked = |measure| Requirement { measure, ..study.requirements[0].clone() };
    let travel = evidence.cases(&asked(Measure::ElevatorTravel)).expect("it was flown");
    assert_eq!(travel.len(), 1);
    let margin = evidence.cases(&asked(Measure::PhaseMargin));
    assert_eq!(margin, Err(NotEvaluated::External));
    let own = study.scenario.flyers().next().expect("a controller");
    let evidence = Evidence::new(&study, own, &result);
    assert!(evidence.cases(&study.requirements[0]).is_ok());
    // Margins of ours do not wait for a library that is not there.
    let mut beside = study.clone();
    beside.scenario.externals.push(external);
    let own = beside.scenario.flyers().next().expect("a controller");
    assert!(Evidence::new(&beside, own, &result).cases(&asked(Measure::PhaseMargin)).is_ok());
}

#[test]
fn the_aircraft_alone_is_judged_once_and_says_that_it_is() {
    let limit = "least = 0.0";
    let damping = format!("[[requirement]]\nmeasure = \"short_period_damping\"\n{limit}\n");
    let judgements = judged(JUMBO, &damping, &[]);
    assert_eq!(judgements.len(), 1);
    assert!(judgements[0].is_of_aircraft() && judgements[0].controller == "(aircraft)");
    let margin = format!("[[requirement]]\nmeasure = \"phase_margin_deg\"\n{limit}\n");
    let judgements = judged(JUMBO, &margin, &[]);
    assert_eq!(judgements.len(), 2);
    assert!(judgements.iter().all(|one| !one.is_of_aircraft()));
}
