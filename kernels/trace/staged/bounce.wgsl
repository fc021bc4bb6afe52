// A further pass of a staged frame: one reflected ray for each path of the list that the pass before it made, and the
// list for the next pass. One invocation per path. Twin: src/workloads/trace/staged.rs.

//!include trace/path.wgsl
//!include trace/staged/list.wgsl
//!slot append
//!slot update

@group(0) @binding(11) var<storage, read> lengths: array<Length>;
@group(0) @binding(12) var<storage, read> paths: array<Waiting>;

@compute @workgroup_size(GROUP_SIZE)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) local_index: u32,
) {
    lane = local_index;
    let index = group.x * GROUP_SIZE + local_index;
    if (index >= lengths[frame.part].paths) {
        return;
    }
    let waiting = paths[index];
    let ray = make_ray(waiting.origin, waiting.direction);
    var path = Path(ray, true, waiting.colour, waiting.weight, MISS, T_MAX);
    resume(waiting.pixel);
    _ = follow(REFLECTED, &path);
    update(waiting.pixel, rgba8(path.colour));
    if (path.alive) {
        append(waiting.pixel, path);
    }
}
