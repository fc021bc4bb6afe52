//! What a run is: rows and their schema, the journal, statistics, and files derived from them.
//!
//! Measuring only writes records ([`row`], [`run`], [`journal`]); CSV files, JSON and tables are pure functions of a
//! journal, so that they can be made again at any time, on any machine.

pub mod files;
pub mod journal;
pub mod merge;
pub mod picture;
pub mod row;
pub mod run;
pub mod schema;
pub mod statistics;
pub mod stream;
pub mod terminal;
