// Grid walked by packets, slice by slice (Wald et al. 2006). Twin: src/workloads/trace/grid/packet.rs.
//
// The packet's major axis is the one along which most of its rays run fastest. In every slice of cells across it, each
// ray has a rectangle of cells that it may touch; all rays test the triangles of all cells in the rectangle around
// these, again if they meet them in several cells (no mailboxing).

//!include lib/cooperative.wgsl
//!include trace/grid/walk.wgsl

var<workgroup> axis_votes: array<atomic<u32>, 6>; // rays by major axis, upwards and downwards
var<workgroup> low: array<atomic<i32>, 3>;        // cells of the packet: along the major axis, and across it
var<workgroup> high: array<atomic<i32>, 3>;
var<workgroup> packet: array<i32, 6>;             // low and high of each axis, after reduce_range
var<workgroup> packet_axis: u32;                  // after choose_major_axis

const NO_CELLS: vec2<i32> = vec2<i32>(0x7fffffff, -1);

// A ray with its axes permuted cyclically, so that x is the packet's major axis.
struct PermutedRay {
    origin: vec3<f32>,
    direction: vec3<f32>,
    inv_direction: vec3<f32>,
    origin_min: vec3<f32>,
    origin_max: vec3<f32>,
    grid_min: vec3<f32>,
    last: vec3<i32>, // cell of the highest index
}

fn permute(v: vec3<f32>, major: u32) -> vec3<f32> {
    if (major == 1u) {
        return v.yzx;
    }
    return select(v, v.zxy, major == 2u);
}

fn permute_ray(ray: Ray, major: u32) -> PermutedRay {
    let last = vec3<i32>(permute(vec3<f32>(grid.resolution) - 1.0, major));
    return PermutedRay(
        permute(ray.origin, major), permute(ray.direction, major), permute(ray.inv_direction, major),
        permute(ray.origin_min, major), permute(ray.origin_max, major), permute(grid.bounds_min, major), last
    );
}

// The major axis of a ray, on which it moves fastest, the first of equals; plus 3 if it runs towards smaller
// coordinates.
fn major_axis(ray: Ray) -> u32 {
    let d = abs(ray.direction);
    if (d.x >= d.y && d.x >= d.z) {
        return select(0u, 3u, ray.inv_direction.x < 0.0);
    }
    if (d.y >= d.z) {
        return select(1u, 4u, ray.inv_direction.y < 0.0);
    }
    return select(2u, 5u, ray.inv_direction.z < 0.0);
}

fn border(ray: PermutedRay, axis: u32, index: i32, origin: f32) -> f32 {
    return (ray.grid_min[axis] + f32(index) * grid.cell_size - origin) * ray.inv_direction[axis];
}

// Distances at which the ray is in the slab of cell `index`. A ray in the plane between two slabs is in both.
fn slab(ray: PermutedRay, axis: u32, index: i32) -> vec2<f32> {
    let a = border(ray, axis, index, ray.origin_min[axis]);
    let b = border(ray, axis, index + 1, ray.origin_max[axis]);
    return vec2<f32>(min(a, b), max(a, b));
}

// Distance at which the ray leaves the slice; it is behind a ray in the upper plane, which is in the next slice as
// well.
fn leave_slice(ray: PermutedRay, index: i32) -> f32 {
    return max(border(ray, 0u, index, ray.origin.x), border(ray, 0u, index + 1, ray.origin_min.x));
}

fn guess(ray: PermutedRay, axis: u32, t: f32) -> i32 {
    let place = (ray.origin[axis] + ray.direction[axis] * t - ray.grid_min[axis]) / grid.cell_size;
    return i32(min(max(floor(place), 0.0), f32(ray.last[axis])));
}

// Upwards, cells are left behind first and entered last at the high end; downwards the other way round.
fn meets(ray: PermutedRay, axis: u32, index: i32, interval: vec2<f32>, low_end: bool) -> bool {
    let s = slab(ray, axis, index);
    if (low_end != (ray.inv_direction[axis] < 0.0)) {
        return s.y >= interval.x;
    }
    return s.x <= interval.y;
}

