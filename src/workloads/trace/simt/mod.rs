//! What a GPU's warps would issue: the events of the twins, replayed by lanes in lockstep.
//!
//! A warp is so many consecutive invocations of a work-group that share an instruction stream. Its lanes do an event
//! together where the loops of the kernel let them ([`Lockstep`], stated where each traversal is registered); the
//! others wait. An event is *issued* once for a warp in which any lane takes part in it, and *lanes* are those that do.
//! Counts are exact and the same on every machine: they are of the algorithm, not of a device.
//!
//! T. Aila and S. Laine: Understanding the Efficiency of Ray Traversal on GPUs, 2009, bound traversals in this way.
//! Reconvergence at the end of the innermost loop, and weights of events, are ours (`docs/simt-model.md`).

mod lockstep;
pub mod model;
mod reads;
mod stream;
mod sums;
mod warps;

pub use lockstep::{Group, Lockstep, Part, choice, maybe, repeat, replay};
pub use reads::{Loads, Read, SEGMENTS, TestReads};
pub use stream::{EVENTS, Event, Mark, NO_READ, Stream};
pub use sums::{NotWhole, Sums};
pub use warps::InWarps;
