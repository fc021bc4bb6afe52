//! Structures with their options, as `--structure` takes them.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtbench_fuzz::structure(bytes));
