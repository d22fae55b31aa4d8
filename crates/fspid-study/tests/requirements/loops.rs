//! Requirements of the linear loops, of the aircraft alone and of proofs: each value, its band, its plant and its rest.

use fspid_scenario::file;
use fspid_scenario::measure::Measure;
use fspid_study::analysis::{Analysis, Question};
use fspid_study::judgement::{Judgement, NotEvaluated};
use fspid_study::simulation::Simulation;

use crate::requirements::{JUMBO, judged, of, one, repository, study, values};

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
        let [either, swings, creeps] = [
            Measure::PhugoidDoubling,
            Measure::PhugoidOscillationDoubling,
            Measure::PhugoidDivergenceDoubling,
        ]
        .map(|measure| values(&text, measure, "", &[])[0]);
        assert!(swings.is_infinite() && creeps.total_cmp(&either).is_eq(), "{swings} {creeps}");
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

/// The 747 whose elevator acts to the other side.
const TURNED: &str = "numerator = [1.69, 0.843, 0.0099]\ndenominator = [1.0, 1.17103, 1.55405, 0.012538, 0.0072771]\n";

/// Where a calm flight is refused for its loop, the plant and the rest that are not held are told.
#[test]
fn the_plant_and_the_rest_at_which_a_loop_is_unstable_are_told() {
    let calm = "[[requirement]]\nmeasure = \"largest_error_deg\"\nmost = 99.0\nto_s = 2.0\ncontroller = \"FSPID\"\n";
    let place = |text: &str, set: &[&str]| match &judged(text, calm, set)[0].found {
        Err(NotEvaluated::Unstable { place, .. }) => place.clone(),
        other => panic!("{other:?}"),
    };
    let found = place(
        &format!("{JUMBO}[[plant_change]]\nat_s = 10.0\n{TURNED}"),
        &["loop.duration_s=11.0"],
    );
    let plant = found.plant.expect("there are two");
    assert_eq!((plant.index, plant.from_s, found.rest), (1, 10.0, None));
    // Without an integral an error stays at rest, at which the rules ask for more gain than the loop bears.
    let set = [
        "controller.FSPID.nominal={kp=2.0,ki=0.0,kd=0.0}",
        "controller.FSPID.supervisor.output_scale={kp=20.0,ki=0.0,kd=0.0}",
        "controller.FSPID.supervisor.error_scale=2.0",
        "loop.duration_s=2.0",
    ];
    let found = place(JUMBO, &set);
    let rest = found.rest.expect("it is not the trim");
    assert!(found.plant.is_none() && rest.setpoint_rad != 0.0, "{rest:?}");
}

#[test]
fn a_loop_whose_gain_is_nowhere_one_has_no_crossover() {
    let weak = ["controller.P.kp=0.001"];
    let crossover = of("P", "measure = \"gain_crossover_rad_s\"\nmost = 99.0", &weak);
    assert_eq!((crossover.met, crossover.found), (false, Err(NotEvaluated::NoCrossover)));
    let phase = of("P", "measure = \"phase_margin_deg\"\nleast = 45.0", &weak);
    assert!(phase.met && phase.value_in_words() == "without end");
}

/// A band above half the sample rate has no crossing, which was taken for a margin without end.
#[test]
fn what_is_faster_than_the_samples_has_no_margin_that_could_be_met() {
    for measure in ["phase_margin_deg", "gain_margin_db", "gain_margin_high_db"] {
        let found = |from_hz: &str| {
            let asked = format!("measure = \"{measure}\"\nleast = 6.0\nfrom_hz = {from_hz}");
            of("P", &asked, &["loop.sample_period_s=0.05", "loop.duration_s=1.0"])
        };
        let beyond = NotEvaluated::BeyondSampling { from_hz: 10.0, ends_hz: 10.0 };
        assert!(found("9.99").met);
        let refused = found("10.0");
        assert_eq!((refused.met, refused.found), (false, Err(beyond)));
    }
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
    let asked = |text: &str| one(text, "measure = \"certified\"\ncontroller = \"P\"", &[]);
    let only = format!("{TURNED}elevator_sign = \"nose-down-positive\"");
    let alone = asked(&JUMBO.replace("preset = \"b747-paper\"", &only));
    assert!(!alone.met && alone.place().plant.is_none(), "{alone:?}");
    let second = asked(&format!("{JUMBO}\n[[plant_change]]\nat_s = 10.0\n{TURNED}"));
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

/// A bending mode near half the sample rate, at which the gain of the loop is 4.
const BENDING: &str = r#"
schema = 1
name = "bending mode near half the sample rate"
[plant]
numerator = [-16175.14818846, -71307.92997127, 37540.21281599]
denominator = [1.0, 14.2880807, 28053.0355, 123492.118, 0.0]
elevator_sign = "nose-up-positive"
[loop]
sample_period_s = 0.02
duration_s = 5.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[controller]]
name = "P"
kind = "pid"
kp = 1.0
"#;

/// 0.056 s were told, and 0.02 s make it grow.
#[test]
fn a_delay_margin_is_no_longer_than_the_first_sample_that_makes_the_loop_unstable() {
    let told_s = values(BENDING, Measure::DelayMargin, "", &[]);
    assert!(told_s.iter().all(|told_s| (0.0124..0.0127).contains(told_s)), "{told_s:?}");
    let late = one(BENDING, "measure = \"stable\"\nleast = 1", &["actuator.delay_samples=1"]);
    assert!(!late.met, "{late:?}");
    let analysis = Analysis::of(&study(BENDING, &[]), Question::default()).expect("analysed");
    assert!(analysis.text().contains("where a sample of delay turns the sign"));
}
