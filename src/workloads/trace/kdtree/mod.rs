//! SAH kd-tree.

mod bins;
pub mod build;
pub(crate) mod check;
mod events;
mod exact;
mod layout;
pub mod search;

pub use layout::{KdNode, KdTree};
