//! Uniform grid.

pub mod build;
pub(crate) mod check;
pub mod coop;
pub mod dda;
mod layout;
pub mod octants;
pub mod packet;

pub use layout::{Cell, Grid, plane};
