//! Scenes of spheres, and their views.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtbench_fuzz::spheres(bytes));
