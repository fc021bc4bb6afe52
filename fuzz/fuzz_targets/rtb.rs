//! The reader of caches. The checksum is set to a valid value first, because a fuzzer would not guess it, and the other
//! checks follow it.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = bytes.to_vec();
    rtbench::scene::cache::reseal(&mut bytes);
    rtbench_fuzz::scene("rtb", &bytes);
});
