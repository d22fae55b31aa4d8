//! Campaigns: a dispersed scenario flown many times, its results kept, and what they say.
//!
//! ```text
//! scenario ─plan▶ ranges of runs ─shard▶ a Parquet file each ─merge▶ one file ─summarise▶ report
//! ```
//!
//! Run *i* depends on the campaign and on *i* alone, so that nothing else (shards, threads, order,
//! interruptions) can show in the result.

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

pub mod engine;
pub mod sample;
pub mod statistics;
pub mod table;
