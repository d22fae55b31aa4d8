//! Numerator and denominator of a loop as polynomials whose coefficients are proved.

use super::real::Real;
use crate::balance::balance;
use crate::matrix::Matrix;
use crate::wide::WideBall;

/// A square array of numbers with bounds.
struct Square<const W: usize> {
    size: usize,
    data: Vec<WideBall<W>>,
}

/// $L = N / D$ on the upper half of the unit circle, over a common factor.
///
/// In $s = (z - 1)/(z + 1) = j \tan (\omega T / 2)$ both are polynomials over $(1 - s)^n$, which cancels.
#[derive(Debug, Clone)]
pub(super) struct Parts<const W: usize> {
    /// D: 0 where L has a pole.
    pub(super) under: Real<W>,
    /// N.
    pub(super) over: Real<W>,
}

impl<const W: usize> Parts<W> {
    /// From $A - I$, b and c; `None` where the reduction meets a pivot that may be 0 and need not be.
    ///
    /// Whole samples of dead time in front are taken out first, and come back exactly.
    pub(super) fn new(states: States<W>) -> Option<Self> {
        Self::by(states, States::polynomials)
    }

    /// The same without a pivot, for loops with states that the output does not see: slower by the order.
    pub(super) fn without_pivots(states: States<W>) -> Option<Self> {
        Self::by(states, States::polynomials_without_pivots)
    }

    fn by(mut states: States<W>, polynomials: impl Fn(&States<W>) -> Found<W>) -> Option<Self> {
        let order = states.b.len();
        let mut dead_samples = 0;
        while let Some(rest) = states.after_a_dead_sample() {
            (states, dead_samples) = (rest, dead_samples + 1);
        }
        let (mut under, mut over) = polynomials(&states)?;
        // z⁻¹ = (1 − s)/(1 + s), exactly.
        for _ in 0..dead_samples {
            under = times_linear(&under, WideBall::from(1.0), WideBall::from(1.0));
            over = times_one_less_s(&over);
        }
        Some(Self { under: Real::of_s(&under, order), over: Real::of_s(&over, order) })
    }

    /// Denominator of S and T, $D + N$.
    pub(super) fn closed(&self) -> Real<W> {
        self.under.combined(1.0, &self.over, 1.0)
    }
}

/// D and N over s, lowest power first.
type Found<const W: usize> = Option<(Vec<WideBall<W>>, Vec<WideBall<W>>)>;

/// $A - I$ row after row, b and c.
pub(super) struct States<const W: usize> {
    change: Vec<WideBall<W>>,
    b: Vec<WideBall<W>>,
    c: Vec<f64>,
}

impl<const W: usize> States<W> {
    /// Of entries that are sums of two.
    pub(super) fn new(change: &[[f64; 2]], b: &[[f64; 2]], c: &[f64]) -> Self {
        let wide = |values: &[[f64; 2]]| values.iter().copied().map(WideBall::sum).collect();
        Self { change: wide(change), b: wide(b), c: c.to_vec() }
    }

    /// The loop behind a state that only keeps its input for a sample, if there is one.
    fn after_a_dead_sample(&self) -> Option<Self> {
        let order = self.b.len();
        let mut inputs = (0..order).filter(|&place| !self.b[place].is_zero());
        let (Some(first), None) = (inputs.next(), inputs.next()) else { return None };
        let row = &self.change[first * order..(first + 1) * order];
        let forgets = row.iter().enumerate().all(|(column, entry)| {
            if column == first {
                entry.plus(&WideBall::from(1.0)).is_zero()
            } else {
                entry.is_zero()
            }
        });
        if !forgets || self.c[first] != 0.0 || order < 2 {
            return None;
        }
        let others = || (0..order).filter(move |&place| place != first);
        let entries = others().flat_map(|row| others().map(move |column| (row, column)));
        let input = |row: usize| self.b[first].times(&self.change[row * order + first]);
        Some(Self {
            change: entries.map(|(row, column)| self.change[row * order + column]).collect(),
            b: others().map(input).collect(),
            c: others().map(|place| self.c[place]).collect(),
        })
    }

