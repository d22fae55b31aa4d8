//! The nonlinear Navion, flown by its own equations through samples and through whole flights.

use fspid_aircraft::Range as Known;
use fspid_aircraft::aerodynamics::derivatives::{Longitudinal, LongitudinalCoefficient};
use fspid_aircraft::data::Laws;
use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{
    Derivative, Fspid, InputScale, InputSets, Law, Pid, PidConfig, ReferenceModel, Sample,
    SecondInput, SelfTuner, SetCentres, State, TunerSettings,
};
use fspid_fuzzy::NumberTable;
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::loop_model::Sensing;
use fspid_sim::{Controller, ElevatorSign};

use super::*;
use crate::prove::{Effort, Verdict, certify};
use crate::scope::Asked;

const LAG_S: f64 = 0.1;
const GAINS: Gains<f64> = Gains { kp: 0.82, ki: 0.43, kd: 0.165 };
/// Steps of an integration within a sample: the error of fourth order is then below that of rounding.
const STEPS: u32 = 20;

/// Nelson's Navion at 176 ft/s and sea level, in SI.
fn navion() -> MotionNumbers {
    let row = |reference, alpha, alpha_rate, pitch_rate, elevator| LongitudinalCoefficient {
        reference,
        alpha,
        alpha_rate,
        pitch_rate,
        speed: 0.0,
        elevator,
    };
    MotionNumbers {
        mass_kg: 1247.0,
        iy_kg_m2: 4067.0,
        aft_chords: 0.0,
        airspeed_m_s: 53.64,
        flight_path_rad: 0.0,
        density_kg_m3: 1.2256,
        height_m: 0.0,
        densities_kg_m3: Known { min: 1.2256, max: 1.2256 },
        gravity_m_s2: 9.815,
        area_m2: 17.09,
        chord_m: 1.737,
        reference_airspeed_m_s: 53.64,
        longitudinal: Longitudinal {
            lift: row(0.406, 4.44, 0.0, 3.8, 0.355),
            drag: row(0.05, 0.33, 0.0, 0.0, 0.0),
            pitch: row(0.0, -0.683, -4.36, -9.96, -0.923),
            thrust_speed: 0.0,
        },
        laws: Laws::default(),
        alpha_rad: Known { min: -0.14, max: 0.17 },
        airspeeds_m_s: Known { min: 32.0, max: 82.0 },
        elevator_rad: Known { min: -0.43, max: 0.35 },
    }
}

fn config() -> PidConfig<f64> {
    PidConfig { derivative: Derivative { filter_s: 0.05 }, ..PidConfig::sampled_every(0.01) }
}

/// The loop around its linear model; the coefficients are those that the program prints of it.
fn description() -> LoopDescription {
    description_with(Controller::Fixed(Pid::new(GAINS, config()).expect("allowed")))
}

fn description_with(controller: Controller) -> LoopDescription {
    let aircraft = navion();
    let over = aircraft.over([1e-6; MOTION]).expect("a trim");
    let middle = |it: Interval| it.midpoint();
    let a = over.slopes.map(|row| [row[0], row[1], row[2], row[3]].map(middle));
    let b = over.slopes.map(|row| [middle(row[4])]);
    let system = fspid_lti::StateSpace::new(
        Matrix::from_rows(&a).expect("finite"),
        Matrix::from_rows(&b).expect("finite"),
        Matrix::identity(4),
        Matrix::zeros(4, 1),
    );
    let plant = fspid_aircraft::transfer_function(&system.expect("fits"), 0, 0).expect("a plant");
    LoopDescription {
        numerator: plant.numerator().coefficients().to_vec(),
        denominator: plant.denominator().coefficients().to_vec(),
        elevator_sign: ElevatorSign::NoseDownPositive,
        actuator: Actuator::new(Lag::first_order(LAG_S).expect("allowed")),
        pitch: Sensing::DIRECT,
        rate: Sensing::DIRECT,
        controller,
    }
}

/// Numbers in -1..1 that differ.
fn draw(number: u32) -> f64 {
    let golden = 0.618_033_988_749_895 * f64::from(number);
    2.0 * (golden - libm::floor(golden)) - 1.0
}

