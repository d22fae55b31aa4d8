//! Controllers.

use super::ends::{ends, placed};
use fspid_core::{
    Change, ConfigError, ControllerSetting, DeadZone, Derivative, Fspid, GainCoupling, GainLimits,
    Gains, InputScale, InputSets, Law, Limits, Pid, PidConfig, ReferenceModel, SecondInput,
    SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};
use fspid_sim::Controller;

use super::schedule::{self, Pressure};
use super::{idle, judged, lqi, rad, supervisor};
use crate::file::files::Files;
use crate::file::spec::autopilot::OuterKind;
use crate::file::spec::controller as keys;
use crate::file::spec::controller::{ControllerKind, DerivativeOn, LawWord, SecondInputWord};
use crate::keyed::{Key, Section};
use crate::units::degrees;
use fspid_diagnostics::Report;

/// The controller of a sound section; one with equations.
pub(super) fn controller(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    (dt_s, pressure): (f64, Pressure),
) -> Option<Controller> {
    let controller = built(report, files, section, (dt_s, pressure))?;
    idle::warn(report, section, &controller);
    Some(controller)
}

fn built(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    (dt_s, pressure): (f64, Pressure),
) -> Option<Controller> {
    match section.variant()? {
        // Built elsewhere: they have none.
        ControllerKind::External | ControllerKind::ArduPilot | ControllerKind::Px4 => None,
        ControllerKind::Lqi => lqi::controller(report, section, dt_s),
        ControllerKind::P => {
            let factor = schedule::factor(report, section, pressure);
            let gains = Gains { kp: section.get(keys::P_KP)?, ..Gains::ZERO };
            let config = PidConfig {
                rate_gain_s: section.get(keys::RATE_GAIN)?,
                feedforward: section.get(keys::FEEDFORWARD)?,
                ..PidConfig::sampled_every(dt_s)
            };
            let (gains, config) = schedule::scaled(report, section, factor?, (gains, config))?;
            judged(report, (section, keys::P_KP), Pid::new(gains, config)).map(Controller::Fixed)
        }
        ControllerKind::Pid => {
            let factor = schedule::factor(report, section, pressure);
            let (gains, filter_s) = gains(report, section);
            let config = config(report, section, (dt_s, filter_s));
            let (gains, config) = schedule::scaled(report, section, factor?, (gains?, config?))?;
            placed(report, section, Pid::new(gains, config)).map(Controller::Fixed)
        }
        ControllerKind::Fspid => {
            let (gains, filter_s) = gains(report, section);
            let config = config(report, section, (dt_s, filter_s));
            let tuner = tuner(report, files, section, gains);
            let fspid = Fspid::new(tuner?, config?);
            placed(report, section, fspid).map(Controller::SelfTuning)
        }
    }
}

/// The controller of an outer loop within `ends`.
pub(super) fn outer(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    ends: PidConfig<f64>,
) -> Option<Controller> {
    let gains = parallel(section);
    let (weights, filter_s) = (weights(report, section), filter(report, section, None));
    let config = PidConfig {
        rate_gain_s: section.get(keys::RATE_GAIN)?,
        setpoint_weights: weights?,
        derivative: Derivative { filter_s: filter_s? },
        integral: section.get(keys::INTEGRAL)?,
        ..ends
    };
    match section.variant()? {
        OuterKind::Pid => placed(report, section, Pid::new(gains?, config)).map(Controller::Fixed),
        OuterKind::Fspid => {
            let tuner = tuner(report, files, section, gains);
            placed(report, section, Fspid::new(tuner?, config)).map(Controller::SelfTuning)
        }
    }
}

/// The gains, and the derivative filter that an ISA form's `n` asks for.
fn gains(report: &mut Report, section: &Section) -> (Option<Gains<f64>>, Option<f64>) {
    if let Some(isa) = section.get(keys::ISA).or_else(|| section.get(keys::NOMINAL_ISA)) {
        return from_isa(report, isa);
    }
    (parallel(section), None)
}

/// The gains in parallel form.
fn parallel(section: &Section) -> Option<Gains<f64>> {
    let parallel = section.get(keys::NOMINAL).unwrap_or(section);
    parallel.get(keys::KP).map(|kp| Gains {
        kp,
        ki: parallel.get(keys::KI).unwrap_or(0.0),
        kd: parallel.get(keys::KD).unwrap_or(0.0),
    })
}

