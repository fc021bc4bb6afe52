//! The thesis: its published numbers, and what is made of recorded runs.

mod published; // every row parses; the memory model against all 27 sizes
mod runs; // which scene, device and variant a record belongs to