/// The nonlinear aircraft with its lag: states from the trim, and where they were on the way.
struct Flown {
    aircraft: MotionNumbers,
    centre: [f64; MOTION],
    thrust_n: f64,
    density_kg_m3: f64,
}

impl Flown {
    fn new() -> Self {
        let aircraft = navion();
        let trim = aircraft.trim().expect("a trim");
        let centre = aircraft.at_trim(&trim).map(Interval::midpoint);
        let density_kg_m3 = aircraft.density_kg_m3;
        Self { aircraft, centre, thrust_n: trim.thrust_n.midpoint(), density_kg_m3 }
    }

    /// The same in air of another density.
    fn in_air_of(density_kg_m3: f64) -> Self {
        Self { density_kg_m3, ..Self::new() }
    }

    /// Rates of θ, q, V, α and of the deflection, which is counted as the command is.
    fn rate(&self, state: &[f64; MOTION], command: f64) -> [f64; MOTION] {
        let [theta, q, speed, alpha, deflection] = *state;
        let off = [theta, q, speed, alpha, -deflection];
        let at = core::array::from_fn(|i| self.centre[i] + off[i]);
        let [theta, q, speed, alpha] =
            self.aircraft.rates_in(self.density_kg_m3, self.thrust_n, at);
        [theta, q, speed, alpha, (command - deflection) / LAG_S]
    }

    /// One sample with a held command; `seen` is shown every state on the way.
    fn sample(
        &self,
        mut state: [f64; MOTION],
        command: f64,
        mut seen: impl FnMut(&[f64; MOTION]),
    ) -> [f64; MOTION] {
        let step_s = 0.01 / f64::from(STEPS);
        let moved = |from: &[f64; MOTION], by: &[f64; MOTION], time_s: f64| -> [f64; MOTION] {
            core::array::from_fn(|i| from[i] + time_s * by[i])
        };
        for _ in 0..STEPS {
            seen(&state);
            let k1 = self.rate(&state, command);
            let k2 = self.rate(&moved(&state, &k1, 0.5 * step_s), command);
            let k3 = self.rate(&moved(&state, &k2, 0.5 * step_s), command);
            let k4 = self.rate(&moved(&state, &k3, step_s), command);
            let mean = core::array::from_fn(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0);
            state = moved(&state, &mean, step_s);
        }
        seen(&state);
        state
    }
}

/// Of a flight through one sample the means of what bends are computed: with these, in place of corners, the enclosure
/// is narrow, and the end of the sample has to lie in it.
#[test]
fn samples_flown_by_the_equations_lie_where_the_means_of_what_bends_say() {
    let flown = Flown::new();
    let reach = Reach { motion: [0.12, 0.3, 2.0, 0.07, 0.15], command_rad: 0.2 };
    let transition = Transition::of(&description(), &navion(), &reach).expect("enclosed");
    let below = &transition.corners[0];
    let columns = below.states + 1;
    let mut narrowest = f64::INFINITY;
    for number in 0..200_u32 {
        let share = |which: u32| 0.8 * draw(13 * number + which);
        let state: [f64; MOTION] =
            core::array::from_fn(|i| reach.motion[i] * share(u32::try_from(i).expect("few")));
        let command = reach.command_rad * share(9);
        let (mut sum, mut ends) = ([0.0; MOTION], Vec::new());
        let end = flown.sample(state, command, |at| ends.push(*at));
        for pair in ends.windows(2) {
            for (i, sum) in sum.iter_mut().enumerate() {
                *sum += 0.5 * (pair[0][i] + pair[1][i]) / f64::from(STEPS);
            }
        }
        let from: Vec<f64> = state.into_iter().chain([command]).collect();
        for (row, end) in end.into_iter().enumerate().take(4) {
            let mut found = Interval::ZERO;
            for (column, from) in from.iter().enumerate() {
                let entry = |plant: &fspid_sim::loop_model::SampledPlant<Interval>| {
                    plant.rows[row * columns + column]
                };
                let mut by = entry(below);
                for (side, which) in transition.sides.iter().enumerate() {
                    // The elevator is counted the other way round than the deflection.
                    let sign = if *which == 4 { -1.0 } else { 1.0 };
                    let part = 0.5 * (1.0 + sign * sum[*which] / reach.motion[*which]);
                    let above = entry(&transition.corners[1 << side]);
                    by = by + Interval::point(part * (above.midpoint() - entry(below).midpoint()));
                }
                found = found + by * Interval::point(*from);
            }
            assert!(found.contains(end), "sample {number}, row {row}: {end} not in {found:?}");
            let moved = (end - state[row]).abs();
            if moved > 1e-3 {
                narrowest = narrowest.min(found.width() / moved);
            }
        }
    }
    // And it is no enclosure of everything.
    assert!(narrowest < 0.05, "{narrowest}");
}

