// Photons without the empty slots, in the order of the slots.

//!include splat/list.wgsl

@group(0) @binding(0) var<uniform> list: List;
@group(0) @binding(1) var<storage, read> slot_positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> slot_directions: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> slot_fluxes: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> places: array<u32>; // photons in the slots before each
@group(0) @binding(5) var<storage, read_write> positions: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> directions: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluxes: array<vec4<f32>>;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local_index: u32) {
    let slot = list_index(group, local_index, list.row_groups);
    if (slot >= list.count) {
        return;
    }
    let position = slot_positions[slot];
    if (position.w > 0.0) {
        let place = places[slot];
        positions[place] = position;
        directions[place] = slot_directions[slot];
        fluxes[place] = slot_fluxes[slot];
    }
}
