//! Comparing measurements, by pure functions: which rows may be compared with each other, and what a difference says.

pub mod judge;
pub mod pair;
