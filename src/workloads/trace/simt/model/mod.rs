//! What issued work means on a GPU: a lower bound of a frame's time, and an order of structures.
//!
//! The issue bound is `cycles per instruction * issued instructions / (multiprocessors * clock)`: the least time of
//! issuing what is counted; latency and memory come on top. For an order, issued instructions are divided by the
//! resident warps, which hide latency. Nothing is fitted.

mod gpu;
mod order;
mod run;
mod weights;

pub use gpu::{Gpu, names};
pub use order::{CLOSE, Modelled, Ranked, rank};
pub use run::tables;
pub use weights::{EVENT_FACTOR, KernelFacts, Weights};
