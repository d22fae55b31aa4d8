//! How requirements are judged: the worst case, the limit itself, and what cannot be evaluated.

use fspid_scenario::file;
use fspid_scenario::measure::{Family, Measure};
use fspid_scenario::requirement::Requirement;
use fspid_sim::gradient::{Flown, Slopes};
use fspid_sim::{External, ExternalSource, Flyer, NamedExternal, Trace};
use fspid_study::analysis::{Analysis, Question};
use fspid_study::judgement::{
    Evidence, Judgement, NotEvaluated, SlopeOf, Sloped, add_slopes, of_loop,
};
use fspid_study::metrics::Absent;
use fspid_study::simulation::Simulation;

use crate::requirements::{JUMBO, judged, repository, study, values};

/// The only judgement.
pub(super) fn one(text: &str, requirement: &str, set: &[&str]) -> Judgement {
    let mut judgements = judged(text, &format!("[[requirement]]\n{requirement}"), set);
    assert_eq!(judgements.len(), 1, "{judgements:?}");
    judgements.remove(0)
}

/// The same for one controller of the jumbo.
pub(super) fn of(controller: &str, requirement: &str, set: &[&str]) -> Judgement {
    one(JUMBO, &format!("{requirement}\ncontroller = \"{controller}\"\n"), set)
}

#[test]
fn margins_are_those_of_the_analysis_bit_for_bit() {
    let analysis = Analysis::of(&study(JUMBO, &[]), Question::default()).expect("it is analysed");
    let margins: Vec<_> =
        analysis.loops.iter().map(|one| one.margins().expect("a stable loop")).collect();
    let theirs = |of: fn(&fspid_study::analysis::Margins) -> f64| -> Vec<f64> {
        margins.iter().map(of).collect()
    };
    let ours = |measure| values(JUMBO, measure, "", &[]);
    assert_eq!(ours(Measure::PhaseMargin), theirs(|m| m.phase_margin_deg));
    assert_eq!(ours(Measure::GainMarginHigh), theirs(|m| m.gain_margin_db[1]));
    assert_eq!(ours(Measure::GainMarginLow), theirs(|m| -m.gain_margin_db[0]));
    assert_eq!(
        ours(Measure::GainMargin),
        theirs(|m| (-m.gain_margin_db[0]).min(m.gain_margin_db[1]))
    );
    assert_eq!(ours(Measure::DelayMargin), theirs(|m| m.delay_margin_s));
    assert_eq!(ours(Measure::DiskMargin), theirs(|m| m.disk_margin));
    assert_eq!(ours(Measure::SensitivityPeak), theirs(|m| m.sensitivity_peak));
    assert_eq!(
        ours(Measure::GainCrossover),
        theirs(|m| m.gain_crossover_rad_s.expect("the gain is 1 somewhere"))
    );
}

/// Continuous values of the handbook (flight.md 1.6 and 7): a gain of 4.750, 45.01 deg at 1.445 rad/s, sensitivity
/// 1.9829. The hold costs half a sample, an error of first order in the period: two periods take it away.
#[test]
fn a_quickly_sampled_loop_tends_to_the_margins_of_the_book() {
    let at = |measure, period: &str| {
        let period = format!("loop.sample_period_s={period}");
        let set = [period.as_str(), "loop.duration_s=1.0"];
        values(JUMBO, measure, "controller = \"P\"", &set)[0]
    };
    let limit = |measure| 2.0 * at(measure, "0.0005") - at(measure, "0.001");
    let near = |measure, book: f64, digits: f64| {
        let found = limit(measure);
        assert!((found - book).abs() <= digits, "{}: {found} {book}", measure.name());
    };
    near(Measure::GainMargin, 20.0 * 4.750_f64.log10(), 1e-3);
    near(Measure::PhaseMargin, 45.01, 5e-3);
    near(Measure::GainCrossover, 1.445, 5e-4);
    near(Measure::SensitivityPeak, 1.9829, 1e-4);
}

