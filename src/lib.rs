//! rtbench: a headless benchmark for ray tracing on GPUs.
//!
//! Data flows down one staircase; a module uses only modules above it (`tests/it/architecture.rs` holds us to it):
//!
//! | step | what it is |
//! |---|---|
//! | [`error`] | the one error that reaches a user: file, line, problem, mend |
//! | [`threads`] | pools of threads to measure with |
//! | [`math`] | boxes, rays, and the ray/box test; the twin of `kernels/lib/geom.wgsl` |
//! | [`intersect`] | ray/triangle tests |
//! | [`scene`] | mesh, materials, lights; one file per format; procedural scenes |
//! | [`config`] | ray configurations P, PS and PSR |
//! | [`camera`] | cameras, camera paths and their files |
//! | [`accel`] | acceleration structures: builders, node layouts, validation, memory model |
//! | [`backend`] | what a device must be able to do: render, count, time, trace |
//! | [`cpu`] | a twin of every kernel, with the same names |
//! | [`gpu`] | wgpu: devices, kernel assembly, uploads, timers. Only here stands a wgpu type |
//! | [`results`] | records and their schema, journal, statistics, CSV, JSON, tables, pictures |
//! | [`thesis`] | the thesis's numbers; tables, figures, claims and report from recorded runs |
//! | [`bench`] | plan, verify, measure, environment: writes records. Only here (and in builds) is a clock read |
//! | [`fetch`] | downloads of the catalogue's scenes |
//! | [`cli`] | one file per command; only here is anything printed |

pub mod accel;
pub mod backend;
pub mod bench;
pub mod camera;
pub mod cli;
pub mod config;
pub mod cpu;
pub mod error;
pub mod fetch;
pub mod gpu;
pub mod intersect;
pub mod math;
pub mod results;
pub mod scene;
pub mod thesis;
pub mod threads;

pub use error::{Error, Result};
