//! Lyapunov functions $V(z) = z^T P(\kappa) z$ that move with the gains of a loop.
//!
//! Gains are counted in half widths of a box, $\kappa_j \in [-1, 1]$; loop and form are affine in them,
//! with $\kappa_0 = 1$:
//!
//! $$ M(\kappa) = \sum_a \kappa_a M_a, \quad P(\kappa) = \sum_a \kappa_a P_a $$
//!
//! In a cell of the box the decrease is a polynomial of degree 3 in each gain, and so a mean, with weights
//! that are not negative, of $4^g$ symmetric matrices, its Bernstein coefficients. A cell in which not
//! all of them are positive definite is halved. That P is positive definite is proved at the corners of
//! each cell; between them it is a mean.
//!
//! # Source
//! J. Garloff, *The Bernstein algorithm*, Interval Computations 2 (1993) 154.

use fspid_lti::{LtiError, Matrix};
use fspid_numeric::scalar::Interval;

use super::definite::{basis, form, symmetric};
use super::error::NotProved;
use super::exponential::require_bounded;
use super::matrix::IntervalMatrix;
use super::packed::Packed;
use crate::caps::MOST_WORK;

/// Most gains that may move.
const GAINS: usize = 3;
/// Ends of cells are multiples of one over this, $2^{12}$, so that what [`weights`] computes of them is
/// exact.
const GRID: f64 = 4096.0;
/// A cell that is no wider, in half widths of the box, is not halved any more: the form does not decrease there.
const NARROWEST: f64 = 1.0 / 64.0;
/// Cells looked at before giving up; fewer where the loop is large, so that work has a bound.
const MOST_CELLS: u64 = 20_000;
/// Coefficients along each gain.
const ALONG: usize = 4;
const WHAT: &str = "fall of the moving form";

/// A loop and a form that are affine in gains, and how the gains move.
#[derive(Clone, Copy, Debug)]
pub struct Moving<'a> {
    /// $M_0$, then $M_j$ for each gain: the loop at the centre of the box, and what each half width adds.
    pub loops: &'a [IntervalMatrix],
    /// $P_0$, then $P_j$ for each gain.
    pub forms: &'a [Matrix],
    /// Largest change $d_j$ of each gain in a sample, in half widths; 1 or more for a gain that jumps.
    pub changes: &'a [f64],
    /// ρ, from 0 to 1.
    pub rate: f64,
}

/// Lower and upper end of each gain of a cell, in half widths of the box.
pub type Ends = Vec<[f64; 2]>;

/// What a proof took.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingProof {
    /// Cells that together hold all gains that were asked for, with what they are in half widths.
    pub cells: Vec<Ends>,
    /// Matrices that were proved to be positive definite.
    pub inequalities: usize,
}

/// Gains at which a moving form was not proved to decrease.
#[derive(Clone, Debug, PartialEq)]
pub struct NotProvedAt {
    /// The middle of the cell in question, in half widths; empty where it is not about gains.
    pub gains: Vec<f64>,
    /// What was found.
    pub reason: NotProved,
}

impl From<NotProved> for NotProvedAt {
    fn from(reason: NotProved) -> Self {
        Self { gains: Vec::new(), reason }
    }
}

impl From<LtiError> for NotProvedAt {
    fn from(reason: LtiError) -> Self {
        NotProved::from(reason).into()
    }
}

/// Proves that V decreases by the factor `rate`² at least with every sample, for all gains of a set and
/// every motion within it in which no gain changes by more than is allowed:
///
/// $$ \rho^2 P(\kappa) - M(\kappa)^T P(\kappa^+) M(\kappa) \succ 0, \quad P(\kappa) \succ 0, \quad
/// |\kappa_j^+ - \kappa_j| \le d_j $$
///
/// for all matrices inside `loops`. The set is told by `part`, which answers for a cell of the box a cell
/// that holds all of the set that is in it, or nothing where there is none of it. Asked is a little more
/// than needed, that the form decreases for $\kappa^+$ up to $d_j$ outside of the set.
///
/// # Errors
/// [`NotProvedAt`] where shapes do not fit, an entry is not finite, a number is not allowed, or the decrease
/// could not be shown.
pub fn falls_while_moving(
    moving: &Moving<'_>,
    part: impl Fn(&Ends) -> Option<Ends>,
) -> Result<MovingProof, NotProvedAt> {
    let most = most_cells(moving.changes.len(), moving.forms.first().map_or(0, Matrix::rows));
    Parts::of(moving)?.prove(most, part)
}

