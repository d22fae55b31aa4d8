//! Values of the literature, and cases that other tools answer wrongly.

use fspid_study::analysis::BreakPoint;
use fspid_study::metrics::Absent;

use super::{LOOP, analysed, analysed_at, margins};

/// A printed value with one unit of its last digit: the handbook's values come from rounded inputs.
fn near(found: f64, printed: f64, unit: f64) {
    assert!((found - printed).abs() <= unit, "{found} is not {printed}");
}

#[test]
fn the_loop_with_gain_2_has_the_margins_of_its_sampling() {
    let at_20_hz = margins(LOOP, &[]).expect("stable");
    near(at_20_hz.gain_margin_db[1], 5.64, 0.01);
    near(at_20_hz.phase_margin_deg, 15.2, 0.1);
    let delayed = ["loop.sample_period_s=0.1", "actuator.delay_samples=1"];
    let at_10_hz = margins(LOOP, &delayed).expect("stable");
    near(at_10_hz.gain_margin_db[1], 0.2, 0.05);
    near(at_10_hz.phase_margin_deg, 0.9, 0.1);
    // Sampled fast, the loop is the continuous one: 7.5 dB and 18.1 deg.
    let fast = margins(LOOP, &["loop.sample_period_s=0.0001"]).expect("stable");
    near(fast.gain_margin_db[1], 7.5, 0.05);
    near(fast.phase_margin_deg, 18.1, 0.1);
}

#[test]
fn the_smallest_disk_is_found_where_grids_of_frequencies_find_one_twice_as_large() {
    let found = [0.0001, 0.05].map(|dt| {
        margins(LOOP, &[&format!("loop.sample_period_s={dt}")]).expect("stable").disk_margin
    });
    // The handbook's grids of 20, 50, 100 and 1000 frequencies say 0.610, 0.380, 0.293 and 0.2891.
    assert!(found.iter().any(|size| (size - 0.28898).abs() < 2e-4), "{found:?}");
}

#[test]
fn proportional_loops_have_the_continuous_margins_when_sampled_fast() {
    let fast = "loop.sample_period_s=0.0001";
    let b747 = margins(LOOP, &[fast, "controller.C.kp=1.0"]).expect("stable");
    near(b747.gain_margin_db[1], 13.53, 0.01);
    near(b747.phase_margin_deg, 45.01, 0.01);
    near(b747.phase_crossover_rad_s[1].expect("a limit"), 2.929, 0.001);
    near(b747.gain_crossover_rad_s.expect("a crossover"), 1.445, 0.001);
    near(b747.sensitivity_peak, 1.9829, 2e-4);
    let navion = ["plant.preset=\"navion-paper\"", fast, "controller.C.kp=1.0"];
    let navion = margins(LOOP, &navion).expect("stable");
    near(navion.gain_margin_db[1], 12.05, 0.01);
    near(navion.phase_margin_deg, 65.44, 0.02);
    near(navion.phase_crossover_rad_s[1].expect("a limit"), 6.327, 0.002);
    near(navion.gain_crossover_rad_s.expect("a crossover"), 2.557, 0.001);
    // Half a sample of lag, 50 µs, still shows here.
    near(navion.sensitivity_peak, 1.7109, 5e-4);
}

#[test]
fn an_unstable_loop_has_poles_and_no_margins() {
    for gain in ["controller.C.kp=5.0", "controller.C.kp=10.0"] {
        let analysis = analysed(LOOP, &["loop.sample_period_s=0.01", gain]);
        assert!(!analysis.all_held());
        let margins = analysis.loops[0].margins();
        assert!(
            matches!(margins, Err(Absent::Unstable { spectral_radius }) if spectral_radius > 1.0)
        );
        let answer = &analysis.json()["controllers"][0];
        assert_eq!(answer["stable"], false);
        assert_eq!(answer["unstable_poles"].as_array().map(Vec::len), Some(2));
        for absent in ["gain_margin_db", "phase_margin_deg", "disk_margin", "sensitivity_peak"] {
            assert!(answer.get(absent).is_none(), "{absent}");
        }
    }
}

#[test]
fn a_positive_sign_of_the_elevator_makes_every_gain_unstable() {
    let plant = r#"plant={ numerator = [-1.69144, -0.84341, -0.0099096], denominator = [1.0, 1.17103, 1.55405, 0.012538, 0.0072771], elevator_sign = "nose-up-positive" }"#;
    for gain in ["controller.C.kp=0.1", "controller.C.kp=0.5", "controller.C.kp=5.0"] {
        assert!(!analysed(LOOP, &[plant, "loop.sample_period_s=0.01", gain]).all_held());
    }
}

#[test]
fn a_rate_loop_is_broken_with_the_pitch_loop_closed() {
    let set =
        ["loop.sample_period_s=0.01", "controller.C.kp=3.5287", "controller.C.rate_gain=0.9144"];
    let of = |point| analysed_at(LOOP, &set, point).loops[0].margins().expect("stable");
    let [command, pitch, rate] = BreakPoint::ALL.map(of);
    // Without its rate loop this gain is 2.6 dB below the neutral 4.75: the rate loop may open, but
    // it is what gives the pitch loop its margin.
    assert!(pitch.gain_margin_db[1] > 11.0, "{pitch:?}");
    assert!(rate.gain_margin_db[0].is_infinite(), "{rate:?}");
    assert!((command.disk_margin - pitch.disk_margin).abs() > 1e-3);
    let none = analysed_at(LOOP, &["loop.sample_period_s=0.01"], BreakPoint::Rate);
    assert_eq!(none.loops[0].margins(), Err(Absent::NoRateLoop));
}

/// Issue 14: a phugoid of 0.0024 rad/s sampled at 100 Hz lies within 3e-5 of z = 1, where level sets lost its peak: the
/// answer was a disk margin of 1.9944 and a sensitivity peak of 1.0014, both at Nyquist's frequency.
#[test]
fn a_slow_phugoid_sampled_fast_keeps_its_peak() {
    let slow = r#"
schema = 1
name = "slow"
[plant]
numerator = [0.164319198678308, 0.019741450638662523, 0.0001578062351632995, 5.91386240829545e-07]
denominator = [1.0, 2.2670562990848655, 11.092049189641381, 0.0005505139406397153, 6.328349077933575e-05]
elevator_sign = "nose-up-positive"
[actuator]
time_constant_s = 0.0
[loop]
sample_period_s = 0.01
duration_s = 5.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
[[controller]]
name = "C"
kind = "pid"
kp = 1.7147072448943388
ki = 0.00015804193991113128
kd = 0.0
"#;
    let found = margins(slow, &[]).expect("stable");
    assert!(found.disk_margin <= 1.49538, "{found:?}");
    assert!(found.sensitivity_peak >= 1.13194, "{found:?}");
    near(found.sensitivity_peak_rad_s, 0.00246, 5e-6);
}
