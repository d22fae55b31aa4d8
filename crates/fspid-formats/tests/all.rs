//! All integration tests in one binary: linking one takes less than linking many.

mod common;
mod fcl;
mod fcl_fll_abuse;
mod fcl_fll_problems;
mod fcl_fll_round_trips;
mod fcl_jfuzzylogic;
mod fis_abuse;
mod fis_answers;
mod fis_dialects;
mod fis_errors;
mod fis_properties;
mod fis_write;
mod fll;
mod fll_hedges;
mod fml;