fn linear() -> Certificate {
    linear_of(&description())
}

fn linear_of(description: &LoopDescription) -> Certificate {
    let outcome = certify(description, &Asked::rest(), &Effort::default()).expect("provable");
    match outcome.verdict {
        Verdict::Proved(certificate, _) => certificate,
        other => panic!("{other:?}"),
    }
}

/// Why a certificate with another claim than its own is not believed.
fn refused(
    (certificate, claim): (&Certificate, &Nonlinear),
    change: impl Fn(&mut Nonlinear),
) -> String {
    let mut other = claim.clone();
    change(&mut other);
    let whole = Certificate { nonlinear: Some(other), ..certificate.clone() };
    whole.check().expect_err("changed").to_string()
}

/// $z^T P z$.
fn value(form: &Matrix, z: &[f64]) -> f64 {
    let places = (0..z.len()).flat_map(|i| (0..z.len()).map(move |j| (i, j)));
    places.map(|(i, j)| z[i] * form.get(i, j).expect("fits") * z[j]).sum()
}

/// Loops of the controller around the flown plant: rows of the loop's matrix but for the plant's own.
fn fly(
    (claim, flown): (&Nonlinear, &Flown),
    start: &[f64],
    samples: usize,
    mut seen: impl FnMut(&[f64; MOTION]),
) -> Vec<f64> {
    let model = description().enclosed().expect("a model").midpoint();
    let (matrix, arriving) = (model.closed(GAINS), model.arriving_row(GAINS));
    let along = |row: &Vec<f64>, z: &[f64]| row.iter().zip(z).map(|(r, z)| r * z).sum::<f64>();
    let mut z = start.to_vec();
    for _ in 0..samples {
        let command = along(&arriving, &z);
        assert!(command.abs() <= claim.reach.command_rad);
        let state = core::array::from_fn(|i| z[i]);
        let next = flown.sample(state, command, &mut seen);
        let memory: Vec<f64> = matrix[MOTION..].iter().map(|row| along(row, &z)).collect();
        z = next.into_iter().chain(memory).collect();
    }
    z
}

