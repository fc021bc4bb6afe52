//! The reader of `.aff`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtbench_fuzz::scene("aff", bytes));