    /// With the output turned into the last unit vector by an elimination whose every step carries its bounds, L is
    ///
    /// $$ D = \det(\zeta I - H), \quad N = \gamma \sum_j b_j \det(\zeta I - H)_{j+1..} \prod_{m \le j} h_{m,m-1} $$
    ///
    /// and the trailing minors follow from each other. They are kept in s, where $\zeta - h = (2 s - h (1 - s))/(1 -
    /// s)$: slow poles keep their digits at $s = 0$, and those of a dead time, $h = -1$, are $1 + s$ and cancel nothing.
    ///
    /// # Source
    /// The recurrence of minors of a Hessenberg matrix: J. H. Wilkinson, The Algebraic Eigenvalue Problem, Oxford
    /// (1965), chapter 7.
    fn polynomials(&self) -> Found<W> {
        let system = Square::bordered(&self.change, &self.b, &self.c).reduced()?;
        let order = self.b.len();
        let h = |row: usize, column: usize| system.at(1 + row, 1 + column);
        // minors[k] is the determinant of the rows and columns from k on, over (1 - s) to the power that is left.
        let mut minors: Vec<Vec<WideBall<W>>> = vec![vec![WideBall::from(1.0)]];
        let mut over: Vec<WideBall<W>> = vec![WideBall::ZERO];
        for row in (0..order).rev() {
            let corner = h(row, row);
            let lead = corner.plus(&WideBall::from(2.0));
            let mut minor = times_linear(minors.last()?, corner.negative(), lead);
            for minor in &mut minors {
                *minor = times_one_less_s(minor);
            }
            let mut below = WideBall::from(1.0);
            for column in row + 1..order {
                below = below.times(&h(column, column - 1));
                let factor = below.times(&h(row, column)).negative();
                add(&mut minor, minors.get(order - 1 - column)?, factor);
            }
            minors.push(minor);
        }
        let under = minors.pop()?;
        // minors[order - 1 - j] belongs to the rows after j, and has been brought to the full power.
        let mut entry = system.at(1, 0);
        for (place, minor) in minors.iter().rev().enumerate() {
            if place > 0 {
                entry = entry.times(&h(place, place - 1));
            }
            add(&mut over, minor, entry.times(&system.at(0, 1 + place)));
        }
        Some((under, over))
    }

    /// By sums of products alone: states that the output does not see leave an elimination with pivots of which nobody
    /// can tell whether they are 0. What such states have in common stays in D and N.
    ///
    /// $$ M_1 = I, \quad d_{n-k} = -\tfrac{1}{k} \operatorname{tr}(H M_k), \quad M_{k+1} = H M_k + d_{n-k} I, \quad N =
    /// \sum_k c M_k b \zeta^{n-k} $$
    ///
    /// # Source
    /// Faddeev and LeVerrier's recurrence: F. R. Gantmacher, The Theory of Matrices I, Chelsea (1959), chapter IV, § 5.
    fn polynomials_without_pivots(&self) -> Found<W> {
        let system = Square::bordered(&self.change, &self.b, &self.c);
        let order = self.b.len();
        let mut adjugate = Square::unit(order);
        let (mut under, mut over) = (vec![WideBall::from(1.0)], vec![WideBall::ZERO]);
        for k in 1..=order {
            // Row 0 and column 0 of the bordered matrix are the output and the input.
            let mut value = WideBall::ZERO;
            for (row, column) in pairs(order) {
                let seen = system.at(0, 1 + row).times(&adjugate.at(row, column));
                value = value.plus(&seen.times(&system.at(1 + column, 0)));
            }
            over.push(value);
            let product = Square::from_function(order, |row, column| {
                let terms =
                    (0..order).map(|k| system.at(1 + row, 1 + k).times(&adjugate.at(k, column)));
                terms.fold(WideBall::ZERO, |sum, term| sum.plus(&term))
            });
            let trace = (0..order).fold(WideBall::ZERO, |sum, k| sum.plus(&product.at(k, k)));
            let coefficient = trace.negative().over(&WideBall::from(k as f64))?;
            under.push(coefficient);
            adjugate = Square::from_function(order, |row, column| {
                let entry = product.at(row, column);
                if row == column { entry.plus(&coefficient) } else { entry }
            });
        }
        Some((over_s(&under), over_s(&over)))
    }
}

fn pairs(order: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..order).flat_map(move |row| (0..order).map(move |column| (row, column)))
}

/// From a polynomial in $\zeta = 2 s / (1 - s)$, highest power first, to one in s, lowest first, over $(1 - s)^n$.
fn over_s<const W: usize>(coefficients: &[WideBall<W>]) -> Vec<WideBall<W>> {
    let mut sum = Vec::new();
    let mut power = vec![WideBall::from(1.0)];
    for &coefficient in coefficients {
        sum = times_linear(&sum, WideBall::ZERO, WideBall::from(2.0));
        add(&mut sum, &power, coefficient);
        power = times_one_less_s(&power);
    }
    sum
}

