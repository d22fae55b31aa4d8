//! Flying qualities of the paper's aircraft against numbers computed independently.

use fspid_aircraft::modes::{AircraftMode, ModeName};
use fspid_aircraft::qualities::{
    Absent, Bandwidth, BandwidthLimit, Category, Class, CommandPath, Confidence, Dropback,
    EquivalentDelay, Level, Phugoid, PitchModel, Qualities, REQUIREMENTS, bandwidth_level, c_star,
    cap_level, lateral_level,
};
use fspid_lti::{Complex, TransferFunction, step_response};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const FOOT_M: f64 = 0.3048;

/// Gravity with which the handbook makes load factors.
const GRAVITY_M_S2: f64 = 32.2 * FOOT_M;

fn model(numerator: &[f64], denominator: &[f64], airspeed_ft_s: f64) -> PitchModel {
    let plant = TransferFunction::new(numerator, denominator).expect("a plant");
    PitchModel::new(plant, airspeed_ft_s * FOOT_M, GRAVITY_M_S2).expect("a flight condition")
}

/// With the paper's sign: a positive elevator lowers the nose.
fn b747() -> PitchModel {
    model(&[-1.69144, -0.84341, -0.0099096], &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771], 673.0)
}

fn navion() -> PitchModel {
    model(&[11.7304, 22.578], &[1.0, 4.9676, 12.941, 0.0], 176.0)
}

fn servo(delay_s: f64) -> CommandPath {
    let servo = TransferFunction::new(&[10.0], &[1.0, 10.0]).expect("a servo");
    CommandPath { servo: Some(servo), delay_s }
}

fn assert_digits(found: f64, printed: f64, digits: i32) {
    let half_digit = 0.51 * libm::pow(10.0, -f64::from(digits));
    assert!((found - printed).abs() < half_digit, "{found} is not {printed}");
}

#[test]
fn load_and_control_anticipation_are_those_of_the_handbook() {
    for (model, load, cap) in [(navion(), 10.520, 1.2301), (b747(), 10.170, 0.1518)] {
        let found = Qualities::of(&model, Category::B).short_period.expect("a stable pair");
        assert_digits(found.load_per_alpha_g_rad, load, 3);
        assert_digits(found.cap, cap, 4);
    }
}

#[test]
fn the_navion_is_level_1_in_every_category() {
    for category in Category::ALL {
        let qualities = Qualities::of(&navion(), category);
        let found = qualities.short_period.expect("a stable pair");
        let damping = qualities.short_period_damping.expect("a stable pair");
        let levels = [found.cap_level, damping, found.frequency_level];
        assert!(levels.iter().all(|judged| judged.level == Level::One), "{levels:?}");
    }
}

#[test]
fn the_747_is_level_1_in_cruise_and_slower_than_other_phases_want() {
    let judged = |category| Qualities::of(&b747(), category).short_period.expect("a stable pair");
    assert_digits(judged(Category::B).mode.damping_ratio, 0.469, 3);
    assert_eq!(judged(Category::B).cap_level.level, Level::One);
    assert_eq!(judged(Category::C).cap_level.level, Level::Two);
    // 0.1518 is below the 0.16 of level 2: the box of level 3 asks for damping alone, while the older standard's
    // figure draws one lower line for levels 2 and 3.
    assert_eq!(judged(Category::A).cap_level.level, Level::Three);
    assert_eq!(judged(Category::A).frequency_level.level, Level::Worse);
    let damping = Qualities::of(&b747(), Category::A).short_period_damping;
    assert_eq!(damping.map(|it| it.level), Ok(Level::One));
}

#[test]
fn the_phugoid_of_the_747_is_level_2() {
    let Ok(Phugoid::Oscillation { mode, level, .. }) = Phugoid::of(&b747()) else {
        panic!("a pair")
    };
    assert_digits(mode.damping_ratio, 0.033, 3);
    assert_eq!(level.level, Level::Two);
    assert_eq!(Phugoid::of(&navion()), Err(Absent::NoPhugoid));
}

/// Three decimals of a frequency: the handbook's are those of a grid below it.
fn assert_cut_or_rounded(found: f64, printed: f64) {
    assert!((-5e-4..1e-3).contains(&(found - printed)), "{found} is not {printed}");
}

