//! Where a system's answers may jump: there, slopes say nothing.

use alloc::vec;
use alloc::vec::Vec;

use crate::formula::Formula;
use crate::norm::{SNormKind, TNormKind};
use crate::system::{Membership, RuleBlock, SNorm, Statement, System, TNorm, Variable};
use fspid_numeric::scalar::Interval;

/// A shape that changes by more than this across a corner is taken to jump there.
const JUMP: f64 = 1e-6;
/// Where a statement's grade may jump.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Jumps {
    /// At these values of its input only.
    At(Vec<f64>),
    /// Anywhere, and the grade may be 0 for want of a value.
    Anywhere,
}

/// Where a system's firing strengths may jump.
#[derive(Clone, Debug)]
pub(super) struct Continuity {
    /// For each statement of the program.
    pub(super) statements: Vec<Jumps>,
    /// For each block whether its *and* and *or* are continuous.
    pub(super) blocks: Vec<bool>,
}

impl Continuity {
    pub(super) fn of(system: &System) -> Self {
        let statements = system.program.statements.iter();
        let blocks = system.parts.blocks.iter();
        Self {
            statements: statements.map(|statement| jumps(system, statement)).collect(),
            blocks: blocks.map(joins_continuously).collect(),
        }
    }
}

fn joins_continuously(block: &RuleBlock) -> bool {
    let and = match &block.and {
        TNorm::Kind(kind) => {
            !matches!(kind, TNormKind::DrasticProduct | TNormKind::NilpotentMinimum)
        }
        TNorm::Formula(formula) => joins_everywhere(formula),
    };
    and && continuous_join(&block.or)
}

/// True if a joining of conclusions cannot jump.
pub(super) fn continuous_join(norm: &SNorm) -> bool {
    match norm {
        SNorm::Kind(kind) => !matches!(kind, SNormKind::DrasticSum | SNormKind::NilpotentMaximum),
        SNorm::Formula(formula) => joins_everywhere(formula),
    }
}

/// True if a formula joins any two grades, and cannot jump.
fn joins_everywhere(formula: &Formula) -> bool {
    formula.is_continuous() && formula.has_value(&[Interval::UNIT; 2])
}

fn jumps(system: &System, statement: &Statement) -> Jumps {
    let Variable::Input(input) = statement.variable else { return Jumps::Anywhere };
    let term = statement.term.and_then(|term| system.parts.inputs.get(input)?.terms.get(term));
    // The bare `any` is 1 everywhere.
    let Some(term) = term else { return Jumps::At(Vec::new()) };
    jumps_of(&term.membership)
}

/// Where a membership function may jump.
pub(super) fn jumps_of(membership: &Membership) -> Jumps {
    let (kind, params) = match membership {
        Membership::Shape { kind, params, .. } => (kind, params),
        Membership::Formula { formula, .. } if formula.is_continuous() => {
            return Jumps::At(Vec::new());
        }
        Membership::Formula { .. } => return Jumps::Anywhere,
    };
    let mut places = vec![];
    kind.corners(params, &mut |corner| {
        let nearby = 1e-9 * (1.0 + corner.abs());
        let grades = [corner - nearby, corner, corner + nearby].map(|x| kind.grade(params, x));
        let [before, at, after]: [f64; 3] = grades;
        let level = (before - at).abs() <= JUMP && (after - at).abs() <= JUMP;
        if !level {
            places.push(corner);
        }
    });
    // Two corners in one place are a jump, however low.
    let mut last = None;
    kind.vertices(params, &mut |vertex| {
        if last.is_some_and(|before: f64| before >= vertex.x) {
            places.push(vertex.x);
        }
        last = Some(vertex.x);
    });
    Jumps::At(places)
}
