//! Numbers of plants that move in flight: within samples, from patch to patch, and where an enemy moves them.

use fspid_core::{Derivative, Gains, Pid, PidConfig};
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{ContinuousPlant, LagOf, NotProved, PlantSet, Sloped};
use fspid_proof::{
    Asked, Certificate, Effort, Family, FamilyVerdict, LoopDescription, Parameter, Patch,
    ScaledSensor, Verdict, certify, numbers, prove_family,
};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::loop_model::{LoopModel, SampledPlant, Sensing};
use fspid_sim::{Controller, ElevatorSign};

const DT_S: f64 = 0.02;
/// What the elevator and the angle of attack do to an aircraft at constant speed.
#[derive(Clone, Copy)]
struct Aircraft {
    effect: f64,
    by_alpha: f64,
    damping: f64,
    lift: f64,
    lag_s: f64,
    gains: Gains<f64>,
}

const STEADY: Aircraft = Aircraft {
    effect: 6.0,
    by_alpha: -4.0,
    damping: -1.2,
    lift: -0.9,
    lag_s: 0.1,
    gains: Gains { kp: 1.0, ki: 0.5, kd: 0.2 },
};

impl Aircraft {
    /// The loop at these numbers.
    fn description(self) -> LoopDescription {
        let Self { effect, by_alpha, damping, lift, lag_s, gains } = self;
        let derivative = Derivative { filter_s: 0.05 };
        let config = PidConfig { derivative, ..PidConfig::sampled_every(DT_S) };
        LoopDescription {
            numerator: vec![effect, -effect * lift],
            denominator: vec![1.0, -(damping + lift), damping * lift - by_alpha, 0.0],
            elevator_sign: ElevatorSign::NoseUpPositive,
            actuator: Actuator::new(Lag::first_order(lag_s).expect("allowed")),
            pitch: Sensing::DIRECT,
            rate: Sensing::DIRECT,
            controller: Controller::Fixed(Pid::new(gains, config).expect("allowed")),
        }
    }

    /// Pitch angle, pitch rate and angle of attack; numbers are the stability and one over the time constant.
    fn plant(self, at: &[Sloped]) -> Result<ContinuousPlant<Sloped>, NotProved> {
        let [by_alpha, bandwidth] = *at else { panic!("two numbers") };
        let point = |value: f64| Sloped::fixed(Interval::point(value));
        let [zero, one] = [0.0, 1.0].map(point);
        Ok(ContinuousPlant {
            by_states: vec![
                vec![zero, one, zero],
                vec![zero, point(self.damping), by_alpha],
                vec![zero, one, point(self.lift)],
            ],
            by_elevator: vec![zero, point(self.effect), zero],
            pitch_rate: vec![zero, one, zero, zero],
            lag: LagOf::First(bandwidth),
        })
    }

    /// Derivatives by states, deflection and command at numbers as a scenario has them.
    fn rows(self, [by_alpha, lag_s]: [f64; 2]) -> [[f64; 5]; 4] {
        [
            [0.0, 1.0, 0.0, 0.0, 0.0],
            [0.0, self.damping, by_alpha, self.effect, 0.0],
            [0.0, 1.0, self.lift, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0 / lag_s, 1.0 / lag_s],
        ]
    }

    /// Transitions over a sample in which the numbers are somewhere at each share of it.
    fn over_a_sample(self, at: impl Fn(f64) -> [f64; 2]) -> Vec<f64> {
        const STEPS: u32 = 16;
        let step_s = DT_S / f64::from(STEPS);
        let columns = (0..5).map(|column: usize| {
            let mut x = [0.0; 5];
            x[column] = 1.0;
            for step in 0..STEPS {
                let slope = |part: f64, x: [f64; 5]| -> [f64; 5] {
                    let rows = self.rows(at((f64::from(step) + part) / f64::from(STEPS)));
                    let along = |row: [f64; 5]| row.iter().zip(x).map(|(a, x)| a * x).sum();
                    let [a, b, c, d] = rows.map(along);
                    [a, b, c, d, 0.0]
                };
                let moved = |by: [f64; 5], part: f64| {
                    core::array::from_fn(|place| x[place] + part * step_s * by[place])
                };
                let first = slope(0.0, x);
                let second = slope(0.5, moved(first, 0.5));
                let third = slope(0.5, moved(second, 0.5));
                let fourth = slope(1.0, moved(third, 1.0));
                for place in 0..5 {
                    let sum =
                        first[place] + 2.0 * second[place] + 2.0 * third[place] + fourth[place];
                    x[place] += step_s / 6.0 * sum;
                }
            }
            x
        });
        let columns: Vec<[f64; 5]> = columns.collect();
        (0..4).flat_map(|row| columns.iter().map(move |column| column[row])).collect()
    }

