//! A script around the Lua module, for flight controllers with ArduPilot.

use super::{Heading, decimal};
use crate::compose::Angles;
use crate::program::{Part, Precision, Program, Value};

/// Full throw of a servo in degrees where the design limits nothing; an assumption, which a parameter replaces.
const THROW_DEG: f64 = 25.0;

/// The script, or nothing where the period is no whole number of milliseconds, in which ArduPilot counts.
#[must_use]
pub fn ardupilot(program: &Program, prefix: &str, heading: &Heading<'_>) -> Option<String> {
    let period_ms = period_ms(program)?;
    let head: String = heading.lines().iter().map(|line| format!("-- {line}\n")).collect();
    let (throw_deg, source) = match limit_deg(program) {
        Some(limit) => (limit, ": the design's limit"),
        None => (THROW_DEG, "; assumed, as the design has no limit"),
    };
    let sample = sample(program).join("\n    ");
    let text = include_str!("ardupilot.lua")
        .replace("@PARAMETERS@", &parameters(prefix))
        .replace("@PREFIX@", prefix)
        .replace("@KEY@", &key(prefix).to_string())
        .replace("@PERIOD@", &period_ms.to_string())
        .replace("@THROW@", &decimal(throw_deg, program.precision == Precision::Single))
        .replace("@THROW_SOURCE@", source)
        .replace("@SAMPLE@", &sample)
        .replace(
            "@COMMAND@",
            match heading.angles {
                Some(Angles::Degrees) => "answer.command_deg",
                Some(Angles::Radians) | None => "math.deg(answer.command_rad)",
            },
        );
    Some(head + &text)
}

fn configured(program: &Program, name: &str) -> Option<f64> {
    let member = program.configuration.iter().find(|member| member.name == name)?;
    if let Value::Real(value) = member.value { Some(value) } else { None }
}

fn period_ms(program: &Program) -> Option<u32> {
    let period_ms = configured(program, "dt_s")? * 1e3;
    let whole = period_ms.round();
    // A period of 32 bits is a whole number of milliseconds to seven digits.
    let is_whole = (period_ms - whole).abs() < 1e-6 * whole && whole < 6e4;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 60000")]
    (is_whole && whole >= 1.0).then_some(whole as u32)
}

fn limit_deg(program: &Program) -> Option<f64> {
    let ends = ["lower_rad", "upper_rad"].map(|name| configured(program, name));
    let largest = ends.into_iter().flatten().map(f64::abs).fold(0.0, f64::max);
    (largest > 0.0).then(|| largest.to_degrees())
}

/// What fills the sample; ArduPilot has radians.
fn sample(program: &Program) -> Vec<String> {
    let given = |name: &str| match name {
        "setpoint_rad" => "math.rad(setpoint_deg:get())",
        "setpoint_deg" => "setpoint_deg:get()",
        "measurement_rad" => "ahrs:get_pitch()",
        "measurement_deg" => "math.deg(ahrs:get_pitch())",
        "rate_rad_s" => "ahrs:get_gyro():y()",
        _ => "math.deg(ahrs:get_gyro():y())",
    };
    let members = program.members(Part::Sample).iter();
    members.map(|member| format!("sample.{} = {}", member.name, given(&member.name))).collect()
}

/// What its parameters begin with: short, as their names have sixteen characters at most.
fn parameters(prefix: &str) -> String {
    let letters = prefix.chars().filter(char::is_ascii_alphanumeric).take(5);
    format!("{}_", letters.collect::<String>().to_ascii_uppercase())
}

/// A key of its own for each name, from 1 to 199.
fn key(prefix: &str) -> u32 {
    1 + prefix.bytes().fold(0, |sum, byte| (31 * sum + u32::from(byte)) % 199)
}
