//! What a ball of old unknowns holds, and what is near rest.

use fspid_core::{
    ControllerSetting, Derivative, Fspid, Gains, Guard, Limits, Pid, PidConfig, SelfTuner,
    TunerSettings,
};
use fspid_fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_sim::actuator::Actuator;

use super::*;
use crate::rest::drawn::Dice;
use crate::steps::tests::navion::{GAINS, navion};
use crate::{Asked, Certificate, Effort, Range, Verdict, certify};

mod flown_on;
mod remembering;
pub(in crate::steps) mod self_tuned;

const DEG: f64 = core::f64::consts::PI / 180.0;
/// Set-points of the flights that are at rest, rad.
const SETPOINT_RAD: f64 = 0.05;
/// Much more than rounding, and much less than what is looked for.
const HAIR: f64 = 1e-6;

/// A loop with a limit everywhere, and its form near rest.
pub(in crate::steps) struct Loop {
    certificate: Certificate,
    model: LoopModel<Interval>,
    set: GainSet,
}

/// The Navion with a PID.
fn description() -> LoopDescription {
    let around = |most: f64| {
        Limits::new(ControllerSetting::OutputLimits, -most * DEG, most * DEG).expect("allowed")
    };
    let config = PidConfig {
        derivative: Derivative { filter_s: 0.05 },
        limits: Some(around(18.0)),
        slew_rad_s: Some(90.0 * DEG),
        ..PidConfig::sampled_every(0.02)
    };
    let servo = Actuator::first_order(0.1)
        .and_then(|servo| servo.with_command_limits(-20.0 * DEG, 20.0 * DEG))
        .and_then(|servo| servo.with_rate_limit(40.0 * DEG))
        .and_then(|servo| servo.with_delay(2));
    navion(servo.expect("allowed"), Controller::Fixed(Pid::new(GAINS, config).expect("allowed")))
}

impl Loop {
    pub(in crate::steps) fn new() -> Self {
        let description = description();
        let asked = Asked::within(Range { setpoint_rad: SETPOINT_RAD, load_rad: 0.01 });
        let outcome = certify(&description, &asked, &Effort::default()).expect("an answer");
        let Verdict::Proved(certificate, _) = outcome.verdict else { panic!("not proved") };
        let model = description.enclosed().expect("enclosed");
        let set = GainSet::fixed(description.controller.nominal());
        Self { certificate, model, set }
    }

    pub(in crate::steps) fn ready(&self) -> Ready<'_> {
        let terminal = &self.certificate.steps.as_ref().expect("steps are proved").terminal;
        let forms = [terminal, terminal];
        let Self { certificate, model, set } = self;
        let ready = Ready::of(&certificate.description, model, set, forms, None);
        ready.expect("proved").expect("enclosed")
    }
}

/// Numbers to either side.
fn drawn(dice: &mut Dice, size: usize, most: f64) -> Vec<f64> {
    (0..size).map(|_| dice.between(-most, most)).collect()
}

/// A vector of such a norm.
fn of_norm(norm: &Norm, vector: &[f64], size: f64) -> Vec<f64> {
    let factor = size / norm.size_of(vector);
    vector.iter().map(|value| factor * value).collect()
}

fn column(values: &[Affine], symbol: usize) -> Vec<f64> {
    values.iter().map(|value| value.parts.of(symbol)).collect()
}

/// A set with many unknowns of its own, each much smaller than the one before.
fn with_unknowns(ready: &Ready<'_>, dice: &mut Dice, symbols: usize, largest: f64) -> Flight {
    let mut flight = at_rest(ready);
    let mut add = |value: &mut Affine| {
        let own = (0..symbols).map(|symbol| {
            let size = largest * libm::pow(0.97, symbol as f64);
            if symbol < OWN { value.parts.of(symbol) } else { dice.between(-size, size) }
        });
        value.parts = own.collect();
        value.off = 1e-9;
    };
    flight.values.iter_mut().for_each(&mut add);
    add(&mut flight.last);
    (flight.symbols, flight.ball) = (symbols, 0.003);
    flight
}

/// Flights at their rests.
pub(in crate::steps) fn at_rest(ready: &Ready<'_>) -> Flight {
    let mut flight = ready.unit(None);
    flight.setpoint = Affine::unknown([0.9 * SETPOINT_RAD, SETPOINT_RAD], SETPOINT);
    flight.load = Affine::unknown([0.0, 0.005], LOAD);
    let rest = |by: [f64; 2]| {
        let terms = [(by[0], &flight.setpoint), (by[1], &flight.load)];
        Affine::sum(terms.map(|(by, of)| (Interval::point(by), of)))
    };
    let [by_setpoint, by_load] = &ready.rest;
    let values = by_setpoint.iter().zip(by_load).map(|(one, other)| rest([*one, *other]));
    let values: Vec<Affine> = values.collect();
    let last = rest(ready.rest_command);
    Flight { values, last, ..flight }
}

