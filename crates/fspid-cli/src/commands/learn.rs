//! `fspid learn`: the numbers of a fuzzy system, from data.

use clap::{ArgGroup, Args, ValueEnum};

use super::{Format, Loading, interrupt, json_text};
use crate::argument::{InFile, OutFile, Source, count, is_standard, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_scenario::count as counts;
use fspid_scenario::fuzzy_system;
use fspid_scenario::fuzzy_system::{NUMBER_GRID, Parts, Target};
use fspid_study::output;
use fspid_tune::anfis::{Data, Learned, Order, Plan, learn, sugeno};

/// Learn a fuzzy system from data: what rules conclude by least squares, where their sets lie by gradient descent (ANFIS).
///
/// The system must be one of Takagi and Sugeno, of order 0 or 1; --conclude makes one of any other.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("teaching").required(true).args(["data", "teacher"]))]
pub(crate) struct Arguments {
    /// A file (.toml, .fis, .t2fis, .fcl, .fll, .xml), a scenario for its supervisor, or `printed`, `mirrored` or `sugeno-grid` with --range.
    system: Source,
    #[command(flatten)]
    loading: Loading,
    /// A CSV file with a column for each input and each output, found by their names.
    #[arg(long, value_name = "FILE.csv")]
    data: Option<InFile>,
    /// In place of data: a system whose answers are to be learned, named as SYSTEM is.
    #[arg(long, value_name = "SYSTEM", requires = "points")]
    teacher: Option<Source>,
    /// How many points the grid has along each input of the teacher, such as `15,15`.
    #[arg(long, value_name = "N,N", value_delimiter = ',', requires = "teacher", value_parser = count::<usize>(&counts::TAUGHT_POINTS))]
    points: Vec<usize>,
    /// Give every rule a conclusion of its own in place of those of the file.
    #[arg(long, value_enum, value_name = "WHAT")]
    conclude: Option<Conclude>,
    /// The new file: .toml (everything can be said), .fis, .t2fis, .fcl, .fll or .xml.
    #[arg(value_parser = written(&["toml", "fis", "t2fis", "fcl", "fll", "xml"]), long, value_name = "OUT")]
    out: OutFile,
    /// Most epochs.
    #[arg(long, default_value_t = Plan::default().epochs, value_parser = count::<usize>(&counts::EPOCHS))]
    epochs: usize,
    /// Length of the first step of the sets, in spans of their inputs.
    #[arg(long, default_value_t = Plan::default().step)]
    step: f64,
    /// Learn conclusions only; the sets stay where they are.
    #[arg(long)]
    sets_stay: bool,
    /// Share of the rows that only judge; the best system by them is kept.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    validate: f64,
    /// Seed of the choice of those rows.
    #[arg(long, default_value_t = Plan::default().seed)]
    seed: u64,
    /// Ends after so many epochs without a better error of those rows.
    #[arg(long, default_value_t = Plan::default().patience, value_parser = count::<usize>(&counts::PATIENCE))]
    patience: usize,
    /// How the errors are told.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// What a rule concludes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Conclude {
    /// A number (order 0).
    Constant,
    /// A linear function of the inputs (order 1).
    Linear,
}

impl From<Conclude> for Order {
    fn from(conclude: Conclude) -> Self {
        match conclude {
            Conclude::Constant => Self::Zero,
            Conclude::Linear => Self::One,
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (system, teacher) = match &arguments.teacher {
        None => (arguments.loading.load(&arguments.system)?, None),
        Some(teacher) => {
            let [system, teacher] = arguments.loading.load_both([&arguments.system, teacher])?;
            (system, Some(teacher))
        }
    };
    let parts = match arguments.conclude {
        Some(conclude) => sugeno(system.parts(), conclude.into()),
        None => system.parts().clone(),
    };
    let data = match (&arguments.data, &teacher) {
        (Some(path), _) => Data::load(&parts, path),
        (None, Some(teacher)) => {
            same_names(&parts, teacher.parts())?;
            Data::taught(teacher.parts(), &arguments.points)
        }
        (None, None) => Ok(Data::new(parts.inputs.len(), parts.outputs.len())),
    };
    let plan = Plan {
        epochs: arguments.epochs,
        premises: !arguments.sets_stay,
        step: arguments.step,
        validation_share: arguments.validate,
        seed: arguments.seed,
        patience: arguments.patience,
        ..Plan::default()
    };
    interrupt::ends_with(
        "interrupted; nothing is written, and the same command learns from the beginning"
            .to_owned(),
    );
    let learned = learn(&parts, &data.map_err(Failure::input)?, &plan).map_err(Failure::input)?;
    let out = &arguments.out;
    // Everything can be said in our own format.
    let format = is_standard(out).then_some(fuzzy_system::Format::Toml);
    let target = Target { format, ..Target::default() };
    let written = fuzzy_system::write_as(&learned.parts, out, target);
    output::write(&arguments.out, &written.map_err(Failure::input)?.text)?;
    wrote(&arguments.out);
    tell(arguments, &learned)
}

/// What was learned, and whether it flies.
fn tell(arguments: &Arguments, learned: &Learned) -> Result<(), Failure> {
    let numbers = fuzzy_system::numbers_of(&learned.parts);
    if let (true, Err(differences)) = (&*arguments.system == NUMBER_GRID, &numbers) {
        let first = differences.first().map_or("", String::as_str);
        note(format_args!("warning: it does not fly: {first}; --sets-stay keeps the sets"));
    }
    let beyond = numbers.as_ref().map_or(Vec::new(), |numbers| numbers.beyond(numbers.range));
    for what in &beyond {
        note(format_args!(
            "warning: a scenario refuses it: {what}; teach smaller answers and let `output_scale` make them larger"
        ));
    }
    match arguments.format {
        Format::Text => {
            let heading = match beyond.is_empty() {
                true => "It flies as `system` of a supervisor, or with its numbers, here rounded:",
                false => "Its numbers, here rounded; a scenario refuses those beyond the range:",
            };
            let numbers = numbers
                .map_or(String::new(), |numbers| format!("\n{heading}\n\n{}", numbers.toml()));
            print(&format!("{}{numbers}", learned.text()))
        }
        Format::Json => {
            let mut answer = learned.json();
            if let Ok(numbers) = numbers {
                answer["numbers"] = numbers.json();
            }
            print(&json_text(&answer))
        }
    }
}

/// Answers of a teacher are learned by position, so that its variables must be those of the system.
fn same_names(parts: &Parts, teacher: &Parts) -> Result<(), Failure> {
    let names = |parts: &Parts| {
        let inputs = parts.inputs.iter().map(|input| input.name.as_str());
        let outputs = parts.outputs.iter().map(|output| output.name.as_str());
        inputs.chain(outputs).collect::<Vec<_>>().join(", ")
    };
    let (own, taught) = (names(parts), names(teacher));
    if own == taught {
        return Ok(());
    }
    Err(Failure::input(format!("the teacher has {taught}; the system has {own}")))
}
