//! Every bad setting is refused by its name.

use crate::common;

use common::{NOMINAL, T, supervisor, tuner};
use fspid_core::fuzzy::OutOfRange;
use fspid_core::{
    AntiWindup, ConfigError, ControllerSetting, DeadZone, Derivative, Fspid, GainLimits, Gains,
    Guard, Law, Limits, Pid, PidConfig, SelfTuner, TunerSettings,
};

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// The name an error of a number gives, and the value it found.
fn refused<T>(result: Result<T, ConfigError>) -> (&'static str, u64) {
    match result {
        Err(ConfigError::Number { what, found, .. }) => (what.name(), found.to_bits()),
        Err(other) => panic!("{other}"),
        Ok(_) => ("accepted", 0),
    }
}

/// Sets one field, tries values that are not finite and those given, expects the name each time;
/// and a good value to be accepted.
fn table<S: Copy, B>(
    name: &'static str,
    good: S,
    set: impl Fn(&mut S, f64),
    bad: &[f64],
    fine: &[f64],
    build: impl Fn(S) -> Result<B, ConfigError>,
) {
    for &value in NOT_FINITE.iter().chain(bad) {
        let mut settings = good;
        set(&mut settings, value);
        assert_eq!(refused(build(settings)), (name, value.to_bits()), "{name} {value}");
    }
    for &value in fine {
        let mut settings = good;
        set(&mut settings, value);
        assert!(build(settings).is_ok(), "{name} {value}");
    }
}

#[test]
fn every_bad_gain_is_refused_by_name_in_both_controllers() {
    let config = PidConfig::sampled_every(T);
    type Set = fn(&mut Gains<f64>, f64);
    let sets: [(&str, Set); 3] =
        [("kp", |g, v| g.kp = v), ("ki", |g, v| g.ki = v), ("kd", |g, v| g.kd = v)];
    for (name, set) in sets {
        table(name, NOMINAL, set, &[], &[0.0, -1.0], |gains| Pid::new(gains, config));
        table(name, NOMINAL, set, &[], &[0.0, -1.0], |nominal| {
            SelfTuner::new(nominal, supervisor(OutOfRange::Clamp), TunerSettings::literal())
        });
    }
}

/// A denormal period used to be accepted, and every derivative overflowed. So did a tracking time
/// below the period, which corrects by more than the excess and may grow without bound.
#[test]
fn every_bad_setting_of_the_configuration_is_refused_by_name_in_both_controllers() {
    type Set = fn(&mut PidConfig<f64>, f64);
    /// Name, how to set it, what is refused and what is not.
    type Row = (&'static str, Set, &'static [f64], &'static [f64]);
    let not_positive: &[f64] = &[0.0, -0.0, -1.0, 5e-324];
    let rows: [Row; 8] = [
        ("sample period, s", |s, v| s.dt_s = v, not_positive, &[1e-6, 1.0]),
        ("rate_gain, s", |s, v| s.rate_gain_s = v, &[], &[0.0, -1.0]),
        (
            "command per set-point that is fed forward",
            |s, v| s.feedforward = v,
            &[],
            &[0.0, -1.0, 2.0],
        ),
        (
            "set-point weight of the proportional term",
            |s, v| s.setpoint_weights.proportional = v,
            &[],
            &[0.0, -1.0, 2.0],
        ),
        (
            "set-point weight of the derivative term",
            |s, v| s.setpoint_weights.derivative = v,
            &[],
            &[0.0, -1.0, 2.0],
        ),
        ("derivative filter, s", |s, v| s.derivative.filter_s = v, &[-1e-9], &[0.0, 1.0]),
        (
            "anti-windup tracking time, s",
            |s, v| s.anti_windup = AntiWindup::BackCalculation { tracking_s: v },
            &[0.0, -1.0, 5e-324, 0.999 * T],
            &[T, 1.0],
        ),
        ("slew limit, rad/s", |s, v| s.slew_rad_s = Some(v), not_positive, &[1e-6, 1.0]),
    ];
    let mut good = PidConfig::sampled_every(T);
    good.limits = Limits::new(ControllerSetting::OutputLimits, -1.0, 1.0).ok();
    for (name, set, bad, fine) in rows {
        table(name, good, set, bad, fine, |config| Pid::new(NOMINAL, config));
        table(name, good, set, bad, fine, |config| {
            Fspid::new(tuner(TunerSettings::literal()), config)
        });
    }
}

#[test]
fn every_bad_setting_of_the_tuner_is_refused_by_name() {
    type Set = fn(&mut TunerSettings<f64>, f64);
    /// Name, how to set it, and what is refused.
    type Row = (&'static str, Set, &'static [f64]);
    fn zone(settings: &mut TunerSettings<f64>) -> &mut DeadZone<f64> {
        settings.dead_zone.get_or_insert(DeadZone { error_rad: 0.0, change_rad: 0.0 })
    }
    let rows: [Row; 8] = [
        ("error_scale", |s, v| s.input_scale.error_per_rad = v, &[]),
        ("change_scale", |s, v| s.input_scale.change_per_rad = v, &[]),
        ("output_scale kp", |s, v| s.output_scale.kp = v, &[]),
        ("output_scale ki", |s, v| s.output_scale.ki = v, &[]),
        ("output_scale kd", |s, v| s.output_scale.kd = v, &[]),
        ("leakage, 1/s", |s, v| s.law = Law::Accumulating { leakage_per_s: v }, &[-1e-9]),
        ("dead zone of the error", |s, v| zone(s).error_rad = v, &[-1e-9]),
        ("dead zone of the change", |s, v| zone(s).change_rad = v, &[-1e-9]),
    ];
    for (name, set, bad) in rows {
        table(name, TunerSettings::literal(), set, bad, &[0.0, 1.0], |settings| {
            SelfTuner::new(NOMINAL, supervisor(OutOfRange::Clamp), settings)
        });
    }
}

/// A leakage above one per period used to be accepted: it throws the gains past their nominal
/// values, above two ever further.
#[test]
fn a_leakage_above_one_per_period_is_refused() {
    for (leakage_per_s, accepted) in
        [(0.0, true), (1.0 / T, true), (1.01 / T, false), (1e300, false)]
    {
        let law = Law::Accumulating { leakage_per_s };
        let built = Fspid::new(
            tuner(TunerSettings { law, ..TunerSettings::literal() }),
            PidConfig::sampled_every(T),
        );
        assert_eq!(built.is_ok(), accepted, "{leakage_per_s}");
        if !accepted {
            assert_eq!(refused(built), ("leakage, 1/s", leakage_per_s.to_bits()));
        }
    }
}

#[test]
fn every_bad_guard_is_refused_by_name() {
    table("sample guard, rad", 1.0, |g, v| *g = v, &[0.0, -1.0], &[1.0, 1e308], Guard::new);
}

/// Parallel gains that overflow used to be handed out, and only the controller refused them.
#[test]
fn every_bad_number_of_the_isa_form_is_refused_by_name() {
    let isa = |[k, ti, td]: [f64; 3]| Gains::from_isa(k, ti, td);
    let good = [2.0, 4.0, 0.5];
    table("gain K", good, |v, x| v[0] = x, &[], &[-1.0], isa);
    table("Td, s", good, |v, x| v[2] = x, &[-1.0], &[0.0], isa);
    table("Td, s", 0.5, |v, x| *v = x, &[-1.0], &[0.0], |td| Derivative::from_isa(td, 8.0));
    for bad in [f64::NAN, 0.0, -1.0, f64::NEG_INFINITY] {
        assert_eq!(refused(isa([2.0, bad, 0.5])).0, "Ti, s");
        assert_eq!(refused(Derivative::from_isa(0.5, bad)).0, "N");
    }
    assert_eq!(refused(isa([2.0, 1e-308, 0.5])).0, "ki");
    assert_eq!(refused(isa([1e200, 1.0, 1e200])).0, "kd");
    assert_eq!(refused(Derivative::from_isa(0.5, 5e-324)).0, "N");
}

#[test]
fn an_empty_range_is_refused_by_name() {
    for (lower, upper) in
        [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::NAN), (f64::INFINITY, f64::INFINITY)]
    {
        let error = Limits::new(ControllerSetting::OutputLimits, lower, upper).expect_err("empty");
        assert!(
            matches!(error, ConfigError::EmptyRange { what: ControllerSetting::OutputLimits, .. }),
            "{error}"
        );
    }
    assert!(Limits::new(ControllerSetting::OutputLimits, f64::NEG_INFINITY, f64::INFINITY).is_ok());
}

