//! From a controller to its program.

pub(crate) mod exponential;
mod infer;
pub(crate) mod members;
mod observe;
pub(crate) mod prune;
mod step;

pub(crate) use infer::GAINS;
pub(crate) use infer::centroid;

use fspid_core::fuzzy::Defuzzifier;
use fspid_numeric::Real;

use crate::program::{Precision, Program};
use fspid_core::Controller;

pub(crate) use observe::{STRENGTHS, observed};

/// The unit of the angles that go in and come out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Angles {
    /// Radians.
    #[default]
    Radians,
    /// Degrees.
    Degrees,
}

/// What cannot be exported.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// A rule for the centre of gravity whose number of steps depends on the inputs.
    #[error(
        "the defuzzifier {0} takes a number of steps that depends on the inputs, which --to rust alone can write; allowed are exact, endpoints:N, midpoint:N, trapezoid:N, left-end:N"
    )]
    Defuzzifier(Defuzzifier),
    /// A fuzzy system of its own, where a target is of controllers alone.
    #[error("this target is written of controllers alone; --to c writes a fuzzy system")]
    NoController,
    /// What would make a page too large.
    #[error("a page does not write this; `fspid export` does")]
    NotInPages,
    /// Nothing that a table could be of.
    #[error(
        "it has no supervisor, so that there is no surface to write as a table; allowed is a self-tuning controller"
    )]
    NoSupervisor,
    /// Settings that do not survive rounding.
    #[error("its settings do not survive rounding to 32 bits, which tables have")]
    NotSingle,
    /// No table over the range has what lies beyond it.
    #[error(
        "its rules are evaluated beyond their range, where no table ends; out_of_range = \"clamp\" or \"error\" has one"
    )]
    BeyondRange,
    /// A surface that no bound of a table is known for.
    #[error(
        "its supervisor is a network, for which no bound of a table is proved; --to c, rust, st or lua writes the network itself, which is smaller than a table"
    )]
    Network,
    /// A name that is too long for a language.
    #[error(
        "its name is too long for functions of MATLAB; allowed are {most} letters, and --prefix NAME gives another"
    )]
    LongName {
        /// Letters that are possible.
        most: usize,
    },
    /// Points that would miss the centres of sets.
    #[error(
        "{found} points along an input; allowed are 6m + 1 from 7 to 127, which keep the centres of the sets"
    )]
    Points {
        /// What was asked for.
        found: usize,
    },
}

/// The precision that a number type is.
#[must_use]
pub fn precision_of<R: Real>() -> Precision {
    if R::MIN_POSITIVE.to_f64() > 1e-100 { Precision::Single } else { Precision::Double }
}

/// The program of a controller: the same answers to the same samples, bit for bit.
///
/// # Errors
/// [`Refusal`] for what no program of a bounded number of steps can do.
pub fn program<R: Real>(controller: &Controller<R>, angles: Angles) -> Result<Program, Refusal> {
    let mut configuration = members::Configuration::default();
    let mut functions = Vec::new();
    if let Controller::SelfTuning(fspid) = controller {
        functions.extend(infer::functions(&mut configuration, fspid.tuner())?);
    }
    functions.extend(step::functions(&mut configuration, controller, angles));
    let mut program = Program {
        configuration: configuration.members(),
        functions,
        ..outline(controller, angles)
    };
    prune::prune(&mut program);
    Ok(program)
}

/// What goes in and comes out alone, for a target whose operations are those of `fspid-core` itself.
pub(crate) fn outline<R: Real>(controller: &Controller<R>, angles: Angles) -> Program {
    Program {
        precision: precision_of::<R>(),
        configuration: Vec::new(),
        state: step::state(controller),
        sample: step::sample(controller, angles),
        answer: step::answer(angles),
        functions: Vec::new(),
    }
}
