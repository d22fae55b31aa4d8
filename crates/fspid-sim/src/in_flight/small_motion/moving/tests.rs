//! What moving gains add to a mode, against modes of fixed controllers that have as much: of those the flying code is asked, and
//! nothing is added to a matrix.

use fspid_core::{
    Derivative, Fspid, Gains, InputScale, IntegralForm, PidConfig, ReferenceModel, SecondInput,
    SelfTuner, SetpointWeights, TunerSettings, paper,
};
use fspid_fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_lti::{Complex, Matrix, eigenvalues};

use super::super::numbers::Place;
use super::super::still::{at_rest, still, unlimited};
use super::super::{Asked, Small};
use super::{Acting, Reach, Sides, acting_loop, closed, of_loops, of_one_loop, reach, seen};
use crate::autopilot::{Autopilot, Engagement, Mode, Moves, OuterLoop, Quantity, Units};
use crate::beyond::ALTITUDE;
use crate::controller::Controller;
use crate::in_tests::{ALTITUDE_M, DT_S, mode, navion, outer, pid, pitch, scenario, without_wings};
use crate::loop_model::Gathered;
use crate::rest::{Doubt, Rest, Side, Stand};
use crate::scenario::{Prepared, Scenario};
use crate::sensor::Seeing;

/// Numbers of the loops of [`loops`]: the engaged ones stand in no order.
const THROTTLE: usize = 0;
const PATH: usize = 1;
const ALTITUDE_LOOP: usize = 2;

/// Gains of the loop that holds altitude, and of the one of the path, which it moves.
const OF_ALTITUDE: [f64; 3] = [0.15, 0.02, 0.0];
const OF_PATH: [f64; 3] = [0.01, 0.004, 0.0];

fn loops() -> Vec<OuterLoop> {
    vec![
        outer("autothrottle", Quantity::Airspeed, Moves::Throttle, [0.2, 0.02, 0.0]),
        outer("vertical speed", Quantity::VerticalSpeed, Moves::Pitch, OF_PATH),
        outer("altitude", Quantity::Altitude, Moves::Loop(PATH), OF_ALTITUDE),
    ]
}

/// The Navion with one mode that engages all loops.
fn flight(loops: Vec<OuterLoop>) -> Scenario {
    let mode = mode("hold", &[ALTITUDE_LOOP, THROTTLE, PATH]);
    let autopilot = Autopilot::new(loops, None, None, vec![mode]).expect("makes sense");
    scenario(navion(), Some(autopilot))
}

/// A mode that is asked, and its flight.
struct Question<'a> {
    asked: Asked<'a>,
    prepared: Prepared,
}

impl<'a> Question<'a> {
    fn of(scenario: &'a Scenario, mode: usize) -> Self {
        let autopilot = scenario.autopilot.as_ref().expect("an autopilot");
        let controller = unlimited(&pitch(), pitch().nominal()).expect("allowed");
        let seeing = Seeing::Latest;
        let prepared = still(scenario, autopilot, mode, seeing).expect("it flies");
        Self { asked: Asked { scenario, autopilot, mode, seeing, controller }, prepared }
    }

    fn small(&self) -> Small<'_> {
        self.asked.small(&self.prepared).expect("it flies")
    }
}

/// One loop that is said to have these sides at its one target.
fn acting<'a>(asked: &Asked<'a>, number: usize, sides: &[Side]) -> Acting<'a> {
    let controller = &asked.autopilot.loops()[number].controller;
    let gains = at_rest(controller).expect("they stand still");
    let mut rest = Rest::still(gains);
    rest.sides = sides.to_vec();
    Acting { number, controller, gains, rests: vec![rest] }
}

fn reach_of(question: &Question<'_>, small: &Small<'_>, acting: &Acting<'_>) -> Reach {
    reach(&question.asked, small, acting).expect("it flies").expect("its integral shows it")
}

/// A side that adds nothing to gains.
fn side([kp, ki, kd]: [f64; 3]) -> Side {
    Rest::still(Gains { kp, ki, kd }).sides[0]
}

/// What a loop adds on a side: to kp, on the change of the error, and late.
#[derive(Clone, Copy, Debug)]
struct Added {
    kp: f64,
    change: f64,
    /// What stays, what is gathered by the error, and by its change.
    late: Option<[f64; 3]>,
}

