//! Records of a run and everything that is made of them.
//!
//! Measuring only writes records ([`record`], [`journal`]); the CSV files, the JSON and the tables are pure functions of
//! a journal ([`summary`], [`table`]), so that they can be made again at any time, on any machine.

pub mod files;
pub mod journal;
pub mod picture;
pub mod rays_csv;
pub mod schema;
pub mod statistics;
pub mod summary;
pub mod table;
