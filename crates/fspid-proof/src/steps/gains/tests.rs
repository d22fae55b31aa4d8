//! Gains over boxes of inputs hold those that the tuner answers in them, and are not much more.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{
    Change, DeadZone, ErrorSign, Gains, InputScale, PidConfig, SelfTuner, TunerSettings,
};

use super::*;
use crate::gain_set::IncrementMap;
use crate::rest::drawn::Dice;
use crate::steps::system_of;

const RANGE: f64 = 5.0;
const DIVISIONS: usize = 12;

fn settings() -> TunerSettings<f64> {
    TunerSettings {
        input_scale: InputScale { error_per_rad: 40.0, change_per_rad: 8.0 },
        output_scale: Gains { kp: 0.2, ki: 0.05, kd: 0.1 },
        ..TunerSettings::literal()
    }
}

/// The paper's rules.
fn fspid(policy: OutOfRange, settings: TunerSettings<f64>) -> Fspid<f64> {
    let rules = fspid_core::paper::rules();
    let supervisor = Supervisor::new(&rules, RANGE, Defuzzifier::Exact, policy).expect("allowed");
    let nominal = Gains { kp: 2.0, ki: 0.5, kd: 1.0 };
    let tuner = SelfTuner::new(nominal, supervisor, settings).expect("allowed");
    Fspid::new(tuner, PidConfig::sampled_every(0.02)).expect("allowed")
}

fn set(fspid: &Fspid<f64>) -> GainSet {
    IncrementMap::of(fspid.tuner(), DIVISIONS).expect("bounded").gains(1.0)
}

/// The gains that the tuner answers, and whether the supervisor was asked beyond what it takes.
fn answered(fspid: &Fspid<f64>, [error_rad, change_rad]: [f64; 2]) -> Option<[f64; 3]> {
    let equations = fspid.tuner_equations();
    let second_rad = change_rad / equations.numbers.change_divisor;
    let [error, second] = equations.seen(error_rad, second_rad);
    let nominal = fspid.tuner().nominal();
    let added = match equations.is_silent(error_rad, second_rad) {
        true => Gains::ZERO,
        false => fspid.tuner().increments_where_seen(error, second)?,
    };
    Some([nominal.kp + added.kp, nominal.ki + added.ki, nominal.kd + added.kd])
}

/// A side in units of the supervisor: of any width, often with an end or its middle where sets meet, also beyond the range.
fn side(dice: &mut Dice) -> [f64; 2] {
    let width = RANGE * libm::pow(10.0, dice.between(-5.0, 0.4));
    let border = (dice.between(-7.0, 7.0)).round() * RANGE / 6.0;
    let lower = match (dice.part() * 4.0) as u32 {
        0 => border,
        1 => border - width,
        2 => border - width * dice.part(),
        _ => dice.between(-1.3 * RANGE, 1.1 * RANGE),
    };
    [lower, lower + width]
}

fn per_unit(fspid: &Fspid<f64>) -> [f64; 2] {
    let numbers = &fspid.tuner_equations().numbers;
    [1.0 / numbers.error_per_rad, numbers.change_divisor / numbers.change_per_rad]
}

/// Ends of both sides, and points between.
fn points(dice: &mut Dice, sides: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    let [[left, right], [below, above]] = sides;
    let mut points = vec![[left, below], [left, above], [right, below], [right, above]];
    points.extend([0; 4].map(|_| sides.map(|[lower, upper]| dice.between(lower, upper))));
    points
}

/// Every point of a box, and each time a box within it that may be answered as it was.
fn are_held(fspid: &Fspid<f64>, seed: u64) -> usize {
    let (set, system, dice) = (set(fspid), system_of(fspid), &mut Dice::new(seed));
    let seen = SeenGains::of(&set, Some(fspid), system.as_ref());
    let [per_error, per_change] = per_unit(fspid);
    let mut compared = 0;
    for _ in 0..60 {
        let [error, change] = [side(dice), side(dice)];
        for share in [1.0, 0.97, 0.6] {
            let narrower = |[lower, upper]: [f64; 2], per: f64| {
                [lower * per, (lower + share * (upper - lower)) * per]
            };
            let sides = [narrower(error, per_error), narrower(change, per_change)];
            let [error, change] = sides.map(|[lower, upper]| Interval::between(lower, upper));
            let found = seen.seen(error, change).expect("every input has gains");
            let middle = Gains { kp: found.middle[0], ki: found.middle[1], kd: found.middle[2] };
            assert!(set.contains(middle), "{middle:?} is no gain of the set");
            for point in points(dice, sides) {
                let Some(gains) = answered(fspid, point) else { continue };
                compared += 1;
                for (gain, value) in gains.into_iter().enumerate() {
                    let off = (value - found.middle[gain]).abs();
                    assert!(off <= found.radius[gain], "{gain} at {point:?} of {sides:?}: {off}");
                }
            }
        }
    }
    compared
}

