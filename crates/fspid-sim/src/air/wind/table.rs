//! Wind that was measured, or made by somebody else: rows of a table.

use super::{AirMotion, AirPlace, Corners};
use crate::error::SimError;

/// What the rows of a table go by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// Time since the start, s.
    Time,
    /// Distance flown through the air since the start, m.
    Distance,
    /// Height above the ground, m.
    Height,
}

/// The air at a place of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TableRow {
    /// Where, in s or m.
    pub at: f64,
    /// Velocity along north, east, down, m/s.
    pub earth_m_s: [f64; 3],
    /// Velocity along forward, right, down of the body, m/s.
    pub body_m_s: [f64; 3],
}

/// Velocities of the air over time, distance or height, between rows by straight lines.
///
/// $$ v(x) = v_i + \frac{x - x_i}{x_{i+1} - x_i} (v_{i+1} - v_i) $$
///
/// and beyond the first and the last row what these say. Every row is a corner, at which a step of the
/// integration ends. The air does not turn: its gradient over the aircraft's own size is neglected.
#[derive(Clone, Debug, PartialEq)]
pub struct WindTable {
    along: Along,
    rows: Vec<TableRow>,
}

impl WindTable {
    /// Name in files and messages.
    pub const NAME: &'static str = "table";
    /// Most rows.
    pub const MOST_ROWS: usize = 10_000;

    /// A table of at least two rows, each behind the one before.
    ///
    /// # Errors
    /// [`SimError::Number`] for a number of rows that is not allowed, a row that is not behind the one before, and
    /// what is not finite.
    pub fn new(along: Along, rows: Vec<TableRow>) -> Result<Self, SimError> {
        let wrong = |what, found, allowed| Err(SimError::Number { what, found, allowed });
        if !(2..=Self::MOST_ROWS).contains(&rows.len()) {
            return wrong("rows of a wind table", rows.len() as f64, "2 to 10000");
        }
        for row in &rows {
            let values = [row.at].into_iter().chain(row.earth_m_s).chain(row.body_m_s);
            if let Some(found) = values.into_iter().find(|value| !value.is_finite()) {
                return wrong("number of a wind table", found, "a finite number");
            }
        }
        for pair in rows.windows(2) {
            if let [before, after] = pair
                && !(after.at > before.at)
            {
                return wrong("row of a wind table", after.at, "above the row before");
            }
        }
        Ok(Self { along, rows })
    }

    /// What its rows go by.
    #[must_use]
    pub fn along(&self) -> Along {
        self.along
    }

    /// Its rows.
    #[must_use]
    pub fn rows(&self) -> &[TableRow] {
        &self.rows
    }

    /// How the air moves at a place.
    #[must_use]
    pub fn at(&self, place: &AirPlace) -> AirMotion {
        let at = match self.along {
            Along::Time => place.time_s,
            Along::Distance => place.distance_m,
            Along::Height => place.height_m,
        };
        let after = self.rows.partition_point(|row| row.at <= at);
        let before = after.checked_sub(1).and_then(|index| self.rows.get(index));
        let (earth_m_s, body_m_s) = match (before, self.rows.get(after)) {
            (Some(row), None) | (None, Some(row)) => (row.earth_m_s, row.body_m_s),
            (Some(row), Some(next)) => {
                let share = (at - row.at) / (next.at - row.at);
                let between = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] {
                    std::array::from_fn(|part| a[part] + share * (b[part] - a[part]))
                };
                (between(row.earth_m_s, next.earth_m_s), between(row.body_m_s, next.body_m_s))
            }
            (None, None) => ([0.0; 3], [0.0; 3]),
        };
        AirMotion { earth_m_s, body_m_s, ..AirMotion::default() }
    }

    /// Its rows, at which it is not smooth.
    #[must_use]
    pub fn corners(&self) -> Corners {
        let at = self.rows.iter().map(|row| row.at).collect();
        match self.along {
            Along::Time => Corners { time_s: at, ..Corners::default() },
            Along::Distance => Corners { distance_m: at, ..Corners::default() },
            Along::Height => Corners { height_m: at, ..Corners::default() },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(at: f64, north: f64) -> TableRow {
        TableRow { at, earth_m_s: [north, 0.0, 0.0], ..TableRow::default() }
    }

    #[test]
    fn between_rows_it_is_a_straight_line_and_beyond_them_it_stays() {
        let table = WindTable::new(Along::Height, vec![row(10.0, 2.0), row(20.0, 6.0)]);
        let table = table.expect("allowed");
        let at = |height_m| table.at(&AirPlace { height_m, ..AirPlace::default() }).earth_m_s[0];
        for (height_m, north) in [(-5.0, 2.0), (10.0, 2.0), (12.5, 3.0), (20.0, 6.0), (1e9, 6.0)] {
            assert!((at(height_m) - north).abs() < 1e-15, "{height_m}");
        }
        assert_eq!(table.corners().height_m, [10.0, 20.0]);
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        let refused = |rows: Vec<TableRow>| WindTable::new(Along::Time, rows).is_err();
        assert!(refused(vec![]) && refused(vec![row(0.0, 1.0)]));
        assert!(refused(vec![row(0.0, 1.0), row(0.0, 2.0)]));
        assert!(refused(vec![row(1.0, 1.0), row(0.0, 2.0)]));
        assert!(refused(vec![row(0.0, 1.0), row(f64::NAN, 2.0)]));
        assert!(refused(vec![row(0.0, f64::INFINITY), row(1.0, 2.0)]));
        assert!(refused((0..10_001).map(|at| row(f64::from(at), 0.0)).collect()));
        assert!(!refused((0..10_000).map(|at| row(f64::from(at), 0.0)).collect()));
    }
}