// All cells of an axis whose slab the ray is in at any distance of the interval, from .. to. By the same distances as
// everywhere, so that no cell is missed in which a triangle is hit; the position is only where the search begins.
fn cells_between(ray: PermutedRay, axis: u32, interval: vec2<f32>) -> vec2<i32> {
    let downwards = ray.inv_direction[axis] < 0.0;
    var first = guess(ray, axis, select(interval.x, interval.y, downwards));
    var end = guess(ray, axis, select(interval.y, interval.x, downwards));
    let last = ray.last[axis];
    while (first < last && !meets(ray, axis, first, interval, true)) {
        first += 1;
    }
    while (first > 0 && meets(ray, axis, first - 1, interval, true)) {
        first -= 1;
    }
    while (end > 0 && !meets(ray, axis, end, interval, false)) {
        end -= 1;
    }
    while (end < last && meets(ray, axis, end + 1, interval, false)) {
        end += 1;
    }
    return vec2<i32>(first, end);
}

// Widens the packet's range of cells on an axis by a ray's.
fn atomic_min_max(axis: u32, range: vec2<i32>) {
    atomicMin(&low[axis], range.x);
    atomicMax(&high[axis], range.y);
}

// Moves the ranges of all rays to `packet`, and empties them for the next slice. Reached by the whole work-group.
fn reduce_range() {
    workgroupBarrier();
    if (lane < 3u) {
        packet[2u * lane] = atomicExchange(&low[lane], NO_CELLS.x);
        packet[2u * lane + 1u] = atomicExchange(&high[lane], NO_CELLS.y);
    }
    workgroupBarrier();
}

// The major axis that most rays have, the first of equals, in the same numbering. Reached by the whole work-group; the
// answer is uniform.
fn choose_major_axis(ray: Ray, searching: bool) -> u32 {
    if (lane < 3u) {
        atomicStore(&low[lane], NO_CELLS.x);
        atomicStore(&high[lane], NO_CELLS.y);
    }
    if (searching) {
        atomicAdd(&axis_votes[major_axis(ray)], 1u);
    }
    workgroupBarrier();
    if (lane == 0u) {
        var most = 0u;
        for (var i = 0u; i < 6u; i += 1u) {
            let rays = atomicExchange(&axis_votes[i], 0u);
            if (rays > most) {
                most = rays;
                packet_axis = i;
            }
        }
    }
    return workgroupUniformLoad(&packet_axis);
}

fn cell_at(major: u32, slice: i32, i: i32, j: i32) -> vec2<u32> {
    var cell = vec3<i32>(slice, i, j);
    if (major == 1u) {
        cell = cell.zxy;
    } else if (major == 2u) {
        cell = cell.yzx;
    }
    return read_cell(cell);
}

// With `any`, all tests of the first slice that has a hit are done. Reached by the whole work-group.
fn traverse(unpermuted: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    var best = Best(limit, MISS);
    let bounds = ray_box(unpermuted, grid.bounds_min, grid.bounds_max);
    let interval = vec2<f32>(max(bounds.x, 0.0), min(bounds.y, limit));
    var searching = alive && interval.x <= interval.y;
    if (!group_any(searching)) {
        return MISS;
    }
    let chosen = choose_major_axis(unpermuted, searching);
    let major = chosen % 3u;
    let forward = chosen < 3u;
    let ray = permute_ray(unpermuted, major);
    let with_packet = (ray.inv_direction.x >= 0.0) == forward;
    if (searching) {
        atomic_min_max(0u, cells_between(ray, 0u, interval));
    }
    reduce_range();
    let first = workgroupUniformLoad(&packet[0]);
    let last = workgroupUniformLoad(&packet[1]);

    for (var step = 0; step <= last - first; step += 1) {
        let slice = select(last - step, first + step, forward);

        mark_turn();
        // Which cells of the slice the rays touch
        let inside = slab(ray, 0u, slice);
        let part = vec2<f32>(max(inside.x, interval.x), min(inside.y, interval.y));
        let touching = searching && part.x <= part.y;
        if (touching) {
            atomic_min_max(1u, cells_between(ray, 1u, part));
            atomic_min_max(2u, cells_between(ray, 2u, part));
        }
        reduce_range();

        // All of them test everything in all of these
        if (touching) {
            for (var j = packet[4]; j <= packet[5]; j += 1) {
                for (var i = packet[2]; i <= packet[3]; i += 1) {
                    count_inner();
                    let cell = cell_at(major, slice, i, j);
                    for (var k = cell.x; k < cell.x + cell.y; k += 1u) {
                        count_test();
                        test_triangle(unpermuted, k, &best);
                    }
                }
            }
        }

        // A ray that runs with the packet is done with a hit before the slice's end; another may find a nearer one
        // later
        let leave = leave_slice(ray, slice);
        let behind = with_packet && leave > interval.y;
        let found = select(with_packet && best.t < leave, best.t < limit, any);
        searching = searching && !behind && !found;
        if (!group_any(searching)) {
            break;
        }
    }
    return best.triangle_ref;
}
