//! Lights, radii and techniques, as the flags of `rtbench splat` take them.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtbench_fuzz::splat(bytes));