#[test]
fn gains_over_a_box_hold_those_that_the_tuner_answers_anywhere_in_it() {
    let zone = DeadZone { error_rad: 0.02, change_rad: 0.05 };
    let silent = TunerSettings { dead_zone: Some(zone), ..settings() };
    let turned = TunerSettings {
        error_sign: ErrorSign::MeasurementMinusSetpoint,
        change: Change::Delta,
        ..settings()
    };
    for (seed, settings) in [settings(), silent, turned].into_iter().enumerate() {
        for policy in [OutOfRange::Clamp, OutOfRange::Evaluate, OutOfRange::Error] {
            let compared = are_held(&fspid(policy, settings), seed as u64);
            assert!(compared > 500, "{policy:?}: {compared}");
        }
    }
}

#[test]
fn gains_over_a_narrow_box_are_far_less_than_those_of_its_cell() {
    let fspid = fspid(OutOfRange::Clamp, settings());
    let (set, system) = (set(&fspid), system_of(&fspid));
    let seen = SeenGains::of(&set, Some(&fspid), system.as_ref());
    let by_cells = SeenGains { over: None, ..seen.clone() };
    let [per_error, per_change] = per_unit(&fspid);
    let narrow = |at: f64, per: f64| Interval::between(at * per, (at + 1e-3) * per);
    let inputs = (narrow(1.1, per_error), narrow(-0.6, per_change));
    let [narrow, wide] = [&seen, &by_cells].map(|it| it.seen(inputs.0, inputs.1).expect("some"));
    for gain in 0..3 {
        assert!(narrow.radius[gain] < 0.1 * wide.radius[gain], "{gain}: {narrow:?} {wide:?}");
    }
}

/// A box of both inputs that was asked last, and whether another is answered as it was.
fn is_kept(asked: &mut Asked<'_>, [error, change]: [[f64; 2]; 2]) -> bool {
    let between = |[lower, upper]: [f64; 2]| Interval::between(lower, upper);
    asked.last = None;
    let whole = asked.over([between([0.01, 0.03]), between([-0.03, -0.01])]).expect("clamped");
    let before = asked.last;
    let now = asked.over([between(error), between(change)]).expect("clamped");
    assert!(asked.last != before || now == whole, "what is kept is what was answered");
    asked.last == before
}

#[test]
fn a_box_is_asked_somewhat_wider_and_answers_for_those_within_that_are_not_much_narrower() {
    let fspid = fspid(OutOfRange::Clamp, settings());
    let system = system_of(&fspid);
    let cell = asked((&fspid, system.as_ref())).expect("memoryless");
    let mut asked = cell.into_inner();
    // 0.004 and a tenth of 0.02 to either side.
    let wider = [[0.004, 0.036], [-0.036, -0.004]];
    assert!(is_kept(&mut asked, [[0.01, 0.03], [-0.03, -0.01]]));
    let [error, change] = asked.last.expect("asked").0;
    for (side, [lower, upper]) in [error, change].into_iter().zip(wider) {
        let off = (side.lower() - lower).abs().max((side.upper() - upper).abs());
        assert!(off < 1e-12, "{side:?}");
    }
    // Twice as wide as 0.008 and 0.008 more is 0.032.
    let (just, less) = ([0.014, 0.0221], [0.014, 0.0219]);
    let turned = |[lower, upper]: [f64; 2]| [-upper, -lower];
    for (error, change, kept) in [
        (just, turned(just), true),
        (less, turned(just), false),
        (just, turned(less), false),
        ([0.02, 0.0359], turned(just), true),
        ([0.02, 0.0361], turned(just), false),
        (just, turned([0.0039, 0.02]), false),
    ] {
        assert_eq!(is_kept(&mut asked, [error, change]), kept, "{error:?} {change:?}");
    }
}

