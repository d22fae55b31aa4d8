//! What a self-tuner can do with its gains is what the set says.

#![allow(clippy::float_cmp, reason = "what is exact is asked for exactly")]

use crate::gain_set_common;

use fspid_core::fuzzy::OutOfRange;
use fspid_core::{
    ControllerSetting, DeadZone, ErrorSign, Fspid, GainLimits, Gains, InputScale, InputSets,
    Limits, PidConfig, SelfTuner, SetCentres, State, TunerSettings,
};
use fspid_numeric::scalar::Interval;
use fspid_proof::gain_set::{GainCell, IncrementMap, NoBound, grid, producible};
use gain_set_common::*;

/// Bounds of the increments over all cells.
fn increments(map: &IncrementMap) -> [Interval; 3] {
    [0, 1, 2].map(|gain: usize| {
        let all = map.cells.iter().map(|cell| cell.delta[gain]);
        all.reduce(Interval::hull).expect("cells")
    })
}

#[test]
fn the_cells_hold_the_paper_s_proved_extremes_and_hardly_more() {
    // From the audit of the surfaces, where they are proved to a millionth at range 5.
    let known = [
        [-4.234_089_847_555, 4.444_385_106_649],
        [-4.444_274_913_314, 4.444_274_913_314],
        [-4.234_089_847_408, 3.902_748_775_224],
    ];
    // Only with multiples of 12 do the extremes, at centres of sets, lie on borders of cells.
    for (range, divisions, excess) in
        [(5.0, 24, 1e-9), (5.0, 48, 1e-9), (40.0, 24, 1e-8), (5.0, 12, 3e-3), (5.0, 16, 2e-2)]
    {
        let supervisor = supervisor(PRINTED, range, OutOfRange::Clamp);
        let map = IncrementMap::of(&tuner(supervisor, settings()), divisions).expect("bounded");
        assert_eq!(map.cells.len(), divisions * divisions);
        for (bounds, [least, most]) in increments(&map).into_iter().zip(known) {
            let [least, most] = [least, most].map(|end| end * range / 5.0);
            // The printed digits end there.
            let digits = 1e-12 * range;
            assert!(bounds.lower() <= least + digits && bounds.upper() >= most - digits);
            assert!(bounds.lower() > least - excess, "{divisions}: {bounds:?} {least}");
            assert!(bounds.upper() < most + excess, "{divisions}: {bounds:?} {most}");
        }
    }
}

#[test]
fn boxes_shrink_in_proportion_to_cells() {
    let widest = |divisions| {
        let map = IncrementMap::of(&paper(settings()), divisions).expect("bounded");
        let widths = map.cells.iter().flat_map(|cell| cell.delta).map(Interval::width);
        widths.fold(0.0, f64::max)
    };
    let [coarse, fine, finest] = [12, 24, 96].map(widest);
    assert!(fine < 0.7 * coarse && finest < 0.3 * fine, "{coarse} {fine} {finest}");
}

/// The gains at many points, computed as the controller does, against the cells in which these lie.
fn check_points(tuner: &SelfTuner<f64>, divisions: usize, points: usize) {
    let set = IncrementMap::of(tuner, divisions).expect("bounded").gains(1.0);
    let mut dice = Dice(divisions as u64);
    let reach = 1.3 * tuner.supervisor().range();
    for _ in 0..points {
        let point = dice.point(reach);
        let gains = producible(tuner, point[0], point[1]);
        if tuner.supervisor().out_of_range() == OutOfRange::Error {
            // What was there before may be held, so that all cells are everywhere.
            assert!(set.contains(gains), "{point:?} {gains:?}");
            assert!(set.cells.iter().all(|cell| around(cell, point)));
            continue;
        }
        let mut cells = set.cells.iter().filter(|cell| around(cell, point)).peekable();
        assert!(cells.peek().is_some(), "{point:?}");
        assert!(cells.all(|cell| inside(cell, gains)), "{point:?} {gains:?}");
    }
}

#[test]
fn no_gain_of_a_hundred_thousand_points_lies_outside_of_its_cell() {
    check_points(&paper(settings()), 24, 100_000);
}