fn from_isa(report: &mut Report, isa: &Section) -> (Option<Gains<f64>>, Option<f64>) {
    let (gain, td_s) = (isa.get(keys::GAIN), isa.get(keys::TD_S).unwrap_or(0.0));
    let ti_s = isa.get(keys::TI_S).unwrap_or(f64::INFINITY);
    let gains = gain.map(|gain| Gains::from_isa(gain, ti_s, td_s).and_then(Gains::checked));
    let gains = gains.and_then(|gains| judged(report, (isa, keys::GAIN), gains));
    let filter_s = isa.get(keys::N).map(|n| td_s / n);
    if filter_s.is_some_and(|filter_s| !filter_s.is_finite()) {
        let allowed = "an n for which td_s / n is a finite number";
        isa.wrong(report, keys::N, "out of range", allowed);
    }
    (gains, filter_s)
}

fn config(
    report: &mut Report,
    section: &Section,
    (dt_s, isa_filter_s): (f64, Option<f64>),
) -> Option<PidConfig<f64>> {
    let ends = ends(report, section, dt_s);
    let weights = weights(report, section);
    let filter_s = filter(report, section, isa_filter_s);
    Some(PidConfig {
        rate_gain_s: section.get(keys::RATE_GAIN)?,
        setpoint_weights: weights?,
        feedforward: section.get(keys::FEEDFORWARD)?,
        derivative: Derivative { filter_s: filter_s? },
        integral: section.get(keys::INTEGRAL)?,
        ..ends?
    })
}

fn filter(report: &mut Report, section: &Section, isa_filter_s: Option<f64>) -> Option<f64> {
    let given = section.get(keys::DERIVATIVE_FILTER_S);
    if given.is_some() && isa_filter_s.is_some() {
        let (key, allowed) = (keys::DERIVATIVE_FILTER_S, "one of the two");
        let message = "not together with `n`, which sets the filter as well";
        section.wrong(report, key, message, allowed);
        return None;
    }
    Some(given.or(isa_filter_s).unwrap_or(0.0))
}

fn weights(report: &mut Report, section: &Section) -> Option<SetpointWeights<f64>> {
    let given = section.get(keys::SETPOINT_WEIGHTS);
    let number = |key| given.and_then(|weights| weights.get(key)).unwrap_or(1.0);
    let explicit = given.filter(|weights| weights.given(keys::DERIVATIVE));
    let derivative = number(keys::DERIVATIVE);
    let on_measurement = section.get(keys::DERIVATIVE_ON) == Some(DerivativeOn::Measurement);
    let conflict = match explicit {
        Some(_) if on_measurement => derivative != 0.0,
        Some(_) => section.given(keys::DERIVATIVE_ON) && derivative == 0.0,
        None => false,
    };
    if conflict {
        let message = if on_measurement {
            "the derivative acts on the measurement, yet the set-point has a derivative weight"
        } else {
            "the derivative acts on the error, yet the set-point has no derivative weight"
        };
        let allowed = "one of `derivative_on` and `setpoint_weights.derivative`, or both alike";
        section.wrong(report, keys::DERIVATIVE_ON, message, allowed);
        return None;
    }
    Some(SetpointWeights {
        proportional: number(keys::PROPORTIONAL),
        derivative: if on_measurement { 0.0 } else { derivative },
    })
}

fn tuner(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    nominal: Option<Gains<f64>>,
) -> Option<SelfTuner<f64>> {
    let part = section.get(keys::SUPERVISOR)?;
    let supervisor = supervisor::supervisor(report, files, part);
    let limits = section.get(keys::GAIN_LIMITS);
    let gain_limits = limits.map(|limits| gain_limits(report, limits));
    let law = law(report, section);
    let settings = TunerSettings {
        error_sign: part.get(keys::ERROR_SIGN)?,
        second_input: second_input(report, part)?,
        change: part.get(keys::CHANGE)?,
        input_scale: input_scale(report, part)?,
        input_sets: InputSets {
            error: set_centres(report, part, keys::ERROR_SET_CENTRES)?,
            change: set_centres(report, part, keys::CHANGE_SET_CENTRES)?,
        },
        output_scale: output_scale(part),
        gain_coupling: gain_coupling(section),
        law: law?,
        gain_limits: match gain_limits {
            Some(limits) => Some(limits?),
            None => None,
        },
        dead_zone: dead_zone(section),
    };
    match SelfTuner::new(nominal?, supervisor?, settings) {
        Ok(tuner) => {
            warn_of_drift(report, section, &tuner, limits);
            Some(tuner)
        }
        Err(error) => {
            refuse_nominal(report, section, error);
            None
        }
    }
}