impl Added {
    fn times(self, by: f64) -> Self {
        let late =
            self.late.map(|[keeps, by_error, by_change]| [keeps, by * by_error, by * by_change]);
        Self { kp: by * self.kp, change: by * self.change, late }
    }

    fn side(self, gains: [f64; 3]) -> Side {
        let mut side = side(gains);
        side.gains.kp += self.kp;
        side.change_gain = self.change;
        side.gathered = self.late.map(|[keeps, by_error, by_change]| Gathered {
            keeps,
            by_error,
            by_change,
            by_rate: 0.0,
        });
        side
    }

    /// A fixed controller that has as much: what is gathered late and leaks is a proportional part less a filtered derivative,
    /// $\frac{a + b (1 - q)}{1 - \varphi q} = \alpha + (b - \alpha \varphi) \frac{1 - q}{1 - \varphi q}$ with
    /// $\alpha = a / (1 - \varphi)$ and the sample before, q; its filter is
    /// $T_f = \varphi T / (1 - \varphi)$.
    fn fixed(self, [kp, ki, _]: [f64; 3], mut config: PidConfig<f64>) -> Controller {
        let Some([keeps, by_error, by_change]) = self.late else {
            return pid([kp + self.kp, ki, self.change * DT_S], config);
        };
        let alpha = by_error / (1.0 - keeps);
        let period_s = DT_S / (1.0 - keeps);
        config.derivative = Derivative { filter_s: keeps * period_s };
        pid([kp + alpha, ki, (by_change - alpha * keeps) * period_s], config)
    }
}

/// $\prod_i (1 - \lambda_i / z)$, to which poles of 0 add nothing, however many there are.
fn characteristic(poles: &[Complex], [re, im]: [f64; 2]) -> [f64; 2] {
    let size = re * re + im * im;
    let inverse = [re / size, -im / size];
    let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    poles.iter().fold([1.0, 0.0], |product, pole| {
        let [part_re, part_im] = times([pole.re, pole.im], inverse);
        times(product, [1.0 - part_re, -part_im])
    })
}

/// Places in the plane of z at which characteristics are compared.
const ASKED: [[f64; 2]; 4] = [[1.3, 0.0], [0.9, 0.4], [-0.8, 0.7], [1.05, 0.1]];

fn assert_same_poles(rows: &[Vec<f64>], fixed: &Matrix, allowed: f64, what: &str) {
    let found = eigenvalues(&Matrix::from_rows(rows).expect("a matrix")).expect("found");
    let expected = eigenvalues(fixed).expect("found");
    for place in ASKED {
        let [one, other] = [&found, &expected].map(|poles| characteristic(poles, place));
        let size = libm::hypot(other[0], other[1]);
        let off = libm::hypot(one[0] - other[0], one[1] - other[1]) / size;
        assert!(off < allowed, "{what} at {place:?}: {off}");
    }
}

/// With another controller in the place of some loops.
fn with(mut loops: Vec<OuterLoop>, controllers: &[(usize, Controller)]) -> Vec<OuterLoop> {
    for (number, controller) in controllers {
        loops[*number].controller = *controller;
    }
    loops
}

const ADDED: [Added; 5] = [
    Added { kp: 0.07, change: 0.0, late: None },
    Added { kp: -0.2, change: 0.9, late: None },
    Added { kp: 0.0, change: 0.0, late: Some([0.9, 0.004, 0.0]) },
    Added { kp: 0.0, change: 0.0, late: Some([0.8, -0.02, 0.3]) },
    Added { kp: 0.0, change: 0.0, late: Some([0.0, 0.05, -0.2]) },
];

#[test]
fn a_side_adds_to_a_mode_what_a_fixed_controller_with_as_much_has() {
    let plain = PidConfig::sampled_every(DT_S);
    // A sum of errors is multiplied by ki T, and what it does is known to a few digits less.
    for (integral, allowed) in [(IntegralForm::Bumpless, 1e-6), (IntegralForm::Literal, 1e-4)] {
        let config = PidConfig { integral, ..plain };
        for (number, gains) in [(ALTITUDE_LOOP, OF_ALTITUDE), (PATH, OF_PATH)] {
            // The path is commanded in rad where the altitude is in m/s.
            let small_ones = if number == PATH { 0.1 } else { 1.0 };
            let base = flight(with(loops(), &[(number, pid(gains, config))]));
            let question = Question::of(&base, 0);
            let small = question.small();
            for added in ADDED {
                let added = added.times(small_ones);
                let side = added.side(gains);
                let acting = acting(&question.asked, number, &[side]);
                let reach = reach_of(&question, &small, &acting);
                let rows = closed(&small, &[(&reach, &side, acting.gains)]);
                assert_eq!(rows.len(), small.places.len() + 2);
                let other = flight(with(loops(), &[(number, added.fixed(gains, config))]));
                let other = Question::of(&other, 0);
                let what = format!("{integral:?} {number} {added:?}");
                assert_same_poles(&rows, &other.small().matrix, allowed, &what);
            }
        }
    }
}