#[test]
fn whatever_the_settings_no_gain_lies_outside_of_its_cell() {
    let zone = Some(DeadZone { error_rad: 0.7, change_rad: 2.0 });
    let turned = TunerSettings { error_sign: ErrorSign::MeasurementMinusSetpoint, ..settings() };
    let mixed = Gains { kp: -0.3, ki: 0.0, kd: 10.0 };
    let uneven =
        InputSets { error: SetCentres::new(0.1, 0.8).ok(), change: SetCentres::new(0.4, 0.5).ok() };
    let all = [
        TunerSettings { input_sets: uneven, dead_zone: zone, ..settings() },
        TunerSettings { dead_zone: zone, ..settings() },
        TunerSettings { gain_limits: Some(limits()), ..turned },
        TunerSettings { output_scale: mixed, ..settings() },
    ];
    for settings in all {
        for policy in OutOfRange::ALL {
            check_points(&tuner(supervisor(MIRRORED, 3.0, policy), settings), 9, 1_000);
        }
        check_points(&tuner(supervisor(PRINTED, 1e-6, OutOfRange::Clamp), settings), 13, 1_000);
    }
    for rule in ["midpoint:100", "endpoints:101", "left-end:7", "vertices:26", "trapezoid:2"] {
        let rule = rule.parse().expect("a known rule");
        let sampled = with_centroid(PRINTED, 5.0, rule, OutOfRange::Clamp);
        check_points(&tuner(sampled, settings()), 6, 300);
    }
}

/// Cells so narrow that they are enclosed by their slopes as well.
#[test]
fn narrow_cells_hold_their_gains_too() {
    check_points(&paper(settings()), 150, 500);
}

/// Far beyond its range a supervisor that evaluates its inputs as they are underflows.
#[test]
fn increments_far_beyond_the_range_are_in_the_outer_cells() {
    let tuner = tuner(supervisor(PRINTED, 5.0, OutOfRange::Evaluate), settings());
    let set = IncrementMap::of(&tuner, 6).expect("bounded").gains(1.0);
    for far in [5.1, 6.0, 9.0, 15.0, 31.0, 33.0, 1e3, 1e300] {
        for point in [[far, 0.3], [-far, far], [2.0, -far], [far, -5.0]] {
            let gains = producible(&tuner, point[0], point[1]);
            let mut cells = set.cells.iter().filter(|cell| around(cell, point)).peekable();
            assert!(cells.peek().is_some() && cells.all(|cell| inside(cell, gains)), "{point:?}");
        }
    }
}

/// Flies a controller over errors that jump about, and asks the set at each sample.
fn fly(tuner: SelfTuner<f64>, samples: usize) {
    let set = IncrementMap::of(&tuner, 12).expect("bounded").gains(1.0);
    let controller = Fspid::new(tuner, PidConfig::sampled_every(PERIOD_S)).expect("allowed");
    let (mut state, mut dice) = (State::new(), Dice(7));
    let mut last = None;
    for sample in 0..samples {
        // Sometimes at rest, sometimes slow, sometimes far out.
        let size = [0.0, 0.02, 1.0, 8.0][sample / 50 % 4];
        let error_rad = size * dice.number();
        let gains = controller.step(&mut state, error(error_rad)).gains;
        let change = (error_rad - last.unwrap_or(error_rad)) / PERIOD_S;
        last = Some(error_rad);
        let scale = tuner.settings().input_scale;
        let seen = [scale.error_per_rad * error_rad, scale.change_per_rad * change];
        let mut cells = set.cells.iter().filter(|cell| around(cell, seen));
        assert!(cells.any(|cell| inside(cell, gains)), "{seen:?} {gains:?}");
    }
}

#[test]
fn no_flown_gain_lies_outside_of_the_set_whatever_the_law() {
    let scale = InputScale { error_per_rad: 2.0, change_per_rad: 0.1 };
    let settings = TunerSettings { input_scale: scale, ..settings() };
    let zone = Some(DeadZone { error_rad: 0.5, change_rad: 30.0 });
    let held = Some(limits());
    for policy in OutOfRange::ALL {
        let fly = |settings| fly(tuner(supervisor(PRINTED, 5.0, policy), settings), 2_000);
        fly(settings);
        fly(TunerSettings { law: leaking(0.5), ..settings });
        // All of it within one sample.
        fly(TunerSettings { law: leaking(100.0), ..settings });
        fly(TunerSettings { law: leaking(0.0), gain_limits: held, ..settings });
        fly(TunerSettings { law: leaking(3.0), gain_limits: held, ..settings });
        fly(TunerSettings { dead_zone: zone, ..settings });
    }
}