/// By halving an interval in double precision, in another language.
#[test]
fn frequencies_and_delays_have_all_the_digits_of_another_computation() {
    let computed = [
        (b747(), 0.0, [2.928982174417296, 0.06973415815913607]),
        (b747(), 0.05, [2.4716611865609557, 0.11311210575771431]),
        (navion(), 0.0, [6.326966252461278, 0.05131420938223557]),
        (navion(), 0.05, [5.123384777518588, 0.09666414620082174]),
    ];
    for (model, delay_s, [neutral_rad_s, phase_delay_s]) in computed {
        let found = Bandwidth::of(&model.behind(servo(delay_s)), Category::B).expect("a limit");
        assert!((found.neutral_rad_s - neutral_rad_s).abs() < 1e-13, "{found:?}");
        assert!((found.phase_delay_s - phase_delay_s).abs() < 1e-14, "{found:?}");
    }
}

#[test]
fn bandwidth_and_phase_delay_are_those_of_the_handbook() {
    let printed = [
        (b747(), 0.0, [2.928, 1.445, 0.0697]),
        (b747(), 0.05, [2.471, 1.390, 0.1131]),
        (navion(), 0.0, [6.327, 3.462, 0.0513]),
        (navion(), 0.05, [5.123, 3.071, 0.0967]),
    ];
    for (model, delay_s, [neutral_rad_s, bandwidth_rad_s, phase_delay_s]) in printed {
        let found = Bandwidth::of(&model.behind(servo(delay_s)), Category::B).expect("a limit");
        assert_cut_or_rounded(found.neutral_rad_s, neutral_rad_s);
        assert_cut_or_rounded(found.bandwidth_rad_s, bandwidth_rad_s);
        assert_digits(found.phase_delay_s, phase_delay_s, 4);
        assert_eq!(found.limit, BandwidthLimit::Phase);
        assert_eq!(found.level, Err(Absent::NoChart(Category::B)));
    }
}

#[test]
fn an_attitude_without_servo_can_be_followed_at_any_frequency() {
    assert_eq!(Bandwidth::of(&navion(), Category::A), Err(Absent::NoPhaseLimit));
}

#[test]
fn a_slow_unstable_phugoid_does_not_change_the_bandwidth_much() {
    let denominator = [1.0, 1.166, 1.549, 0.0, 0.0072771];
    let unstable = model(&[-1.69144, -0.84341, -0.0099096], &denominator, 673.0);
    let found = Bandwidth::of(&unstable.behind(servo(0.0)), Category::A).expect("a limit");
    assert!((found.bandwidth_rad_s - 1.445).abs() < 0.02, "{found:?}");
    assert_eq!(found.level.expect("a chart").level, Level::Two);
}

#[test]
fn the_servo_of_the_paper_costs_a_tenth_of_a_second() {
    let found = EquivalentDelay::of(&b747().behind(servo(0.0))).expect("a short period");
    assert!((found.delay_s - 0.0995).abs() < 5e-5, "{found:?}");
    assert_eq!(found.level.level, Level::One);
    let later = EquivalentDelay::of(&b747().behind(servo(0.05))).expect("a short period");
    assert_eq!(later.level.level, Level::Two);
    assert_eq!(EquivalentDelay::new(0.2501).level.level, Level::Worse);
}

/// Pitch rate of the short period after a step, normalised, at every millisecond.
fn pitch_rate(model: &PitchModel) -> Vec<f64> {
    let found = Qualities::of(model, Category::B).short_period.expect("a stable pair");
    let (omega, damping) = (found.mode.natural_frequency_rad_s, found.mode.damping_ratio);
    let square = omega * omega;
    let numerator = [square * found.lift_lag_s, square];
    let rate = TransferFunction::new(&numerator, &[1.0, 2.0 * damping * omega, square]);
    step_response(&rate.expect("a pair"), 1e-3, 40_001).expect("a response")
}

#[test]
fn dropback_and_overshoot_are_what_a_step_shows() {
    for model in [b747(), navion()] {
        let found = Dropback::of(&model).expect("a pair");
        let rate = pitch_rate(&model);
        let highest = rate.iter().copied().fold(0.0, f64::max);
        assert!((highest - found.pitch_rate_overshoot).abs() < 1e-5, "{highest} {found:?}");
        // What the attitude is ahead of a ramp in the end.
        let ahead =
            rate.windows(2).fold(0.0, |sum, pair| sum + 1e-3 * (0.5 * (pair[0] + pair[1]) - 1.0));
        assert!((ahead - found.dropback_s).abs() < 1e-5, "{ahead} {found:?}");
    }
}