#[track_caller]
fn same(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs() + 1e-290, "{found:e} {expected:e}");
}

#[test]
fn the_ball_grows_by_the_norms_of_the_smallest_unknowns_and_they_are_gone() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flight = with_unknowns(&ready, &mut Dice::new(1), OWN + MOST_SYMBOLS, 0.01);
    let before = flight.clone();
    ready.absorb(&mut flight);
    assert_eq!(flight.symbols, OWN + KEPT_SYMBOLS);
    let mut sizes: Vec<(f64, usize)> = (OWN..before.symbols)
        .map(|symbol| (ready.norm.size_of(&column(&before.values, symbol)), symbol))
        .collect();
    sizes.sort_by(|one, other| other.0.total_cmp(&one.0));
    let gone = sizes.split_off(KEPT_SYMBOLS);
    same(flight.ball, before.ball + gone.iter().map(|(size, _)| size).sum::<f64>());
    let lost = gone.iter().map(|(_, symbol)| before.last.parts.of(*symbol).abs()).sum::<f64>();
    same(flight.last.off, before.last.off + lost);
    let mut kept: Vec<usize> = (0..OWN).chain(sizes.iter().map(|(_, symbol)| *symbol)).collect();
    kept.sort_unstable();
    for (now, then) in kept.iter().enumerate() {
        assert_eq!(column(&flight.values, now), column(&before.values, *then));
        let [one, other] = [(&flight, now), (&before, *then)].map(|(it, at)| it.last.parts.of(at));
        assert_eq!(one.to_bits(), other.to_bits());
    }
}

#[test]
fn what_is_gathered_becomes_one_unknown_for_each_number_with_its_share_of_the_ball() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flight = with_unknowns(&ready, &mut Dice::new(2), OWN + KEPT_FOLLOWED + 40, 0.01);
    let before = flight.clone();
    ready.gather(&mut flight);
    assert_eq!(flight.symbols, OWN + KEPT_FOLLOWED + flight.values.len() + 1);
    assert!(flight.ball.to_bits() == 0 && flight.values.iter().all(|value| value.of_ball == 0.0));
    let mut sizes: Vec<(f64, usize)> = (OWN..before.symbols)
        .map(|symbol| (ready.near.size_of(&column(&before.values, symbol)), symbol))
        .collect();
    sizes.sort_by(|one, other| other.0.total_cmp(&one.0));
    let gone = sizes.split_off(KEPT_FOLLOWED);
    let reach = ready.flown.reach.iter().map(|reach| reach * before.ball).chain([0.0]);
    let numbers = |flight: &Flight| -> Vec<Affine> {
        flight.values.iter().chain([&flight.last]).cloned().collect()
    };
    let own = OWN + KEPT_FOLLOWED..;
    for (((now, then), of_ball), symbol) in
        numbers(&flight).iter().zip(numbers(&before)).zip(reach).zip(own)
    {
        let sum = gone.iter().map(|(_, symbol)| then.parts.of(*symbol).abs()).sum::<f64>();
        same(now.parts.of(symbol), sum + then.off + of_ball);
        same(now.spread(), then.spread() + then.off + of_ball);
        assert!(now.off <= 1e-12 && now.centre.to_bits() == then.centre.to_bits());
    }
}

/// One flight of a set: each unknown at an end, the ball at its edge.
fn one_of(ready: &Ready<'_>, set: &Flight, dice: &mut Dice) -> Flight {
    let ends: Vec<f64> = (0..set.symbols).map(|_| 2.0 * dice.part().round() - 1.0).collect();
    let at = |value: &Affine| -> f64 {
        let parts = value.parts.each().iter().zip(&ends).map(|(part, end)| part * end);
        value.centre + parts.sum::<f64>()
    };
    let beside = of_norm(&ready.norm, &drawn(dice, set.values.len(), 1.0), set.ball);
    let fixed = |value: f64| Affine::constant(Interval::point(value));
    let values = set.values.iter().zip(&beside).map(|(value, beside)| fixed(at(value) + beside));
    Flight {
        values: values.collect(),
        last: fixed(at(&set.last)),
        setpoint: fixed(at(&set.setpoint)),
        load: fixed(at(&set.load)),
        ball: 0.0,
        symbols: OWN,
        ..set.clone()
    }
}

