//! What build systems want beside the C: CMake, PlatformIO, and a sketch for Arduino.

use super::{Heading, Page};
use crate::compose::Angles;
use crate::program::{Part, Precision, Program, Value};

/// `CMakeLists.txt`: a library, and the check where it is the whole project.
#[must_use]
pub fn cmake(prefix: &str) -> String {
    CMAKE.replace("PREFIX", prefix)
}

const CMAKE: &str = "\
cmake_minimum_required(VERSION 3.13)
project(PREFIX C)

add_library(PREFIX STATIC PREFIX.c)
target_include_directories(PREFIX PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
set_target_properties(PREFIX PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
# Products and sums are rounded one by one.
if(CMAKE_C_COMPILER_ID MATCHES \"GNU|Clang\")
  target_compile_options(PREFIX PRIVATE -ffp-contract=off)
endif()

# The vectors, where this is not a part of another project: ctest runs them.
if(CMAKE_SOURCE_DIR STREQUAL CMAKE_CURRENT_SOURCE_DIR)
  enable_testing()
  add_executable(PREFIX_check PREFIX_check.c)
  set_target_properties(PREFIX_check PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON)
  target_link_libraries(PREFIX_check PRIVATE PREFIX)
  add_test(NAME PREFIX_check COMMAND PREFIX_check)
endif()
";

/// `library.json` of PlatformIO.
#[must_use]
pub fn platformio(prefix: &str, precision: Precision) -> String {
    let platforms = match precision {
        Precision::Single => "\"*\"".to_owned(),
        Precision::Double => {
            format!("[{}]", DOUBLE_HAS_64_BITS.map(|name| format!("\"{name}\"")).join(", "))
        }
    };
    PLATFORMIO
        .replace("PREFIX", prefix)
        .replace("VERSION", env!("CARGO_PKG_VERSION"))
        .replace("PLATFORMS", &platforms)
}

/// Platforms of PlatformIO by their names there; not `atmelavr`, `atmelmegaavr` and others whose double may have 32 bits.
const DOUBLE_HAS_64_BITS: [&str; 14] = [
    "atmelsam",
    "espressif32",
    "espressif8266",
    "freescalekinetis",
    "linux_arm",
    "linux_x86_64",
    "native",
    "nordicnrf52",
    "nxpimxrt",
    "nxplpc",
    "raspberrypi",
    "sifive",
    "ststm32",
    "titiva",
];

const PLATFORMIO: &str = "\
{
  \"name\": \"PREFIX\",
  \"version\": \"VERSION\",
  \"description\": \"A controller that fspid has written\",
  \"frameworks\": \"*\",
  \"platforms\": PLATFORMS,
  \"headers\": \"PREFIX.h\",
  \"build\": {
    \"srcDir\": \".\",
    \"includeDir\": \".\",
    \"srcFilter\": [\"-<*>\", \"+<PREFIX.c>\"],
    \"flags\": [\"-ffp-contract=off\"]
  }
}
";

/// A sketch for Arduino that flies the controller with voltages; nothing for what has no angles.
#[must_use]
pub fn sketch(program: &Program, prefix: &str, heading: &Heading<'_>) -> Option<String> {
    let angles = heading.angles?;
    let (real, numbers) = match heading.precision {
        Precision::Single => {
            ("float", "Its numbers have 32 bits, on boards with an AVR as elsewhere.")
        }
        Precision::Double => (
            "double",
            "Its numbers have 64 bits: for boards whose double has 32, such as those with an AVR, export it with --numbers single.",
        ),
    };
    // What 5 V is in the unit of the angles: 30 degrees of pitch, 60 degrees a second.
    let (unit, pitch, rate) = match angles {
        Angles::Radians => ("rad", "0.5235988", "1.0471976"),
        Angles::Degrees => ("deg", "30.0", "60.0"),
    };
    let period = program.configuration.iter().find(|member| member.name == "dt_s");
    let period_us = match period.map(|member| &member.value) {
        Some(Value::Real(dt_s)) => libm::round(dt_s * 1e6),
        _ => return None,
    };
    let mut page = Page::default();
    for line in heading.lines() {
        page.line(&format!("// {line}"));
    }
    let pins = ["A0", "A1", "A2"];
    let mut reads = String::new();
    for (member, pin) in program.members(Part::Sample).iter().zip(pins) {
        let full = if member.name.starts_with("rate") { rate } else { pitch };
        reads += &format!("    sample.{} = angle({pin}, {full});\n", member.name);
    }
    let text = SKETCH
        .replace("READS\n", &reads)
        .replace("PREFIX", prefix)
        .replace("NUMBERS", numbers)
        .replace("REAL", real)
        .replace("UNIT", unit)
        .replace("PITCH", pitch)
        .replace("MICROSECONDS", &format!("{period_us}"));
    page.text.push_str(&text);
    Some(page.text)
}

const SKETCH: &str = "\
//
// An example: copy PREFIX.h and PREFIX.c beside this sketch. Set-point, pitch and pitch rate come as voltages at A0, A1 and
// A2 (0 to 5 V from the least to the largest angle), the command leaves as pulses at pin 9. Put your sensors and your servo
// in their places.
// NUMBERS
#include \"PREFIX.h\"

static_assert(sizeof(REAL) == sizeof(((PREFIX_configuration *)0)->dt_s), \"one kind of number\");

static const uint32_t PERIOD_US = MICROSECONDSUL;
static const uint8_t SERVO_PIN = 9;
static PREFIX_state state;
static uint32_t next_us;

// An angle from a voltage: a full scale of 1023 steps.
static REAL angle(uint8_t pin, REAL largest)
{
    return ((REAL)analogRead(pin) - (REAL)511.5) / (REAL)511.5 * largest;
}

void setup()
{
    pinMode(SERVO_PIN, OUTPUT);
    PREFIX_reset(&PREFIX_design, &state);
    next_us = micros();
}

void loop()
{
    // The next sample is a period behind the one before, however long the last took.
    if ((int32_t)(micros() - next_us) < 0) {
        return;
    }
    next_us += PERIOD_US;
    PREFIX_sample sample;
    PREFIX_answer answer;
READS
    PREFIX_step(&PREFIX_design, &state, &sample, &answer);
    REAL pulse = (REAL)127.5 + answer.command_UNIT / (REAL)PITCH * (REAL)127.5;
    pulse = pulse < (REAL)0 ? (REAL)0 : (pulse > (REAL)255 ? (REAL)255 : pulse);
    analogWrite(SERVO_PIN, (int)pulse);
}
";