/// Flies a leaking law over errors that jump about and stay, and asks what it reaches at each sample.
fn check_reached(settings: TunerSettings<f64>, sets: InputSets<f64>) -> f64 {
    let scale = InputScale { error_per_rad: 2.0, change_per_rad: 0.1 };
    let settings = TunerSettings { input_scale: scale, input_sets: sets, ..settings };
    let tuner = tuner(supervisor(PRINTED, 5.0, OutOfRange::Clamp), settings);
    let map = IncrementMap::of(&tuner, 24).expect("bounded");
    let around = map.gains(1.0);
    let set = map.sampled_every(PERIOD_S).gains(1.0);
    let reached = set.reached.as_ref().expect("a leaking law");
    let controller = Fspid::new(tuner, PidConfig::sampled_every(PERIOD_S)).expect("allowed");
    let (mut state, mut dice, mut held) = (State::new(), Dice(5), 0.0);
    for sample in 0..20_000 {
        if sample % 150 == 0 {
            held = 5.0 * dice.number();
        }
        let error_rad = if sample / 150 % 3 == 0 { 5.0 * dice.number() } else { held };
        let gains = controller.step(&mut state, error(error_rad)).gains;
        assert!(set.contains(gains), "{gains:?}");
        let near = array(gains).map(|gain| Interval::between(0.99 * gain, 1.01 * gain));
        let part = reached.part(near).expect("gains that are flown");
        assert!(part.iter().zip(array(gains)).all(|(side, gain)| side.contains(gain)));
    }
    // Of the corners of the box so many are surely not reached.
    let corners: Vec<Gains<f64>> = around.corners().map(|(_, corner)| corner).collect();
    let beyond = corners.iter().filter(|corner| !set.contains(**corner)).count();
    beyond as f64 / corners.len() as f64
}

#[test]
fn no_combination_of_gains_that_is_flown_lies_outside_of_what_is_reached() {
    let uneven = InputSets { error: SetCentres::new(0.1, 0.8).ok(), change: None };
    for law in [leaking(0.5), leaking(3.0), leaking(100.0)] {
        let settings = TunerSettings { law, ..settings() };
        let cut = TunerSettings { gain_limits: Some(limits()), ..settings };
        for sets in [InputSets::EVEN, uneven] {
            // The three tables answer one after another, so that no corner of the box is reached at once.
            assert!(check_reached(settings, sets) > 0.4);
            check_reached(cut, sets);
        }
    }
}

#[test]
fn a_leaking_law_comes_as_near_to_its_bounds_as_one_likes_and_never_beyond() {
    let tuner = paper(TunerSettings { law: leaking(2.0), ..settings() });
    let set = IncrementMap::of(&tuner, 24).expect("bounded").gains(1.0);
    let [all] = &set.cells[..] else { panic!("{set:?}") };
    assert!(around(all, [1e9, -1e9]));
    let controller = Fspid::new(tuner, PidConfig::sampled_every(PERIOD_S)).expect("allowed");
    let mut state = State::new();
    let mut nearest = f64::INFINITY;
    // Down the corner where the printed table adds most to kp: error and change negative.
    for sample in 0..4_000_u32 {
        let gains = controller.step(&mut state, error(-5.0 - 0.05 * f64::from(sample))).gains;
        nearest = nearest.min(all.gains[0].upper() - gains.kp);
    }
    assert!((0.0..1e-6).contains(&nearest), "{nearest}");
}

#[test]
fn an_accumulating_law_that_nothing_holds_back_is_refused_with_the_gain() {
    let free = TunerSettings { law: leaking(0.0), ..settings() };
    let refused = IncrementMap::of(&paper(free), 6);
    assert_eq!(refused, Err(NoBound::Accumulating { gain: "kp" }));
    let endless = Limits::new(ControllerSetting::GainLimits, 0.0, f64::INFINITY).expect("in order");
    let open = TunerSettings { gain_limits: Some(GainLimits { kd: endless, ..limits() }), ..free };
    let refused = IncrementMap::of(&paper(open), 6).expect_err("kd has no upper limit");
    assert!(refused.to_string().contains("kd both gain limits"), "{refused}");
    // A gain that is not tuned needs no limits.
    let still = TunerSettings { output_scale: Gains { kd: 0.0, ..SCALE }, ..open };
    let set = IncrementMap::of(&paper(still), 6).expect("bounded").gains(1.0);
    assert_eq!(set.bounds()[2], Interval::ONE);
    assert_eq!(set.bounds()[0], Interval::between(1.5, 2.6));
}