/// Numbers of one loop do not mix with those of another, but by what the outer one of two commands: with both gains larger the
/// loops of a cascade were asked without the product of what is added to them, and were stable where they grow.
#[test]
fn sides_of_two_loops_add_what_two_fixed_controllers_have() {
    let plain = PidConfig::sampled_every(DT_S);
    let base = flight(loops());
    let question = Question::of(&base, 0);
    let small = question.small();
    let pairs = [(THROTTLE, [0.2, 0.02, 0.0]), (PATH, OF_PATH)];
    for ([one, other], inner) in
        [[0, 1], [2, 3], [1, 4], [3, 2]].into_iter().flat_map(|it| pairs.map(|inner| (it, inner)))
    {
        let gains = [(ALTITUDE_LOOP, OF_ALTITUDE), inner];
        let small_ones = if inner.0 == PATH { 0.1 } else { 1.0 };
        let added = [ADDED[one], ADDED[other].times(small_ones)];
        let sides = [0, 1].map(|at| added[at].side(gains[at].1));
        let acting = [0, 1].map(|at| acting(&question.asked, gains[at].0, &[sides[at]]));
        let reach = [0, 1].map(|at| reach_of(&question, &small, &acting[at]));
        let both = [0, 1].map(|at| (&reach[at], &sides[at], acting[at].gains));
        let rows = closed(&small, &both);
        assert_eq!(rows.len(), small.places.len() + 4);
        let fixed = [0, 1].map(|at| (gains[at].0, added[at].fixed(gains[at].1, plain)));
        let other = flight(with(loops(), &fixed));
        let other = Question::of(&other, 0);
        assert_same_poles(&rows, &other.small().matrix, 1e-6, &format!("{added:?}"));
    }
}

/// A metre above its target is a metre of error, and a metre a second that is commanded a sample's worth of the integral below.
#[test]
fn a_loop_sees_its_error_and_acts_in_units_of_what_it_holds_and_commands() {
    for integral in [IntegralForm::Bumpless, IntegralForm::Literal] {
        let config = PidConfig { integral, ..PidConfig::sampled_every(DT_S) };
        let base = flight(with(loops(), &[(ALTITUDE_LOOP, pid(OF_ALTITUDE, config))]));
        let question = Question::of(&base, 0);
        let small = question.small();
        let acting = acting(&question.asked, ALTITUDE_LOOP, &[side(OF_ALTITUDE)]);
        let Reach { by_command, error, .. } = reach_of(&question, &small, &acting);
        let [_, ki_of_path, _] = OF_PATH;
        for (at, place) in small.places.iter().enumerate() {
            let expected = if *place == Place::Beyond(ALTITUDE) { -1.0 } else { 0.0 };
            assert!((error[at] - expected).abs() < 1e-3, "{integral:?} {at}: {}", error[at]);
            if *place == Place::Remembered(1 + PATH, 0) {
                assert!((by_command[at] / (ki_of_path * DT_S) - 1.0).abs() < 1e-3, "{integral:?}");
            }
        }
    }
}

/// Of a loop whose target another one moves: its error is that target less what is measured, whatever weight the target has in
/// what it commands.
#[test]
fn a_loop_sees_as_error_what_moves_its_target_in_full() {
    for weight in [1.0, 0.4] {
        let mut config = PidConfig::sampled_every(DT_S);
        config.setpoint_weights = SetpointWeights { proportional: weight, derivative: 1.0 };
        let base = flight(with(loops(), &[(PATH, pid(OF_PATH, config))]));
        let question = Question::of(&base, 0);
        let small = question.small();
        let acting = acting(&question.asked, PATH, &[side(OF_PATH)]);
        let error = reach_of(&question, &small, &acting).error;
        let [kp, ki, _] = OF_ALTITUDE;
        // Memories are numbered in the order of the loops, behind that of the pitch loop.
        for (place, expected) in [
            (Place::Beyond(ALTITUDE), -(kp + ki * DT_S)),
            (Place::Remembered(1 + ALTITUDE_LOOP, 0), 1.0),
            (Place::Remembered(1 + PATH, 0), 0.0),
            (Place::Remembered(1 + THROTTLE, 0), 0.0),
            (Place::Remembered(0, 0), 0.0),
        ] {
            let at = small.places.iter().position(|it| *it == place).expect("it counts");
            assert!((error[at] - expected).abs() < 1e-6, "{weight} {at}: {} {expected}", error[at]);
        }
    }
}

