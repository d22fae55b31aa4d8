//! `fspid aircraft qualities`: what an aircraft is worth to a pilot.

use clap::{Args, ValueEnum};

use super::{Answer, Flight};
use crate::exit::Failure;
use fspid_study::aircraft::{self, QualitiesQuestion, qualities};

/// Judge the flying qualities: levels by MIL-F-8785C and MIL-STD-1797A, each with its clause.
///
/// A plant that the program carries, such as b747-paper, is judged at its own condition.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    flight: Flight,
    /// What is being flown.
    #[arg(long, value_enum, ignore_case = true, default_value_t = Category::B)]
    category: Category,
    /// What flies; without it the lateral motion is not judged.
    #[arg(long, value_enum, ignore_case = true)]
    class: Option<Class>,
    /// Bandwidth of the servo in rad/s; 0 for none.
    #[arg(long, value_name = "RAD/S", default_value_t = 10.0, allow_negative_numbers = true)]
    servo: f64,
    /// Dead time between the command and the servo, such as 0.05s or 50ms.
    #[arg(long, value_name = "TIME", default_value = "0s", allow_hyphen_values = true)]
    delay: String,
    #[command(flatten)]
    answer: Answer,
}

/// What is being flown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "UPPER")]
pub(super) enum Category {
    /// Rapid manoeuvres and precise tracking.
    A,
    /// Climb, cruise and descent.
    B,
    /// Take-off, approach and landing.
    C,
}

/// What flies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "UPPER")]
enum Class {
    /// Small and light.
    I,
    /// Medium weight.
    #[value(name = "II")]
    Ii,
    /// Large and heavy.
    #[value(name = "III")]
    Iii,
    /// Highly manoeuvrable.
    #[value(name = "IV")]
    Iv,
}

impl From<Category> for aircraft::Category {
    fn from(category: Category) -> Self {
        match category {
            Category::A => Self::A,
            Category::B => Self::B,
            Category::C => Self::C,
        }
    }
}

impl From<Class> for aircraft::Class {
    fn from(class: Class) -> Self {
        match class {
            Class::I => Self::I,
            Class::Ii => Self::II,
            Class::Iii => Self::III,
            Class::Iv => Self::IV,
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let answer = arguments.answer;
    let question = QualitiesQuestion {
        question: arguments.flight.question(answer.units()),
        category: arguments.category.into(),
        class: arguments.class.map(Into::into),
        servo_rad_s: arguments.servo,
        delay: &arguments.delay,
    };
    let judged = qualities(&question).map_err(Failure::input)?;
    answer.print(|| judged.text(), || judged.json())
}
