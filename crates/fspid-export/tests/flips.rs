//! Every single bit of an exported configuration, turned over: the self test tells its place, and a step stays in its arrays.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use fspid_core::fuzzy::{NumberTable, OutOfRange, Supervisor};
use fspid_core::{Controller, Fspid, Gains, PidConfig, SelfTuner, TunerSettings};
use fspid_export::program::Value;
use fspid_export::{Angles, program};
use fspid_numeric::Real;

use crate::c::write_all;
use crate::common::paper;

/// A member of the configuration: where it stands, bytes of an element, elements, and the code of the first one with what
/// is added for each that follows.
const HARNESS: &str = r#"
#include <stddef.h>
#include <stdio.h>
#include "pitch.h"

static const struct { size_t at; size_t size; unsigned count; unsigned first; unsigned more; } members[] = {
MEMBERS
};

static int is_finite(REAL number) { return number - number == 0; }

/* Steps over the whole range of the supervisor, all of which must answer numbers. */
static unsigned steps_without_number(const pitch_configuration *configuration)
{
    unsigned without = 0U;
    pitch_state state;
    pitch_sample sample;
    pitch_answer answer;
    pitch_reset(configuration, &state);
    for (int k = 0; k < 24; ++k) {
        sample.setpoint_rad = (REAL)((k * 7) % 24 - 12) / 2;
        sample.measurement_rad = (REAL)0;
        pitch_step(configuration, &state, &sample, &answer);
        without += !is_finite(answer.command_rad) || !is_finite(answer.kp);
    }
    return without;
}

int main(void)
{
    static pitch_configuration other;
    unsigned flips = 0U, missed = 0U, without = 0U;
    for (size_t m = 0U; m < sizeof members / sizeof members[0]; ++m) {
        for (unsigned k = 0U; k < members[m].count; ++k) {
            for (size_t bit = 0U; bit < 8U * members[m].size; ++bit) {
                uint8_t *bytes = (uint8_t *)&other + members[m].at + k * members[m].size;
                other = pitch_design;
                bytes[bit / 8U] = (uint8_t)(bytes[bit / 8U] ^ (1U << (bit % 8U)));
                missed += pitch_selftest(&other) != members[m].first + members[m].more * k;
                if (members[m].size == 1U) { without += steps_without_number(&other); }
                ++flips;
            }
        }
    }
    printf("%u flips, %u told otherwise, %u steps without a number, the design %u\n", flips, missed, without,
        pitch_selftest(&pitch_design));
    return 0;
}
"#;

/// Bits of the configuration, and the harness that turns each of them over.
fn harness<R: Real>(controller: &Controller<R>) -> (usize, String) {
    let program = program(controller, Angles::Radians).expect("nothing here is refused");
    let (mut bits, mut members) = (0, String::new());
    let rules = program.configuration.iter().filter(|member| member.is_rules()).count();
    let mut first = 1;
    for member in &program.configuration {
        let (size, count) = match &member.value {
            Value::Bytes(values) => (1, values.len()),
            Value::Reals(values) => (size_of::<R>(), values.len()),
            Value::Real(_) => (size_of::<R>(), 1),
            Value::Byte(_) | Value::Truth(_) => {
                panic!("{} is neither a number nor a table", member.name)
            }
        };
        let [code, more] = if member.is_rules() { [first, 1] } else { [300, 0] };
        first += 100 * usize::from(member.is_rules());
        bits += 8 * size * count;
        let name = &member.name;
        let _ = writeln!(
            members,
            "    {{ offsetof(pitch_configuration, {name}), {size}U, {count}U, {code}U, {more}U }},"
        );
    }
    assert_eq!(rules, 3, "kp, ki, kd");
    let real = if size_of::<R>() == 4 { "float" } else { "double" };
    (bits, HARNESS.replace("MEMBERS", members.trim_end()).replace("REAL", real))
}

/// What the harness prints, built with what ends a program that leaves an array, where the compiler has that.
fn turned_over<R: Real>(controller: &Controller<R>, folder: &Path) -> (usize, String) {
    let (bits, main) = harness(controller);
    write_all(controller, Angles::Radians, folder, Some(&main));
    let built = |flags: &[&str]| {
        let mut compiler = Command::new("cc");
        compiler.args(["-std=c99", "-O1", "-ffp-contract=off"]).args(flags);
        let sources = ["pitch.c", "pitch_selftest.c", "main.c", "-o", "main"];
        compiler.args(sources).current_dir(folder).output().expect("the compiler that links Rust")
    };
    let sanitized = built(&["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]);
    if !sanitized.status.success() {
        let plain = built(&[]);
        assert!(plain.status.success(), "{}", String::from_utf8_lossy(&plain.stderr));
    }
    let ran = Command::new(folder.join("main")).output().expect("what was built");
    let [out, error] = [ran.stdout, ran.stderr].map(|it| String::from_utf8_lossy(&it).into_owned());
    (bits, out + &error)
}

fn told<R: Real>(controller: &Controller<R>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (bits, printed) = turned_over(controller, folder.path());
    let expected =
        format!("{bits} flips, 0 told otherwise, 0 steps without a number, the design 0\n");
    assert_eq!(printed, expected);
}

/// The paper's gains around rules that conclude numbers.
fn with_numbers() -> Controller<f64> {
    let number = |cell: usize| 0.1 + 0.003 * ((cell * 37) % 49) as f64;
    let grid = |first: usize| {
        std::array::from_fn(|row| std::array::from_fn(|column| number(first + 7 * row + column)))
    };
    let numbers = NumberTable::new([grid(0), grid(5), grid(11)]).expect("finite");
    let rules = Supervisor::of_numbers(&numbers, 5.0, OutOfRange::Clamp).expect("rules");
    let nominal = Gains { kp: 1.0, ki: 0.5, kd: 0.2 };
    let tuner = SelfTuner::new(nominal, rules, TunerSettings::literal()).expect("a tuner");
    let fspid = Fspid::new(tuner, PidConfig::sampled_every(0.01));
    Controller::SelfTuning(fspid.expect("a controller"))
}

/// A label beyond the last led out of arrays on the stack: of 1176 bits of the tables 12 were told as good, 19 by another
/// code, and 63 ended the program.
#[test]
fn every_bit_of_a_configuration_that_is_turned_over_is_told_by_its_place() {
    told(&paper());
    told(&paper().rounded::<f32>().expect("rounded"));
    told(&with_numbers());
}
