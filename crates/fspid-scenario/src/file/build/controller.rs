//! Controllers.

use fspid_core::{
    AntiWindup, Change, ConfigError, DeadZone, Derivative, Fspid, GainCoupling, GainLimits, Gains,
    Guard, InputScale, InputSets, Law, Limits, Pid, PidConfig, ReferenceModel, SecondInput,
    SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};
use fspid_sim::Controller;

use super::schedule::{self, Pressure};
use super::{judged, lqi, rad, supervisor};
use crate::file::files::Files;
use crate::file::section::Section;
use crate::file::spec::controller::{
    AntiWindupKind, ControllerKind, DerivativeOn, LawWord, SecondInputWord,
};
use crate::units::degrees;
use fspid_diagnostics::Report;

/// The controller of a sound section.
pub(super) fn controller(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    (dt_s, pressure): (f64, Pressure),
) -> Option<Controller> {
    match section.variant()? {
        ControllerKind::Lqi => lqi::controller(report, section, dt_s),
        ControllerKind::P => {
            let factor = schedule::factor(report, section, pressure);
            let gains = Gains { kp: section.number("kp")?, ..Gains::ZERO };
            let config = PidConfig {
                rate_gain_s: section.number("rate_gain")?,
                ..PidConfig::sampled_every(dt_s)
            };
            let (gains, config) = schedule::scaled(report, section, factor?, (gains, config))?;
            judged(report, (section, "kp"), Pid::new(gains, config)).map(Controller::Fixed)
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

/// The controller, or its conflict at the setting that is in it.
pub(super) fn placed<T>(
    report: &mut Report,
    section: &Section,
    result: Result<T, ConfigError>,
) -> Option<T> {
    let key = match result {
        Err(ConfigError::Conflict { .. }) => "anti_windup",
        _ => "name",
    };
    judged(report, (section, key), result)
}

/// The gains, and the derivative filter that an ISA form's `n` asks for.
fn gains(report: &mut Report, section: &Section) -> (Option<Gains<f64>>, Option<f64>) {
    for key in ["isa", "nominal_isa"] {
        if let Some(isa) = section.section(key) {
            return from_isa(report, isa);
        }
    }
    let parallel = section.section("nominal").unwrap_or(section);
    let gains = parallel.number("kp").map(|kp| Gains {
        kp,
        ki: parallel.number("ki").unwrap_or(0.0),
        kd: parallel.number("kd").unwrap_or(0.0),
    });
    (gains, None)
}

fn from_isa(report: &mut Report, isa: &Section) -> (Option<Gains<f64>>, Option<f64>) {
    let (gain, td_s) = (isa.number("gain"), isa.number("td_s").unwrap_or(0.0));
    let ti_s = isa.number("ti_s").unwrap_or(f64::INFINITY);
    let gains = gain.map(|gain| Gains::from_isa(gain, ti_s, td_s).and_then(Gains::checked));
    let gains = gains.and_then(|gains| judged(report, (isa, "gain"), gains));
    let filter_s = isa.number("n").map(|n| td_s / n);
    if filter_s.is_some_and(|filter_s| !filter_s.is_finite()) {
        let allowed = "an n for which td_s / n is a finite number";
        report.value(isa.at("n"), &isa.path("n"), "out of range", allowed);
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
        rate_gain_s: section.number("rate_gain")?,
        setpoint_weights: weights?,
        derivative: Derivative { filter_s: filter_s? },
        integral: section.word("integral")?,
        ..ends?
    })
}

/// A configuration with limits, anti-windup and guard alone.
pub(super) fn ends(report: &mut Report, section: &Section, dt_s: f64) -> Option<PidConfig<f64>> {
    let limits = match section.interval("output_limits_deg") {
        Some((lower, upper)) => {
            let limits = Limits::new("output limits", rad(lower), rad(upper));
            Some(judged(report, (section, "output_limits_deg"), limits)?)
        }
        None => None,
    };
    let guard = Guard::new(rad(section.number("sample_guard_deg")?));
    let guard = judged(report, (section, "sample_guard_deg"), guard);
    let anti_windup = anti_windup(report, section, limits.is_some());
    Some(PidConfig {
        anti_windup: anti_windup?,
        limits,
        slew_rad_s: section.number("slew_limit_deg_s").map(rad),
        guard: guard?,
        ..PidConfig::sampled_every(dt_s)
    })
}

fn filter(report: &mut Report, section: &Section, isa_filter_s: Option<f64>) -> Option<f64> {
    let given = section.number("derivative_filter_s");
    if given.is_some() && isa_filter_s.is_some() {
        let (key, allowed) = ("derivative_filter_s", "one of the two");
        let message = "not together with `n`, which sets the filter as well";
        report.value(section.at(key), &section.path(key), message, allowed);
        return None;
    }
    Some(given.or(isa_filter_s).unwrap_or(0.0))
}

fn weights(report: &mut Report, section: &Section) -> Option<SetpointWeights<f64>> {
    let given = section.section("setpoint_weights");
    let number = |key| given.and_then(|weights| weights.number(key)).unwrap_or(1.0);
    let explicit = given.filter(|weights| weights.given("derivative"));
    let derivative = number("derivative");
    let on_measurement = section.word("derivative_on") == Some(DerivativeOn::Measurement);
    let conflict = match explicit {
        Some(_) if on_measurement => derivative != 0.0,
        Some(_) => section.given("derivative_on") && derivative == 0.0,
        None => false,
    };
    if conflict {
        let message = if on_measurement {
            "the derivative acts on the measurement, yet the set-point has a derivative weight"
        } else {
            "the derivative acts on the error, yet the set-point has no derivative weight"
        };
        let (place, path) = (section.at("derivative_on"), section.path("derivative_on"));
        let allowed = "one of `derivative_on` and `setpoint_weights.derivative`, or both alike";
        report.value(place, &path, message, allowed);
        return None;
    }
    Some(SetpointWeights {
        proportional: number("proportional"),
        derivative: if on_measurement { 0.0 } else { derivative },
    })
}

fn anti_windup(report: &mut Report, section: &Section, limited: bool) -> Option<AntiWindup<f64>> {
    let Some(part) = section.section("anti_windup") else {
        return Some(AntiWindup::None);
    };
    let kind = part.variant()?;
    let acts_at_limits =
        matches!(kind, AntiWindupKind::Conditional | AntiWindupKind::BackCalculation);
    if acts_at_limits && !limited && section.number("slew_limit_deg_s").is_none() {
        let message = format!("\"{}\" has no limit to act at", part.kind);
        let allowed = "with `output_limits_deg` or `slew_limit_deg_s`, or left out";
        report.missing(section.at("anti_windup"), &part.path, message, allowed);
        return None;
    }
    Some(match kind {
        AntiWindupKind::Clamping => {
            let (lower, upper) = (part.number("lower_deg")?, part.number("upper_deg")?);
            if lower >= upper {
                let (place, path) = (part.at("upper_deg"), part.path("upper_deg"));
                report.value(place, &path, "not above `lower_deg`", format!("above {lower:?} deg"));
                return None;
            }
            let limits = Limits::new("anti-windup limits", rad(lower), rad(upper));
            AntiWindup::Clamping(judged(report, (part, "upper_deg"), limits)?)
        }
        AntiWindupKind::Conditional => AntiWindup::Conditional,
        AntiWindupKind::BackCalculation => {
            AntiWindup::BackCalculation { tracking_s: part.number("tracking_s")? }
        }
        AntiWindupKind::None => AntiWindup::None,
    })
}

fn tuner(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    nominal: Option<Gains<f64>>,
) -> Option<SelfTuner<f64>> {
    let part = section.section("supervisor")?;
    let supervisor = supervisor::supervisor(report, files, part);
    let limits = section.section("gain_limits");
    let gain_limits = limits.map(|limits| gain_limits(report, limits));
    let law = law(report, section);
    let settings = TunerSettings {
        error_sign: part.word("error_sign")?,
        second_input: second_input(report, part)?,
        change: part.word("change")?,
        input_scale: input_scale(report, part)?,
        input_sets: InputSets {
            error: set_centres(report, part, "error_set_centres")?,
            change: set_centres(report, part, "change_set_centres")?,
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
    let mut per_rad = |key| {
        // A factor per degree is as many times larger per radian as a radian has degrees.
        let scale = degrees(part.number(key)?);
        if scale.is_finite() {
            return Some(scale);
        }
        report.value(part.at(key), &part.path(key), "too large", "a smaller factor");
        None
    };
    let (error, change) = (per_rad("error_scale"), per_rad("change_scale"));
    Some(InputScale { error_per_rad: error?, change_per_rad: change? })
}

/// What the supervisor sees beside the error; what would go unused is refused.
fn second_input(report: &mut Report, part: &Section) -> Option<SecondInput<f64>> {
    let (second_input, model): (SecondInputWord, _) =
        (part.word("second_input")?, part.section("model"));
    if second_input != SecondInputWord::Change && part.word("change") == Some(Change::Delta) {
        let message = format!("the supervisor sees no change, but \"{}\"", second_input.name());
        let allowed = "only with second_input = \"error-and-change\"";
        report.value(part.at("change"), &part.path("change"), message, allowed);
        return None;
    }
    match (second_input, model) {
        (SecondInputWord::ModelError, Some(model)) => {
            Some(SecondInput::ModelError(ReferenceModel {
                bandwidth_rad_s: model.number("bandwidth_rad_s")?,
                damping: model.number("damping")?,
            }))
        }
        (SecondInputWord::ModelError, None) => {
            let (message, allowed) = ("it has no reference model", "together with `model`");
            report.missing(part.at("second_input"), &part.path("second_input"), message, allowed);
            None
        }
        (SecondInputWord::Rate | SecondInputWord::Change, Some(model)) => {
            let message = format!("the supervisor sees no model, but \"{}\"", second_input.name());
            let allowed = "only with second_input = \"error-and-model-error\"";
            report.value(part.at("model"), &model.path, message, allowed);
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
    key: &'static str,
) -> Option<Option<SetCentres<f64>>> {
    match part.interval(key) {
        None => Some(None),
        Some((small, medium)) => {
            judged(report, (part, key), SetCentres::new(small, medium)).map(Some)
        }
    }
}

fn gain_coupling(section: &Section) -> GainCoupling<f64> {
    let part = section.section("gain_coupling");
    let number = |key| part.and_then(|part| part.number(key)).unwrap_or(0.0);
    GainCoupling {
        setpoint_weight: number("setpoint_weight_per_kp"),
        rate_gain: number("rate_gain_per_kd"),
    }
}

fn output_scale(part: &Section) -> Gains<f64> {
    let scale = part.section("output_scale");
    let number = |key| scale.and_then(|scale| scale.number(key)).unwrap_or(1.0);
    Gains { kp: number("kp"), ki: number("ki"), kd: number("kd") }
}

fn dead_zone(section: &Section) -> Option<DeadZone<f64>> {
    let zone = section.section("dead_zone")?;
    Some(DeadZone {
        error_rad: rad(zone.number("error_deg")?),
        change_rad: rad(zone.number("change_deg_s")?),
    })
}

fn law(report: &mut Report, section: &Section) -> Option<Law<f64>> {
    let leakage = section.number("leakage_per_s");
    match section.word("law")? {
        LawWord::Accumulating => Some(Law::Accumulating { leakage_per_s: leakage.unwrap_or(0.0) }),
        LawWord::Memoryless if leakage.is_some() => {
            let (place, path) = (section.at("leakage_per_s"), section.path("leakage_per_s"));
            let message = "the memoryless law has nothing that could leak";
            report.value(place, &path, message, "only with law = \"accumulating\"");
            None
        }
        LawWord::Memoryless => Some(Law::Memoryless),
    }
}

/// The limits of each gain; an end that is not given is open.
fn gain_limits(report: &mut Report, part: &Section) -> Option<GainLimits<f64>> {
    let mut limits = |least: &'static str, most: &'static str| {
        let lower = part.number(least).unwrap_or(f64::NEG_INFINITY);
        let upper = part.number(most).unwrap_or(f64::INFINITY);
        if lower < upper {
            return Limits::new("gain limits", lower, upper).ok();
        }
        let message = format!("not above `{least}`");
        let allowed = format!("above {lower:?}");
        report.value(part.at(most), &part.path(most), message, allowed);
        None
    };
    let (kp, ki, kd) =
        (limits("kp_min", "kp_max"), limits("ki_min", "ki_max"), limits("kd_min", "kd_max"));
    Some(GainLimits { kp: kp?, ki: ki?, kd: kd? })
}

/// Reports nominal gains outside their limits at the gain itself.
fn refuse_nominal(report: &mut Report, section: &Section, error: ConfigError) {
    let ConfigError::OutsideLimits { what, found, lower, upper } = error else {
        judged(report, (section, "supervisor"), Err::<(), _>(error));
        return;
    };
    let gain = what.trim_start_matches("nominal ");
    let message = format!("{found:?} is outside `gain_limits`");
    let allowed = match (lower.is_finite(), upper.is_finite()) {
        (true, true) => format!("{lower:?} to {upper:?}"),
        (true, false) => format!("{lower:?} or above"),
        _ => format!("{upper:?} or below"),
    };
    let (place, path) = match section.section("nominal") {
        Some(nominal) => (nominal.at(gain), nominal.path(gain)),
        None => (section.at("nominal_isa"), section.path("nominal_isa")),
    };
    report.missing(place, &path, message, allowed);
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
    let drifts =
        [("kp", rest.kp - nominal.kp), ("ki", rest.ki - nominal.ki), ("kd", rest.kd - nominal.kd)];
    let bounded = |gain: &str, drift: f64| {
        let end = if drift > 0.0 { "max" } else { "min" };
        limits.is_some_and(|limits| limits.given(&format!("{gain}_{end}")))
    };
    let text: Vec<String> = drifts
        .iter()
        .filter(|(gain, drift)| drift.abs() > 1e-12 && !bounded(gain, *drift))
        .map(|(gain, drift)| format!("{gain} by {drift:+.4}"))
        .collect();
    if text.is_empty() {
        return;
    }
    let (path, text) = (&section.path, text.join(" and "));
    let leakage = section.number("leakage_per_s").unwrap_or(0.0);
    report.warn(if leakage > 0.0 {
        format!("{path}: at rest the accumulating law drives {text} every second, less what leaks; without gain_limits only the leakage bounds it")
    } else {
        format!("{path}: at rest the accumulating law moves {text} every second, without end; gain_limits, dead_zone or leakage_per_s bound it")
    });
}
