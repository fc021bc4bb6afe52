//! Parts that builders of several structures share.

pub(crate) mod check;
pub mod estimate;
pub mod memory;
pub(crate) mod part;
pub mod prims;
pub mod properties;
pub mod sah;
