//! rtbench: a headless benchmark for ray tracing on GPUs.
//!
//! Data flows down one staircase; a module uses only modules above it (`tests/it/architecture.rs` holds us to it):
//!
//! | step | what it is |
//! |---|---|
//! | [`names`] | file names as text, names of scenes from paths, names of output files |
//! | [`error`] | the one error that reaches a user: file, line, problem, hint |
//! | [`guard`] | no command writes over what it reads |
//! | [`threads`] | pools of threads to measure with |
//! | [`math`] | boxes, rays, and the ray/box test; the twin of `kernels/lib/geom.wgsl` |
//! | [`scene`] | mesh, materials, lights; one file per format; procedural scenes |
//! | [`camera`] | cameras, camera paths and their files |
//! | [`device`] | what can compute: the CPU or a Vulkan adapter; frames of passes and their times |
//! | [`record`] | rows and their schema, journal, statistics, pictures |
//! | [`report`] | tables and their formats, figures, HTML |
//! | [`compare`] | which measurements compare, and what a difference says |
//! | [`harness`] | plan, order, clock, journal, resuming: one measuring loop for all workloads |
//! | [`workloads`] | what can be measured; [`workloads::trace`] is ray tracing over triangles |
//! | [`sources`] | documents with published numbers; tables, figures, claims and report from recorded runs |
//! | [`fetch`] | downloads of the catalogue's scenes |
//! | [`cli`] | one file per command; only here is anything printed |

pub mod camera;
pub mod cli;
pub mod compare;
pub mod device;
pub mod error;
pub mod fetch;
pub mod guard;
pub mod harness;
pub mod math;
pub mod names;
pub mod record;
pub mod report;
pub mod scene;
pub mod sources;
pub mod threads;
pub mod workloads;

pub use error::{Error, Result};
