//! From a fuzzy system to its program: inputs by name, outputs by name, the bits of `fspid-fuzzy`.
//!
//! Shapes, norms and hedges are asked of their equations (`library`). What has loops or branches there is composed by
//! hand, each part next to a reference to the module that it follows: `firing` and `activation` after `system/firing.rs`,
//! `outputs` after `system/evaluate.rs`, `polygon` after `system/output/outline`, `sampled` after `system/output/sampled`.

mod activation;
mod export;
mod firing;
mod library;
mod names;
mod outputs;
mod polygon;
mod reading;
mod root;
mod sampled;
mod vectors;

use fspid_fuzzy::system::System;
use fspid_numeric::Real;

use crate::compose::{members::Configuration, precision_of, prune};
use crate::program::{
    Expression, Function, Member, Part, Program, Statement, Value, element, whole,
};
pub use export::{SystemRequest, export_system};
use library::Library;
pub use names::Names;
pub use vectors::{NOT_FINITE, OUT_OF_RANGE, source_code, system_vectors};

/// What of a fuzzy system cannot be exported, and what would make it possible.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {problem}; {possible}")]
pub struct SystemRefusal {
    /// Where it stands.
    pub place: String,
    /// What it is.
    pub problem: String,
    /// What would make it possible.
    pub possible: String,
}

/// What a part of a system asks for and no program has.
#[derive(Clone, Debug, PartialEq)]
enum Trouble {
    /// A function of the platform.
    Foreign(&'static str),
    /// A norm that is a formula.
    Formula,
    /// What asks, and for what.
    Asks(String, &'static str),
    /// A sentence of its own.
    Said(&'static str, &'static str),
}

impl Trouble {
    /// Names who asks.
    fn of(self, what: &str, name: &str) -> Self {
        match self {
            Self::Foreign(function) => Self::Asks(format!("{what} `{name}`"), function),
            other => other,
        }
    }

    /// The refusal, with its place.
    fn at(self, place: impl Into<String>) -> SystemRefusal {
        let (problem, possible) = match self {
            Self::Foreign(function) => (format!("it asks for `{function}`"), PLATFORM),
            Self::Asks(who, function) => (format!("{who} asks for `{function}`"), PLATFORM),
            Self::Formula => ("a norm that is a formula cannot be exported".to_owned(), FAMILY),
            Self::Said(problem, possible) => (problem.to_owned(), possible),
        };
        SystemRefusal { place: place.into(), problem, possible: possible.to_owned() }
    }
}

const PLATFORM: &str = "that differs in its last bits from machine to machine; possible is a shape of sums, products, \
                        roots and exponentials, such as triangle, gaussian or semi-ellipse";
const FAMILY: &str =
    "possible is a norm of the family, such as minimum, maximum or algebraic-product";

/// A fuzzy system as a program, and what has been chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemProgram {
    /// Its one function that others call is `infer`.
    pub program: Program,
    /// How inputs and outputs are called in it.
    pub names: Names,
    /// Which way each output is computed, and why.
    pub ways: Vec<String>,
}

/// What is being composed.
struct Composer<'a, R> {
    system: &'a System,
    names: Names,
    configuration: Configuration,
    /// What members of the configuration are for, and their names.
    members: Vec<[String; 2]>,
    library: Library,
    /// Rules that are switched on.
    fired: Vec<firing::Fired>,
    /// Statements about inputs in these rules, each once.
    conditions: Vec<fspid_fuzzy::system::Statement>,
    /// Of all conclusions of these rules, in their order: rule, output and term.
    conclusions: Vec<[usize; 3]>,
    /// True if some rule asks about an output.
    chained: bool,
    /// How many operands of antecedents have names.
    operands: usize,
    /// How much room outlines need.
    room: polygon::Room,
    /// What `infer` does.
    body: Vec<Statement>,
    precision: std::marker::PhantomData<R>,
}

/// The program of a fuzzy system: with numbers of 64 bits the answers of `fspid-fuzzy`, bit for bit; with those of 32 bits
/// the same operations rounded to 32 bits.
///
/// # Errors
/// [`SystemRefusal`] with what would make it possible.
pub fn system_program<R: Real>(system: &System) -> Result<SystemProgram, SystemRefusal> {
    let rules = firing::Rules::of(system.parts());
    let mut composer = Composer::<R> {
        system,
        members: Vec::new(),
        fired: rules.fired,
        conditions: rules.conditions,
        conclusions: rules.conclusions,
        chained: rules.chained,
        operands: 0,
        room: polygon::Room::default(),
        names: Names::of(system.parts()),
        configuration: Configuration::default(),
        library: Library::default(),
        body: Vec::new(),
        precision: std::marker::PhantomData,
    };
    composer.refuse_what_has_no_program()?;
    composer.inputs();
    composer.grades()?;
    composer.rules()?;
    let ways = composer.outputs()?;
    Ok(composer.finished(ways))
}

const ENTRY: &[Part] = &[Part::Configuration, Part::Sample, Part::Answer];
const ENTRY_WITH_STATE: &[Part] = &[Part::Configuration, Part::State, Part::Sample, Part::Answer];
const ENTRY_WITHOUT_CONFIGURATION: &[Part] = &[Part::Sample, Part::Answer];

/// The name of the state's member that says whether there was an answer.
fn known(output: &str) -> String {
    format!("{output}_known")
}

