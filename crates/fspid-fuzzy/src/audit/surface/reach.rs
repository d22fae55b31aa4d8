//! All outputs of a system over boxes of inputs.

use alloc::vec;
use alloc::vec::Vec;

use super::field::Field;
use crate::system::System;
use fspid_numeric::scalar::Interval;

/// Slopes are asked for in boxes whose sides are narrower than this share of their universes.
///
/// On the paper's supervisor the plain enclosure is 5 % wider than the range at every width, and
/// its slopes cost six times as much. They begin to help at a hundredth of the universe: at 1/192
/// they take a quarter of the excess away, at 1/384 a half, at 1/96 a tenth and above that nothing.
const NARROW: f64 = 1.0 / 128.0;

/// Encloses the outputs of a system over boxes of inputs.
///
/// The answers over a box $X$ hold every value that [`evaluate`](System::evaluate) has to answer
/// there; what it does answer differs from that by its rounding and its
/// [`error_bound`](crate::system::Answer::error_bound). Over a narrow box with the middle $m$ they
/// are what two enclosures have in common,
///
/// $$ f(X) \subseteq F(X) \cap \Big( f(m) + \sum_i f'_i(X) (X_i - m_i) \Big) $$
///
/// where $F$ is that of interval arithmetic and $f'_i(X)$ holds all slopes along input $i$ (at
/// kinks those of Clarke's generalised gradient; no bounds where the output may jump). In a wide
/// box $F$ is the better one and stands alone.
///
/// Asked for one box after another, it keeps its room.
///
/// # Source
/// Moore, Kearfott and Cloud, *Introduction to Interval Analysis*, SIAM 2009, section 6.4.
pub struct Reach<'a> {
    field: Field<'a>,
    middle: Vec<Interval>,
    answers: Vec<Interval>,
    spreads: Vec<Interval>,
}

impl<'a> Reach<'a> {
    /// Room for the boxes of a system.
    #[must_use]
    pub fn new(system: &'a System) -> Self {
        let outputs = system.parts.outputs.len();
        Self {
            field: Field::new(system),
            middle: Vec::new(),
            answers: vec![Interval::ENTIRE; outputs],
            spreads: vec![Interval::ENTIRE; outputs],
        }
    }

    /// All values of each output over a box with one side for each input.
    ///
    /// A side may be without bounds; so is an answer of which nothing is known, and every answer to
    /// a box with too few or too many sides.
    pub fn over(&mut self, cell: &[Interval]) -> &[Interval] {
        if cell.len() != self.field.firing.system.parts.inputs.len() {
            self.answers.fill(Interval::ENTIRE);
            return &self.answers;
        }
        values(&mut self.field, cell, &mut self.answers);
        if self.is_narrow(cell) {
            self.spread(cell);
            for (answer, spread) in self.answers.iter_mut().zip(&self.spreads) {
                *answer = answer.intersection(*spread).unwrap_or(*answer);
            }
        }
        &self.answers
    }

    /// All slopes of each output along an input over a box, at kinks those of Clarke's generalised gradient: no bounds where
    /// an output may jump, and where the box does not fit the system.
    pub fn slopes(&mut self, cell: &[Interval], input: usize) -> &[Interval] {
        let Self { field, spreads, .. } = self;
        if cell.len() != field.firing.system.parts.inputs.len() || input >= cell.len() {
            spreads.fill(Interval::ENTIRE);
            return spreads;
        }
        field.firing.fire(cell, Some(input));
        for (output, slope) in spreads.iter_mut().enumerate() {
            [*slope] = field.answer(output, Some(input)).derivative;
        }
        spreads
    }

    /// Whether slopes are worth their while.
    fn is_narrow(&self, cell: &[Interval]) -> bool {
        let mut sides = cell.iter().zip(&self.field.firing.system.parts.inputs);
        let narrow = sides.all(|(side, input)| {
            let span = input.universe.map_or(f64::INFINITY, |universe| universe.span());
            side.is_bounded() && side.width() < NARROW * span
        });
        narrow && !cell.iter().all(|side| side.is_point())
    }

    /// Encloses by values at the middle and slopes.
    fn spread(&mut self, cell: &[Interval]) {
        let Self { field, middle, spreads, .. } = self;
        middle.clear();
        middle.extend(cell.iter().map(|side| Interval::point(side.midpoint())));
        values(field, middle, spreads);
        for (input, (side, at)) in cell.iter().zip(middle.iter()).enumerate() {
            // Across a side without width nothing changes.
            if side.is_point() {
                continue;
            }
            field.firing.fire(cell, Some(input));
            for (output, spread) in spreads.iter_mut().enumerate() {
                let [slope] = field.answer(output, Some(input)).derivative;
                *spread = *spread + slope * (*side - *at);
            }
        }
    }
}

/// Fires the rules once for all outputs.
fn values(field: &mut Field<'_>, cell: &[Interval], places: &mut [Interval]) {
    field.firing.fire(cell, None);
    for (output, place) in places.iter_mut().enumerate() {
        *place = field.answer(output, None).value;
    }
}
