//! Which settings an importer may change, and to what.
//!
//! A setting is a parameter where nothing else in the program was computed from it: then the FMU with another value
//! answers as the export of a controller with that setting would. The ranges are those of `fspid-core`, which checks
//! them where a controller is built.

use super::variable::{Variable, plain};
use crate::program::{Member, Part, Precision, Program, Value};

/// A pair of parameters of which one bounds the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Order {
    pub(super) below: String,
    pub(super) above: String,
    pub(super) may_be_equal: bool,
}

/// Damping of a reference model up to which its discrete poles are stable, as `fspid-core` has it.
const MOST_DAMPING: f64 = 1.5;
/// A step of a reference model covers at most this part of its time constant, likewise.
const LONGEST_STEP: f64 = 0.5;

/// The parameters of a program.
pub(super) fn parameters(program: &Program) -> Vec<Variable> {
    let parameter = |member: &Member| {
        let range = range(program, &member.name)?;
        Some(Variable { range, ..plain(member, Part::Configuration)? })
    };
    program.configuration.iter().filter_map(parameter).collect()
}

/// The allowed values of a setting; `None` for one that is no parameter: from the sample period, the rules and their
/// sets others were computed, or proofs made.
fn range(program: &Program, name: &str) -> Option<(f64, f64)> {
    let (smallest, largest) = match program.precision {
        Precision::Single => (f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)),
        Precision::Double => (f64::MIN_POSITIVE, f64::MAX),
    };
    let (any, positive, not_negative) = ((-largest, largest), (smallest, largest), (0.0, largest));
    let dt_s = real(program, "dt_s")?;
    match name {
        "rate_gain_s" | "rate_gain_per_kd" => has_rate(program).then_some(any),
        "nominal_kp"
        | "nominal_ki"
        | "nominal_kd"
        | "scale_kp"
        | "scale_ki"
        | "scale_kd"
        | "lower_kp"
        | "lower_ki"
        | "lower_kd"
        | "upper_kp"
        | "upper_ki"
        | "upper_kd"
        | "lower_rad"
        | "upper_rad"
        | "term_lower_rad"
        | "term_upper_rad"
        | "proportional_weight"
        | "derivative_weight"
        | "feedforward"
        | "weight_per_kp"
        | "error_per_rad"
        | "change_per_rad" => Some(any),
        "slew_rad" | "guard_rad" => Some(positive),
        "filter_s" | "zone_error_rad" | "zone_change_rad" => Some(not_negative),
        "tracking_s" => Some((dt_s, largest)),
        "leakage_per_s" => Some((0.0, at_most(1.0, dt_s))),
        "bandwidth_rad_s" => Some((smallest, at_most(LONGEST_STEP, dt_s))),
        "damping" => Some((smallest, MOST_DAMPING)),
        "small_error" | "small_change" | "medium_error" | "medium_change" => {
            Some((smallest, below_one(program.precision)))
        }
        _ => None,
    }
}

/// The largest number of which the product with a period is at most that.
fn at_most(product: f64, dt_s: f64) -> f64 {
    let most = product / dt_s;
    if most * dt_s > product { most.next_down() } else { most }
}

fn below_one(precision: Precision) -> f64 {
    match precision {
        Precision::Single => f64::from(1.0_f32.next_down()),
        Precision::Double => 1.0_f64.next_down(),
    }
}

fn has_rate(program: &Program) -> bool {
    program.sample.iter().any(|member| member.name.starts_with("rate"))
}

fn real(program: &Program, name: &str) -> Option<f64> {
    program.configuration.iter().find_map(|member| match member.value {
        Value::Real(value) if member.name == name => Some(value),
        _ => None,
    })
}

/// Which parameters bound which, among those that there are.
pub(super) fn orders(parameters: &[Variable]) -> Vec<Order> {
    let mut pairs = vec![
        ("lower_rad".to_owned(), "upper_rad".to_owned(), false),
        ("term_lower_rad".to_owned(), "term_upper_rad".to_owned(), false),
        ("small_error".to_owned(), "medium_error".to_owned(), false),
        ("small_change".to_owned(), "medium_change".to_owned(), false),
    ];
    for gain in ["kp", "ki", "kd"] {
        let [lower, nominal, upper] =
            ["lower", "nominal", "upper"].map(|of| format!("{of}_{gain}"));
        pairs.push((lower.clone(), upper.clone(), false));
        pairs.push((lower, nominal.clone(), true));
        pairs.push((nominal, upper, true));
    }
    let is_there = |name: &String| parameters.iter().any(|parameter| parameter.name == *name);
    pairs.retain(|(below, above, _)| is_there(below) && is_there(above));
    let order = |(below, above, may_be_equal)| Order { below, above, may_be_equal };
    pairs.into_iter().map(order).collect()
}