/// The function that forgets the previous answers.
fn reset(state: &[Member]) -> Function {
    let begin = |it: &Member| {
        let value = match it.value {
            Value::Truth(value) => Expression::Truth(value),
            _ => crate::program::number(0.0),
        };
        Statement::set_member(Part::State, &it.name, value)
    };
    Function {
        name: "reset",
        doc: "Forgets the previous answers.",
        parts: &[Part::State],
        parameters: Vec::new(),
        answers: None,
        body: state.iter().map(begin).collect(),
    }
}

impl<R: Real> Composer<'_, R> {
    /// The name of the configuration's member that is there for something: the wanted one if it is free.
    fn member(&mut self, purpose: &str, wanted: &str) -> String {
        if let Some([_, name]) = self.members.iter().find(|[known, _]| known == purpose) {
            return name.clone();
        }
        let mut taken = self.members.iter().map(|[_, name]| name.clone()).collect();
        let name = names::unique(wanted, &mut taken);
        self.members.push([purpose.to_owned(), name.clone()]);
        name
    }

    /// The name of an output's term.
    fn term_name(&mut self, output: usize, term: usize) -> String {
        let found = self.system.parts().outputs.get(output).and_then(|it| it.terms.get(term));
        let wanted = found.map_or_else(String::new, |it| it.name.clone());
        let wanted = format!("{}_{wanted}", self.names.outputs[output]);
        self.member(&format!("output {output} term {term}"), &wanted)
    }

    fn finished(self, ways: Vec<String>) -> SystemProgram {
        let Self { system, names, configuration, mut library, body, .. } = self;
        library.helpers::<R>(&body);
        let mut functions = library.functions;
        let state = remembered(system, &names);
        if !state.is_empty() {
            functions.push(reset(&state));
        }
        functions.push(Function {
            name: "infer",
            doc: "The outputs at these inputs, and for each of them where its value comes from.",
            parts: if state.is_empty() { ENTRY } else { ENTRY_WITH_STATE },
            parameters: Vec::new(),
            answers: None,
            body,
        });
        let parts = system.parts();
        let input = |(input, name): (&fspid_fuzzy::system::Input, &String)| {
            member(name, sentence("Input", &input.name, &input.description), Value::Real(0.0))
        };
        let mut answer = Vec::new();
        for (output, name) in parts.outputs.iter().zip(&names.outputs) {
            let doc = sentence("Output", &output.name, &output.description);
            answer.push(member(name, doc, Value::Real(0.0)));
        }
        for (output, name) in parts.outputs.iter().zip(&names.sources) {
            let doc = format!("Where {} comes from: {SOURCES}.", clean(&output.name));
            answer.push(member(name, doc, Value::Byte(0)));
        }
        answer.push(member(&names.faults, FAULTS.to_owned(), Value::Byte(0)));
        let mut program = Program {
            precision: precision_of::<R>(),
            configuration: configuration.members(),
            state,
            sample: parts.inputs.iter().zip(&names.inputs).map(input).collect(),
            answer,
            functions,
        };
        let mut before = usize::MAX;
        while let Some(entry) = program.functions.last_mut()
            && prune::statements(&entry.body) < before
        {
            before = prune::statements(&entry.body);
            prune::remove_unread_arrays(&mut entry.body);
            prune::prune(&mut program);
        }
        prune::remove_uncalled(&mut program, &["reset", "infer"]);
        if program.configuration.is_empty()
            && program.state.is_empty()
            && let Some(entry) = program.functions.last_mut()
        {
            entry.parts = ENTRY_WITHOUT_CONFIGURATION;
        }
        SystemProgram { program, names, ways }
    }
}

/// What is remembered of outputs that keep their previous answers.
fn remembered(system: &System, names: &Names) -> Vec<Member> {
    let remembering = system.parts().outputs.iter().zip(&names.outputs);
    let remembering = remembering.filter(|(output, _)| output.fallback.previous);
    let both = |(_, name): (&fspid_fuzzy::system::Output, &String)| {
        let value = member(name, format!("The previous answer of {name}."), Value::Real(0.0));
        let doc = format!("There is a previous answer of {name}.");
        [value, member(&known(name), doc, Value::Truth(false))]
    };
    remembering.flat_map(both).collect()
}

const SOURCES: &str = "0 there is none, 1 the rules, 2 the middle of the range, 3 the default, 4 the previous \
                       answer";
const FAULTS: &str = "What is wrong with the inputs, as bits: 1 one is not finite, 2 one is outside of a range that may \
                      not be left; then there is no value.";

fn member(name: &str, doc: String, value: Value) -> Member {
    Member { name: name.to_owned(), doc, value }
}

/// What a variable is, in a line that no comment ends.
fn sentence(kind: &str, name: &str, description: &str) -> String {
    match description {
        "" => format!("{kind} {}.", clean(name)),
        more => format!("{kind} {}: {}.", clean(name), clean(more.trim_end_matches('.'))),
    }
}

/// A text that no comment ends with.
fn clean(text: &str) -> String {
    text.replace(['*', '/', '\n', '\r', '\\'], " ")
}

/// A value of an array at a place that is known.
fn at(array: &str, index: usize) -> Expression {
    element(array, index_of(index))
}

fn put(array: &str, index: usize, value: Expression) -> Statement {
    Statement::set_element(array, index_of(index), value)
}

fn index_of(index: usize) -> Expression {
    whole(i32::try_from(index).unwrap_or(i32::MAX))
}

fn count_of(count: usize) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX)
}