#[test]
fn a_value_that_equals_its_limit_meets_it_and_the_next_number_does_not() {
    let is_here =
        |measure: &Measure| !measure.is_yes_or_no() && measure.family() != Family::Aircraft;
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

/// Below a gain of 0.3 the phugoid still reaches over a loop gain of 1: it has crossovers of its own.
#[test]
fn every_crossing_is_judged_in_the_band_of_its_frequency() {
    let weak = ["controller.P.kp=0.3", "loop.duration_s=1.0"];
    let phase = |conditions: &str| {
        values(JUMBO, Measure::PhaseMargin, &format!("controller = \"P\"\n{conditions}"), &weak)[0]
    };
    let (all, low, high) = (phase(""), phase("to_hz = 0.06"), phase("from_hz = 0.06"));
    assert!(low.is_finite(), "the phugoid crosses at some 0.011 Hz");
    assert_eq!(all, low.min(high));
    let asked = "measure = \"phase_margin_deg\"\nleast = 0.0\nto_hz = 0.06";
    let at_rad_s = of("P", asked, &weak).place().frequency_rad_s.expect("where it crosses");
    assert!(at_rad_s < 0.06 * std::f64::consts::TAU, "{at_rad_s}");
    let analysis = Analysis::of(&study(JUMBO, &weak), Question::default()).expect("analysed");
    let found = analysis.loops[0].plants[0].worst.sampled.as_ref().expect("it is stable");
    let crossover = |at: &fspid_lti::SampledCrossover| {
        (at.omega_rad_s / std::f64::consts::TAU, at.phase_margin_rad.abs().to_degrees())
    };
    let margins: Vec<(f64, f64)> = found.crossovers.iter().map(crossover).collect();
    assert!(margins.len() >= 2, "{margins:?}");
    let least = |low_hz: f64, high_hz: f64| {
        let inside = margins.iter().filter(|(hz, _)| (low_hz..high_hz).contains(hz));
        inside.map(|(_, margin)| *margin).fold(f64::INFINITY, f64::min)
    };
    assert!((low - least(0.0, 0.06)).abs() < 1e-9);
    assert!(high == least(0.06, 1e9) || (high - least(0.06, 1e9)).abs() < 1e-9);
}

#[test]
fn the_bands_of_the_gain_margin_together_have_the_whole_one() {
    let gain = |conditions: &str| values(JUMBO, Measure::GainMargin, conditions, &[]);
    let (all, low, high) = (gain(""), gain("to_hz = 0.3"), gain("from_hz = 0.3"));
    for ((all, low), high) in all.iter().zip(low).zip(high) {
        assert!((all - low.min(high)).abs() < 1e-9, "{all} {low} {high}");
    }
    // At 2.93 rad/s the proportional loop would oscillate: 0.466 Hz.
    let nothing = values(JUMBO, Measure::GainMargin, "controller = \"P\"\nto_hz = 0.4", &[]);
    let something = values(JUMBO, Measure::GainMargin, "controller = \"P\"\nto_hz = 0.5", &[]);
    assert_eq!(nothing, [f64::INFINITY]);
    assert!(something[0].is_finite());
}

/// 0.7/(s - 0.5): the loop is lost at 0.5/0.7 of its gain, which is nearer than the gain that the servo bears.
const GROWING: &str =
    "numerator = [1.0]\ndenominator = [1.0, -0.5]\nelevator_sign = \"nose-up-positive\"";

#[test]
fn a_gain_that_may_not_fall_is_a_margin_of_its_own() {
    let text = JUMBO.replace("preset = \"b747-paper\"", GROWING);
    let set = ["controller.P.kp=0.7", "controller.P.output_limits_deg=[-60.0, 60.0]"];
    let of = |measure: Measure, conditions: &str| {
        let requirement = format!(
            "measure = \"{}\"\nleast = 0.0\ncontroller = \"P\"\n{conditions}",
            measure.name()
        );
        let case = one(&text, &requirement, &set).found.expect("a margin");
        (case.value, case.place.frequency_rad_s)
    };
    let low_db = 20.0 * 1.4_f64.log10();
    let (high_db, high_rad_s) = of(Measure::GainMarginHigh, "");
    let high_rad_s = high_rad_s.expect("where it oscillates");
    assert!(high_db > 12.0 && high_rad_s > 1.0, "{high_db} {high_rad_s}");
    for measure in [Measure::GainMargin, Measure::GainMarginLow] {
        // In the band of what lies below a hertz as well: at rest.
        for conditions in ["", "to_hz = 0.1"] {
            let (found, at_rad_s) = of(measure, conditions);
            assert!((found - low_db).abs() < 1e-9, "{} {conditions}: {found}", measure.name());
            assert_eq!(at_rad_s, Some(0.0), "{} {conditions}", measure.name());
        }
    }
    assert_eq!(of(Measure::GainMarginHigh, "to_hz = 0.1"), (f64::INFINITY, None));
    assert_eq!(of(Measure::GainMarginLow, "from_hz = 0.1"), (f64::INFINITY, None));
    let (found, at_rad_s) = of(Measure::GainMargin, "from_hz = 0.1");
    assert!((found - high_db).abs() < 1e-9, "{found} {high_db}");
    assert!((at_rad_s.expect("there") - high_rad_s).abs() < 1e-6);
}

#[test]
fn a_loop_that_is_stable_at_rest_and_whose_flight_diverges_is_not_stable() {
    // More is commanded than the elevator can hold.
    let text = JUMBO.replace("preset = \"b747-paper\"", GROWING);
    let set =
        ["controller.P.kp=0.7", "controller.P.output_limits_deg=[-1.0, 1.0]", "loop.duration_s=60"];
    let stable = "measure = \"stable\"\ncontroller = \"P\"";
    let judgement = one(&text, stable, &set);
    let case = judgement.found.clone().expect("known");
    assert!(!judgement.met && case.value == 0.0 && case.place.at_s.is_some(), "{judgement:?}");
    // A margin is one of the loop at rest, of the only plant that there is.
    let disk = one(&text, "measure = \"disk_margin\"\nleast = 0.0\ncontroller = \"P\"", &set);
    assert!(disk.met && disk.place().plant.is_none(), "{disk:?}");
    assert!(one(&text, stable, &["controller.P.kp=0.7", "setpoint.amplitude_deg=0.1"]).met);
}

/// From the poles of the sampled loop, by the definition of a damping ratio.
#[test]
fn the_damping_is_that_of_the_least_damped_closed_loop_pole() {
    let analysis = Analysis::of(&study(JUMBO, &[]), Question::default()).expect("analysed");
    let ours = values(JUMBO, Measure::ModeDamping, "", &[]);
    for (analysed, ours) in analysis.loops.iter().zip(ours) {
        let poles = &analysed.plants[0].worst.closed_poles;
        let damping = poles.iter().map(|pole| (pole.re.hypot(pole.im), pole.im.atan2(pole.re)));
        let damping = damping.filter(|(size, _)| *size > 0.0).map(|(size, angle)| {
            let decay = -size.ln();
            decay / decay.hypot(angle)
        });
        let least = damping.fold(f64::INFINITY, f64::min);
        assert!((ours - least).abs() < 1e-9, "{ours} {least}");
    }
    // The phugoid's, at the place that a band around it has.
    let band = "measure = \"mode_damping\"\nleast = 0.0\nto_hz = 0.05";
    let at_rad_s = of("P", band, &[]).place().frequency_rad_s.expect("the mode's");
    assert!((0.01..0.3).contains(&at_rad_s), "{at_rad_s}");
}

#[test]
fn the_modes_of_the_aircraft_are_those_of_the_book() {
    let jumbo = |measure| values(JUMBO, measure, "", &[]);
    // Printed polynomial: short period 0.46937233, phugoid 0.03320908; the aircraft is judged once.
    assert_eq!(jumbo(Measure::ShortPeriodDamping).len(), 1);
    assert!((jumbo(Measure::ShortPeriodDamping)[0] - 0.469_372_33).abs() < 1e-8);
    assert!((jumbo(Measure::PhugoidDamping)[0] - 0.033_209_08).abs() < 1e-8);
    assert_eq!(jumbo(Measure::PhugoidDoubling), [f64::INFINITY]);
    let navion = JUMBO.replace("b747-paper", "navion-paper").replace("kp = 1.0", "kp = 0.5");
    // wn² over n/alpha, from the printed coefficients, the plant's 176 ft/s and standard gravity.
    let cap = 12.941 * 9.80665 / (53.6448 * 22.578 / 11.7304);
    assert!((values(&navion, Measure::ControlAnticipation, "", &[])[0] - cap).abs() < 1e-12);
    let short_period = values(&navion, Measure::ShortPeriodDamping, "", &[])[0];
    assert!((short_period - 4.9676 / 2.0 / 12.941_f64.sqrt()).abs() < 1e-12);
}

/// A servo of 0.1 s at the short period's 1.2426 rad/s, a delay of two samples and half a sample of the hold.
#[test]
fn the_equivalent_delay_has_servo_samples_and_hold() {
    let set = ["actuator.delay_samples=2"];
    let found = values(JUMBO, Measure::EquivalentDelay, "", &set)[0];
    let omega: f64 = 1.242_585_25;
    let expected = (0.1 * omega).atan() / omega + 2.5 * 0.01;
    assert!((found - expected).abs() < 1e-8, "{found} {expected}");
}

#[test]
fn a_phugoid_that_the_model_does_not_have_is_not_met() {
    let navion = JUMBO.replace("b747-paper", "navion-paper");
    let judgement = one(&navion, "measure = \"phugoid_damping\"\nleast = 0.0", &[]);
    assert!(!judgement.met);
    assert!(matches!(judgement.found, Err(NotEvaluated::Quality(_))), "{:?}", judgement.found);
}

/// Slow poles at -0.02 and -0.05 rad/s, and at 0.01 and -0.05, before a short period of (s² + 1.5 s + 4).
#[test]
fn a_phugoid_that_creeps_is_damped_where_it_falls_and_not_where_it_grows() {
    let creeping = |denominator: &str| {
        let plant = format!(
            "numerator = [1.0, 0.8, 0.02]\ndenominator = {denominator}\nelevator_sign = \"nose-up-positive\""
        );
        let text = JUMBO.replace("preset = \"b747-paper\"", &plant);
        [Measure::PhugoidDamping, Measure::PhugoidDoubling]
            .map(|measure| values(&text, measure, "", &[])[0])
    };
    assert_eq!(creeping("[1.0, 1.57, 4.106, 0.2815, 0.004]"), [1.0, f64::INFINITY]);
    let [damping, doubles_s] = creeping("[1.0, 1.54, 4.0595, 0.15925, -0.002]");
    assert_eq!(damping, -1.0);
    assert!((doubles_s - 2.0_f64.ln() / 0.01).abs() < 1e-6, "{doubles_s}");
}

#[test]
fn an_aircraft_of_unknown_speed_has_no_control_anticipation_but_has_its_modes() {
    let plant = "numerator = [11.7304, 22.578]\ndenominator = [1.0, 4.9676, 12.941, 0.0]\nelevator_sign = \"nose-up-positive\"";
    let text = JUMBO.replace("preset = \"b747-paper\"", plant);
    let cap = one(&text, "measure = \"cap_rad_s2_per_g\"\nleast = 0.0", &[]);
    assert_eq!((cap.met, &cap.found), (false, &Err(NotEvaluated::SpeedUnknown)));
    assert!(values(&text, Measure::ShortPeriodDamping, "", &[])[0] > 0.69);
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
        "controller.FSPID.nominal.kp=-0.02",
        "controller.FSPID.nominal.ki=0.0",
        "controller.FSPID.nominal.kd=0.0",
        "controller.FSPID.supervisor.output_scale.kp=0.0",
        "controller.FSPID.supervisor.output_scale.ki=0.0",
        "controller.FSPID.supervisor.output_scale.kd=0.0",
        "setpoint.amplitude_deg=0.1",
        "loop.duration_s=5.0",
    ];
    let judgement = of("FSPID", "measure = \"largest_error_deg\"\nmost = 99.0", &set);
    assert!(!judgement.met);
    assert!(matches!(judgement.found, Err(NotEvaluated::Unstable { .. })), "{judgement:?}");
}

