//! Ray tracing over triangles: acceleration structures, traversals, and frames of primary, shadow and reflected rays.

pub mod backend;
pub mod brute;
pub mod bvh;
pub mod common;
pub mod count;
mod cpu;
pub mod given;
pub mod gpu;
pub mod grid;
pub mod intersect;
pub mod kdtree;
pub mod method;
pub mod rays;
mod registry;
pub mod render;
mod selection;
pub mod shade;
mod structure;
pub mod traverse;

pub use common::properties::Properties;
pub use cpu::CpuBackend;
pub use method::{Method, Traversal};
pub use registry::{COMMON_OPTIONS, OptionInfo, VariantInfo, variants};
pub use selection::{Built, Selection};
pub use structure::{Brute, Structure, TriangleRef};
