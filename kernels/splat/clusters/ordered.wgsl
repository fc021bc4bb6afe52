// Floats as words that are ordered as they are; -0 comes right before 0. Twin: src/workloads/splat/clusters/bounds.rs.

const SIGN = 0x80000000u;

fn ordered(value: f32) -> u32 {
    let bits = bitcast<u32>(value);
    return select(bits | SIGN, ~bits, (bits & SIGN) != 0u);
}

fn unordered(word: u32) -> f32 {
    return bitcast<f32>(select(~word, word & ~SIGN, (word & SIGN) != 0u));
}