fn input_scale(report: &mut Report, part: &Section) -> Option<InputScale<f64>> {
    let mut per_rad = |key: Key<f64>| {
        // A factor per degree is as many times larger per radian as a radian has degrees.
        let scale = degrees(part.get(key)?);
        if scale.is_finite() {
            return Some(scale);
        }
        part.wrong(report, key, "too large", "a smaller factor");
        None
    };
    let (error, change) = (per_rad(keys::ERROR_SCALE), per_rad(keys::CHANGE_SCALE));
    Some(InputScale { error_per_rad: error?, change_per_rad: change? })
}

/// What the supervisor sees beside the error; what would go unused is refused.
fn second_input(report: &mut Report, part: &Section) -> Option<SecondInput<f64>> {
    let (second_input, model): (SecondInputWord, _) =
        (part.get(keys::SECOND_INPUT)?, part.get(keys::MODEL));
    if second_input != SecondInputWord::Change && part.get(keys::CHANGE) == Some(Change::Delta) {
        let message = format!("the supervisor sees no change, but \"{}\"", second_input.name());
        let allowed = "only with second_input = \"error-and-change\"";
        part.wrong(report, keys::CHANGE, message, allowed);
        return None;
    }
    match (second_input, model) {
        (SecondInputWord::ModelError, Some(model)) => {
            Some(SecondInput::ModelError(ReferenceModel {
                bandwidth_rad_s: model.get(keys::BANDWIDTH_RAD_S)?,
                damping: model.get(keys::DAMPING)?,
            }))
        }
        (SecondInputWord::ModelError, None) => {
            let (message, allowed) = ("it has no reference model", "together with `model`");
            part.problem(report, keys::SECOND_INPUT, message, allowed);
            None
        }
        (SecondInputWord::Rate | SecondInputWord::Change, Some(model)) => {
            let message = format!("the supervisor sees no model, but \"{}\"", second_input.name());
            let allowed = "only with second_input = \"error-and-model-error\"";
            report.value(part.at(keys::MODEL), &model.path, message, allowed);
            None
        }
        (SecondInputWord::Rate, None) => Some(SecondInput::Rate),
        (SecondInputWord::Change, None) => Some(SecondInput::Change),
    }
}

/// Where the sets of an input lie; the inner `None` where nothing is said, the outer one for a problem.
#[allow(clippy::option_option, reason = "left out and refused are two things")]
fn set_centres(
    report: &mut Report,
    part: &Section,
    key: Key<(f64, f64)>,
) -> Option<Option<SetCentres<f64>>> {
    match part.get(key) {
        None => Some(None),
        Some((small, medium)) => {
            judged(report, (part, key), SetCentres::new(small, medium)).map(Some)
        }
    }
}

fn gain_coupling(section: &Section) -> GainCoupling<f64> {
    let part = section.get(keys::GAIN_COUPLING);
    let number = |key| part.and_then(|part| part.get(key)).unwrap_or(0.0);
    GainCoupling {
        setpoint_weight: number(keys::SETPOINT_WEIGHT_PER_KP),
        rate_gain: number(keys::RATE_GAIN_PER_KD),
    }
}

fn output_scale(part: &Section) -> Gains<f64> {
    let scale = part.get(keys::OUTPUT_SCALE);
    let number = |key| scale.and_then(|scale| scale.get(key)).unwrap_or(1.0);
    Gains {
        kp: number(keys::OUTPUT_SCALE_KP),
        ki: number(keys::OUTPUT_SCALE_KI),
        kd: number(keys::OUTPUT_SCALE_KD),
    }
}

fn dead_zone(section: &Section) -> Option<DeadZone<f64>> {
    let zone = section.get(keys::DEAD_ZONE)?;
    Some(DeadZone {
        error_rad: rad(zone.get(keys::ERROR_DEG)?),
        change_rad: rad(zone.get(keys::CHANGE_DEG_S)?),
    })
}

