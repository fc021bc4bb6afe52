//! Path-traced references that were kept.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| rtbench_fuzz::path_traced(bytes));
