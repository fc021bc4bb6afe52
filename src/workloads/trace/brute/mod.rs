//! No structure: every ray is tested against every triangle.

pub mod build;
pub mod scan;
