//! A twin of every kernel in plain Rust, with the same names, the same order of operations and the same counters: the
//! reference for correctness, and the way the main job runs where there is no Vulkan driver.

mod backend;
pub mod count;
pub mod render;
pub mod shade;
pub mod trace;
pub mod traverse;

pub use backend::CpuBackend;