#[test]
fn flights_that_begin_at_the_edge_of_the_ellipsoid_stay_in_the_box_and_come_to_rest() {
    let linear = linear();
    let verdict = prove_nonlinear(&linear, &navion(), &Effort::default()).expect("provable");
    let NonlinearVerdict::Proved(claim, checked) = verdict else { panic!("{verdict:?}") };
    assert!(checked.pitch_within_rad > 2.0_f64.to_radians(), "{checked:?}");
    let whole = |claim: Nonlinear| Certificate { nonlinear: Some(claim), ..linear.clone() };
    let again = whole((*claim).clone()).check().expect("it holds").nonlinear;
    assert_eq!(again, Some(checked));

    // Directions that fill the sphere, scaled to the edge.
    let size = claim.form.rows();
    let value = |z: &[f64]| value(&claim.form, z);
    let spread: Vec<f64> = (0..size)
        .map(|i| {
            let mut unit = vec![[0.0]; size];
            unit[i] = [1.0];
            let column = Matrix::from_rows(&unit).expect("finite");
            claim.form.solve(&column).expect("regular").get(i, 0).expect("fits").sqrt()
        })
        .collect();
    for number in 0..16_u32 {
        let mut z: Vec<f64> = (0..size)
            .map(|i| spread[i] * draw(17 * number + 3 * u32::try_from(i).expect("few")))
            .collect();
        if number == 0 {
            z = description().enclosed().expect("a model").midpoint().pitch_off(1.0);
        }
        let scale = (0.999 * claim.level / value(&z)).sqrt();
        z.iter_mut().for_each(|it| *it *= scale);
        let end = fly((&claim, &Flown::new()), &z, 1500, |at| {
            for (at, reach) in at.iter().zip(claim.reach.motion) {
                assert!(at.abs() <= reach, "flight {number}: {at} beyond {reach}");
            }
        });
        // 15 s: a factor of 100 in the form is less than what the slowest mode loses.
        assert!(value(&end) < 0.3 * claim.level, "flight {number}: {}", value(&end));
    }

    let refused = |change: &dyn Fn(&mut Nonlinear)| refused((&linear, &claim), change);
    assert!(refused(&|it| it.level *= 1.3).contains("limit"));
    assert!(refused(&|it| it.reach = it.reach.scaled(3.0)).contains("nonlinear aircraft"));
    assert!(refused(&|it| it.aircraft.elevator_rad.max = -0.1).contains("its travel"));
    assert!(refused(&|it| it.aircraft.longitudinal.pitch.elevator *= 3.0).contains("nonlinear"));
    assert!(refused(&|it| it.reach.command_rad = 1e-4).contains("limit"));
    assert!(refused(&|it| it.rate = 0.9).contains("fall"));
}

/// In air that is denser or thinner all along, as 10 m below and above the trim, flights from the edge of the ellipsoid stay
/// in the box and come to where the certificate says; without the densities in the numbers the claim is another one.
#[test]
fn flights_in_denser_and_in_thinner_air_stay_in_the_box_and_come_near_the_trim() {
    let (linear, sea_level) = (linear(), navion());
    let ends = [0.999, 1.001].map(|share| share * sea_level.density_kg_m3);
    let aircraft = MotionNumbers {
        height_m: 10.0,
        densities_kg_m3: Known { min: ends[0], max: ends[1] },
        ..sea_level
    };
    let verdict = prove_nonlinear(&linear, &aircraft, &Effort::default()).expect("provable");
    let NonlinearVerdict::Proved(claim, checked) = verdict else { panic!("{verdict:?}") };
    assert!(checked.pitch_within_rad > 1.0_f64.to_radians(), "{checked:?}");
    assert!(checked.remains[0] > 0.0 && checked.remains[0] < checked.reached[0], "{checked:?}");
    for (number, density) in (0..6_u32).zip(ends.into_iter().cycle()) {
        let flown = Flown::in_air_of(density);
        let sign = if number % 4 < 2 { 1.0 } else { -1.0 };
        let share = 1.0 - 0.15 * f64::from(number / 4);
        let off = sign * share * 0.999 * checked.pitch_within_rad;
        let start = description().enclosed().expect("a model").midpoint().pitch_off(off);
        let end = fly((&claim, &flown), &start, 12_000, |at| {
            for (at, reach) in at.iter().zip(claim.reach.motion) {
                assert!(at.abs() <= reach, "flight {number}: {at} beyond {reach}");
            }
        });
        // Two minutes: nearly as near as it will come.
        for (place, (at, remains)) in end.iter().zip(checked.remains).enumerate().take(4) {
            assert!(at.abs() <= 1.1 * remains, "flight {number}, {place}: {at} beyond {remains}");
        }
    }
    // Broken on purpose: ten times the change of density takes motions out.
    let wide = Known { min: 0.97 * ends[0], max: 1.03 * ends[1] };
    let broken = MotionNumbers { densities_kg_m3: wide, ..aircraft };
    let whole = Nonlinear { aircraft: broken, ..(*claim).clone() };
    assert!(Certificate { nonlinear: Some(whole), ..linear.clone() }.check().is_err());
    let whole = Nonlinear { aircraft: MotionNumbers { density_kg_m3: 1.1, ..aircraft }, ..*claim };
    let refused = Certificate { nonlinear: Some(whole), ..linear }.check().expect_err("changed");
    assert!(refused.to_string().contains("density of the trim"), "{refused}");
}