    /// The loop over a sample in which its numbers move so.
    fn closed(self, at: impl Fn(f64) -> [f64; 2]) -> Matrix {
        let rate = vec![0.0, 1.0, 0.0, 0.0];
        let plant = SampledPlant { states: 4, rows: self.over_a_sample(at), rate };
        let model = LoopModel::new(plant, self.description().settings());
        model.closed_matrix(self.gains).expect("finite")
    }
}

fn parameters(ends: [[f64; 2]; 2]) -> Vec<Parameter> {
    let parameter = |(path, ends): (&str, [f64; 2])| Parameter {
        name: path.to_owned(),
        paths: vec![path.to_owned()],
        relative: false,
        inverse: path.starts_with("actuator"),
        sensors: Vec::new(),
        ends,
    };
    let paths = ["aircraft.name.longitudinal.pitch.alpha", "actuator.time_constant_s"];
    paths.into_iter().zip(ends).map(parameter).collect()
}

fn proved(aircraft: Aircraft, ends: [[f64; 2]; 2]) -> Family {
    let makes = |at: &[Sloped]| aircraft.plant(at);
    let description = aircraft.description();
    let found = prove_family(&description, &parameters(ends), &Effort::default(), &makes);
    match found.expect("provable") {
        FamilyVerdict::Proved(family) => family,
        other => panic!("{other:?}"),
    }
}

fn certificate(description: &LoopDescription, family: &Family) -> Certificate {
    let outcome = certify(description, &Asked::rest(), &Effort::default()).expect("provable");
    let Verdict::Proved(certificate, _) = outcome.verdict else { panic!("{outcome:?}") };
    Certificate { family: Some(family.clone()), ..certificate }
}

/// Numbers in 0..1 that fill it evenly.
fn share(number: u32) -> f64 {
    let golden = 0.618_033_988_749_895 * f64::from(number);
    golden - libm::floor(golden)
}

const BOX: [[f64; 2]; 2] = [[-6.0, -2.0], [0.08, 0.12]];

#[test]
fn what_a_sample_makes_of_numbers_that_move_in_it_is_within_the_bound_and_nearly_reaches_it() {
    let set =
        PlantSet::of(&numbers(&parameters(BOX), &BOX), &|at| STEADY.plant(at)).expect("plants");
    let most = [0.05, 0.2];
    let off = PlantSet::off_by_moving(&[&set], &most, DT_S).expect("a bound");
    let mut nearest = 0.0_f64;
    for number in 0..60 {
        let begin = BOX.map(|[from, to]| {
            let margin = 0.02 * (to - from);
            from + margin + (to - from - 2.0 * margin) * share(number)
        });
        let [along_alpha, along_lag] =
            [share(3 * number), share(7 * number + 2)].map(|it| 2.0 * it - 1.0);
        // At once, evenly, and there and back.
        let how: [&dyn Fn(f64) -> f64; 3] = [&|_| 1.0, &|part| part, &|part| libm::sin(7.0 * part)];
        for how in how {
            let at = |part: f64| {
                let bandwidth = 1.0 / begin[1] + most[1] * along_lag * how(part);
                [begin[0] + most[0] * along_alpha * how(part), 1.0 / bandwidth]
            };
            let moved = STEADY.over_a_sample(at);
            let still = STEADY.over_a_sample(|_| begin);
            for ((moved, still), off) in moved.iter().zip(&still).zip(&off) {
                let found = (moved - still).abs();
                assert!(found <= off + 1e-12, "{found} of {off} from {begin:?}");
                nearest = nearest.max(if *off > 1e-6 { found / off } else { 0.0 });
            }
        }
    }
    assert!((0.4..=1.0).contains(&nearest), "{nearest}");
}

/// Where an enemy has the numbers go next: towards one of the corners of the box.
type Enemy<'a> = dyn FnMut(usize, &[Matrix; 4], &[f64]) -> usize + 'a;

