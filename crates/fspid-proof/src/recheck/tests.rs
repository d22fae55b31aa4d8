use fspid_core::{Change, Fspid, Gains, InputScale, Law, Pid, PidConfig, SelfTuner, TunerSettings};
use fspid_sim::Controller;
use fspid_sim::loop_model::BreakPoint;

use super::*;
use crate::description::LoopDescription;
use crate::scope::{Asked, Range};
use crate::{Effort, Verdict, certify};
use paper_loop::{NOMINAL, loop_of, rising};

#[path = "../../tests/paper_loop.rs"]
#[allow(clippy::expect_used, reason = "shared with a test")]
mod paper_loop;

fn tuned(input_scale: InputScale<f64>, change: Change) -> Fspid<f64> {
    let settings = TunerSettings {
        input_scale,
        output_scale: Gains { kp: 0.09, ki: 0.02, kd: 0.045 },
        law: Law::Memoryless,
        change,
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(NOMINAL, rising(), settings).expect("allowed");
    Fspid::new(tuner, PidConfig::sampled_every(0.01)).expect("allowed")
}

/// States of which none is zero, each another than the others.
fn states(size: usize) -> Vec<Vec<f64>> {
    let entry = |seed: usize, place: usize| ((seed * 7 + place * 5) % 11) as f64 / 4.0 - 1.3;
    (0..20).map(|seed| (0..size).map(|place| entry(seed, place)).collect()).collect()
}

fn along(row: &[Interval], state: &[f64]) -> f64 {
    row.iter().zip(state).map(|(entry, value)| entry.midpoint() * value).sum()
}

#[test]
fn a_supervisor_sees_the_error_and_its_rate_or_its_change_each_times_its_own_scale() {
    let scale = InputScale { error_per_rad: 57.0, change_per_rad: 12.0 };
    for (change, time_s) in [(Change::Rate, 0.01), (Change::Delta, 1.0)] {
        let fspid = tuned(scale, change);
        let model = loop_of(Controller::SelfTuning(fspid)).enclosed().expect("enclosed");
        let [seen_error, seen_change] = input_rows(&model, &fspid);
        let [error, by_sample] = model.error_rows();
        for state in states(model.size()) {
            let near = |one: f64, other: f64| (one - other).abs() <= 1e-9 * (1.0 + other.abs());
            assert!(near(along(&seen_error, &state), 57.0 * along(&error, &state)));
            let expected = 12.0 * along(&by_sample, &state) / time_s;
            assert!(near(along(&seen_change, &state), expected), "{change:?} {expected}");
        }
    }
}

#[test]
fn the_form_of_a_cone_is_the_product_of_what_both_its_sides_see() {
    let scale = InputScale { error_per_rad: 57.0, change_per_rad: 12.0 };
    let fspid = tuned(scale, Change::Rate);
    let model = loop_of(Controller::SelfTuning(fspid)).enclosed().expect("enclosed");
    let rows = input_rows(&model, &fspid);
    for normals in [[[0.3, 0.8], [-0.6, 0.5]], [[-1.0, 0.25], [0.4, -0.9]]] {
        let form = cone_form(&model, &fspid, &Cone { normals, cells: Vec::new() }).midpoint();
        for state in states(model.size()) {
            let [error, change] = [0, 1].map(|input: usize| along(&rows[input], &state));
            let [one, other] =
                normals.map(|[by_error, by_change]| by_error * error + by_change * change);
            let mut moved = vec![0.0; state.len()];
            form.apply(&state, &mut moved).expect("as large");
            let squared: f64 = moved.iter().zip(&state).map(|(x, y)| x * y).sum();
            let size = 1.0 + error * error + change * change;
            assert!((squared - one * other).abs() <= 1e-9 * size, "{squared} {}", one * other);
        }
    }
}

#[test]
fn an_input_whose_scale_is_zero_is_only_ever_zero() {
    let controller = |error_per_rad: f64, change_per_rad: f64| {
        let scale = InputScale { error_per_rad, change_per_rad };
        Controller::SelfTuning(tuned(scale, Change::Rate))
    };
    let no_error = controller(0.0, 12.0);
    assert!(can_see(&no_error, [0.0, 1.0]) && !can_see(&no_error, [1.0, 0.0]));
    let no_change = controller(57.0, 0.0);
    assert!(can_see(&no_change, [1.0, 0.0]) && !can_see(&no_change, [0.0, 1.0]));
    assert!(can_see(&controller(57.0, 12.0), [1.0, -1.0]));
}

#[test]
fn gains_at_which_something_fails_are_told_in_words() {
    let gains = Gains { kp: 2.0, ki: 0.5, kd: 1.25 };
    let grows = RecheckError::Grows { gains }.to_string();
    assert!(grows.contains("holds kp 2.0000, ki 0.5000, kd 1.2500 as well"), "{grows}");
    let reason = NotProved::NotKept;
    let at_some = RecheckError::Inequality { gains: Some(gains), reason: reason.clone() };
    let at_none = RecheckError::Inequality { gains: None, reason: reason.clone() };
    assert_eq!(at_some.to_string(), format!("at kp 2.0, ki 0.5, kd 1.25: {reason}"));
    assert_eq!(at_none.to_string(), reason.to_string());
}

#[test]
fn gains_are_those_that_the_supervisor_makes_of_an_input_and_fixed_ones_stay() {
    let pid = Pid::new(NOMINAL, PidConfig::sampled_every(0.01)).expect("allowed");
    assert_eq!(produced(&Controller::Fixed(pid), [5.0, 1.0]), NOMINAL);
    let scale = InputScale { error_per_rad: 57.0, change_per_rad: 12.0 };
    let moved = produced(&Controller::SelfTuning(tuned(scale, Change::Rate)), [5.0, 0.0]);
    assert!(moved.kp > NOMINAL.kp && moved.ki > NOMINAL.ki && moved.kd > NOMINAL.kd, "{moved:?}");
}

/// The sum of what half a step of each sensor leaves at all later samples, in ordinary arithmetic, is what is bounded.
#[test]
fn what_two_sensors_leave_of_a_motion_is_the_sum_of_what_each_of_their_samples_does() {
    let config = PidConfig { rate_gain_s: 0.25, ..PidConfig::sampled_every(0.01) };
    let pid = Pid::new(NOMINAL, config).expect("allowed");
    let mut description = loop_of(Controller::Fixed(pid));
    description.pitch.resolution = 1e-6;
    description.rate.resolution = 5e-4;
    let asked = Asked::within(Range { setpoint_rad: 0.5, load_rad: 0.0 });
    let outcome = certify(&description, &asked, &Effort::default()).expect("provable");
    let Verdict::Proved(certificate, rechecked) = outcome.verdict else { panic!("not proved") };
    let model = description.enclosed().expect("enclosed").midpoint();
    let matrix = model.closed_matrix(NOMINAL).expect("a loop");
    let left = |point: BreakPoint, half_a_step: f64| {
        let (mut state, mut sum) = (model.by_seen(point, NOMINAL), 0.0);
        for _ in 0..200_000 {
            sum += state[0].abs() * half_a_step;
            let mut next = vec![0.0; state.len()];
            matrix.apply(&state, &mut next).expect("as large");
            state = next;
        }
        sum
    };
    let [of_pitch, of_rate] = [left(BreakPoint::Pitch, 5e-7), left(BreakPoint::Rate, 2.5e-4)];
    assert!(of_pitch > 0.0 && of_rate > of_pitch, "{of_pitch} {of_rate}");
    let sum = of_pitch + of_rate;
    let remains = rechecked.remains_rad;
    assert!(remains >= sum * (1.0 - 1e-9) && remains <= 1.02 * sum, "{remains} {sum}");
    // Of the set-points a tenth may remain; ten steps of the pitch sensor are less.
    assert!(remains > 2.0 * 10.0 * description.pitch.resolution, "{remains}");
    let within = |setpoint_rad: f64| {
        let range = Range { setpoint_rad, load_rad: 0.0 };
        Certificate { range, ..certificate.clone() }.check()
    };
    within(10.0 * remains * (1.0 + 1e-9)).expect("a tenth");
    let told = within(10.0 * remains * (1.0 - 1e-6)).expect_err("more").to_string();
    assert!(told.contains("which says nothing of a flight"), "{told}");
    // And where those are more, they.
    description.pitch.resolution = 2e-3;
    description.rate.resolution = 0.0;
    let outcome = certify(&description, &asked, &Effort::default()).expect("provable");
    let Verdict::Proved(certificate, rechecked) = outcome.verdict else { panic!("not proved") };
    assert!(rechecked.remains_rad < 10.0 * 2e-3, "{}", rechecked.remains_rad);
    Certificate { range: Range::REST, ..certificate }.check().expect("within ten steps");
}