/// Cells that may be looked at: each takes a factor of as many matrices as its decrease has coefficients.
pub(super) fn most_cells(gains: usize, size: usize) -> u64 {
    let coefficients = (ALONG as u64).saturating_pow(u32::try_from(gains).unwrap_or(u32::MAX));
    let work = coefficients.saturating_mul((size as u64).saturating_pow(3)).max(1);
    (MOST_WORK / work).clamp(1, MOST_CELLS)
}

/// What is needed of a cell, with ends moved outward to the grid: all of the cell where that is not inside.
fn on_grid(cell: &Ends, needed: &Ends) -> Ends {
    let side = |(gain, &[lower, upper]): (usize, &[f64; 2])| match needed.get(gain) {
        Some(&[from, to]) if from >= lower && to <= upper => {
            [(from * GRID).floor() / GRID, (to * GRID).ceil() / GRID]
        }
        _ => [lower, upper],
    };
    cell.iter().enumerate().map(side).collect()
}

fn middle(cell: &Ends) -> Vec<f64> {
    cell.iter().map(|[lower, upper]| 0.5 * (lower + upper)).collect()
}

/// Two halves, across the widest side; nothing for a cell that is narrow.
fn halves(cell: &Ends) -> Option<[Ends; 2]> {
    let widths = cell.iter().map(|[lower, upper]| upper - lower).enumerate();
    let (gain, width) = widths.max_by(|one, other| one.1.total_cmp(&other.1))?;
    let [lower, upper] = *cell.get(gain).filter(|_| width > NARROWEST)?;
    let middle = (0.5 * (lower + upper) * GRID).floor() / GRID;
    Some([[lower, middle], [middle, upper]].map(|side| {
        let mut half = cell.clone();
        half[gain] = side;
        half
    }))
}

/// A polynomial's coefficient matrix with the power of each gain.
struct Term {
    powers: [usize; GAINS],
    matrix: Packed,
}

/// The decrease in the basis in which the form at the centre is about the identity.
///
/// $$ F = \sum_t \kappa^{p_t} C_t - \sum_j o_j \sum_t \kappa^{q_{jt}} D_{jt}, \quad
/// \kappa_j^+ = f_j \kappa_j + o_j $$
///
/// with $f_j = 1$, $o_j = \pm d_j$ for a gain that moves and $f_j = 0$, $o_j = \pm 1$ for one that jumps.
pub(super) struct Parts {
    gains: usize,
    /// $X^T P_a X$.
    forms: Vec<Packed>,
    resting: Vec<Term>,
    /// Of each gain: $|o_j|$, and the terms of $D_j$.
    moved: Vec<(f64, Vec<Term>)>,
}

impl Parts {
    fn of(moving: &Moving<'_>) -> Result<Self, NotProvedAt> {
        let forms = symmetric_forms(moving)?;
        let Turned { own, loops } = Turned::of(moving.loops, &forms)?;
        let rate = Interval::point(moving.rate);
        let kept: Vec<IntervalMatrix> = own.iter().map(|own| own.scaled(rate * rate)).collect();
        Self::assembled(&own, &kept, &loops, (&forms, moving.changes))
    }

    /// From the forms, what is kept of them and the loops, all in the basis, and the forms as they are, which what the
    /// loops make of a state is measured by; a loop may have more columns than the form, and what is kept as many.
    pub(super) fn assembled(
        own: &[IntervalMatrix],
        kept: &[IntervalMatrix],
        loops: &[IntervalMatrix],
        (forms, changes): (&[IntervalMatrix], &[f64]),
    ) -> Result<Self, NotProvedAt> {
        let mut resting = Vec::new();
        for (part, kept) in kept.iter().enumerate() {
            add(&mut resting, &[part], &Packed::of(kept));
        }
        let mut moved: Vec<(f64, Vec<Term>)> = changes
            .iter()
            .map(|&change| (if change < 1.0 { change } else { 1.0 }, Vec::new()))
            .collect();
        for (part, next) in forms.iter().enumerate() {
            for (left, right, triple) in triples(loops, next)? {
                let follows = part.checked_sub(1).is_none_or(|gain| changes[gain] < 1.0);
                if follows {
                    add(&mut resting, &[left, right, part], &triple.negated());
                }
                if let Some(gain) = part.checked_sub(1) {
                    add(&mut moved[gain].1, &[left, right], &triple);
                }
            }
        }
        let gains = changes.len();
        Ok(Self { gains, forms: own.iter().map(Packed::of).collect(), resting, moved })
    }

