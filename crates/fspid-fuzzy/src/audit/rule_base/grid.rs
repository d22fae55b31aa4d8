//! Rules as a grid over the terms of the inputs.

use alloc::vec;
use alloc::vec::Vec;

use super::antecedent::conjuncts;
use super::labels::{self, LabelAudit};
use super::{ActiveRule, order};
use crate::system::{Antecedent, System, Variable};

/// Most cells of a grid that is looked at.
const MAX_CELLS: usize = 1_000_000;

/// The rules about an output as a grid over the terms of the inputs. A cell is told by the position
/// of a term for each input, in the order of the inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct GridAudit {
    /// How many cells there are: the product of the numbers of terms.
    pub cells: usize,
    /// Cells for which no rule concludes anything about this output.
    pub holes: Vec<Vec<usize>>,
    /// Cells for which rules conclude more than one term.
    pub ambiguous: Vec<Vec<usize>>,
    /// Symmetry and monotonicity of the labels; `None` where terms cannot be put in order.
    pub labels: Option<LabelAudit>,
}

/// A grid of terms, all by rank.
pub(super) struct Grid {
    /// For each input, positions of its terms by rank.
    pub(super) orders: Vec<Vec<usize>>,
    /// For each cell, the first input varying slowest, the terms that are concluded, by position.
    terms: Vec<Vec<usize>>,
    /// Rank of each output term, if they can be put in order.
    ranks: Option<Vec<usize>>,
}

impl Grid {
    /// The cell at flat position `index`, by ranks.
    pub(super) fn cell(&self, mut index: usize) -> Vec<usize> {
        let mut cell = vec![0; self.orders.len()];
        for (place, order) in cell.iter_mut().zip(&self.orders).rev() {
            *place = index % order.len();
            index /= order.len();
        }
        cell
    }

    /// The flat position of a cell.
    pub(super) fn index(&self, cell: &[usize]) -> usize {
        cell.iter().zip(&self.orders).fold(0, |index, (rank, order)| index * order.len() + rank)
    }

    /// How many cells there are.
    pub(super) fn count(&self) -> usize {
        self.terms.len()
    }

    /// The cell as positions of terms.
    pub(super) fn positions(&self, cell: &[usize]) -> Vec<usize> {
        let position = |(rank, order): (&usize, &Vec<usize>)| order.get(*rank).copied();
        cell.iter().zip(&self.orders).filter_map(position).collect()
    }

    /// The rank of the one term concluded in a cell; nothing in holes and ambiguous cells.
    pub(super) fn label(&self, cell: &[usize]) -> Option<usize> {
        match self.terms.get(self.index(cell))?.as_slice() {
            [only] => self.ranks.as_ref()?.get(*only).copied(),
            _ => None,
        }
    }

    /// How many output terms there are, if they can be put in order.
    pub(super) fn label_count(&self) -> Option<usize> {
        self.ranks.as_ref().map(Vec::len)
    }

    fn cells_where(&self, wanted: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let cells = self.terms.iter().enumerate().filter(|(_, terms)| wanted(terms.len()));
        cells.map(|(index, _)| self.positions(&self.cell(index))).collect()
    }
}

/// The grid of an output and what is true of it.
pub(super) fn audit(system: &System, rules: &[ActiveRule<'_>], output: usize) -> Option<GridAudit> {
    let in_order: Option<Vec<_>> = system.parts().inputs.iter().map(order::of_input).collect();
    let as_written = || {
        let inputs = system.parts().inputs.iter();
        inputs.map(|input| (0..input.terms.len()).collect()).collect()
    };
    let grid = of_rules(system, rules, output, in_order.clone().unwrap_or_else(as_written))?;
    Some(GridAudit {
        cells: grid.count(),
        holes: grid.cells_where(|terms| terms == 0),
        ambiguous: grid.cells_where(|terms| terms > 1),
        labels: in_order.and_then(|_| labels::audit(&grid)),
    })
}

fn of_rules(
    system: &System,
    rules: &[ActiveRule<'_>],
    output: usize,
    orders: Vec<Vec<usize>>,
) -> Option<Grid> {
    let count = orders.iter().try_fold(1_usize, |n, order| n.checked_mul(order.len()))?;
    if !(1..=MAX_CELLS).contains(&count) {
        return None;
    }
    let ranks = system.parts().outputs.get(output).and_then(order::of_output);
    let mut grid =
        Grid { orders, terms: vec![Vec::new(); count], ranks: ranks.map(|o| order::ranks(&o)) };
    for rule in rules {
        let wanted = choices(&rule.antecedent, grid.orders.len())?;
        let concluded = rule.rule.consequents.iter().filter(|c| c.output == output);
        for term in concluded.map(|c| c.term) {
            for index in 0..count {
                grid.conclude(index, &wanted, term);
            }
        }
    }
    Some(grid)
}

impl Grid {
    fn conclude(&mut self, index: usize, wanted: &[Option<usize>], term: usize) {
        let positions = self.positions(&self.cell(index));
        let fits = wanted.iter().zip(&positions).all(|(w, p)| w.is_none_or(|w| w == *p));
        if let Some(terms) = self.terms.get_mut(index)
            && fits
            && !terms.contains(&term)
        {
            terms.push(term);
        }
    }
}

/// For each input the term that the antecedent asks for, if it is a plain conjunction.
fn choices(antecedent: &Antecedent, inputs: usize) -> Option<Vec<Option<usize>>> {
    let mut wanted = vec![None; inputs];
    for part in conjuncts(antecedent) {
        let Antecedent::Is(statement) = part else { return None };
        let (Variable::Input(input), true) = (statement.variable, statement.hedges.is_empty())
        else {
            return None;
        };
        let place = wanted.get_mut(input)?;
        if place.is_some() || statement.term.is_none() {
            return None;
        }
        *place = statement.term;
    }
    Some(wanted)
}