/// The targets of a mode are those that it may hold on from the modes before it, as its controller counts.
#[test]
fn a_loop_is_asked_at_every_target_that_it_may_hold() {
    let [feet, command] = [3.0, 0.0];
    let tuned = |moves: Moves, holds: Quantity, name: &str, held: f64| {
        let units = Units { held, moved: 1.0 };
        OuterLoop {
            controller: Controller::SelfTuning(tuned_by_itself()),
            units,
            ..outer(name, holds, moves, OF_PATH)
        }
    };
    let loops = vec![
        tuned(Moves::Pitch, Quantity::VerticalSpeed, "vertical speed", 1.0),
        tuned(Moves::Loop(0), Quantity::Altitude, "altitude", feet),
    ];
    let to_hold = |name: &str, engaged: &[usize], quantity, target| {
        let targets = vec![Engagement { quantity, target }];
        Mode { targets, ..mode(name, engaged) }
    };
    let modes = vec![
        to_hold("climb", &[0], Quantity::VerticalSpeed, 2.0),
        to_hold("altitude", &[0, 1], Quantity::Altitude, 310.0),
        mode("on", &[0, 1]),
        to_hold("another", &[0, 1], Quantity::Altitude, 320.0),
        mode("level", &[0]),
    ];
    let autopilot = Autopilot::new(loops, None, None, modes).expect("makes sense");
    let scenario = scenario(navion(), Some(autopilot));
    let fspid = tuned_by_itself();
    let gains = fspid.tuner().gains_at_rest();
    let rest = |target: f64| Rest::of_outer_loop(&fspid, gains, [target, command]).expect("known");
    let here = feet * ALTITUDE_M;
    let rows: [(usize, usize, &[f64]); 6] = [
        (0, 0, &[0.0, 2.0]),
        (1, 1, &[here, feet * 310.0]),
        (2, 1, &[here, feet * 310.0]),
        (3, 1, &[here, feet * 310.0, feet * 320.0]),
        // Another loop moves its target.
        (1, 0, &[0.0]),
        (4, 0, &[0.0, 2.0]),
    ];
    for (mode, number, targets) in rows {
        let question = Question::of(&scenario, mode);
        let small = question.small();
        let engaged = question.asked.mode().expect("a mode");
        let acting = acting_loop(&question.asked, &small, engaged, number).expect("known");
        let expected: Vec<Rest> = targets.iter().map(|target| rest(*target)).collect();
        assert_eq!(acting.rests.len(), expected.len(), "{mode} {number}");
        for (found, expected) in acting.rests.iter().zip(&expected) {
            let apart = found.sides.iter().zip(&expected.sides).map(|(found, expected)| {
                (found.gains.kp - expected.gains.kp).abs()
                    + (found.change_gain - expected.change_gain).abs()
            });
            assert_eq!(found.sides.len(), expected.sides.len());
            assert!(apart.fold(0.0, f64::max) < 1e-6, "{mode} {number} {found:?} {expected:?}");
        }
    }
    assert!(rest(here).sides[0].gains.kp != rest(feet * 310.0).sides[0].gains.kp);
}

/// A self-tuner whose gains are multiplied by a part of what it holds.
fn tuned_by_itself() -> Fspid<f64> {
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 1.0, change_per_rad: 1.0 },
        output_scale: Gains { kp: 1e-3, ki: 0.0, kd: 0.0 },
        ..TunerSettings::literal()
    };
    let supervisor = Supervisor::new(&paper::rules(), 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let [kp, ki, kd] = OF_ALTITUDE;
    let nominal = Gains { kp, ki, kd };
    let tuner = SelfTuner::new(nominal, supervisor.expect("allowed"), settings).expect("allowed");
    let mut config = PidConfig::sampled_every(DT_S);
    config.setpoint_weights.proportional = 0.7;
    Fspid::new(tuner, config).expect("allowed")
}

