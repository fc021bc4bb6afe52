//! Measuring, for all workloads alike: the plan of a run, verification before timing, the order of passes, the clock,
//! the journal, and resuming. What is measured leaves as [`crate::record`] rows and nothing else. Outside of it only
//! devices and builders read a clock.

pub mod ab;
pub mod environment;
mod failure;
pub mod measure;
mod order;
mod outcome;
mod plan;
pub mod preset;
pub mod previous;
pub mod run;
pub mod shard;
pub mod summary;
mod turns;
pub mod warnings;
pub mod workload;

pub use order::order;
pub use plan::{Plan, Request, parse_list, split_list};