#[test]
fn c_star_is_load_factor_and_pitch_rate_together() {
    let model = navion();
    let response = c_star(&model, 2.0).expect("a stable pair");
    assert!((response.dc_gain().expect("no integrator") - 1.0).abs() < 1e-14);
    let rate = pitch_rate(&model);
    let found = step_response(&response, 1e-3, 40_001).expect("a response");
    // A pitch rate of V/g + Vco/g in the end: the load at the centre of gravity lags the rate by the lift.
    let (speed, lag_s) = (model.airspeed_m_s, 1.0 / model.lift_zero_rad_s().expect("a zero"));
    let mut path_rate = 0.0;
    for index in 0..40_000 {
        let (now, next) = (rate[index], rate[index + 1]);
        let at_pilot = speed * path_rate + 2.0 * (next - now) / 1e-3 + 121.92 * 0.5 * (now + next);
        let expected = at_pilot / (speed + 121.92);
        let middle = 0.5 * (found[index] + found[index + 1]);
        assert!((middle - expected).abs() < 2e-2, "{index}: {middle} {expected}");
        path_rate += 1e-3 * (0.5 * (now + next) - path_rate) / lag_s;
    }
}

#[test]
fn motions_that_are_no_modes_say_why() {
    let third = model(&[-1.0, -0.5], &[1.0, 1.85, 0.655, 0.1775, -0.00975], 300.0);
    let qualities = Qualities::of(&third, Category::B);
    assert_eq!(qualities.short_period, Err(Absent::ThirdOscillation));
    assert_eq!(qualities.phugoid, Err(Absent::ThirdOscillation));
    let diverging = model(&[-1.0, -0.5], &[1.0, 1.0, -0.75, 0.0], 300.0);
    let reason = Qualities::of(&diverging, Category::B).short_period.expect_err("it diverges");
    assert!(
        matches!(reason, Absent::ShortPeriodDiverges { doubles_s, .. } if (doubles_s - 1.386).abs() < 1e-3)
    );
    assert!(reason.to_string().contains("0.5 rad/s"), "{reason}");
    let no_zero = model(&[-1.0], &[1.0, 1.0, 4.0, 0.0], 300.0);
    assert_eq!(Qualities::of(&no_zero, Category::B).short_period, Err(Absent::NoLiftZero));
    let small = model(&[-1.0], &[1.0, 1.0], 300.0);
    assert_eq!(Phugoid::of(&small), Err(Absent::OtherModel { found: 1 }));
}

/// Level 1 in every row of an aircraft whose short period doubles in a third of a second.
#[test]
fn a_short_period_that_swings_and_grows_is_worse_than_all_levels() {
    // A pair of damping -0.1 at 3 rad/s, with a phugoid of 0.1 rad/s, and alone.
    let (pair, slow) = ([1.0, -0.6, 9.0], [1.0, 0.02, 0.01]);
    let mut both = [0.0; 5];
    for (i, one) in pair.iter().enumerate() {
        for (j, other) in slow.iter().enumerate() {
            both[i + j] += one * other;
        }
    }
    for denominator in [&both[..], &[1.0, -0.6, 9.0, 0.0]] {
        let qualities = Qualities::of(&model(&[-1.0, -0.5], denominator, 300.0), Category::B);
        let worst = qualities.worst().expect("judged");
        assert_eq!((worst.requirement.title, worst.level), ("short-period damping", Level::Worse));
        assert!((worst.value + 0.1).abs() < 1e-9, "{worst:?}");
        assert!(qualities.short_period.is_err());
    }
}

