//! Bounding volume hierarchies.

mod bins;
pub mod build;
pub(crate) mod check;
mod layout;
pub mod packet;
mod partition;
pub mod ploc;
mod ploc_passes;
pub mod stack;

pub use layout::{Bvh, BvhNode, MAX_DEPTH, MAX_LEAF};
