//! Camera paths, and their views in a scene.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtbench_fuzz::camera_path(bytes));
