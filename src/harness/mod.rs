//! Measuring: the plan of a sweep, verification before timing, the clock, the machine's description. Only here (and
//! in build statistics) is a clock read. What is measured leaves as [`crate::record`] records and nothing else.

pub mod batch;
pub mod building;
pub mod configuration;
pub mod environment;
pub mod measure;
pub mod pictures;
pub mod plan;
pub mod preset;
pub mod resume;
pub mod sweep;
pub mod verify;
