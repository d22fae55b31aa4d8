//! The commanded pitch over time.

use super::shape::{Shape, amplitude, extremes};
use crate::error::{SimError, finite};
use crate::timing::Timing;

/// How a table of set-points is read between its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The last row's value holds.
    Hold,
    /// In a straight line to the next row.
    Linear,
}

/// A set-point over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile(Kind);

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Shape { amplitude_rad: f64, shape: Shape },
    Table { time_s: Vec<f64>, setpoint_rad: Vec<f64>, interpolation: Interpolation },
}

/// A step in the command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// First sample with the new set-point.
    pub sample: usize,
    /// Set-point before, rad.
    pub from_rad: f64,
    /// Set-point from here on, rad.
    pub to_rad: f64,
}

/// When a set-point leaves the trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Leaves {
    Never,
    /// From then on, s, the same whenever that is.
    At(f64),
    /// By a table, or noise, whose times are its own.
    ByTimes,
}

impl Profile {
    /// `amplitude_rad` times a shape.
    ///
    /// # Errors
    /// [`SimError::Number`] for an amplitude that is not finite or a shape out of its range.
    pub fn new(amplitude_rad: f64, shape: Shape) -> Result<Self, SimError> {
        let amplitude_rad = amplitude("amplitude", amplitude_rad)?;
        Ok(Self(Kind::Shape { amplitude_rad, shape: shape.checked()? }))
    }

    /// Rows of time and set-point; 0 before the first, the last value after the last.
    ///
    /// # Errors
    /// [`SimError::Table`] for no rows, columns of different length or times that do not rise,
    /// [`SimError::Number`] for an entry that is not finite.
    pub fn table(
        time_s: Vec<f64>,
        setpoint_rad: Vec<f64>,
        interpolation: Interpolation,
    ) -> Result<Self, SimError> {
        if time_s.is_empty() {
            return Err(SimError::Table {
                problem: "there is none; allowed is one or more",
                row: 1,
            });
        }
        if time_s.len() != setpoint_rad.len() {
            let row = time_s.len().min(setpoint_rad.len()) + 1;
            return Err(SimError::Table { problem: "a time or a set-point is missing", row });
        }
        for (row, (&time, &setpoint)) in time_s.iter().zip(&setpoint_rad).enumerate() {
            finite("set-point table, time", time)?;
            finite("set-point table, set-point", setpoint)?;
            if row > 0 && time_s.get(row - 1).is_some_and(|&before| before >= time) {
                let problem = "the time is not after that of the row before";
                return Err(SimError::Table { problem, row: row + 1 });
            }
        }
        Ok(Self(Kind::Table { time_s, setpoint_rad, interpolation }))
    }

    /// The same shape so much earlier; a table as it is.
    pub(crate) fn earlier(&self, by_s: f64) -> Self {
        match &self.0 {
            Kind::Shape { amplitude_rad, shape } => {
                let (amplitude_rad, shape) = (*amplitude_rad, shape.clone().earlier(by_s));
                Self(Kind::Shape { amplitude_rad, shape })
            }
            Kind::Table { .. } => self.clone(),
        }
    }

    /// A set-point that stays at the trim.
    pub(crate) const fn still() -> Self {
        Self(Kind::Shape { amplitude_rad: 0.0, shape: Shape::Step { at_s: 0.0 } })
    }

    /// When it leaves the trim, s; never, if it has no size. A table has times of its own.
    pub(crate) fn leaves_s(&self) -> Leaves {
        match &self.0 {
            Kind::Shape { amplitude_rad, .. } if *amplitude_rad == 0.0 => Leaves::Never,
            Kind::Shape { shape: Shape::Noise { .. }, .. } | Kind::Table { .. } => Leaves::ByTimes,
            Kind::Shape { shape, .. } => Leaves::At(shape.starts_s()),
        }
    }

    /// True for a set-point that never stands still.
    #[must_use]
    pub fn is_sine(&self) -> bool {
        matches!(self.0, Kind::Shape { shape: Shape::Sine { .. } | Shape::Noise { .. }, .. })
    }

    /// True for a set-point that moves for ever, a square wave among them.
    pub(crate) fn goes_on(&self) -> bool {
        matches!(&self.0, Kind::Shape { shape, .. } if shape.goes_on())
    }

    /// As [`Shape::period_s`].
    pub(crate) fn period_s(&self) -> Option<(f64, f64)> {
        match &self.0 {
            Kind::Shape { shape, .. } => shape.period_s(),
            Kind::Table { .. } => None,
        }
    }

    /// True for noise of some size, which [`Self::ends_rad`] leaves out.
    pub(crate) fn is_noise(&self) -> bool {
        matches!(self.0, Kind::Shape { amplitude_rad, shape: Shape::Noise { .. } } if amplitude_rad != 0.0)
    }

    /// Least and largest set-point that is commanded in all time, rad; the trim is one of them. Noise is left out.
    #[must_use]
    pub fn ends_rad(&self) -> [f64; 2] {
        match &self.0 {
            Kind::Shape { amplitude_rad, shape } => extremes(&[(*amplitude_rad, shape)]),
            Kind::Table { setpoint_rad, .. } => setpoint_rad
                .iter()
                .fold([0.0, 0.0], |[least, most], value| [value.min(least), value.max(most)]),
        }
    }

    /// Set-points of a table that holds each of them, rad; of a shape they are its ends.
    pub(crate) fn held_rad(&self) -> Vec<f64> {
        match &self.0 {
            Kind::Table { setpoint_rad, interpolation: Interpolation::Hold, .. } => {
                let mut held = setpoint_rad.clone();
                held.sort_by(f64::total_cmp);
                held.dedup();
                held
            }
            Kind::Table { .. } | Kind::Shape { .. } => Vec::new(),
        }
    }

