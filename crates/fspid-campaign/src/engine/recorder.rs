//! What measures need of flights side by side: a few columns of all lanes, made traces at the end.

use fspid_core::Faults;
use fspid_sim::batch::Row;
use fspid_sim::{Outcome, Prepared, Trace};

use super::empty_trace;

/// Columns of a trace that is measured.
pub(super) const COLUMNS: usize = 5;

/// Columns of up to `W` flights, one entry a sample.
pub(super) struct Recorder<const W: usize> {
    theta_rad: Vec<[f64; W]>,
    command_rad: Vec<[f64; W]>,
    elevator_rad: Vec<[f64; W]>,
    rows: [usize; W],
    saturated: [usize; W],
    faults: [Faults; W],
}

impl<const W: usize> Recorder<W> {
    pub(super) fn with_room(rows: usize) -> Self {
        let column = || Vec::with_capacity(rows);
        Self {
            theta_rad: column(),
            command_rad: column(),
            elevator_rad: column(),
            rows: [0; W],
            saturated: [0; W],
            faults: [Faults::NONE; W],
        }
    }

    /// Adds a sample of all lanes.
    #[inline(always)]
    pub(super) fn push(&mut self, row: &Row<'_, W>) {
        self.theta_rad.push(*row.theta_rad);
        self.command_rad.push(*row.command_rad);
        self.elevator_rad.push(*row.elevator_rad);
        for lane in 0..W {
            let flies = row.flies(lane);
            self.rows[lane] += usize::from(flies);
            self.saturated[lane] += usize::from(flies && row.saturated(lane));
            if flies {
                self.faults[lane] = row.faults(lane);
            }
        }
    }

    /// The trace of a lane's flight.
    pub(super) fn trace(&self, lane: usize, prepared: &Prepared, outcome: Outcome) -> Trace {
        let rows = self.rows[lane];
        let timing = prepared.timing();
        let of_lane = |column: &mut Vec<f64>, all: &[[f64; W]]| {
            column.extend(all.iter().take(rows).map(|values| values[lane]));
        };
        let mut trace = empty_trace(prepared);
        trace.time_s.extend((0..rows).map(|k| timing.time_s(k)));
        trace.setpoint_rad.extend(prepared.setpoint_rad().iter().take(rows));
        of_lane(&mut trace.theta_rad, &self.theta_rad);
        of_lane(&mut trace.command_rad, &self.command_rad);
        of_lane(&mut trace.elevator_rad, &self.elevator_rad);
        trace.outcome = outcome;
        trace.saturated_samples = self.saturated[lane];
        trace.faults = self.faults[lane];
        trace
    }
}
