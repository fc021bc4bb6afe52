// Positions of samples along the axes of the boxes, and their keys. One invocation per pixel. Twin:
// src/workloads/splat/clusters/keys.rs.

//!include splat/clusters/placement.wgsl
//!include splat/directions.wgsl
//!include splat/list.wgsl
//!include splat/view.wgsl

struct KeyJob {
    tile: u32,    // side in pixels
    columns: u32, // of tiles
    rows: u32,
    slices: u32,
}

const NONE = 0xffffffffu; // the key of a pixel without a sample

@group(0) @binding(1) var<uniform> job: KeyJob;
@group(0) @binding(2) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> spread: array<u32>; // bits of columns, then of rows, then of slices
@group(0) @binding(5) var<storage, read_write> placement: array<vec4<f32>, 4>;
@group(0) @binding(6) var<storage, read_write> positions: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> keys: array<u32>;
@group(0) @binding(8) var<storage, read> borders: array<f32>;

// The last slice that begins no farther away; the first for what is nearer than all.
fn slice_of(depth: f32) -> u32 {
    var first = 0u;
    var end = job.slices;
    while (end - first > 1u) {
        let middle = first + (end - first) / 2u;
        if (borders[view.first_border + middle] <= depth) {
            first = middle;
        } else {
            end = middle;
        }
    }
    return first;
}

fn normal_index(normal: vec3<f32>) -> u32 {
    if (NORMAL_BITS == 3u) {
        return direction_face(normal);
    }
    if (NORMAL_BITS == 6u) {
        return direction_index(normal);
    }
    return 0u;
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let pixel = list_index(group, local_index, view.row_groups);
    if (pixel == 0u) {
        placement[0] = vec4<f32>(view.axis_x, 0.0);
        placement[1] = vec4<f32>(view.axis_y, 0.0);
        placement[2] = vec4<f32>(view.axis_z, 0.0);
        placement[3] = vec4<f32>(view.axes_origin, view.margin);
    }
    if (pixel >= view.pixels) {
        return;
    }
    let sample = samples[pixel];
    var position = vec4<f32>(0.0, 0.0, 0.0, 0.0);
    var key = NONE;
    if (sample.w > 0.0) {
        let axes = Placement(view.axis_x, view.axis_y, view.axis_z, view.axes_origin, view.margin);
        position = vec4<f32>(placed(axes, sample.xyz), sample.w);
        let column = (pixel % view.width) / job.tile;
        let row = (pixel / view.width) / job.tile;
        let tile = spread[column] | spread[job.columns + row];
        key = tile | spread[job.columns + job.rows + slice_of(sample.w)] | normal_index(normals[pixel].xyz);
    }
    positions[pixel] = position;
    keys[pixel] = key;
}