/// With nothing cut the ball shrinks; what is cut, or may be, lets it grow.
#[test]
fn a_set_with_a_ball_holds_the_next_sample_of_every_flight_in_it() {
    let loop_ = Loop::new();
    let mut ready = loop_.ready();
    let dice = &mut Dice::new(3);
    let (mut free, mut cut) = (0, 0);
    for round in 0..200 {
        let [largest, far] = if round % 2 == 0 { [1e-5, 0.0] } else { [0.01, 0.2] };
        let mut set = with_unknowns(&ready, dice, OWN + 20, largest);
        let away = drawn(dice, set.values.len(), far);
        set.values.iter_mut().zip(away).for_each(|(value, by)| value.centre += by);
        set.ball = dice.between(0.0, 2.0 * largest);
        let Ok(next) = ready.after(&set, Moment::Later) else { continue };
        if !next.limited {
            let rate = loop_.certificate.steps.as_ref().expect("proved").terminal.rate;
            let passed = ready.flown.pass(&set, Moment::Later, Judge::Measured).expect("known");
            let off: Vec<f64> = passed.flight.values.iter().map(|value| value.off).collect();
            same(next.ball, rate * set.ball + ready.norm.of_box(&off));
        }
        *if next.limited { &mut cut } else { &mut free } += 1;
        for _ in 0..10 {
            let one = one_of(&ready, &set, dice);
            let one = ready.flown.pass(&one, Moment::Later, Judge::Measured).expect("known").flight;
            let reach = ready.flown.reach.iter().map(|reach| reach * next.ball);
            for ((of_one, of_set), of_ball) in one.values.iter().zip(&next.values).zip(reach) {
                let off = (of_one.centre - of_set.centre).abs();
                let most = of_set.radius() + of_ball + of_one.radius() + 1e-14;
                assert!(off <= most, "{round}: {off:e} {most:e}");
            }
            let off = (one.last.centre - next.last.centre).abs();
            assert!(off <= next.last.radius() + one.last.radius() + 1e-14, "{round}: {off:e}");
        }
    }
    assert!(free > 20 && cut > 20, "{free} {cut}");
}

#[test]
fn a_set_is_near_rest_while_all_that_moves_it_is_within_the_level_together() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let rest = at_rest(&ready);
    assert!(ready.is_near(&rest));
    let dice = &mut Dice::new(4);
    let size = rest.values.len();
    for _ in 0..20 {
        let away = of_norm(&ready.near, &drawn(dice, size, 1.0), ready.within);
        let moved = |share: f64| {
            let mut flight = rest.clone();
            flight.values.iter_mut().zip(&away).for_each(|(it, by)| it.centre += share * by);
            flight
        };
        let spread = |share: f64, mut flight: Flight| {
            let by = |(value, by): (&mut Affine, &f64)| {
                value.parts = (0..=OWN)
                    .map(|it| if it == OWN { share * by } else { value.parts.of(it) })
                    .collect();
            };
            flight.values.iter_mut().zip(&away).for_each(by);
            flight.symbols = OWN + 1;
            flight
        };
        let blown = |share: f64, flight: Flight| Flight {
            ball: share * ready.within / ready.into_near,
            ..flight
        };
        let rounded = |share: f64, mut flight: Flight| {
            let whole: Vec<f64> = away.iter().map(|by| by.abs()).collect();
            let factor = share * ready.within / ready.near.of_box(&whole);
            flight.values.iter_mut().zip(whole).for_each(|(it, by)| it.off = factor * by);
            flight
        };
        for (share, is_near) in [(1.0 - HAIR, true), (1.0 + HAIR, false)] {
            let alone = [
                moved(share),
                spread(share, rest.clone()),
                blown(share, rest.clone()),
                rounded(share, rest.clone()),
            ];
            assert_eq!(alone.map(|flight| ready.is_near(&flight)), [is_near; 4]);
            let part = 0.25 * share;
            let together = rounded(part, blown(part, spread(part, moved(part))));
            assert_eq!(ready.is_near(&together), is_near);
        }
    }
}

