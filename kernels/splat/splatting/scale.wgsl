// The factor from flux to the words of buckets, by the flux of all photons. One work-group; each invocation adds up
// blocks of photons, and a tree adds up the invocations. Twin: `scale` of src/workloads/splat/splatting/buckets.rs.

struct ScaleJob {
    slots: u32,    // most photons
    peak: f32,     // largest factor on the flux
    full: f32,     // what all flux counts as
    faintest: f32, // smallest flux that is scaled
}

@group(0) @binding(0) var<uniform> job: ScaleJob;
@group(0) @binding(1) var<storage, read> fluxes: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> state: array<u32>;

var<workgroup> sums: array<vec4<f32>, LANES>;

@compute @workgroup_size(LANES)
fn main(@builtin(local_invocation_index) local_index: u32) {
    let count = min(state[0], job.slots);
    var sum = vec4<f32>(0.0, 0.0, 0.0, 0.0);
    for (var first = local_index; first < count; first += LANES * BLOCK) {
        let end = min(first + LANES * BLOCK, count);
        var block = vec4<f32>(0.0, 0.0, 0.0, 0.0);
        for (var photon = first; photon < end; photon += LANES) {
            block += fluxes[photon];
        }
        sum += block;
    }
    sums[local_index] = sum;
    workgroupBarrier();
    for (var half = LANES / 2u; half > 0u; half = half >> 1u) {
        if (local_index < half) {
            sums[local_index] += sums[local_index + half];
        }
        workgroupBarrier();
    }
    if (local_index == 0u) {
        let all = sums[0];
        let largest = max(max(all.x, all.y), all.z) * job.peak;
        var scale = 0.0;
        if (largest > 0.0) {
            scale = job.full / max(largest, job.faintest);
        }
        state[1] = bitcast<u32>(scale);
    }
}