#[test]
fn a_dead_zone_silences_the_cells_inside_and_adds_zero_to_those_on_its_edge() {
    let zone = DeadZone { error_rad: 0.5, change_rad: 0.7 };
    let scale = InputScale { error_per_rad: -2.0, change_per_rad: 1.0 };
    let settings = TunerSettings { dead_zone: Some(zone), input_scale: scale, ..settings() };
    let map = IncrementMap::of(&paper(settings), 20).expect("bounded");
    let set = map.gains(1.0);
    assert_eq!(set.rest, array(NOMINAL).map(Interval::point));
    let within = |ends: [f64; 2], side: f64| ends[0] > -side && ends[1] < side;
    let meets = |ends: [f64; 2], side: f64| ends[0] <= side && ends[1] >= -side;
    for (cell, gains) in map.cells.iter().zip(&set.cells) {
        if within(cell.error, 1.0) && within(cell.change, 0.7) {
            assert_eq!(cell.delta, [Interval::ZERO; 3]);
        } else if meets(cell.error, 1.0) && meets(cell.change, 0.7) {
            assert!(cell.delta.iter().all(|delta| delta.contains(0.0)));
            assert!(inside(gains, NOMINAL));
        } else if cell.error[0] > 2.0 && cell.change[0] > 1.0 {
            assert!(!cell.delta[1].contains(0.0), "{cell:?}");
        }
    }
}

#[test]
fn gain_limits_cut_the_boxes() {
    let settings = TunerSettings { gain_limits: Some(limits()), ..settings() };
    let [kp, ki, kd] = IncrementMap::of(&paper(settings), 12).expect("bounded").gains(1.0).bounds();
    assert_eq!((kp, kd.upper(), ki.lower()), (Interval::between(1.5, 2.6), 1.2, 0.4));
    assert!(ki.upper() < 0.73, "{ki:?}");
}

#[test]
fn the_set_grows_with_the_output_factor_about_the_nominal_gains() {
    let map = IncrementMap::of(&paper(settings()), 12).expect("bounded");
    assert!(map.gains(0.0).corners().all(|(_, corner)| corner == NOMINAL));
    let [one, three] = [1.0, 3.0].map(|factor| map.gains(factor).bounds());
    for ((one, three), nominal) in one.iter().zip(three).zip(array(NOMINAL)) {
        assert!((three.upper() - nominal - 3.0 * (one.upper() - nominal)).abs() < 1e-9);
    }
    let tripled = Gains { kp: 3.0 * SCALE.kp, ki: 3.0 * SCALE.ki, kd: 3.0 * SCALE.kd };
    let tuner = paper(TunerSettings { output_scale: tripled, ..settings() });
    let set = map.gains(3.0);
    for (error, change, gains) in grid(&tuner, 25) {
        let mut cells = set.cells.iter().filter(|cell| around(cell, [error, change]));
        assert!(cells.all(|cell| inside(cell, gains)));
    }
}

#[test]
fn an_input_that_is_not_used_is_zero_in_every_cell() {
    let scale = InputScale { error_per_rad: 1.0, change_per_rad: 0.0 };
    let settings = TunerSettings { input_scale: scale, ..settings() };
    for (policy, cells) in [(OutOfRange::Clamp, 12), (OutOfRange::Evaluate, 14)] {
        let tuner = tuner(supervisor(PRINTED, 5.0, policy), settings);
        let map = IncrementMap::of(&tuner, 12).expect("bounded");
        assert_eq!(map.cells.len(), cells);
        assert!(map.cells.iter().all(|cell: &_| cell.change == [0.0; 2]));
    }
}

#[test]
fn the_hull_reaches_as_far_as_all_corners_in_every_direction() {
    let cut = TunerSettings { gain_limits: Some(limits()), ..settings() };
    for settings in [settings(), cut] {
        let set = IncrementMap::of(&paper(settings), 24).expect("bounded").gains(1.0);
        let corners: Vec<[f64; 3]> = set.corners().map(|(_, corner)| array(corner)).collect();
        let hull: Vec<[f64; 3]> = set.hull().into_iter().map(array).collect();
        assert!(hull.len() < 160 && hull.iter().all(|vertex| corners.contains(vertex)));
        let few: Vec<[f64; 3]> = set.hull_within(0.01).into_iter().map(array).collect();
        assert!(few.len() < 65, "{}", few.len());
        let halves = set.bounds().map(Interval::radius);
        let mut dice = Dice(3);
        for _ in 0..2_000 {
            let direction = [0; 3].map(|_| dice.number());
            let size = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            let along = |point: &[f64; 3]| -> f64 {
                (0..3).map(|gain| point[gain] / halves[gain] * direction[gain]).sum()
            };
            let reach = |points: &[[f64; 3]]| points.iter().map(along).fold(f64::MIN, f64::max);
            let all = reach(&corners);
            assert!(reach(&hull) >= all - 1e-9 * size - 1e-12);
            assert!(reach(&few) >= all - 0.01 * size - 1e-12);
        }
    }
}