/// How much of a deviation is left, at its largest, in the last quarter of a flight of so many samples whose numbers cross
/// their ranges in a time.
fn left(aircraft: Aircraft, ends: [[f64; 2]; 2], crosses_in_s: f64, enemy: &mut Enemy<'_>) -> f64 {
    const SAMPLES: usize = 3000;
    let mut at = ends.map(|[from, to]| 0.5 * (from + to));
    let size = aircraft.closed(|_| at).rows();
    let mut z = vec![0.0; size];
    z[0] = 1.0;
    let mut most = 0.0_f64;
    for sample in 0..SAMPLES {
        let towards = |corner: usize| -> [f64; 2] {
            core::array::from_fn(|side| {
                let [from, to] = ends[side];
                let step = (to - from) * DT_S / crosses_in_s;
                let way = if corner >> side & 1 == 0 { -step } else { step };
                (at[side] + way).clamp(from, to)
            })
        };
        let loops = [0, 1, 2, 3].map(|corner| {
            let end = towards(corner);
            aircraft.closed(|part| {
                core::array::from_fn(|side| at[side] + part * (end[side] - at[side]))
            })
        });
        let corner = enemy(sample, &loops, &z);
        let mut next = vec![0.0; size];
        loops[corner].apply(&z, &mut next).expect("of one size");
        (at, z) = (towards(corner), next);
        if sample >= SAMPLES / 4 * 3 {
            most = z.iter().fold(most, |most, it| most.max(it.abs()));
        }
    }
    most
}

fn length(form: &Matrix, z: &[f64]) -> f64 {
    let mut out = vec![0.0; z.len()];
    form.apply(z, &mut out).expect("of one size");
    z.iter().zip(&out).map(|(one, other)| one * other).sum()
}

#[test]
fn flights_of_a_family_at_its_pace_come_to_rest_however_an_enemy_moves_its_numbers() {
    let family = proved(STEADY, BOX);
    let pace = family.pace.clone().expect("a pace");
    assert!(pace.crosses_in_s <= 20.0, "{}", pace.crosses_in_s);
    let whole = certificate(&STEADY.description(), &family);
    whole.check().expect("it holds");
    // Within a sample numbers move further at a faster pace, which one form for all of them does not bear either.
    let faster = |it: &mut Family| it.pace.as_mut().expect("a pace").crosses_in_s *= 1e-3;
    refused(&whole, &faster, "of the family");
    let fspid_proof::Claim::CommonQuadratic { form, .. } = &pace.patches[0].claim else {
        panic!("one form")
    };
    let identity = Matrix::identity(form.rows());
    let worst = |by: &Matrix, loops: &[Matrix; 4], z: &[f64]| {
        let after = |corner: &usize| {
            let mut next = vec![0.0; z.len()];
            loops[*corner].apply(z, &mut next).expect("of one size");
            length(by, &next)
        };
        (0..4).max_by(|one, other| after(one).total_cmp(&after(other))).expect("four")
    };
    let enemies: [&mut Enemy<'_>; 4] = [
        &mut |_, loops, z| worst(form, loops, z),
        &mut |_, loops, z| worst(&identity, loops, z),
        &mut |sample, _, _| usize::from(share(u32::try_from(sample / 7).expect("few")) > 0.5) * 3,
        &mut |sample, _, _| (sample / 40) % 4,
    ];
    for (which, enemy) in enemies.into_iter().enumerate() {
        let left = left(STEADY, BOX, pace.crosses_in_s, enemy);
        assert!(left < 1e-3, "enemy {which} leaves {left}");
    }
}

#[test]
fn a_pace_at_which_an_enemy_makes_the_loop_grow_is_not_claimed_although_every_member_is_stable() {
    let swinging = Aircraft {
        damping: -0.1,
        lift: -0.15,
        effect: 1.0,
        gains: Gains { kp: 0.3, ki: 0.03, kd: 0.0 },
        ..STEADY
    };
    let ends = [[-6.0, -2.0], [0.05, 0.05]];
    // Stiff on the way back, soft on the way out: once a half period each.
    let mut pumps = |_: usize, _: &[Matrix; 4], z: &[f64]| usize::from(z[1] * z[2] > 0.0);
    let fast_s = 0.2;
    let grown = left(swinging, ends, fast_s, &mut pumps);
    assert!(grown > 1e3, "{grown}");
    let family = proved(swinging, ends);
    if let Some(pace) = &family.pace {
        assert!(pace.crosses_in_s > 10.0 * fast_s, "{}", pace.crosses_in_s);
        let slow = left(swinging, ends, pace.crosses_in_s, &mut pumps);
        assert!(slow < 1.0, "{slow}");
    }
}