    /// Set-point at each sample, rad, and the steps in it.
    #[must_use]
    pub fn sampled(&self, timing: Timing) -> (Vec<f64>, Vec<Edge>) {
        let mut values = vec![0.0; timing.rows()];
        let has_steps = match &self.0 {
            Kind::Shape { amplitude_rad, shape } => {
                shape.add_to(&mut values, *amplitude_rad, timing, 0);
                !shape.levels(timing).is_empty()
            }
            Kind::Table { time_s, setpoint_rad, interpolation } => {
                for (k, value) in values.iter_mut().enumerate() {
                    *value = look_up(time_s, setpoint_rad, *interpolation, timing, k);
                }
                *interpolation == Interpolation::Hold
            }
        };
        let edges = if has_steps { edges(&values) } else { Vec::new() };
        (values, edges)
    }
}

fn look_up(
    time_s: &[f64],
    setpoint_rad: &[f64],
    interpolation: Interpolation,
    timing: Timing,
    k: usize,
) -> f64 {
    let passed = time_s.partition_point(|&time| timing.first_sample_at(time) <= k);
    let Some(last) = passed.checked_sub(1) else {
        return 0.0;
    };
    let (t0, r0) = (time_s[last], setpoint_rad[last]);
    match (interpolation, time_s.get(passed), setpoint_rad.get(passed)) {
        (Interpolation::Linear, Some(&t1), Some(&r1)) => {
            r0 + (r1 - r0) * ((timing.time_s(k) - t0) / (t1 - t0)).clamp(0.0, 1.0)
        }
        _ => r0,
    }
}

/// Every change of a piecewise constant signal, from 0 before the first sample.
#[allow(clippy::float_cmp, reason = "any change of a held value is a step")]
fn edges(values: &[f64]) -> Vec<Edge> {
    let mut edges = Vec::new();
    let mut before = 0.0;
    for (sample, &value) in values.iter().enumerate() {
        if value != before {
            edges.push(Edge { sample, from_rad: before, to_rad: value });
            before = value;
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timing() -> Timing {
        Timing::new(0.1, 3.0).expect("allowed")
    }

    #[test]
    fn a_bipolar_square_wave_rises_from_zero_and_then_swings_by_twice_its_amplitude() {
        let shape = Shape::Square { at_s: 0.0, half_period_s: 1.0, bipolar: true };
        let (values, edges) = Profile::new(2.0, shape).expect("allowed").sampled(timing());
        assert_eq!(&values[8..12], &[2.0, 2.0, -2.0, -2.0]);
        let jumps: Vec<_> = edges.iter().map(|e| (e.sample, e.from_rad, e.to_rad)).collect();
        assert_eq!(jumps, [(0, 0.0, 2.0), (10, 2.0, -2.0), (20, -2.0, 2.0), (30, 2.0, -2.0)]);
    }

    #[test]
    fn a_unipolar_square_wave_returns_to_zero() {
        let shape = Shape::Square { at_s: 0.5, half_period_s: 1.0, bipolar: false };
        let (values, edges) = Profile::new(1.0, shape).expect("allowed").sampled(timing());
        assert_eq!((values[4], values[5], values[15], values[25]), (0.0, 1.0, 0.0, 1.0));
        assert_eq!(edges.len(), 3);
    }

    #[test]
    fn a_doublet_ends_where_it_began() {
        let shape = Shape::Doublet { at_s: 0.5, width_s: 0.5 };
        let (values, edges) = Profile::new(1.0, shape).expect("allowed").sampled(timing());
        assert_eq!((values[5], values[10], values[15]), (1.0, -1.0, 0.0));
        assert_eq!(edges.len(), 3);
    }

    #[test]
    fn a_ramp_and_a_sine_have_no_edges() {
        for shape in
            [Shape::Ramp { at_s: 0.0, width_s: 1.0 }, Shape::Sine { at_s: 0.0, frequency_hz: 0.5 }]
        {
            let (values, edges) = Profile::new(1.0, shape).expect("allowed").sampled(timing());
            assert!(edges.is_empty());
            assert!((values[10] - values[10].round()).abs() < 1e-12);
        }
    }

    #[test]
    fn a_table_holds_or_interpolates_as_asked() {
        let table = |kind| {
            Profile::table(vec![0.5, 1.5], vec![1.0, 3.0], kind).expect("allowed").sampled(timing())
        };
        let (held, edges) = table(Interpolation::Hold);
        assert_eq!((held[4], held[5], held[14], held[15]), (0.0, 1.0, 1.0, 3.0));
        assert_eq!(edges.len(), 2);
        let (linear, edges) = table(Interpolation::Linear);
        assert!((linear[10] - 2.0).abs() < 1e-12 && linear[20] == 3.0 && edges.is_empty());
    }

    #[test]
    fn a_table_out_of_order_is_refused_with_its_row() {
        let error = Profile::table(vec![0.0, 2.0, 1.0], vec![0.0; 3], Interpolation::Hold);
        assert!(matches!(error, Err(SimError::Table { row: 3, .. })), "{error:?}");
        assert!(Profile::table(vec![], vec![], Interpolation::Hold).is_err());
        assert!(Profile::table(vec![0.0], vec![f64::NAN], Interpolation::Hold).is_err());
        assert!(Profile::table(vec![0.0, 1.0], vec![1.0], Interpolation::Hold).is_err());
    }
}