/// Damping asks for no load: without a zero of the lift nothing of the short period was judged.
#[test]
fn damping_is_judged_without_a_zero_of_the_lift() {
    let poles = [1.0, 0.06, 9.0, 0.0];
    let judged = |numerator: &[f64]| Qualities::of(&model(numerator, &poles, 300.0), Category::B);
    let damping = |qualities: &Qualities| {
        let all: Vec<_> = qualities.judgements().collect();
        let own = all.iter().filter(|it| it.requirement.title == "short-period damping");
        own.map(|it| (it.value, it.level)).collect::<Vec<_>>()
    };
    let without = judged(&[-1.0, -3.8, -5.1]);
    assert_eq!(without.short_period, Err(Absent::NoLiftZero));
    assert_eq!(damping(&without), damping(&judged(&[-1.0, -0.5])));
    assert_eq!(damping(&without).iter().map(|it| it.1).collect::<Vec<_>>(), [Level::Worse]);
}

/// Nothing was said of one that short period and phugoid share, and only a reason without a level of a fast one.
#[test]
fn a_divergence_is_judged_whichever_half_of_the_motion_it_belongs_to() {
    // (s + 1.5) (s - 0.25) (s² + 0.4 s + 0.13)
    let shared = model(&[-1.0, -0.5], &[1.0, 1.65, 0.255, 0.0125, -0.04875], 300.0);
    let fast = model(&[-1.0, -0.5], &[1.0, 1.0, -0.75, 0.0], 300.0);
    // (s + 2) (s - 0.5) (s² + 0.02 s + 0.01)
    let with_phugoid = model(&[-1.0, -0.5], &[1.0, 1.52, -0.96, -0.005, -0.01], 300.0);
    // (s² + 1.2 s + 1.5) (s + 0.1) (s - 0.05): a slow one, told once.
    let slow = model(&[-1.0, -0.5], &[1.0, 1.25, 1.555, 0.069, -0.0075], 300.0);
    for (model, real_rad_s, level) in [
        (shared, 0.25, Level::Worse),
        (fast, 0.5, Level::Worse),
        (with_phugoid, 0.5, Level::Worse),
        (slow, 0.05, Level::Three),
    ] {
        let qualities = Qualities::of(&model, Category::B);
        let found = qualities.divergence.expect("it diverges");
        assert!((found.real_rad_s - real_rad_s).abs() < 1e-9, "{found:?}");
        assert!((found.doubles_s - core::f64::consts::LN_2 / real_rad_s).abs() < 1e-6);
        let mut told = qualities.judgements();
        let of_speed = told.find(|level| level.requirement.title == "speed stability");
        assert_eq!(of_speed.map(|it| it.level), Some(level), "{real_rad_s}");
        assert!(told.all(|level| level.requirement.title != "speed stability"), "told twice");
    }
    assert_eq!(Qualities::of(&b747(), Category::B).divergence, None);
    assert_eq!(Qualities::of(&navion(), Category::B).divergence, None);
}

#[test]
fn two_real_fast_poles_are_a_short_period_of_high_damping() {
    let heavy = model(&[1.0, 0.8], &[1.0, 5.0, 4.0, 0.0], 300.0);
    let found = Qualities::of(&heavy, Category::B).short_period.expect("stable");
    assert_digits(found.mode.natural_frequency_rad_s, 2.0, 12);
    assert_digits(found.mode.damping_ratio, 1.25, 12);
    assert_eq!(Dropback::of(&heavy), Err(Absent::ShortPeriodDoesNotSwing));
}

/// A pair with a damping of 0.107 was left out, and the real pole had a damping of 1.
#[test]
fn a_pair_that_is_slower_than_the_real_pole_is_no_integral_to_leave_out() {
    let slow = model(&[1.0, 1.0], &[1.0, 6.002, 2.012, 5.0], 300.0);
    assert_eq!(Qualities::of(&slow, Category::B).short_period, Err(Absent::SlowPair));
    // A pair beside a slow real pole is the short period.
    let usual = model(&[1.0, 1.0], &[1.0, 2.01, 4.02, 0.04], 300.0);
    let found = Qualities::of(&usual, Category::B).short_period.expect("a pair");
    assert!((found.mode.natural_frequency_rad_s - 2.0).abs() < 0.02, "{found:?}");
}

