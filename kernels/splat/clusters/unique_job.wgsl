// What the passes over pixels, words of bits, or clusters need to know.

//!include splat/list.wgsl

struct UniqueJob {
    count: u32,      // pixels, words or clusters
    row_groups: u32,
    first_word: u32, // where the bits of keys begin in the masks
    clusters: u32,   // most of them
}

@group(0) @binding(0) var<uniform> job: UniqueJob;
