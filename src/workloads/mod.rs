//! What rtbench can measure: one folder per workload.

pub mod trace;
