//! What Mach number adds to coefficients, by rows of a source.

use super::increment::Increment;
use crate::error::AircraftError;
use crate::validity::Range;

/// Increments at one Mach number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachRow {
    /// Mach number.
    pub mach: f64,
    /// What is added there to the coefficients of the reference.
    pub increment: Increment,
}

/// Increments over Mach number, straight lines between rows.
///
/// Beyond the first and the last row theirs hold on, and the model's [validity](crate::Validity) ends there.
#[derive(Debug, Clone, PartialEq)]
pub struct MachTable {
    first: MachRow,
    /// Those behind it, in rising order; never none.
    others: Vec<MachRow>,
}

impl MachTable {
    /// A table of rows in rising order.
    ///
    /// # Errors
    /// Fewer than two rows; Mach numbers that are not above zero, finite and rising.
    pub fn new(rows: Vec<MachRow>) -> Result<Self, AircraftError> {
        let mut before = 0.0;
        for row in &rows {
            // Written so that NaN is refused.
            if !(row.mach > before && row.mach.is_finite()) {
                return Err(AircraftError::MachRows { before, found: row.mach });
            }
            before = row.mach;
        }
        let mut rows = rows.into_iter();
        let first = rows.next().ok_or(AircraftError::FewMachRows)?;
        let others: Vec<MachRow> = rows.collect();
        if others.is_empty() { Err(AircraftError::FewMachRows) } else { Ok(Self { first, others }) }
    }

    /// The increments at a Mach number.
    #[must_use]
    pub fn at(&self, mach: f64) -> Increment {
        let mut low = &self.first;
        for high in &self.others {
            if mach <= high.mach {
                let share = ((mach - low.mach) / (high.mach - low.mach)).max(0.0);
                return Increment::default()
                    .plus(1.0 - share, &low.increment)
                    .plus(share, &high.increment);
            }
            low = high;
        }
        low.increment
    }

    /// From the first row to the last.
    #[must_use]
    pub fn range(&self) -> Range {
        let last = self.others.last().unwrap_or(&self.first);
        Range { min: self.first.mach, max: last.mach }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "numbers that are chosen so that nothing is rounded")]
mod tests {
    use super::*;

    fn row(mach: f64, drag: f64) -> MachRow {
        let mut increment = Increment::default();
        increment.longitudinal.drag.reference = drag;
        MachRow { mach, increment }
    }

    #[test]
    fn between_rows_is_a_straight_line_and_beyond_them_the_last_holds_on() {
        let table = MachTable::new(vec![row(0.5, 0.0), row(0.75, 0.25), row(1.0, 1.0)]);
        let table = table.expect("rising");
        let drag = |mach| table.at(mach).longitudinal.drag.reference;
        for (mach, expected) in
            [(0.25, 0.0), (0.5, 0.0), (0.625, 0.125), (0.75, 0.25), (0.875, 0.625), (2.0, 1.0)]
        {
            assert_eq!(drag(mach), expected, "{mach}");
        }
        assert_eq!(table.range(), Range { min: 0.5, max: 1.0 });
    }

    #[test]
    fn rows_that_do_not_rise_and_a_single_row_are_refused() {
        for rows in [vec![], vec![row(0.5, 0.0)]] {
            assert_eq!(MachTable::new(rows), Err(AircraftError::FewMachRows));
        }
        for second in [0.5, 0.4, f64::NAN, f64::INFINITY] {
            let refused = MachTable::new(vec![row(0.5, 0.0), row(second, 0.0)]);
            assert!(matches!(refused, Err(AircraftError::MachRows { .. })), "{second}");
        }
    }
}