#[test]
fn a_set_is_not_near_rest_while_a_slew_limit_or_a_command_on_its_way_may_be_cut() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let rest = at_rest(&ready);
    let most = ready.slew_rad.expect("limited");
    for (share, is_near) in [(1.0 - HAIR, true), (1.0 + HAIR, false)] {
        let mut flight = rest.clone();
        flight.last.centre += share * most;
        assert_eq!(ready.is_near(&flight), is_near, "{share}");
    }
    let (least, most) = ready.flown.arriving.expect("limited");
    let layout = &ready.flown.layout;
    assert!(layout.queue > 1);
    for place in layout.plant..layout.plant + layout.queue {
        let reach = ready.flown.reach[place];
        for (limit, share) in
            [(least, 1.0 - HAIR), (most, 1.0 - HAIR), (least, 1.0 + HAIR), (most, 1.0 + HAIR)]
        {
            // What its load, its own unknown and the ball leave.
            let mut flight = rest.clone();
            flight.ball = 0.002;
            flight.at_servo = Affine::constant(Interval::point(0.001));
            let own = reach * flight.ball;
            let at = 0.001 + own.copysign(limit);
            flight.values[place] = Affine::constant(Interval::point(share * limit - at));
            assert_eq!(ready.is_clear(&flight), share < 1.0, "{place} {limit} {share}");
        }
    }
}

/// Two ways to the matrix of a sample, the model's and that of the flights, are held against each other.
#[test]
fn flights_of_another_loop_than_the_model_are_noticed_in_every_entry() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let at_rest = ready.flown.gains.at_rest();
    assert!(ready.is_the_model(&loop_.model, at_rest));
    let is_noticed = |change: &dyn Fn(&mut Flown<'_>)| {
        let mut other = ready.clone();
        change(&mut other.flown);
        !other.is_the_model(&loop_.model, at_rest)
    };
    for row in 0..ready.flown.plant.len() {
        for by in [2e-8, -2e-8] {
            let by = Interval::point(by);
            assert!(is_noticed(&|flown| flown.plant[row][0] = flown.plant[row][0] + by));
        }
    }
    assert!(is_noticed(&|flown| flown.config.derivative.filter_s *= 1.0 + 1e-6));
}

/// The form is the claim's own, and falls at the gains near rest alone: how the ball grows at others is asked.
#[test]
fn only_of_fixed_gains_or_of_a_form_of_the_claim_it_is_known_before_that_a_free_sample_shrinks_the_ball()
 {
    let loop_ = Loop::new();
    let mut tuned = loop_.certificate.description.clone();
    let nominal = tuned.controller.nominal();
    tuned.controller = self_tuner(nominal, *tuned.controller.config());
    let terminal = &loop_.certificate.steps.as_ref().expect("proved").terminal;
    let slower = Terminal { rate: 1.0 - 0.5 * (1.0 - terminal.rate), ..terminal.clone() };
    let model = tuned.enclosed().expect("enclosed");
    let set = |controller: &Controller| match controller {
        Controller::Fixed(pid) => GainSet::fixed(pid.gains()),
        Controller::SelfTuning(fspid) => {
            crate::gain_set::IncrementMap::of(fspid.tuner(), 12).expect("bounded").gains(1.0)
        }
    };
    let fixed = &loop_.certificate.description;
    for (description, model, common, is_known) in [
        (fixed, &loop_.model, terminal, true),
        (fixed, &loop_.model, &slower, true),
        (&tuned, &model, terminal, false),
        (&tuned, &model, &slower, true),
    ] {
        let gains = set(&description.controller);
        let ready = Ready::of(description, model, &gains, [terminal, common], None);
        let ready = ready.expect("proved").expect("enclosed");
        for mut growth in ready.growth.iter().cloned() {
            let mut asked = false;
            growth.of(&ready.norm, FREE, |_| {
                asked = true;
                Vec::new()
            });
            assert_eq!(asked, !is_known);
        }
    }
}