/// Times $a + b s$.
fn times_linear<const W: usize>(
    polynomial: &[WideBall<W>],
    a: WideBall<W>,
    b: WideBall<W>,
) -> Vec<WideBall<W>> {
    let mut product = vec![WideBall::ZERO; polynomial.len() + 1];
    for (power, value) in polynomial.iter().enumerate() {
        product[power] = product[power].plus(&a.times(value));
        product[power + 1] = b.times(value);
    }
    product
}

/// Times $1 - s$.
fn times_one_less_s<const W: usize>(polynomial: &[WideBall<W>]) -> Vec<WideBall<W>> {
    let mut product = polynomial.to_vec();
    product.push(WideBall::ZERO);
    for (power, value) in polynomial.iter().enumerate() {
        product[power + 1] = product[power + 1].minus(value);
    }
    product
}

fn add<const W: usize>(
    sum: &mut Vec<WideBall<W>>,
    polynomial: &[WideBall<W>],
    factor: WideBall<W>,
) {
    if factor.is_zero() {
        return;
    }
    if sum.len() < polynomial.len() {
        sum.resize(polynomial.len(), WideBall::ZERO);
    }
    for (sum, value) in sum.iter_mut().zip(polynomial) {
        *sum = sum.plus(&factor.times(value));
    }
}

impl<const W: usize> Square<W> {
    fn from_function(size: usize, entry: impl Fn(usize, usize) -> WideBall<W>) -> Self {
        Self { size, data: pairs(size).map(|(row, column)| entry(row, column)).collect() }
    }

    fn unit(size: usize) -> Self {
        let one = |row, column| if row == column { WideBall::from(1.0) } else { WideBall::ZERO };
        Self::from_function(size, one)
    }

    fn at(&self, row: usize, column: usize) -> WideBall<W> {
        self.data[row * self.size + column]
    }

    /// The loop with b as its first row and c as its first column, transposed about the other diagonal, balanced.
    fn bordered(change: &[WideBall<W>], b: &[WideBall<W>], c: &[f64]) -> Self {
        let order = b.len();
        let size = order + 1;
        let entry = |row: usize, column: usize| match (row.checked_sub(1), column.checked_sub(1)) {
            (Some(row), Some(column)) => change[(order - 1 - column) * order + order - 1 - row],
            (Some(row), None) => c[order - 1 - row].into(),
            (None, Some(column)) => b[order - 1 - column],
            (None, None) => WideBall::ZERO,
        };
        let data: Vec<WideBall<W>> =
            (0..size * size).map(|index| entry(index / size, index % size)).collect();
        let mut plain =
            Matrix::from_function(size, size, |row, column| data[row * size + column].rounded());
        let exponents = balance(&mut plain);
        let scaled = data
            .iter()
            .enumerate()
            .map(|(index, value)| value.scaled(exponents[index % size] - exponents[index / size]));
        Self { size, data: scaled.collect() }
    }

    /// Zeros below the first subdiagonal, by elimination with exchanges of the states.
    fn reduced(mut self) -> Option<Self> {
        for column in 0..self.size.saturating_sub(2) {
            let target = column + 1;
            let size = |row: usize| self.at(row, column).rounded().abs();
            let mut pivot = target;
            for row in target + 1..self.size {
                if size(row) > size(pivot) {
                    pivot = row;
                }
            }
            self.exchange(pivot, target);
            let head = self.at(target, column);
            for row in target + 1..self.size {
                if !self.at(row, column).is_zero() {
                    let factor = self.at(row, column).over(&head)?;
                    self.eliminate(row, target, column, factor);
                }
            }
        }
        Some(self)
    }

    fn exchange(&mut self, one: usize, other: usize) {
        if one != other {
            for k in 0..self.size {
                self.data.swap(one * self.size + k, other * self.size + k);
            }
            for k in 0..self.size {
                self.data.swap(k * self.size + one, k * self.size + other);
            }
        }
    }

    /// Takes a multiple of the target's row from a row, and adds the multiple of its column to the target's.
    fn eliminate(&mut self, row: usize, target: usize, column: usize, factor: WideBall<W>) {
        let size = self.size;
        self.data[row * size + column] = WideBall::ZERO;
        for k in column + 1..size {
            let taken = factor.times(&self.at(target, k));
            self.data[row * size + k] = self.at(row, k).minus(&taken);
        }
        for k in 0..size {
            let added = factor.times(&self.at(k, row));
            self.data[k * size + target] = self.at(k, target).plus(&added);
        }
    }
}
