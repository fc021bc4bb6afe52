// What samples read of their clusters' lists.

//!include splat/list.wgsl
//!include splat/splatting/terms.wgsl

struct GatherJob {
    pixels: u32,
    row_groups: u32,
    slots: u32,    // most photons
    capacity: u32, // entries that there is room for
    radius2: f32,
    peak: f32,
    one: f32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> job: GatherJob;
@group(0) @binding(1) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> identifiers: array<u32>;
@group(0) @binding(4) var<storage, read> offsets: array<u32>;
@group(0) @binding(5) var<storage, read> entries: array<u32>;
@group(0) @binding(6) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> directions: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> fluxes: array<vec4<f32>>;

// The entries `first` to before `end`, at most a block, for one sample.
fn block_sum(sample: vec3<f32>, normal: vec3<f32>, first: u32, end: u32) -> vec3<f32> {
    let terms = Terms(job.radius2, job.peak, job.one);
    var sum = vec3<f32>(0.0, 0.0, 0.0);
    for (var entry = first; entry < end; entry += 1u) {
        // An entry is a photon's index, unless there are 2^32 entries or more, which overwrite each other
        let photon = min(entries[entry], job.slots - 1u);
        sum += term(terms, sample, normal, positions[photon].xyz, directions[photon].xyz, fluxes[photon].xyz);
    }
    return sum;
}