/// One that hardly moves its gains.
fn self_tuner(nominal: Gains<f64>, config: PidConfig<f64>) -> Controller {
    let rules = fspid_core::paper::rules();
    let supervisor = Supervisor::new(&rules, 5.0, Defuzzifier::Exact, OutOfRange::Clamp);
    let small = 1e-4;
    let output_scale = Gains { kp: small, ki: small, kd: small };
    let settings = TunerSettings { output_scale, ..TunerSettings::literal() };
    let tuner = SelfTuner::new(nominal, supervisor.expect("allowed"), settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
}

#[test]
fn flights_land_as_soon_as_a_look_finds_them_near_rest_from_wherever_they_are_flown_on() {
    let loop_ = Loop::new();
    let mut ready = loop_.ready();
    same(ready.slew_rad.expect("limited"), 0.5 * 90.0 * DEG * 0.02);
    assert_eq!(ready.rests_s(), None);
    let commands = Commands::step();
    let patch = Patch { setpoint: [0.01, 0.0101], load: [0.0, 0.0] };
    let way = Way { commands: &commands, patch, from: Beginning::Controller };
    let begun = ready.begun(Beginning::Controller);
    let whole = ready.landed(&way, begun.clone(), 0..20_000).expect("it lands");
    assert!(whole.flown == whole.samples && whole.samples.is_multiple_of(LOOKS), "{whole:?}");
    let flight = ready.until(&way, begun.clone(), 0..5).expect("known");
    let part = ready.landed(&way, flight, 5..20_000).expect("it lands");
    assert_eq!(part, Landed { flown: whole.flown - 5, ..whole });
    // Not a look before: the flights of then are not near rest.
    let before = ready.until(&way, begun.clone(), 0..whole.samples - LOOKS).expect("known");
    assert!(!ready.is_near(&before));
    let too_short = ready.landed(&way, begun.clone(), 0..whole.samples - 1);
    assert_eq!(too_short, Err((Stop::Lost, whole.samples - 1)));
    // How many samples were flown before it was given up.
    ready.flown.config.guard = Guard::new(0.005).expect("allowed");
    assert_eq!(ready.landed(&way, begun, 0..20_000), Err((Stop::Guard, 0)));
}

#[test]
fn rest_is_where_a_sample_moves_nothing() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let rest = at_rest(&ready);
    let next = ready.flown.pass(&rest, Moment::Later, Judge::Measured).expect("known").flight;
    for (then, now) in rest.values.iter().zip(&next.values) {
        assert!(now.less(then).magnitude() < 1e-9, "{then:?} {now:?}");
    }
    assert!(next.last.less(&rest.last).magnitude() < 1e-9);
    // Of a set-point and a load of 1 together no more than twice what a sample moves of one.
    assert!(ready.off_rest > 0.0 && ready.off_rest < 1e-6, "{:e}", ready.off_rest);
    // What a sample moves there, and all of the samples after it.
    let unit = ready.unit(Some(&ready.rest));
    let forced = Judge::Forced(FREE, ready.flown.gains.at_rest());
    let moved = ready.flown.pass(&unit, Moment::Later, forced).expect("known").flight.values;
    let off = moved.iter().zip(&unit.values).map(|(next, now)| next.less(now).magnitude());
    let rate = loop_.certificate.steps.as_ref().expect("proved").terminal.rate;
    let off: Vec<f64> = off.collect();
    same(ready.off_rest, ready.near.of_box(&off) / (1.0 - rate));
}

#[test]
fn how_far_pitch_angles_are_apart_leaves_out_what_set_point_and_load_make_of_them() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flight = at_rest(&ready);
    assert!(ready.apart_rad(&flight) < 1e-12);
    flight.values[0].parts = [0.3, 0.2, 0.01, -0.02].into_iter().collect();
    flight.ball = 0.001;
    same(ready.apart_rad(&flight), 0.03 + 0.001 * ready.flown.reach[0]);
}

/// What rounding may make of an entry lies to both sides of it.
#[test]
fn the_matrix_of_a_sample_holds_what_its_flights_are_off() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let size = ready.flown.layout.size;
    let gains = ready.flown.gains.at_rest();
    let matrix = forced(&ready.flown, FREE, gains).expect("known");
    let mut unit = ready.unit(None);
    (unit.setpoint, unit.load, unit.symbols) = (Affine::default(), Affine::default(), size);
    for (place, value) in unit.values.iter_mut().enumerate() {
        value.parts = (0..size).map(|at| if at == place { 1.0 } else { 0.0 }).collect();
    }
    let pass = ready.flown.pass(&unit, Moment::Later, Judge::Forced(FREE, gains));
    let moved = pass.expect("known").flight.values;
    let entries: Vec<Interval> = matrix.entries().collect();
    for (row, value) in moved.iter().enumerate() {
        for place in 0..size {
            let [entry, part] =
                [entries[row * size + place], Interval::point(value.parts.of(place))];
            let held = part + Interval::between(-value.off, value.off);
            assert!(entry.encloses(held), "{row} {place}: {entry:?} {held:?}");
        }
    }
    assert!(moved.iter().any(|value| value.off > 1e-17));
}

#[test]
fn a_box_of_gains_has_a_corner_for_each_of_its_ends() {
    let wide = Interval::between(1.0, 2.0);
    let found = |bounds: [Interval; 3]| corners(bounds).len();
    assert_eq!(found([wide; 3]), 8);
    assert_eq!(found([wide, Interval::ONE, wide]), 4);
    let all = corners([wide, Interval::between(3.0, 4.0), Interval::between(5.0, 6.0)]);
    let has = |middle: [f64; 3]| all.contains(&Between { middle, radius: [0.0; 3] });
    assert!(
        [[1.0, 3.0, 5.0], [2.0, 3.0, 5.0], [1.0, 4.0, 5.0], [2.0, 4.0, 6.0]].into_iter().all(has)
    );
}