#[test]
fn nominal_gains_outside_their_limits_are_refused_by_name() {
    let wide =
        Limits::new(ControllerSetting::GainLimits, -10.0, 10.0).expect("lower is below upper");
    let narrow =
        Limits::new(ControllerSetting::GainLimits, 100.0, 101.0).expect("lower is below upper");
    let all = GainLimits { kp: wide, ki: wide, kd: wide };
    for (name, limits) in [
        (ControllerSetting::NominalKp, GainLimits { kp: narrow, ..all }),
        (ControllerSetting::NominalKi, GainLimits { ki: narrow, ..all }),
        (ControllerSetting::NominalKd, GainLimits { kd: narrow, ..all }),
    ] {
        let settings = TunerSettings { gain_limits: Some(limits), ..TunerSettings::literal() };
        let error =
            SelfTuner::new(NOMINAL, supervisor(OutOfRange::Clamp), settings).expect_err("outside");
        assert!(
            matches!(error, ConfigError::OutsideLimits { what, lower: 100.0, upper: 101.0, .. } if what == name)
        );
    }
}

#[test]
fn an_anti_windup_without_a_limit_to_act_at_is_refused() {
    for anti_windup in [AntiWindup::Conditional, AntiWindup::BackCalculation { tracking_s: 1.0 }] {
        let mut config = PidConfig { anti_windup, ..PidConfig::sampled_every(T) };
        assert!(matches!(Pid::new(NOMINAL, config), Err(ConfigError::Conflict { .. })));
        config.slew_rad_s = Some(1.0);
        assert!(Pid::new(NOMINAL, config).is_ok());
        config.slew_rad_s = None;
        config.limits = Limits::new(ControllerSetting::OutputLimits, -1.0, 1.0).ok();
        assert!(Pid::new(NOMINAL, config).is_ok());
    }
}

#[test]
fn a_refusal_reads_as_a_sentence() {
    let refusals = [
        Pid::new(Gains { kp: f64::NAN, ..NOMINAL }, PidConfig::sampled_every(T)).err(),
        Pid::new(NOMINAL, PidConfig::sampled_every(-0.5)).err(),
        Limits::new(ControllerSetting::OutputLimits, 2.0, 1.0).err(),
    ];
    let sentences = refusals.map(|error| error.expect("refused").to_string());
    assert_eq!(
        sentences,
        [
            "kp is NaN; allowed is a finite number",
            "sample period, s is -0.5; allowed is a finite number above 0",
            "output limits are 2.0 to 1.0; the lower must be below the upper, and neither NaN",
        ]
    );
}