/// A motion to one side, or to another, is that of a fixed controller; only one that is alone has poles.
#[test]
fn one_loop_holds_where_every_side_does_and_has_the_poles_of_its_only_one() {
    let base = flight(loops());
    let question = Question::of(&base, 0);
    let small = question.small();
    let with_kp = |kp: f64| Added { kp, change: 0.0, late: None }.side(OF_ALTITUDE);
    let asked = |rests: &[&[f64]]| {
        let mut acting = acting(&question.asked, ALTITUDE_LOOP, &[with_kp(0.05)]);
        let reach = reach_of(&question, &small, &acting);
        let first = acting.rests[0].clone();
        let rest = |added: &&[f64]| {
            let mut rest = first.clone();
            rest.sides = added.iter().map(|kp| with_kp(*kp)).collect();
            rest
        };
        acting.rests = rests.iter().map(rest).collect();
        of_one_loop(&small, &acting, &reach).expect("found")
    };
    let fixed = |kp: f64| {
        let [own, ki, kd] = OF_ALTITUDE;
        let controller = pid([own + kp, ki, kd], PidConfig::sampled_every(DT_S));
        let other = flight(with(loops(), &[(ALTITUDE_LOOP, controller)]));
        let poles = eigenvalues(&Question::of(&other, 0).small().matrix).expect("found");
        (largest(&poles), poles)
    };
    let (gentle, quick) = (0.05, 20.0);
    let [(held, poles), (grows, _)] = [gentle, quick].map(fixed);
    assert!(held < 1.0 && grows > 1.01, "{held} {grows}");
    let alone = asked(&[&[gentle]]);
    assert_eq!(alone.stand, Stand::Holds);
    assert!((alone.largest - held).abs() < 1e-6);
    for place in ASKED {
        let [one, other] = [&alone.eigenvalues, &poles].map(|poles| characteristic(poles, place));
        assert!(libm::hypot(one[0] - other[0], one[1] - other[1]) < 1e-6);
    }
    let [both, twice] = [asked(&[&[gentle, 0.0]]), asked(&[&[gentle], &[0.0]])];
    for several in [&both, &twice] {
        assert_eq!(several.stand, Stand::Holds);
        assert!(several.eigenvalues.is_empty());
    }
    let Stand::Grows { spectral_radius } = asked(&[&[quick]]).stand else { panic!("it holds") };
    assert!((spectral_radius - grows).abs() < 1e-6);
    // At one of two targets alone.
    assert_eq!(asked(&[&[gentle], &[quick]]).stand, Stand::Undecided(Doubt::OuterGains));
}

fn largest(poles: &[Complex]) -> f64 {
    poles.iter().map(|pole| libm::hypot(pole.re, pole.im)).fold(0.0, f64::max)
}

/// All combinations of so many sides, the last of which is this, of two loops.
fn combined<'a>(
    question: &Question<'a>,
    small: &Small<'a>,
    sides: [usize; 2],
    last: Side,
) -> Sides {
    let gains = [(ALTITUDE_LOOP, OF_ALTITUDE), (THROTTLE, [0.2, 0.02, 0.0])];
    let acting = [0, 1].map(|at| {
        let mut all = vec![side(gains[at].1); sides[at]];
        if let (0, Some(side)) = (at, all.last_mut()) {
            *side = last;
        }
        acting(&question.asked, gains[at].0, &all)
    });
    let reach = [0, 1].map(|at| reach_of(question, small, &acting[at]));
    of_loops(small, &acting, &reach).expect("found")
}

#[test]
fn several_loops_hold_where_every_side_of_one_does_beside_every_side_of_the_others() {
    let base = flight(loops());
    let question = Question::of(&base, 0);
    let small = question.small();
    let still = side(OF_ALTITUDE);
    let held = largest(&eigenvalues(&small.matrix).expect("found"));
    assert!(held < 1.0, "{held}");
    for sides in [[1, 1], [2, 3], [8, 8]] {
        let found = combined(&question, &small, sides, still);
        assert_eq!(found.stand, Stand::Holds, "{sides:?}");
        assert!((found.largest - held).abs() < 1e-9);
    }
    // More than 64 combinations are not asked.
    let many = combined(&question, &small, [8, 9], still);
    assert_eq!(many.stand, Stand::Undecided(Doubt::OuterGains));
    // And one of them that grows is in doubt.
    let quick = Added { kp: 20.0, change: 0.0, late: None }.side(OF_ALTITUDE);
    for sides in [[1, 1], [3, 2]] {
        let found = combined(&question, &small, sides, quick);
        assert_eq!(found.stand, Stand::Undecided(Doubt::OuterGains), "{sides:?}");
    }
}