fn law(report: &mut Report, section: &Section) -> Option<Law<f64>> {
    let leakage = section.get(keys::LEAKAGE_PER_S);
    match section.get(keys::LAW)? {
        LawWord::Accumulating => Some(Law::Accumulating { leakage_per_s: leakage.unwrap_or(0.0) }),
        LawWord::Memoryless if leakage.is_some() => {
            let (place, path) =
                (section.at(keys::LEAKAGE_PER_S), section.path(keys::LEAKAGE_PER_S));
            let message = "the memoryless law has nothing that could leak";
            report.value(place, &path, message, "only with law = \"accumulating\"");
            None
        }
        LawWord::Memoryless => Some(Law::Memoryless),
    }
}

/// The limits of each gain; an end that is not given is open.
fn gain_limits(report: &mut Report, part: &Section) -> Option<GainLimits<f64>> {
    let mut limits = |[least, most]: [Key<f64>; 2]| {
        let lower = part.get(least).unwrap_or(f64::NEG_INFINITY);
        let upper = part.get(most).unwrap_or(f64::INFINITY);
        if lower < upper {
            return Limits::new(ControllerSetting::GainLimits, lower, upper).ok();
        }
        let message = format!("not above `{}`", least.name);
        let allowed = format!("above {lower:?}");
        part.wrong(report, most, message, allowed);
        None
    };
    let (kp, ki, kd) = (limits(keys::KP_ENDS), limits(keys::KI_ENDS), limits(keys::KD_ENDS));
    Some(GainLimits { kp: kp?, ki: ki?, kd: kd? })
}

/// The nominal gain that a setting is.
fn nominal_key(what: ControllerSetting) -> Option<Key<f64>> {
    match what {
        ControllerSetting::NominalKp => Some(keys::NOMINAL_KP),
        ControllerSetting::NominalKi => Some(keys::NOMINAL_KI),
        ControllerSetting::NominalKd => Some(keys::NOMINAL_KD),
        _ => None,
    }
}

/// Reports nominal gains outside their limits at the gain itself.
fn refuse_nominal(report: &mut Report, section: &Section, error: ConfigError) {
    let ConfigError::OutsideLimits { what, found, lower, upper } = error else {
        judged(report, (section, keys::SUPERVISOR), Err::<(), _>(error));
        return;
    };
    let message = format!("{found:?} is outside `gain_limits`");
    let allowed = match (lower.is_finite(), upper.is_finite()) {
        (true, true) => format!("{lower:?} to {upper:?}"),
        (true, false) => format!("{lower:?} or above"),
        _ => format!("{upper:?} or below"),
    };
    match section.get(keys::NOMINAL).zip(nominal_key(what)) {
        Some((nominal, gain)) => nominal.problem(report, gain, message, allowed),
        None => section.problem(report, keys::NOMINAL_ISA, message, allowed),
    }
}

/// Says where the accumulating law would take the gains at rest, if nothing stops it.
fn warn_of_drift(
    report: &mut Report,
    section: &Section,
    tuner: &SelfTuner<f64>,
    limits: Option<&Section>,
) {
    if tuner.settings().law == Law::Memoryless {
        return;
    }
    let (nominal, rest) = (tuner.nominal(), tuner.gains_at_rest());
    let drifts = [
        (keys::KP, keys::KP_ENDS, rest.kp - nominal.kp),
        (keys::KI, keys::KI_ENDS, rest.ki - nominal.ki),
        (keys::KD, keys::KD_ENDS, rest.kd - nominal.kd),
    ];
    let is_bounded = |[least, most]: [Key<f64>; 2], drift: f64| {
        limits.is_some_and(|limits| limits.given(if drift > 0.0 { most } else { least }))
    };
    let text: Vec<String> = drifts
        .into_iter()
        .filter(|(_, ends, drift)| drift.abs() > 1e-12 && !is_bounded(*ends, *drift))
        .map(|(gain, _, drift)| format!("{} by {drift:+.4}", gain.name))
        .collect();
    if text.is_empty() {
        return;
    }
    let (path, text) = (&section.path, text.join(" and "));
    let leakage = section.get(keys::LEAKAGE_PER_S).unwrap_or(0.0);
    report.warn(if leakage > 0.0 {
        format!("{path}: at rest the accumulating law drives {text} every second, less what leaks; without gain_limits only the leakage bounds it")
    } else {
        format!("{path}: at rest the accumulating law moves {text} every second, without end; gain_limits or leakage_per_s bound it")
    });
}