    /// Takes off $r(\kappa)^T r(\kappa)$ of a row that is affine in the gains.
    pub(super) fn less_square(&mut self, rows: &[IntervalMatrix]) -> Result<(), NotProvedAt> {
        let whole = IntervalMatrix::identity(1);
        for (left, right, square) in triples(rows, &whole)? {
            add(&mut self.resting, &[left, right], &square.negated());
        }
        Ok(())
    }

    /// Proves cell after cell, of no more than `most`, that all that `part` asks for is positive definite.
    pub(super) fn prove(
        &self,
        most: u64,
        part: impl Fn(&Ends) -> Option<Ends>,
    ) -> Result<MovingProof, NotProvedAt> {
        let mut open: Vec<Ends> = vec![vec![[-1.0, 1.0]; self.gains]];
        let mut proof = MovingProof { cells: Vec::new(), inequalities: 0 };
        let mut looked = 0_u64;
        while let Some(whole) = open.pop() {
            let Some(needed) = part(&whole) else { continue };
            let cell = on_grid(&whole, &needed);
            looked += 1;
            match self.proved_in(&cell) {
                Ok(inequalities) => {
                    proof.inequalities += inequalities;
                    proof.cells.push(cell);
                }
                Err(reason) => {
                    let gains = middle(&cell);
                    let asked = part(&gains.iter().map(|&gain| [gain, gain]).collect()).is_some();
                    let lost = asked && self.prove_at(&gains).is_err();
                    let halves = halves(&cell).filter(|_| looked < most && !lost);
                    open.extend(halves.ok_or(NotProvedAt { gains, reason })?);
                }
            }
        }
        Ok(proof)
    }

    /// Proves a cell; answers how many matrices that took.
    fn proved_in(&self, cell: &Ends) -> Result<usize, NotProved> {
        let corners = 1_usize << self.gains;
        for corner in 0..corners {
            let at = |gain: usize| cell[gain][corner >> gain & 1];
            self.form_at(&at).prove_definite("moving form")?;
        }
        let weights: Vec<[[f64; ALONG]; ALONG]> = cell.iter().copied().map(weights).collect();
        let coefficients = ALONG.pow(self.gains as u32);
        for coefficient in 0..coefficients {
            let weight = |powers: &[usize; GAINS]| -> f64 {
                let along = weights.iter().zip(powers).enumerate();
                along.fold(1.0, |product, (gain, (table, &power))| {
                    product * table[power][coefficient / ALONG.pow(gain as u32) % ALONG]
                })
            };
            self.definite(&weight)?;
        }
        Ok(corners + coefficients * corners)
    }

    /// Proves that a sum of the terms with these weights is positive definite, for all extreme motions.
    fn definite(&self, weight: &dyn Fn(&[usize; GAINS]) -> f64) -> Result<(), NotProved> {
        let sum = |terms: &[Term]| {
            let weighted = terms.iter().map(|term| (weight(&term.powers), &term.matrix));
            Packed::sum(weighted)
        };
        let resting = sum(&self.resting);
        let moved: Vec<Packed> = self.moved.iter().map(|(_, terms)| sum(terms)).collect();
        for corner in 0..1_usize << self.gains {
            let motions = self.moved.iter().zip(&moved).enumerate();
            let motions = motions.map(|(gain, ((offset, _), matrix))| {
                (if corner >> gain & 1 == 1 { -offset } else { *offset }, matrix)
            });
            let whole = Packed::sum([(1.0, &resting)].into_iter().chain(motions));
            whole.prove_definite(WHAT)?;
        }
        Ok(())
    }

    fn form_at(&self, gain: &dyn Fn(usize) -> f64) -> Packed {
        let factor = |part: usize| part.checked_sub(1).map_or(1.0, gain);
        let parts = self.forms.iter().enumerate();
        Packed::sum(parts.map(|(part, form)| (factor(part), form)))
    }

    /// Proves the decrease at a point; where it does not decrease there is no need to halve the cell around.
    fn prove_at(&self, at: &[f64]) -> Result<(), NotProved> {
        self.definite(&|powers: &[usize; GAINS]| {
            let along = at.iter().zip(powers);
            along.fold(1.0, |product, (gain, &power)| (0..power).fold(product, |p, _| p * gain))
        })
    }
}

/// Forms and loops in the basis in which the form at the centre is about the identity.
pub(super) struct Turned {
    /// $X^T P_a X$.
    pub(super) own: Vec<IntervalMatrix>,
    /// $M_a X$.
    pub(super) loops: Vec<IntervalMatrix>,
}