/// What gathers comes in time to a sum without end.
#[test]
fn differences_are_as_large_as_the_most_that_any_side_adds() {
    let scenario = flight(loops());
    let question = Question::of(&scenario, 0);
    let most = |gains: [f64; 3], added: &[Added]| {
        let sides: Vec<Side> = added.iter().map(|it| it.side(gains)).collect();
        let acting = acting(&question.asked, ALTITUDE_LOOP, &sides);
        let [kp, ki, kd] = gains;
        Acting { gains: Gains { kp, ki, kd }, ..acting }.largest_more()
    };
    let none = Added { kp: 0.0, change: 0.0, late: None };
    let late = |keeps: f64, by_error: f64| Added { late: Some([keeps, by_error, 0.0]), ..none };
    let sum: f64 = (0..400).map(|samples| 0.3 * libm::pow(0.9, f64::from(samples))).sum();
    let of = |gains: [f64; 3], added: &[Added], expected: f64| {
        let found = most(gains, added);
        assert!((found / expected - 1.0).abs() < 1e-9, "{added:?}: {found} {expected}");
    };
    let small = [0.15, 0.0, 0.0];
    of(small, &[none], 0.15);
    of([-7.0, 0.0, 0.0], &[Added { kp: 0.5, ..none }], 7.0);
    of(small, &[none, Added { kp: 2.5, ..none }], 2.5);
    of(small, &[Added { kp: -2.5, ..none }, none], 2.5);
    of(small, &[Added { change: -4.0, ..none }], 4.0);
    of(small, &[late(0.9, 0.3)], sum);
    of(small, &[late(0.9, -0.3), none], sum);
    // Something stands for a gain of nothing.
    of([0.0; 3], &[none], 1.0);
    of([0.0; 3], &[Added { kp: 0.2, ..none }], 0.2);
}

#[test]
fn a_supervisor_sees_the_change_of_the_error_or_the_error_twice() {
    let base = flight(loops());
    let question = Question::of(&base, 0);
    let small = question.small();
    let count = small.places.len();
    let error: Vec<f64> = (0..count).map(|place| 1.0 + place as f64).collect();
    let reach = Reach { by_command: vec![0.0; count], error: error.clone(), memory: (0, 1.0) };
    // The error of the sample before, and what gathers, stand behind the numbers of the flight.
    let row = |before: f64| [error.as_slice(), &[before, 0.0]].concat();
    let model = ReferenceModel { bandwidth_rad_s: 1.0, damping: 0.7 };
    for (second_input, before) in
        [(SecondInput::Change, -1.0), (SecondInput::ModelError(model), 0.0)]
    {
        let tuner = tuned_by_itself();
        let settings = TunerSettings { second_input, ..*tuner.tuner().settings() };
        let supervisor = *tuner.tuner().supervisor();
        let other = SelfTuner::new(tuner.tuner().nominal(), supervisor, settings);
        let fspid = Fspid::new(other.expect("allowed"), *tuner.config()).expect("allowed");
        let gains = fspid.tuner().gains_at_rest();
        let rest = Rest::of_outer_loop(&fspid, gains, [300.0, 0.0]).expect("known");
        assert_eq!(seen(&small, &reach, &rest), [row(0.0), row(before)]);
    }
}

/// A bank that nothing turns the aircraft to.
#[test]
fn a_loop_that_moves_nothing_shows_nothing() {
    let loops = vec![outer("heading", Quantity::Heading, Moves::Bank, [1.0, 0.1, 0.0])];
    let autopilot = Autopilot::new(loops, None, None, vec![mode("straight", &[0])]);
    let scenario = scenario(without_wings(), Some(autopilot.expect("makes sense")));
    let question = Question::of(&scenario, 0);
    let small = question.small();
    let acting = acting(&question.asked, 0, &[side([1.1, 0.1, 0.0])]);
    assert!(reach(&question.asked, &small, &acting).expect("it flies").is_none());
}
