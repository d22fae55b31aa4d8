//! Symmetry and monotonicity of a grid of labels.

use alloc::vec::Vec;

use super::grid::Grid;

/// A jump of so many labels between neighbours is worth a list.
const LARGE_JUMP: usize = 3;

/// What is true of the labels of a grid. Cells are told by positions of terms; holes and ambiguous
/// cells take no part.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelAudit {
    /// $L(-x) = -L(x)$: opposite cells have opposite labels.
    pub odd: PairAudit,
    /// $L(-x) = L(x)$: opposite cells have the same label.
    pub even: PairAudit,
    /// $L(\dots x_i \dots x_j \dots) = L(\dots x_j \dots x_i \dots)$, for each pair of inputs with
    /// as many terms.
    pub exchange: Vec<Exchange>,
    /// Along each input.
    pub along: Vec<AxisAudit>,
}

/// Whether a symmetry holds for pairs of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct PairAudit {
    /// How many pairs of different cells were compared.
    pub pairs: usize,
    /// Those that break the symmetry.
    pub violations: Vec<[Vec<usize>; 2]>,
    /// Cells that are their own mirror image and break it.
    pub own_images: Vec<Vec<usize>>,
}

impl PairAudit {
    /// True if nothing breaks the symmetry.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.violations.is_empty() && self.own_images.is_empty()
    }
}

/// Whether two inputs can be exchanged.
#[derive(Clone, Debug, PartialEq)]
pub struct Exchange {
    /// Positions of the two inputs.
    pub inputs: [usize; 2],
    /// The pairs of cells.
    pub cells: PairAudit,
}

/// How labels go along one input, all others held.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisAudit {
    /// Neighbours that were compared.
    pub neighbours: usize,
    /// Where most steps go.
    pub direction: Direction,
    /// Neighbours that go the other way.
    pub exceptions: Vec<Neighbours>,
    /// Most labels between neighbours.
    pub largest_jump: usize,
    /// Neighbours at least three labels apart.
    pub large_jumps: Vec<Neighbours>,
}

/// Where labels go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// They never change.
    Constant,
    /// They rise with the input, or more often than they fall.
    Rising,
    /// They fall with the input, or more often than they rise.
    Falling,
}

/// Two neighbouring cells and the step between their labels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Neighbours {
    /// The cells, in ascending order of the input.
    pub cells: [Vec<usize>; 2],
    /// Labels from the first to the second; negative if they fall.
    pub step: isize,
}

/// What is true of the labels, if they can be put in order.
pub(super) fn audit(grid: &Grid) -> Option<LabelAudit> {
    let last = grid.label_count()?.checked_sub(1)?;
    let inputs = grid.orders.len();
    let opposite = |cell: &[usize]| -> Vec<usize> {
        cell.iter().zip(&grid.orders).map(|(rank, order)| order.len() - 1 - rank).collect()
    };
    let exchangeable = (0..inputs)
        .flat_map(|i| (0..i).map(move |j| [j, i]))
        .filter(|&[i, j]| grid.orders.get(i).map(Vec::len) == grid.orders.get(j).map(Vec::len));
    let exchange = exchangeable.map(|inputs| Exchange {
        inputs,
        cells: pairs(grid, |cell| swapped(cell, inputs), |left, right| left == right),
    });
    Some(LabelAudit {
        odd: pairs(grid, opposite, |left, right| left + right == last),
        even: pairs(grid, opposite, |left, right| left == right),
        exchange: exchange.collect(),
        along: (0..inputs).map(|input| along(grid, input)).collect(),
    })
}

fn swapped(cell: &[usize], [i, j]: [usize; 2]) -> Vec<usize> {
    let mut image = cell.to_vec();
    image.swap(i, j);
    image
}

/// Compares each cell with its image under a mirroring.
fn pairs(
    grid: &Grid,
    image: impl Fn(&[usize]) -> Vec<usize>,
    agree: impl Fn(usize, usize) -> bool,
) -> PairAudit {
    let mut audit = PairAudit { pairs: 0, violations: Vec::new(), own_images: Vec::new() };
    for index in 0..grid.count() {
        let cell = grid.cell(index);
        let mirrored = image(&cell);
        let partner = grid.index(&mirrored);
        let (Some(left), Some(right)) = (grid.label(&cell), grid.label(&mirrored)) else {
            continue;
        };
        audit.pairs += usize::from(index < partner);
        if index < partner && !agree(left, right) {
            audit.violations.push([grid.positions(&cell), grid.positions(&mirrored)]);
        }
        if index == partner && !agree(left, right) {
            audit.own_images.push(grid.positions(&cell));
        }
    }
    audit
}

/// Compares neighbours along one input.
fn along(grid: &Grid, input: usize) -> AxisAudit {
    let steps: Vec<Neighbours> =
        (0..grid.count()).filter_map(|index| neighbours(grid, index, input)).collect();
    let count = |wanted: fn(isize) -> bool| steps.iter().filter(|n| wanted(n.step)).count();
    let (rises, falls) = (count(|step| step > 0), count(|step| step < 0));
    let direction = match (rises, falls) {
        (0, 0) => Direction::Constant,
        _ if rises >= falls => Direction::Rising,
        _ => Direction::Falling,
    };
    let against = |step: isize| match direction {
        Direction::Rising => step < 0,
        Direction::Falling => step > 0,
        Direction::Constant => false,
    };
    AxisAudit {
        neighbours: steps.len(),
        direction,
        exceptions: steps.iter().filter(|n| against(n.step)).cloned().collect(),
        largest_jump: steps.iter().map(|n| n.step.unsigned_abs()).max().unwrap_or(0),
        large_jumps: steps
            .iter()
            .filter(|n| n.step.unsigned_abs() >= LARGE_JUMP)
            .cloned()
            .collect(),
    }
}

/// The step from a cell to the next one along an input.
fn neighbours(grid: &Grid, index: usize, input: usize) -> Option<Neighbours> {
    let cell = grid.cell(index);
    let mut next = cell.clone();
    let rank = next.get_mut(input)?;
    *rank += 1;
    if *rank >= grid.orders.get(input)?.len() {
        return None;
    }
    let step = grid.label(&next)?.checked_signed_diff(grid.label(&cell)?)?;
    Some(Neighbours { cells: [grid.positions(&cell), grid.positions(&next)], step })
}