/// Rules that conclude numbers: more gain where the error is large, and where it grows.
fn numbers() -> Supervisor<f64> {
    let grid = |by_error: f64, by_second: f64| {
        core::array::from_fn(|row: usize| {
            core::array::from_fn(|column: usize| {
                let [row, column] = [row, column].map(|it| (it as f64 - 3.0) / 3.0);
                (by_error * row.abs() + by_second * row * column).clamp(-1.0, 1.0)
            })
        })
    };
    let grids = [grid(0.9, 0.3), grid(-0.5, 0.5), grid(0.4, -0.4)];
    let table = NumberTable::new(grids).expect("numbers");
    Supervisor::of_numbers(&table, 1.0, OutOfRange::Clamp).expect("allowed")
}

/// The paper's rules, the same for a rise and a fall.
fn labels() -> Supervisor<f64> {
    let (rules, rule) = (fspid_core::paper::rules().mirrored(), Defuzzifier::Exact);
    Supervisor::new(&rules, 1.0, rule, OutOfRange::Clamp).expect("allowed")
}

/// A self-tuner whose gains go far with errors of many degrees, and some way with few.
fn self_tuner(
    (law, size): (Law<f64>, f64),
    second_input: SecondInput<f64>,
    supervisor: Supervisor<f64>,
) -> Fspid<f64> {
    let settings = TunerSettings {
        law,
        second_input,
        input_sets: InputSets { error: SetCentres::new(0.2, 0.7).ok(), change: None },
        input_scale: InputScale { error_per_rad: 2.9, change_per_rad: 1.1 },
        output_scale: Gains { kp: 3.0 * size, ki: 2.5 * size, kd: 1.2 * size },
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(GAINS, supervisor, settings).expect("allowed");
    Fspid::new(tuner, config()).expect("allowed")
}

/// A flight from a reset, by the controller itself; `seen` is shown every state on the way and the gains.
fn fly_reset(
    (fspid, flown): (&Fspid<f64>, &Flown),
    mut motion: [f64; MOTION],
    samples: usize,
    mut seen: impl FnMut(&[f64; MOTION], Gains<f64>),
) -> [f64; MOTION] {
    let mut state = State::new();
    for _ in 0..samples {
        let sample =
            Sample { setpoint_rad: 0.0, measurement_rad: motion[0], rate_rad_s: motion[1] };
        let step = fspid.step(&mut state, sample);
        // The flown deflection is counted as the command is.
        motion = flown.sample(motion, step.command_rad, |at| seen(at, step.gains));
    }
    motion
}

#[test]
fn self_tuners_begin_reset_at_the_edge_of_the_ellipsoid_stay_in_the_box_and_come_to_rest() {
    let leaks = Law::Accumulating { leakage_per_s: 0.5 };
    let model = SecondInput::ModelError(ReferenceModel { bandwidth_rad_s: 2.0, damping: 0.8 });
    let mut drawn = vec![
        (self_tuner((Law::Memoryless, 0.1), SecondInput::Change, numbers()), 2.0_f64),
        (self_tuner((leaks, 0.02), model, numbers()), 2.0),
    ];
    if std::env::var_os("FSPID_LONG_TESTS").is_some() {
        drawn.push((self_tuner((Law::Memoryless, 0.05), SecondInput::Change, labels()), 2.0));
    }
    for (number, (fspid, least_deg)) in drawn.into_iter().enumerate() {
        let description = description_with(Controller::SelfTuning(fspid));
        let linear = linear_of(&description);
        let verdict = prove_nonlinear(&linear, &navion(), &Effort::default()).expect("provable");
        let NonlinearVerdict::Proved(claim, checked) = verdict else { panic!("{verdict:?}") };
        assert_eq!(claim.begun, Begun::Reset);
        assert!(checked.pitch_within_rad > least_deg.to_radians(), "{number}: {checked:?}");
        let whole = Certificate { nonlinear: Some((*claim).clone()), ..linear.clone() };
        assert_eq!(whole.check().expect("it holds").nonlinear, Some(checked));

        let loops = description.enclosed().expect("a model").midpoint();
        let gains = flown_from_the_edge((&fspid, &loops), &claim, &checked);
        // They have gone some part of what is said that they may.
        for (flown, bounds) in gains.iter().zip(checked.gains) {
            assert!(flown.width() > 0.05 * bounds.width(), "{number}: {flown:?} of {bounds:?}");
        }

        let refused = |change: &dyn Fn(&mut Nonlinear)| refused((&linear, &claim), change);
        assert!(refused(&|it| it.level *= 1.3).contains("limit"));
        assert!(refused(&|it| it.reach = it.reach.scaled(3.0)).contains("nonlinear aircraft"));
        // With any gains of the widest set the motion leaves the ellipsoid.
        if number == 0 {
            refused(&|it| it.begun = Begun::Anyhow);
        }
    }
}

/// Flies from the edge of the ellipsoid in directions that fill it: none leaves the box, no gain its bounds, and all come
/// nearer to rest. Which gains there were.
fn flown_from_the_edge(
    (fspid, loops): (&Fspid<f64>, &LoopModel<f64>),
    claim: &Nonlinear,
    checked: &CheckedNonlinear,
) -> [Interval; 3] {
    let value = |motion: [f64; MOTION]| {
        let mut z = loops.pitch_off(motion[0]);
        z[..MOTION].copy_from_slice(&motion);
        value(&claim.form, &z)
    };
    let mut flown = [GAINS.kp, GAINS.ki, GAINS.kd].map(Interval::point);
    for flight in 0..12_u32 {
        let motion: [f64; MOTION] = match flight {
            0 => [1.0, 0.0, 0.0, 0.0, 0.0],
            1 => [-1.0, 0.0, 0.0, 0.0, 0.0],
            _ => core::array::from_fn(|i| {
                checked.reached[i] * draw(17 * flight + 3 * u32::try_from(i).expect("few"))
            }),
        };
        let scale = (0.999 * claim.level / value(motion)).sqrt();
        let motion = motion.map(|it| scale * it);
        let end = fly_reset((fspid, &Flown::new()), motion, 3000, |at, gains| {
            for (at, reach) in at.iter().zip(claim.reach.motion) {
                assert!(at.abs() <= reach, "flight {flight}: {at} beyond {reach}");
            }
            let each = [gains.kp, gains.ki, gains.kd].into_iter().zip(checked.gains);
            for ((gain, bounds), flown) in each.zip(&mut flown) {
                assert!(bounds.contains(gain), "flight {flight}: {gain} not in {bounds:?}");
                *flown = flown.hull(Interval::point(gain));
            }
        });
        // 30 s.
        assert!(value(end) < 0.3 * claim.level, "flight {flight}: {}", value(end));
    }
    flown
}

/// A pitch rate that the supervisor alone sees has no row in the loop: the guard on it was not asked, and a sensor that shows
/// five times the rate would have been taken for one that shows it.
#[test]
fn what_the_supervisor_alone_sees_of_the_pitch_rate_is_refused_where_the_loop_does_not_hold_it() {
    let seeing = |config: PidConfig<f64>| {
        let fspid = self_tuner((Law::Memoryless, 0.05), SecondInput::Rate, numbers());
        let fspid = Fspid::new(*fspid.tuner(), config).expect("allowed");
        description_with(Controller::SelfTuning(fspid))
    };
    let plain = seeing(config());
    assert_eq!(not_covered(&plain), None);
    assert!(linear_of(&plain).level.is_none());
    let scaled = LoopDescription { rate: Sensing { scale: 5.0, ..Sensing::DIRECT }, ..plain };
    assert!(not_covered(&scaled).expect("refused").contains("scale error"));
    let guard = fspid_core::Guard::new(0.1).expect("allowed");
    let guarded = seeing(PidConfig { guard, ..config() });
    assert!(not_covered(&guarded).expect("refused").contains("sample guard"));
    let certificate = linear_of(&guarded);
    assert!(certificate.level.is_none(), "{certificate:?}");
    let level = Some(1e-6);
    let claimed = Certificate { level, ..certificate }.check().expect_err("refused").to_string();
    assert!(claimed.contains("sample guard"), "{claimed}");
}
