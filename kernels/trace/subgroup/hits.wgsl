// First pass of a frame of packets: what the primary rays hit. A work-group has four by two packets. Twin:
// src/workloads/trace/subgroup/packet.rs.

//!include trace/path.wgsl
//!slot count_rows
//!include trace/subgroup/packet.wgsl

// Pixels of a packet.
const TILE: vec2<u32> = vec2<u32>(select(8u, 4u, RAYS < 4u), select(select(8u, 4u, RAYS < 8u), 2u, RAYS < 2u));

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(subgroup_id) subgroup: u32,
    @builtin(subgroup_size) subgroup_size: u32,
    @builtin(subgroup_invocation_id) invocation: u32,
) {
    cluster_first = invocation & ~7u;
    member = invocation & 7u;
    let number = (subgroup * subgroup_size + cluster_first) >> 3u;
    let group_rows = (frame.rows + 2u * TILE.y - 1u) / (2u * TILE.y);
    let group_place = vec2<u32>(group.x * 4u, row_of_groups(group.y, group_rows) * 2u);
    corner_place = (group_place + vec2<u32>(number & 3u, number >> 2u)) * TILE;
    if (!is_in_band(corner_place)) {
        return;
    }
    let rows = begin_packet();
    begin_rows();
    trace_packet(rows);
    //!repeat RAYS k
    if (is_in_band(place_of({k}u))) {
        keep_hit(pixel_index(place_of({k}u)), nearest_ref[{k}], {k}u);
    }
    //!end
}
