//! Reuse of trace buffers from flight to flight: allocating them anew costs as much as measuring a flight.

use fspid_core::Faults;
use fspid_sim::batch::LANES;
use fspid_sim::{Outcome, Trace};

use super::recorder::Recorder;

/// What a thread keeps from one group of flights to the next; about as much as one group needs.
#[derive(Debug, Default)]
pub struct Memory {
    pub(super) recorder: Recorder<LANES>,
    traces: Vec<Trace>,
}

impl Memory {
    /// A trace without samples and with room for so many, so that a flight asks for none.
    pub(super) fn empty_trace(&mut self, rows: usize) -> Trace {
        let kept = self.traces.pop().unwrap_or_else(new_trace);
        let Trace { time_s, setpoint_rad, theta_rad, command_rad, elevator_rad, .. } = kept;
        let room = |mut column: Vec<f64>| {
            column.clear();
            column.reserve(rows);
            column
        };
        Trace {
            time_s: room(time_s),
            setpoint_rad: room(setpoint_rad),
            theta_rad: room(theta_rad),
            command_rad: room(command_rad),
            elevator_rad: room(elevator_rad),
            ..new_trace()
        }
    }

    /// Takes a trace back that was measured.
    pub(super) fn take_back(&mut self, trace: Trace) {
        self.traces.push(trace);
    }
}

/// Only the columns that measures need are ever filled.
fn new_trace() -> Trace {
    Trace {
        time_s: Vec::new(),
        setpoint_rad: Vec::new(),
        theta_rad: Vec::new(),
        q_rad_s: Vec::new(),
        command_rad: Vec::new(),
        elevator_rad: Vec::new(),
        gains: Vec::new(),
        autopilot_limited: Vec::new(),
        columns: Vec::new(),
        exit: None,
        outcome: Outcome::Completed,
        saturated_samples: 0,
        faults: Faults::NONE,
    }
}