impl Turned {
    pub(super) fn of(
        loops: &[IntervalMatrix],
        forms: &[IntervalMatrix],
    ) -> Result<Self, NotProvedAt> {
        let x = basis_at_centre(forms)?;
        let own = forms.iter().map(|own| form(own, &x)).collect::<Result<_, _>>()?;
        Ok(Self { own, loops: turned_by(&x, loops)? })
    }
}

/// X.
pub(super) fn basis_at_centre(forms: &[IntervalMatrix]) -> Result<IntervalMatrix, NotProvedAt> {
    let size = forms[0].rows();
    Ok(basis("form at the centre", &forms[0].middle, size)?)
}

/// Each matrix times X.
pub(super) fn turned_by(
    x: &IntervalMatrix,
    matrices: &[IntervalMatrix],
) -> Result<Vec<IntervalMatrix>, NotProvedAt> {
    let turned = matrices.iter().map(|part| part.product(x));
    Ok(turned.collect::<Result<_, _>>()?)
}

/// The forms, if everything is of one shape and all numbers are allowed.
pub(super) fn symmetric_forms(moving: &Moving<'_>) -> Result<Vec<IntervalMatrix>, NotProved> {
    let Moving { loops, forms, changes, rate } = *moving;
    let gains = changes.len();
    if gains > GAINS || loops.len() != gains + 1 || forms.len() != gains + 1 {
        let (found, allowed) = ((loops.len(), forms.len()), (gains + 1, gains + 1));
        return Err(LtiError::Shape { what: "loops and forms", found, allowed }.into());
    }
    if !(0.0..=1.0).contains(&rate) {
        return Err(NotProved::Number { what: "rate", found: rate, allowed: "0 to 1" });
    }
    if let Some(&found) = changes.iter().find(|change| !(**change >= 0.0)) {
        return Err(NotProved::Number { what: "change in a sample", found, allowed: "0 or above" });
    }
    let size = forms[0].rows();
    for part in loops {
        part.require_shape("matrix of the loop", size, size)?;
        require_bounded("matrix of the loop", part)?;
    }
    let own = |matrix: &Matrix| {
        let own = symmetric("moving form", matrix)?;
        own.require_shape("moving form", size, size)?;
        Ok(own)
    };
    forms.iter().map(own).collect()
}

/// $B_a^T P B_c$ for all pairs, that of a pair of two parts with its transpose added.
fn triples(
    loops: &[IntervalMatrix],
    next: &IntervalMatrix,
) -> Result<Vec<(usize, usize, Packed)>, NotProved> {
    let mut triples = Vec::new();
    for (right, by) in loops.iter().enumerate() {
        let after = next.product(by)?;
        for (left, part) in loops.iter().enumerate().take(right + 1) {
            let triple = part.transpose().product(&after)?;
            let whole = if left == right { triple } else { triple.plus(&triple.transpose()) };
            triples.push((left, right, Packed::of(&whole)));
        }
    }
    Ok(triples)
}

/// Adds a matrix to the term whose powers are those of a product of parts; part 0 is the constant.
fn add(terms: &mut Vec<Term>, parts: &[usize], matrix: &Packed) {
    let mut powers = [0; GAINS];
    for gain in parts.iter().filter_map(|part| part.checked_sub(1)) {
        powers[gain] += 1;
    }
    match terms.iter_mut().find(|term| term.powers == powers) {
        Some(term) => term.matrix = Packed::sum([(1.0, &term.matrix), (1.0, matrix)].into_iter()),
        None => terms.push(Term { powers, matrix: matrix.clone() }),
    }
}

/// What each power of a gain contributes to three times each Bernstein coefficient of degree 3 between two
/// ends: the polar forms of $1, x, x^2, x^3$ at $3 - b$ times the lower end and b times the upper.
///
/// That all coefficients are three times too large for each gain does not change whether they are
/// positive definite. With ends that are multiples of $2^{-12}$ up to 1 all of this is exact.
///
/// # Source
/// L. Ramshaw, *Blossoms are polar forms*, Computer Aided Geometric Design 6 (1989) 323.
fn weights([lower, upper]: [f64; 2]) -> [[f64; ALONG]; ALONG] {
    let squares = [lower * lower, lower * upper, upper * upper];
    [
        [3.0; ALONG],
        [3.0 * lower, 2.0 * lower + upper, lower + 2.0 * upper, 3.0 * upper],
        [
            3.0 * squares[0],
            squares[0] + 2.0 * squares[1],
            2.0 * squares[1] + squares[2],
            3.0 * squares[2],
        ],
        [
            3.0 * squares[0] * lower,
            3.0 * squares[0] * upper,
            3.0 * lower * squares[2],
            3.0 * upper * squares[2],
        ],
    ]
}

#[cfg(test)]
mod tests;
