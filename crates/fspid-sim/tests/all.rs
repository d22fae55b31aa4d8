//! All integration tests in one binary: linking one takes less than linking many.

mod autopilot;
mod batch;
mod clocks;
mod closed_loop;
mod describing;
mod empirical;
mod flown_on;
mod gradient;
mod held_limits;
mod in_flight;
mod moving_air;
mod reference;
mod replay;
mod set_centres;
mod squadron;
#[path = "../../fspid-aircraft/tests/support/mod.rs"]
mod support;
mod surroundings;
mod trajectory;
