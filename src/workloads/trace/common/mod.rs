//! Parts that builders of several structures share.

pub(crate) mod check;
pub mod estimate;
pub mod memory;
pub mod prims;
pub mod properties;
pub mod sah;