/// A plant whose elevator has from a tenth to twice its effect, which takes several forms.
fn of_effects() -> (LoopDescription, Family) {
    let mut description = STEADY.description();
    (description.numerator, description.denominator) =
        (vec![1.151, 0.1774], vec![1.0, 0.739, 0.921, 0.0]);
    let paths = vec!["plant.numerator[0]".to_owned(), "plant.numerator[1]".to_owned()];
    let parameter = Parameter {
        name: "effect".to_owned(),
        paths,
        relative: true,
        inverse: false,
        sensors: Vec::new(),
        ends: [0.1, 2.0],
    };
    let makes = |at: &[Sloped]| {
        let point = |value: f64| Sloped::fixed(Interval::point(value));
        let numerator = [1.151, 0.1774].map(|it| point(it) * at[0]);
        let denominator = [1.0, 0.739, 0.921, 0.0].map(point);
        let how = (ElevatorSign::NoseUpPositive, LagOf::First(point(10.0)));
        let may_vanish = |it: &Sloped| it.value.contains(0.0);
        let plant = ContinuousPlant::in_normal_form(&numerator, &denominator, how, may_vanish);
        Ok(plant.expect("an elevator with an effect"))
    };
    let found = prove_family(&description, &[parameter], &Effort::default(), &makes);
    match found.expect("provable") {
        FamilyVerdict::Proved(family) => (description, family),
        other => panic!("{other:?}"),
    }
}

/// Asserts that a certificate whose family is changed so is refused, with a word.
fn refused(whole: &Certificate, change: &dyn Fn(&mut Family), word: &str) {
    let mut other = whole.clone();
    change(other.family.as_mut().expect("a family"));
    let refused = other.check().expect_err(word).to_string();
    assert!(refused.contains(word), "{refused}");
}

#[test]
fn what_is_claimed_of_numbers_that_move_is_believed_only_as_it_was_proved() {
    let (description, family) = of_effects();
    let pace = family.pace.clone().expect("a pace");
    assert!(pace.patches.len() > 1 && pace.crosses_in_s > 0.0, "{pace:?}");
    let whole = certificate(&description, &family);
    whole.check().expect("it holds");
    let with = |change: &dyn Fn(&mut fspid_proof::Pace), word: &str| {
        refused(&whole, &|it| change(it.pace.as_mut().expect("a pace")), word);
    };
    with(&|it| it.crosses_in_s *= 0.01, "too fast");
    with(&|it| it.crosses_in_s = 0.0, "too fast");
    with(&|it| it.crosses_in_s = f64::NAN, "not allowed");
    with(&|it| it.crosses_in_s = f64::INFINITY, "not allowed");
    with(&|it| it.crosses_in_s = -1.0, "not allowed");
    with(&|it| it.overlap = -0.1, "not allowed");
    with(&|it| it.overlap = 1.5, "not allowed");
    for ends in [[0.5, 0.4], [f64::NEG_INFINITY, 1.0], [0.5, f64::INFINITY], [f64::NAN, 1.0]] {
        with(&|it| it.patches[0].ends[0] = ends, "not in order");
    }
    with(&|it| it.overlap *= 3.0, "overlap too little");
    with(&|it| it.overlap = 0.0, "too fast");
    with(&|it| drop(it.patches.pop()), "overlap too little");
    with(&|it| it.patches.clear(), "1 to 64 patches");
    with(&|it| it.patches[0].ends[0] = [0.0, 9.0], "not covered by parts with its form");
    with(&|it| it.patches[0].ends.clear(), "other parameters");
    let swapped = |it: &mut fspid_proof::Pace| {
        let [first, second] = [it.patches[0].claim.clone(), it.patches[1].claim.clone()];
        (it.patches[0].claim, it.patches[1].claim) = (second, first);
    };
    with(&swapped, "not covered by parts with its form");
}

