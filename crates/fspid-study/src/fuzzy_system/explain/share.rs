//! What each rule has in an answer. Areas and moments of the pieces that belong to a rule add up to
//! those of the whole set, so shares of the area add up to 1 and contributions to the centroid.

use fspid_fuzzy::norm::SNormKind;
use fspid_fuzzy::system::{
    Conclusion, Contribution, Defuzzifier, Output, Piece, SNorm, System, Workspace,
};

/// Cells of the grid for sets that are not piecewise linear.
const CELLS: u32 = 4096;

/// What one conclusion of a rule has in an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Which conclusion.
    pub of: Contribution,
    /// Part of the whole: of the area, or of the weight.
    pub part: f64,
    /// What it adds to the number: the contributions of all rules sum to it. None where the conclusion has no number,
    /// as a formula that divides by zero.
    pub contribution: Option<f64>,
}

/// What the shares rest on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// The pieces of the outline, in closed form.
    Outline,
    /// A grid of so many cells: the sets are not piecewise linear.
    Grid(u32),
    /// The weights of a weighted average or sum.
    Weights,
    /// Nothing: the conclusions are added up or joined by another norm than maximum, so that no
    /// part of the area belongs to one of them alone.
    Aggregated,
}

/// The shares of one output.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// What they rest on.
    pub basis: Basis,
    /// The largest first; none where no rule fires.
    pub list: Vec<Share>,
    /// What the contributions sum to: the centre of gravity or the weighted average.
    pub sum: Option<f64>,
    /// The aggregated set from left to right.
    pub pieces: Vec<Piece>,
}

/// The shares in the last evaluation's answer of an output.
pub(super) fn shares(system: &System, output: usize, workspace: &mut Workspace) -> Shares {
    let contributions = system.contributions(output, workspace);
    let Some(part) = system.parts().outputs.get(output) else {
        return finish(Basis::Aggregated, Vec::new(), Vec::new());
    };
    if part.defuzzifier.sampling().is_none() {
        return finish(Basis::Weights, weights(&contributions, part.defuzzifier), Vec::new());
    }
    let reference = part.universe.map_or(0.0, |universe| universe.middle());
    let (basis, pieces) = match system.outline(output, workspace) {
        Some(joined) => (Basis::Outline, joined.pieces().to_vec()),
        None => (Basis::Grid(CELLS), grid(system, part, &contributions, workspace)),
    };
    if pieces.iter().any(|piece| piece.conclusion.is_none()) {
        return finish(Basis::Aggregated, Vec::new(), pieces);
    }
    finish(basis, areas(&contributions, &pieces, reference), pieces)
}

fn finish(basis: Basis, mut list: Vec<Share>, pieces: Vec<Piece>) -> Shares {
    // No sum where a part of it is no number.
    let sum = list.iter().map(|share| share.contribution).sum::<Option<f64>>();
    let sum = sum.filter(|_| !list.is_empty());
    list.sort_by(|a, b| b.part.total_cmp(&a.part).then(b.of.degree.total_cmp(&a.of.degree)));
    Shares { basis, list, sum, pieces }
}

fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}

/// $w_i / \sum w$ and $w_i z_i / \sum w$, or without the division for a weighted sum.
fn weights(contributions: &[Contribution], method: Defuzzifier) -> Vec<Share> {
    let fires = contributions.iter().filter(|c| c.degree > 0.0);
    let total: f64 = fires.clone().map(|c| c.degree).sum();
    let divisor = if matches!(method, Defuzzifier::WeightedAverage(_)) { total } else { 1.0 };
    let share = |of: &Contribution| Share {
        of: *of,
        part: of.degree / total,
        contribution: finite(of.degree * of.value.unwrap_or(0.0) / divisor),
    };
    fires.map(share).collect()
}

/// $A_i / A$ and $(r A_i + M_i) / A$ with the moments $M_i$ about the reference $r$.
fn areas(contributions: &[Contribution], pieces: &[Piece], reference: f64) -> Vec<Share> {
    let total: f64 = pieces.iter().map(Piece::area).sum();
    if !(total > 0.0) {
        return Vec::new();
    }
    let share = |of: &Contribution| {
        let own = pieces.iter().filter(|piece| piece.conclusion == Some(of.conclusion));
        let area: f64 = own.clone().map(Piece::area).sum();
        let moment: f64 = own.map(|piece| piece.moment(reference)).sum();
        let contribution = finite((reference * area + moment) / total);
        Share { of: *of, part: area / total, contribution }
    };
    contributions.iter().filter(|c| c.degree > 0.0).map(share).collect()
}

/// The aggregated set as level pieces on a grid; each belongs to the highest conclusion there.
fn grid(
    system: &System,
    output: &Output,
    contributions: &[Contribution],
    workspace: &Workspace,
) -> Vec<Piece> {
    let Some(universe) = output.universe else { return Vec::new() };
    let is_highest = matches!(output.aggregation, SNorm::Kind(SNormKind::Maximum));
    let inputs = workspace.variables();
    let mut room = vec![0.0; room(output).max(inputs.len() + 1)];
    let at = |n: u32| universe.lower + universe.span() * (f64::from(n) / f64::from(CELLS));
    let mut pieces: Vec<Piece> = Vec::new();
    for cell in 0..CELLS {
        let x = [at(cell), at(cell + 1)];
        let middle = 0.5 * x[0] + 0.5 * x[1];
        let mut joined = (0.0_f64, None);
        for found in contributions.iter().filter(|c| c.degree > 0.0) {
            let grade = concluded(system, output, found, (middle, inputs), &mut room);
            if !is_highest {
                joined = (output.aggregation.apply(joined.0, grade), None);
            } else if grade > joined.0 {
                joined = (grade, Some(found.conclusion));
            }
        }
        if joined.0 > 0.0 {
            pieces.push(Piece { x, grade: [joined.0; 2], conclusion: joined.1, cut: false });
        }
    }
    pieces
}

/// Grade of a conclusion, as its rule's strength shapes it.
fn concluded(
    system: &System,
    output: &Output,
    found: &Contribution,
    (x, inputs): (f64, &[f64]),
    room: &mut [f64],
) -> f64 {
    let (term, block) = (output.terms.get(found.term), system.parts().blocks.get(found.origin[0]));
    match (term.map(|term| &term.conclusion), block) {
        (Some(Conclusion::Set { membership, .. }), Some(block)) => {
            block.implication.apply(found.degree, membership.grade(x, inputs, room))
        }
        _ => 0.0,
    }
}

/// The most parameters of a set of the output.
fn room(output: &Output) -> usize {
    let parameters = output.terms.iter().map(|term| match &term.conclusion {
        Conclusion::Set {
            membership: fspid_fuzzy::system::Membership::Shape { params, .. },
            ..
        } => params.len(),
        _ => 0,
    });
    parameters.max().unwrap_or(0)
}
