// The box around all centroids, and the cells that it is divided into on each axis. One work-group. Twin:
// src/workloads/trace/build/codes.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/read_box.wgsl

@group(0) @binding(2) var<storage, read_write> cells: array<f32, 6>; // lower corner, cells per unit

var<workgroup> lower: array<vec3<u32>, GROUP_SIZE>;
var<workgroup> upper: array<vec3<u32>, GROUP_SIZE>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(local_invocation_index) lane: u32) {
    var part = NOTHING;
    for (var i = lane; i < job.count; i += GROUP_SIZE) {
        part = around(part, read_box(i));
    }
    lower[lane] = part.lo;
    upper[lane] = part.hi;
    workgroupBarrier();
    if (lane == 0u) {
        for (var i = 1u; i < GROUP_SIZE; i += 1u) {
            part = around(part, Box(lower[i], upper[i]));
        }
        let lo = bitcast<vec3<f32>>(floats(part.lo));
        let extent = bitcast<vec3<f32>>(floats(part.hi)) - lo;
        // An axis without extent has one cell
        let scale = select(vec3<f32>(0.0), CELLS / extent, extent > vec3<f32>(SMALLEST_EXTENT));
        cells[0] = lo.x;
        cells[1] = lo.y;
        cells[2] = lo.z;
        cells[3] = scale.x;
        cells[4] = scale.y;
        cells[5] = scale.z;
    }
}
