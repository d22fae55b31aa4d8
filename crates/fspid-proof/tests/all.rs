//! All integration tests in one binary: linking one takes less than linking many.

use fspid_proof::LoopDescription;

mod certify;
mod check_definite;
mod check_disturbed;
mod check_driven;
mod check_exponential;
mod check_forged;
mod check_growth;
mod check_lyapunov;
mod check_matrix;
mod check_plant;
mod check_plant_set;
mod family;
mod flown_proofs;
mod gain_set;
mod gain_set_common;
mod moving_numbers;
mod paper_loop;
mod range;
mod solve_growth;
mod solve_loops;
mod solve_lyapunov;
mod solve_moving;
mod steps;
