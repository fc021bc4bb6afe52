//! rtbench: a headless benchmark for ray tracing on GPUs.
//!
//! Data flows down one staircase; a module uses only modules above it (`tests/it/architecture.rs` holds us to it):
//!
//! | step | what it is |
//! |---|---|
//! | [`error`] | the one error that reaches a user: file, line, problem, hint |
//! | [`threads`] | pools of threads to measure with |
//! | [`math`] | boxes, rays, and the ray/box test; the twin of `kernels/lib/geom.wgsl` |
//! | [`scene`] | mesh, materials, lights; one file per format; procedural scenes |
//! | [`camera`] | cameras, camera paths and their files |
//! | [`record`] | records and their schema, journal, statistics, pictures |
//! | [`workloads`] | what can be measured; [`workloads::trace`] is ray tracing over triangles |
//! | [`thesis`] | the thesis's numbers; tables, figures, claims and report from recorded runs |
//! | [`harness`] | plan, verify, measure, environment: writes records |
//! | [`fetch`] | downloads of the catalogue's scenes |
//! | [`cli`] | one file per command; only here is anything printed |

pub mod camera;
pub mod cli;
pub mod error;
pub mod fetch;
pub mod harness;
pub mod math;
pub mod record;
pub mod scene;
pub mod thesis;
pub mod threads;
pub mod workloads;

pub use error::{Error, Result};
