//! Comparing measurements, by pure functions: which rows may be compared with each other, and what a difference says.

pub mod baseline;
pub mod bless;
pub mod conditions;
pub mod gate;
pub mod judge;
pub mod pair;
pub mod rounds;
pub mod runs;
mod unique;