#[test]
fn the_grid_holds_the_very_gains_that_are_flown() {
    let tuner = paper(TunerSettings { gain_limits: Some(limits()), ..settings() });
    let points = grid(&tuner, 9);
    assert_eq!(points.len(), 81);
    assert_eq!((points[0].0, points[0].1, points[80].0), (-5.0, -5.0, 5.0));
    assert_eq!(grid(&tuner, 1)[0].2, tuner.gains_at_rest());
    // At the first sample the change is zero: the middle column.
    let controller = Fspid::new(tuner, PidConfig::sampled_every(PERIOD_S)).expect("allowed");
    for &(at, _, gains) in points.iter().filter(|point| point.1 == 0.0) {
        assert_eq!(controller.step(&mut State::new(), error(at)).gains, gains, "{at}");
    }
}

#[test]
fn what_an_accumulating_law_tends_to_is_in_its_set() {
    let leaks = TunerSettings { law: leaking(0.5), ..settings() };
    let drifts = TunerSettings { law: leaking(0.0), gain_limits: Some(limits()), ..settings() };
    for tuner in [leaks, drifts].map(paper) {
        let set = IncrementMap::of(&tuner, 12).expect("bounded").gains(1.0);
        assert!(grid(&tuner, 11).iter().all(|&(_, _, gains)| set.contains(gains)));
        let rest = array(producible(&tuner, 0.0, 0.0));
        // At rest the printed table adds to kp and takes from kd; of ki there is no telling.
        for gain in [0, 2] {
            assert!(set.rest[gain].contains(rest[gain]), "{:?} {rest:?}", set.rest);
            assert!(set.rest[gain].width() < 1e-9, "{:?}", set.rest);
        }
    }
}

/// Whether a cell lies between two axes, errors above and changes below zero.
fn in_second_quarter(cell: &GainCell) -> bool {
    cell.error[0] > 0.0 && cell.change[1] < 0.0
}

#[test]
fn cones_leave_out_cells_that_they_do_not_meet() {
    let set = IncrementMap::of(&paper(settings()), 24).expect("bounded").gains(1.0);
    let named: usize = set.cones(16).iter().map(|cone| cone.cells.len()).sum();
    // Of 576 cells those on the lines between count twice or, near the tip, more often.
    assert!(named < 3 * 576, "{named}");
    let first = &set.cones(2)[0];
    assert!(first.cells.iter().all(|&cell| !in_second_quarter(&set.cells[cell])));
    assert!(set.cells.iter().any(in_second_quarter));
}

#[test]
fn every_point_lies_in_a_cone_that_names_its_cell() {
    for policy in OutOfRange::ALL {
        let tuner = tuner(supervisor(PRINTED, 5.0, policy), settings());
        let set = IncrementMap::of(&tuner, 12).expect("bounded").gains(1.0);
        for count in [0, 1, 2, 7, 16] {
            let cones = set.cones(count);
            assert_eq!(cones.len(), count.max(1));
            let mut dice = Dice(11);
            for _ in 0..200 {
                let point = dice.point(9.0);
                // On borders of cells and on an axis, too.
                let border = point.map(|x| (x * 1.2).round() / 1.2);
                for [x, y] in [point, border, [point[0], 0.0], [0.0, point[1]]] {
                    let side = |normal: [f64; 2]| normal[0] * x + normal[1] * y;
                    let meets = |normals: [[f64; 2]; 2]| side(normals[0]) * side(normals[1]) >= 0.0;
                    let own: Vec<_> = cones.iter().filter(|cone| meets(cone.normals)).collect();
                    assert!(!own.is_empty(), "{count}: {x} {y}");
                    let cells = set.cells.iter().enumerate();
                    for (cell, _) in cells.filter(|(_, cell)| around(cell, [x, y])) {
                        assert!(own.iter().all(|cone| cone.cells.contains(&cell)), "{x} {y}");
                    }
                }
            }
        }
    }
}
