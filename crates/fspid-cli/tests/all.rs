//! All integration tests in one binary: linking one takes less than linking many.

mod accepted;
mod aircraft;
mod bench;
mod campaign;
mod certify;
mod certify_cases;
mod certify_disturbances;
mod certify_family;
mod certify_nonlinear;
mod cli;
mod common;
mod equations;
mod every_command;
mod export;
mod external;
mod external_fly;
#[cfg(unix)]
mod external_losses;
mod false_safe;
mod flight_stacks;
mod fly;
mod fmu_aircraft;
mod foreign_fmu;
mod fuzzy_system;
mod guide;
mod help_examples;
mod hostile_answers;
mod learn;
mod limit;
#[cfg(target_os = "linux")]
mod memory;
mod no_clock;
mod one_verdict;
#[cfg(unix)]
mod other_simulators;
#[cfg(unix)]
mod own_files;
mod packages;
mod reports;
mod repository;
#[cfg(all(unix, feature = "web"))]
mod serve;
mod small_things;
mod tables;
mod tune;
mod verify;
mod whole_program;
