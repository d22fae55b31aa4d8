#![doc = include_str!("../README.md")]
//!
//! ```text
//! scenario ─plan▶ ranges of runs ─shard▶ a Parquet file each ─merge▶ one file ─summarise▶ report
//! ```
//!
//! No features. Not here: what a scenario and its dispersions are (`fspid-scenario`).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

pub mod bench;
mod campaign;
mod draws;
pub mod engine;
mod error;
mod folder;
pub mod local;
mod merge;
mod parts;
mod plan;
mod planning;
mod range;
pub mod rare;
pub mod replay;
pub mod report;
pub mod rows;
pub mod sample;
pub mod search;
pub mod shard;
pub mod statistics;
pub mod summary;
pub mod table;

pub use campaign::{Campaign, Progress};
pub use draws::Draws;
pub use error::CampaignError;
pub use folder::{Folder, Lock};
pub use merge::{PLAN_KEY, merge};
pub use plan::{MOST_RUNS, MOST_SHARD_RUNS, Plan, SHARD_RUNS, SLOW_SHARD_RUNS};
pub use planning::{Question, Shards, USUAL_RUNS, USUAL_SEED, plan};
pub use range::Range;
