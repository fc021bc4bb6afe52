//! What warps issue: hand-made events with known counts, every traversal that is modelled, and the thesis of 2009.

mod model;
mod published;
mod streams;
mod study;
mod twins;