/// Where a calm flight is refused for its loop, the plant and the rest that are not held are told.
#[test]
fn the_plant_and_the_rest_at_which_a_loop_is_unstable_are_told() {
    let calm = "[[requirement]]\nmeasure = \"largest_error_deg\"\nmost = 99.0\nto_s = 2.0\ncontroller = \"FSPID\"\n";
    let place = |text: &str, set: &[&str]| match &judged(text, calm, set)[0].found {
        Err(NotEvaluated::Unstable { place, .. }) => place.clone(),
        other => panic!("{other:?}"),
    };
    // After 10 s the elevator acts to the other side.
    let change = "[[plant_change]]\nat_s = 10.0\nnumerator = [1.69, 0.843, 0.0099]\ndenominator = [1.0, 1.17103, 1.55405, 0.012538, 0.0072771]\n";
    let found = place(&format!("{JUMBO}{change}"), &["loop.duration_s=11.0"]);
    let plant = found.plant.expect("there are two");
    assert_eq!((plant.index, plant.from_s, found.rest), (1, 10.0, None));
    // Without an integral an error stays at rest, at which the rules ask for more gain than the loop bears.
    let set = [
        "controller.FSPID.nominal.kp=2.0",
        "controller.FSPID.nominal.ki=0.0",
        "controller.FSPID.nominal.kd=0.0",
        "controller.FSPID.supervisor.output_scale.kp=20.0",
        "controller.FSPID.supervisor.output_scale.ki=0.0",
        "controller.FSPID.supervisor.output_scale.kd=0.0",
        "controller.FSPID.supervisor.error_scale=2.0",
        "loop.duration_s=2.0",
    ];
    let found = place(JUMBO, &set);
    let rest = found.rest.expect("it is not the trim");
    assert!(found.plant.is_none() && rest.setpoint_rad != 0.0, "{rest:?}");
    // At the trim alone: gains that hold nothing.
    let trim = place(
        JUMBO,
        &[
            "controller.FSPID.nominal.kp=-0.02",
            "controller.FSPID.nominal.ki=0.0",
            "controller.FSPID.nominal.kd=0.0",
            "controller.FSPID.supervisor.output_scale={kp=0.0,ki=0.0,kd=0.0}",
            "setpoint.amplitude_deg=0.1",
            "loop.duration_s=2.5",
        ],
    );
    assert_eq!((trim.plant, trim.rest), (None, None));
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
fn a_loop_whose_gain_is_nowhere_one_has_no_crossover() {
    let weak = ["controller.P.kp=0.001"];
    let crossover = of("P", "measure = \"gain_crossover_rad_s\"\nmost = 99.0", &weak);
    assert_eq!((crossover.met, crossover.found), (false, Err(NotEvaluated::NoCrossover)));
    let phase = of("P", "measure = \"phase_margin_deg\"\nleast = 45.0", &weak);
    assert!(phase.met && phase.value_in_words() == "without end");
}

/// A proof is a requirement.
#[test]
fn a_loop_that_is_proved_meets_it_and_one_that_grows_standing_still_does_not() {
    let judged = |controller, scale: &str| {
        let output = "controller.FSPID.supervisor.output_scale";
        let set = ["kp", "ki", "kd"].map(|gain| format!("{output}.{gain}={scale}"));
        of(controller, "measure = \"certified\"", &set.each_ref().map(String::as_str))
    };
    let proved = ["P", "FSPID"].map(|controller| judged(controller, "0.001"));
    assert!(proved.iter().all(|it| it.met && it.value_in_words() == "proved stable"), "{proved:?}");
    let refuted = judged("FSPID", "1.0");
    assert!(!refuted.met && refuted.value_in_words() == "not proved stable", "{refuted:?}");
}

#[test]
fn every_plant_has_to_be_proved_and_the_one_that_is_not_is_told() {
    let turned = "numerator = [1.69, 0.843, 0.0099]\ndenominator = [1.0, 1.17103, 1.55405, 0.012538, 0.0072771]\n";
    let asked = |text: &str| one(text, "measure = \"certified\"\ncontroller = \"P\"", &[]);
    let only = format!("{turned}elevator_sign = \"nose-down-positive\"");
    let alone = asked(&JUMBO.replace("preset = \"b747-paper\"", &only));
    assert!(!alone.met && alone.place().plant.is_none(), "{alone:?}");
    let second = asked(&format!("{JUMBO}\n[[plant_change]]\nat_s = 10.0\n{turned}"));
    let plant = second.place().plant.expect("there are two");
    assert_eq!((second.met, plant.index, plant.from_s), (false, 1, 10.0));
}

/// A mode of its outer loops grows, whatever is proved of the pitch loop (erratum E-10).
#[test]
fn an_autopilot_that_is_not_held_at_rest_is_not_proved() {
    let path = repository("crates/fspid-scenario/tests/scenarios/every-key-autopilot.toml");
    let text = std::fs::read_to_string(&path).expect("it is there");
    let text = format!("{text}\n[[requirement]]\nmeasure = \"certified\"\n");
    let study = file::parse(&text, "autopilot.toml", path.parent(), &[]).expect("it reads");
    let judgements = Simulation::of(&study).expect("it flies").judgements;
    let proved = judgements.iter().filter(|it| it.requirement.measure == Measure::Certified);
    let proved: Vec<&Judgement> = proved.collect();
    assert!(!proved.is_empty() && proved.iter().all(|it| !it.met), "{proved:?}");
    assert!(proved.iter().all(|it| it.value_in_words() == "not proved stable"), "{proved:?}");
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
                "{text}\n[[requirement]]\nmeasure = \"{}\"\nmost = 1.0\n{conditions}\n",
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