#[test]
fn what_was_asked_before_is_forgotten_and_a_copy_has_not_heard_of_it() {
    let fspid = fspid(OutOfRange::Clamp, settings());
    let (set, system) = (set(&fspid), system_of(&fspid));
    let seen = SeenGains::of(&set, Some(&fspid), system.as_ref());
    let side = |width: f64| Interval::between(0.011, 0.011 + width);
    let ask = |seen: &SeenGains<'_>, width: f64| seen.seen(side(width), side(width));
    let fresh = ask(&seen, 0.0019).expect("clamped");
    seen.forget();
    let wider = ask(&seen, 0.002).expect("clamped");
    assert!(wider != fresh, "another box has other gains");
    assert_eq!(ask(&seen, 0.0019), Some(wider), "within what was asked");
    assert_eq!(ask(&seen.clone(), 0.0019), Some(fresh));
    seen.forget();
    assert_eq!(ask(&seen, 0.0019), Some(fresh));
}

#[test]
fn cells_with_the_same_errors_are_one_row() {
    let fspid = fspid(OutOfRange::Clamp, settings());
    let seen = SeenGains::of(&set(&fspid), Some(&fspid), None);
    assert_eq!(seen.rows.len(), DIVISIONS);
    for (error, row) in &seen.rows {
        assert_eq!(row.len(), DIVISIONS);
        assert!(row.iter().all(|cell| same_side(cell.error, *error)));
    }
}

/// Three cells by three beyond the range of a supervisor that refuses them, each of gains that no other has.
fn beyond_the_range() -> GainSet {
    let cell = |place: usize| {
        let (row, column) = ((place / 3) as f64, (place % 3) as f64);
        let gain = (place * place) as f64;
        GainCell {
            error: [RANGE + row, RANGE + row + 1.0],
            change: [column - 1.0, column],
            gains: [gain, -gain, 2.0 * gain].map(Interval::point),
            change_gain: 0.0,
        }
    };
    let rest = [Interval::ONE; 3];
    let cells = (0..9).map(cell).collect();
    GainSet { cells, ..GainSet::boxed(Gains::ZERO, rest, rest) }
}

#[test]
fn where_a_box_cannot_be_asked_the_gains_are_those_of_all_cells_it_meets_around_the_nearest() {
    let settings = TunerSettings { change: Change::Delta, ..TunerSettings::literal() };
    let fspid = fspid(OutOfRange::Error, settings);
    let (set, system) = (beyond_the_range(), system_of(&fspid));
    let seen = SeenGains::of(&set, Some(&fspid), system.as_ref());
    let meets = |[lower, upper]: [f64; 2], from: f64, to: f64| lower <= to && upper >= from;
    for error in [5.3, 5.5, 6.4, 7.25] {
        for change in [-0.75, -0.5, 0.25, 1.5] {
            for half in [0.01, 0.5, 0.6, 1.2] {
                let sides = [error, change].map(|at| [at - half, at + half]);
                let [of_error, of_change] = sides.map(|[from, to]| Interval::between(from, to));
                let found = seen.seen(of_error, of_change).expect("met");
                let cells: Vec<&GainCell> = set
                    .cells
                    .iter()
                    .filter(|cell| meets(cell.error, sides[0][0], sides[0][1]))
                    .filter(|cell| meets(cell.change, sides[1][0], sides[1][1]))
                    .collect();
                let holds = |cell: &&&GainCell| {
                    meets(cell.error, error, error) && meets(cell.change, change, change)
                };
                let nearest = cells.iter().find(holds).expect("a cell holds the middle");
                for gain in 0..3 {
                    let middle = nearest.gains[gain].midpoint();
                    let off = cells.iter().map(|it| (it.gains[gain].midpoint() - middle).abs());
                    let most = off.fold(0.0, f64::max);
                    let told = (found.middle[gain], found.radius[gain]);
                    let off = (told.0 - middle).abs().max((told.1 - most).abs());
                    assert!(off < 1e-12, "{error} {change} {half}: {told:?}, {middle} {most}");
                }
            }
        }
    }
    // Of two that are as near the first counts.
    let border = Interval::between(5.9, 6.1);
    let found = seen.seen(border, Interval::between(0.4, 0.6)).expect("met");
    assert!((found.middle[0] - 1.0).abs() < 1e-12, "{found:?}");
    assert!(seen.seen(Interval::between(8.5, 9.0), Interval::ZERO).is_none());
}

#[test]
fn a_gain_may_be_zero_where_its_bounds_reach_as_far() {
    let between = Between { middle: [1.0, -1.0, 0.5], radius: [1.0, 1.5, 0.499] };
    assert_eq!([0, 1, 2].map(|gain| between.may_be_zero(gain)), [true, true, false]);
    assert!(Between { middle: [0.0; 3], radius: [0.0; 3] }.may_be_zero(0));
}
