//! The reader of caches. The checksum is made right first: no fuzzer would guess it, and behind it are the other checks.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = bytes.to_vec();
    rtbench::scene::cache::reseal(&mut bytes);
    rtbench_fuzz::scene("rtb", &bytes);
});
