// Boxes of the clusters of a tile, one cluster after another in the memory of the work-group, then written once: a
// cluster lies in one tile only. One work-group per tile. Twin: `boxes` of src/workloads/splat/clusters/bounds.rs.

//!include splat/clusters/ordered.wgsl
//!include splat/clusters/tile.wgsl

@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> identifiers: array<u32>;
@group(0) @binding(3) var<storage, read_write> boxes: array<u32>;

var<workgroup> owners: array<u32, TILE_SAMPLES>; // the cluster of each place
var<workgroup> smallest: atomic<u32>;
var<workgroup> current: u32;
var<workgroup> bounds: array<atomic<u32>, 6>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let tile = tile_of(group);
    if (tile >= job.tiles) {
        return;
    }
    for (var i = lane; i < TILE_SAMPLES; i += GROUP_SIZE) {
        let pixel = pixel_at(tile, i);
        var owner = NONE;
        if (pixel != NONE) {
            owner = identifiers[pixel];
        }
        owners[i] = owner;
    }
    // Clusters below it are done
    var next = 0u;
    loop {
        if (lane == 0u) {
            atomicStore(&smallest, NONE);
            for (var i = 0u; i < 6u; i += 1u) {
                atomicStore(&bounds[i], select(0u, NONE, i < 3u));
            }
        }
        workgroupBarrier();
        var own = NONE;
        for (var i = lane; i < TILE_SAMPLES; i += GROUP_SIZE) {
            own = min(own, select(NONE, owners[i], owners[i] >= next));
        }
        if (own != NONE) {
            atomicMin(&smallest, own);
        }
        workgroupBarrier();
        if (lane == 0u) {
            current = atomicLoad(&smallest);
        }
        let cluster = workgroupUniformLoad(&current);
        if (cluster >= job.clusters) {
            break;
        }
        var low = vec3<u32>(NONE, NONE, NONE);
        var high = vec3<u32>(0u, 0u, 0u);
        for (var i = lane; i < TILE_SAMPLES; i += GROUP_SIZE) {
            if (owners[i] == cluster) {
                let position = positions[pixel_at(tile, i)].xyz;
                let words = vec3<u32>(ordered(position.x), ordered(position.y), ordered(position.z));
                low = min(low, words);
                high = max(high, words);
            }
        }
        if (low.x <= high.x) {
            atomicMin(&bounds[0], low.x);
            atomicMin(&bounds[1], low.y);
            atomicMin(&bounds[2], low.z);
            atomicMax(&bounds[3], high.x);
            atomicMax(&bounds[4], high.y);
            atomicMax(&bounds[5], high.z);
        }
        workgroupBarrier();
        if (lane == 0u) {
            for (var i = 0u; i < 6u; i += 1u) {
                boxes[6u * cluster + i] = atomicLoad(&bounds[i]);
            }
        }
        next = cluster + 1u;
    }
}
