//! The thesis of 2009, measured anew: its published numbers, and tables, figures, claims and a report as pure functions
//! of recorded runs. Nothing here measures, reads a clock or looks at the machine: the same runs give the same bytes.

pub mod builds;
pub mod claims;
pub mod convention;
pub mod data;
pub mod figures;
pub mod format;
pub mod measured;
pub mod number;
pub mod published;
pub mod report;
pub mod runs;
pub mod scenes;
pub mod splice;
pub mod sweeps;
pub mod table;
pub mod tables;
pub mod variant;
pub mod workload;
