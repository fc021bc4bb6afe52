// From numbers within tiles to identifiers: those of the tiles before come first. One invocation per pixel. Twin:
// `sort` of src/workloads/splat/clusters/unique.rs.

//!include splat/clusters/tile.wgsl
//!include splat/list.wgsl

@group(0) @binding(1) var<storage, read> keys: array<u32>;
@group(0) @binding(2) var<storage, read> tiles: array<u32>; // clusters in the tiles before each
@group(0) @binding(3) var<storage, read_write> identifiers: array<u32>;
@group(0) @binding(4) var<storage, read_write> cluster_keys: array<u32>;
@group(0) @binding(5) var<storage, read_write> places: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, job.row_groups);
    if (pixel >= job.width * job.height || keys[pixel] == NONE) {
        return;
    }
    let key = keys[pixel];
    let column = (pixel % job.width) / job.tile;
    let row = (pixel / job.width) / job.tile;
    let identifier = tiles[row * job.columns + column] + identifiers[pixel];
    identifiers[pixel] = identifier;
    if (identifier < job.clusters) {
        cluster_keys[identifier] = key; // all samples of the cluster store the same
        places[key] = identifier;
    }
}
