//! Recording of flights that are simulated in lanes: the few columns that measures need, assembled into traces at the end.

use fspid_core::Faults;
use fspid_sim::batch::BatchRow;
use fspid_sim::{Prepared, Trace};

/// Columns of a trace that is measured.
pub(super) const COLUMNS: usize = 5;

/// Rows that are handed to their lanes at once: they stay in the nearest cache until the last lane has its own.
const BLOCK: usize = 64;

/// Columns of up to `W` flights, one entry a sample.
#[derive(Debug)]
pub(super) struct Recorder<const W: usize> {
    theta_rad: Vec<[f64; W]>,
    command_rad: Vec<[f64; W]>,
    elevator_rad: Vec<[f64; W]>,
    rows: [usize; W],
    saturated: [usize; W],
    faults: [Faults; W],
}

impl<const W: usize> Recorder<W> {
    /// Forgets the flights before and makes room for others.
    pub(super) fn begin(&mut self, rows: usize) {
        for column in [&mut self.theta_rad, &mut self.command_rad, &mut self.elevator_rad] {
            column.clear();
            column.reserve(rows);
        }
        (self.rows, self.saturated, self.faults) = ([0; W], [0; W], [Faults::NONE; W]);
    }

    /// Adds a sample of all lanes.
    #[inline(always)]
    pub(super) fn push(&mut self, row: &BatchRow<'_, W>) {
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

    /// Fills the empty traces of the lanes, one for each flight that is there.
    pub(super) fn fill(&self, traces: &mut [Trace], flights: &[&Prepared]) {
        for (lane, (trace, prepared)) in traces.iter_mut().zip(flights).enumerate() {
            let rows = self.rows[lane];
            let timing = prepared.timing();
            trace.time_s.extend((0..rows).map(|k| timing.time_s(k)));
            trace.setpoint_rad.extend(prepared.setpoint_rad().iter().take(rows));
            trace.saturated_samples = self.saturated[lane];
            trace.faults = self.faults[lane];
        }
        self.fill_column(&self.theta_rad, traces, |trace| &mut trace.theta_rad);
        self.fill_column(&self.command_rad, traces, |trace| &mut trace.command_rad);
        self.fill_column(&self.elevator_rad, traces, |trace| &mut trace.elevator_rad);
    }

    fn fill_column(
        &self,
        all: &[[f64; W]],
        traces: &mut [Trace],
        column: impl Fn(&mut Trace) -> &mut Vec<f64>,
    ) {
        for (block, rows) in all.chunks(BLOCK).enumerate() {
            for (lane, trace) in traces.iter_mut().enumerate() {
                let rest = self.rows[lane].saturating_sub(block * BLOCK);
                column(trace).extend(rows.iter().take(rest).map(|values| values[lane]));
            }
        }
    }
}

impl<const W: usize> Default for Recorder<W> {
    fn default() -> Self {
        Self {
            theta_rad: Vec::new(),
            command_rad: Vec::new(),
            elevator_rad: Vec::new(),
            rows: [0; W],
            saturated: [0; W],
            faults: [Faults::NONE; W],
        }
    }
}