#[test]
fn a_phugoid_that_grows_slowly_enough_is_level_3() {
    let with_phugoid = |re: f64, im: f64| {
        let slow =
            TransferFunction::new(&[1.0], &[1.0, -2.0 * re, re * re + im * im]).expect("a pair");
        let fast = TransferFunction::new(&[-1.0, -0.5], &[1.0, 1.2, 1.5]).expect("a pair");
        let plant = fast.series(&slow).expect("small");
        let (numerator, denominator) =
            (plant.numerator().coefficients(), plant.denominator().coefficients());
        Phugoid::of(&model(numerator, denominator, 300.0)).expect("a phugoid").level().level
    };
    assert_eq!(with_phugoid(-0.01, 0.1), Level::One);
    assert_eq!(with_phugoid(-0.001, 0.1), Level::Two);
    assert_eq!(with_phugoid(0.0126, 0.1), Level::Three);
    assert_eq!(with_phugoid(0.0127, 0.1), Level::Worse);
}

#[test]
fn lateral_modes_are_judged_by_class_and_category() {
    let judged = |name, pole, class, category| {
        lateral_level(&AircraftMode { name, pole }, class, category).map(|found| found.level)
    };
    let roll = Complex::new(-1.0 / 1.2, 0.0);
    assert_eq!(judged(ModeName::Roll, roll, Class::III, Category::C), Ok(Level::One));
    assert_eq!(judged(ModeName::Roll, roll, Class::I, Category::C), Ok(Level::Two));
    assert_eq!(judged(ModeName::Roll, -roll, Class::I, Category::C), Ok(Level::Worse));
    let swing = Complex::new(-0.12, 0.9);
    assert_eq!(judged(ModeName::DutchRoll, swing, Class::III, Category::C), Ok(Level::One));
    assert_eq!(judged(ModeName::DutchRoll, swing, Class::IV, Category::C), Ok(Level::Two));
    let spiral = Complex::new(core::f64::consts::LN_2 / 15.0, 0.0);
    assert_eq!(judged(ModeName::Spiral, spiral, Class::I, Category::B), Ok(Level::Two));
    assert_eq!(judged(ModeName::Spiral, spiral, Class::I, Category::A), Ok(Level::One));
    let coupled = judged(ModeName::RollSpiral, swing, Class::I, Category::A);
    assert_eq!(coupled, Ok(Level::Worse), "not allowed at all");
}

#[test]
fn every_requirement_names_its_clause_and_doubts_are_explained() {
    for requirement in REQUIREMENTS {
        assert!(requirement.clause.starts_with("MIL-"), "{requirement:?}");
        let doubted = requirement.confidence != Confidence::Transcribed;
        assert!(!doubted || requirement.note.len() > 20, "{requirement:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn more_damping_below_one_never_makes_a_level_worse(
        damping in 0.0..1.0_f64, more in 0.0..0.3_f64, cap in 0.01..12.0_f64,
    ) {
        for category in Category::ALL {
            let better = cap_level((damping + more).min(1.3), cap, category);
            prop_assert!(better <= cap_level(damping, cap, category));
        }
    }

    #[test]
    fn less_delay_or_more_bandwidth_never_makes_a_level_worse(
        bandwidth in 0.0..12.0_f64, more in 0.0..3.0_f64, delay in 0.0..0.3_f64, less in 0.0..0.1_f64,
    ) {
        let level = bandwidth_level(bandwidth, delay);
        prop_assert!(bandwidth_level(bandwidth + more, delay) <= level);
        prop_assert!(bandwidth_level(bandwidth, delay - less) <= level);
        prop_assert!(EquivalentDelay::new(delay - less).level.level <= EquivalentDelay::new(delay).level.level);
    }

    #[test]
    fn qualities_do_not_depend_on_the_sign_of_the_elevator_and_are_numbers(
        numerator in proptest::array::uniform2(0.01..30.0_f64),
        denominator in proptest::array::uniform4(-3.0..30.0_f64),
        delay_s in 0.0..0.3_f64,
    ) {
        let [a, b, c, d] = denominator;
        let [up, down] = [1.0, -1.0].map(|sign: f64| {
            let numerator = [sign * numerator[0], sign * numerator[1], sign * 0.01];
            let model = model(&numerator, &[1.0, a, b, c, d], 300.0).behind(servo(delay_s));
            Qualities::of(&model, Category::A)
        });
        prop_assert_eq!(up, down);
        prop_assert!(up.judgements().all(|judged| judged.value.is_finite()));
        if let Ok(found) = up.bandwidth {
            prop_assert!(found.bandwidth_rad_s > 0.0 && found.phase_delay_s.is_finite());
        }
    }
}