#[test]
fn plants_whose_numbers_move_are_believed_only_as_those_of_one_function_of_them() {
    let (description, family) = of_effects();
    let whole = certificate(&description, &family);
    let refused = |change: &dyn Fn(&mut Family), word: &str| refused(&whole, change, word);
    // Numbers whose motion means nothing without states.
    for path in ["plant.denominator[1]", "plant.numerator[1]"] {
        refused(
            &|it| it.parameters[0].paths = vec![path.to_owned()],
            "what the states of the plant",
        );
    }
    refused(&|it| it.parameters[0].paths.clear(), "what the states of the plant");
    refused(&|it| it.parameters[0].relative = false, "what the states of the plant");
    // Plants that are those of no one function of their numbers.
    let elsewhere = |it: &mut Family| {
        let plants = &mut it.parts[0].plants;
        for rows in [&mut plants.middle, &mut plants.all] {
            rows[0][0] = rows[0][0] - Interval::point(1e-3);
        }
    };
    refused(&elsewhere, "jump from part to part");
    refused(&|it| it.parts[0].plants.without_lag = true, "not told as those of one function");
    let beside = |it: &mut Family| it.parts[0].plants.middle[0][0] = Interval::point(3.0);
    refused(&beside, "not told as those of one function");
    // Plants that differ more from each other than is known here: what they are off within a sample is larger.
    let steeper = |it: &mut Family| {
        let steep = Interval::between(-1e9, 1e9);
        it.parts.iter_mut().for_each(|part| part.plants.slopes[0][1][2] = steep);
    };
    refused(&steeper, "of the family");
}

#[test]
fn numbers_whose_motion_means_nothing_or_means_other_states_stand_still() {
    let description = STEADY.description();
    let number = |paths: &[&str], ends: [f64; 2], sensors: &[ScaledSensor]| Parameter {
        name: "number".to_owned(),
        paths: paths.iter().map(|&it| it.to_owned()).collect(),
        relative: true,
        inverse: false,
        sensors: sensors.to_vec(),
        ends,
    };
    let may_move = |paths: &[&str], ends: [f64; 2]| number(paths, ends, &[]).may_move(&description);
    let all = ["plant.numerator[0]", "plant.numerator[1]"];
    let ends = [0.5, 2.0];
    assert!(may_move(&all, ends) && may_move(&all, [-2.0, -0.5]));
    assert!(may_move(&["plant.preset.numerator[0]", "plant.preset.numerator[1]"], ends));
    assert!(!may_move(&all[..1], ends));
    // Where the elevator has no effect, states are those of another form.
    assert!(!may_move(&all, [-0.2, 1.0]) && !may_move(&all, [0.0, 1.0]));
    assert!(!may_move(&all, [-1.0, 0.0]));
    assert!(!may_move(&["plant.denominator[1]"], ends) && !may_move(&[], ends));
    assert!(may_move(&["aircraft.mass_kg"], ends) && may_move(&["actuator.damping"], ends));
    assert!(!may_move(&["actuator.damping", "plant.denominator[1]"], ends));
    // The only coefficient of a numerator is a factor on it, however it is drawn.
    let absolute = |description: &LoopDescription| {
        let drawn = Parameter { relative: false, ..number(&all[..1], ends, &[]) };
        drawn.may_move(description)
    };
    let alone = LoopDescription { numerator: vec![2.0], ..description.clone() };
    assert!(absolute(&alone) && !absolute(&description));
    let [pitch, rate] = [ScaledSensor::Pitch, ScaledSensor::Rate];
    assert!(number(&[], ends, &[pitch]).may_move(&description));
    assert!(!number(&[], ends, &[pitch, rate]).may_move(&description));
}

#[test]
fn forms_that_go_over_into_each_other_do_so_after_the_samples_that_the_pace_leaves() {
    let (_, family) = of_effects();
    let pace = family.pace.expect("a pace");
    let dt_s = DT_S;
    let samples = libm::floor(pace.overlap * pace.crosses_in_s / dt_s);
    let parts = |it: &Patch| match &it.claim {
        fspid_proof::Claim::CommonQuadratic { form, rate } => (form.clone(), *rate),
        other => panic!("{other:?}"),
    };
    // At many states the next form, fallen, is below the one before.
    for (before, next) in
        pace.patches.iter().flat_map(|it| pace.patches.iter().map(move |other| (it, other)))
    {
        let touch = before.ends[0][0] <= next.ends[0][1] && next.ends[0][0] <= before.ends[0][1];
        let ((below, _), (form, rate)) = (parts(before), parts(next));
        if !touch || below == form {
            continue;
        }
        for number in 0..200 {
            let z: Vec<f64> = (0..form.rows())
                .map(|place| share(13 * number + 5 * u32::try_from(place).expect("few")) - 0.5)
                .collect();
            let fallen = libm::pow(rate, 2.0 * samples) * length(&form, &z);
            assert!(fallen < length(&below, &z), "{number}");
        }
    }
}
