// Grid walked by packets, slice by slice (Wald et al. 2006). Twin: src/workloads/trace/grid/packet.rs.
//
// The packet's main axis is the one along which most of its rays run fastest. In every slice of cells across it, each
// ray has a rectangle of cells that it may touch; all rays test the triangles of all cells in the rectangle around
// these, again if they meet them in several cells (no mailboxing).

//!include lib/cooperative.wgsl
//!include trace/grid/walk.wgsl

var<workgroup> courses: array<atomic<u32>, 6>; // rays by main axis, upwards and downwards
var<workgroup> low: array<atomic<i32>, 3>;     // cells of the packet: along the main axis, and across it
var<workgroup> high: array<atomic<i32>, 3>;
var<workgroup> packet: array<i32, 6>;          // what one invocation has made of these, for all
var<workgroup> course: u32;

const NO_CELLS: vec2<i32> = vec2<i32>(0x7fffffff, -1);

// A ray as the packet sees it: axes are turned so that x is the main one.
struct Turned {
    origin: vec3<f32>,
    direction: vec3<f32>,
    inv_direction: vec3<f32>,
    origin_min: vec3<f32>,
    origin_max: vec3<f32>,
    grid_min: vec3<f32>,
    last: vec3<i32>, // cell of the highest index
}

fn turn(v: vec3<f32>, main: u32) -> vec3<f32> {
    if (main == 1u) {
        return v.yzx;
    }
    return select(v, v.zxy, main == 2u);
}

fn turned(ray: Ray, main: u32) -> Turned {
    let last = vec3<i32>(turn(vec3<f32>(structure.resolution) - 1.0, main));
    return Turned(
        turn(ray.origin, main), turn(ray.direction, main), turn(ray.inv_direction, main), turn(ray.origin_min, main),
        turn(ray.origin_max, main), turn(structure.bounds_min, main), last
    );
}

// The main axis of a ray: the one on which it moves fastest, the first of equals; plus 3 if it runs downwards.
fn course_of(ray: Ray) -> u32 {
    let d = abs(ray.direction);
    if (d.x >= d.y && d.x >= d.z) {
        return select(0u, 3u, ray.inv_direction.x < 0.0);
    }
    if (d.y >= d.z) {
        return select(1u, 4u, ray.inv_direction.y < 0.0);
    }
    return select(2u, 5u, ray.inv_direction.z < 0.0);
}

fn border(ray: Turned, axis: u32, index: i32, origin: f32) -> f32 {
    return (ray.grid_min[axis] + f32(index) * structure.cell_size - origin) * ray.inv_direction[axis];
}

// Distances at which the ray is in the slab of cell `index`. A ray in the plane between two slabs is in both.
fn slab(ray: Turned, axis: u32, index: i32) -> vec2<f32> {
    let a = border(ray, axis, index, ray.origin_min[axis]);
    let b = border(ray, axis, index + 1, ray.origin_max[axis]);
    return vec2<f32>(min(a, b), max(a, b));
}

// Distance at which the ray leaves the slice; it is behind a ray in the upper plane, which is in the next slice as well.
fn leave_slice(ray: Turned, index: i32) -> f32 {
    return max(border(ray, 0u, index, ray.origin.x), border(ray, 0u, index + 1, ray.origin_min.x));
}

fn guess(ray: Turned, axis: u32, t: f32) -> i32 {
    let place = (ray.origin[axis] + ray.direction[axis] * t - ray.grid_min[axis]) / structure.cell_size;
    return i32(min(max(floor(place), 0.0), f32(ray.last[axis])));
}

// Upwards, cells are left behind first and entered last at the high end; downwards the other way round.
fn meets(ray: Turned, axis: u32, index: i32, interval: vec2<f32>, low_end: bool) -> bool {
    let s = slab(ray, axis, index);
    if (low_end != (ray.inv_direction[axis] < 0.0)) {
        return s.y >= interval.x;
    }
    return s.x <= interval.y;
}

// All cells of an axis whose slab the ray is in at any distance of the interval, from .. to. By the same distances as
// everywhere, so that no cell is missed in which a triangle is hit; the position is only where the search begins.
fn cells_between(ray: Turned, axis: u32, interval: vec2<f32>) -> vec2<i32> {
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

fn propose(axis: u32, range: vec2<i32>) {
    atomicMin(&low[axis], range.x);
    atomicMax(&high[axis], range.y);
}

// What all rays have proposed, the same for all; and a fresh start. Reached by the whole work-group.
fn agree() {
    workgroupBarrier();
    if (lane < 3u) {
        packet[2u * lane] = atomicExchange(&low[lane], NO_CELLS.x);
        packet[2u * lane + 1u] = atomicExchange(&high[lane], NO_CELLS.y);
    }
    workgroupBarrier();
}

// The course that most rays have, the first of equals. Reached by the whole work-group; the answer is uniform.
fn choose_course(ray: Ray, searching: bool) -> u32 {
    if (lane < 3u) {
        atomicStore(&low[lane], NO_CELLS.x);
        atomicStore(&high[lane], NO_CELLS.y);
    }
    if (searching) {
        atomicAdd(&courses[course_of(ray)], 1u);
    }
    workgroupBarrier();
    if (lane == 0u) {
        var most = 0u;
        for (var i = 0u; i < 6u; i += 1u) {
            let rays = atomicExchange(&courses[i], 0u);
            if (rays > most) {
                most = rays;
                course = i;
            }
        }
    }
    return workgroupUniformLoad(&course);
}

fn cell_at(main: u32, slice: i32, i: i32, j: i32) -> vec2<u32> {
    var cell = vec3<i32>(slice, i, j);
    if (main == 1u) {
        cell = cell.zxy;
    } else if (main == 2u) {
        cell = cell.yzx;
    }
    return read_cell(cell);
}

// The nearest hit before `limit`; with `anything`, some hit. Reached by the whole work-group.
fn march(given: Ray, limit: f32, anything: bool, alive: bool) -> Best {
    var best = no_best();
    let bounds = ray_box(given, structure.bounds_min, structure.bounds_max);
    let interval = vec2<f32>(max(bounds.x, 0.0), min(bounds.y, limit));
    var searching = alive && interval.x <= interval.y;
    if (!group_any(searching)) {
        return best;
    }
    let chosen = choose_course(given, searching);
    let main = chosen % 3u;
    let forward = chosen < 3u;
    let ray = turned(given, main);
    let with_packet = (ray.inv_direction.x >= 0.0) == forward;
    if (searching) {
        propose(0u, cells_between(ray, 0u, interval));
    }
    agree();
    let first = workgroupUniformLoad(&packet[0]);
    let last = workgroupUniformLoad(&packet[1]);

    for (var step = 0; step <= last - first; step += 1) {
        let slice = select(last - step, first + step, forward);

        // Which cells of the slice the rays touch
        let inside = slab(ray, 0u, slice);
        let part = vec2<f32>(max(inside.x, interval.x), min(inside.y, interval.y));
        let touching = searching && part.x <= part.y;
        if (touching) {
            propose(1u, cells_between(ray, 1u, part));
            propose(2u, cells_between(ray, 2u, part));
        }
        agree();

        // All of them test everything in all of these
        if (touching) {
            for (var j = packet[4]; j <= packet[5]; j += 1) {
                for (var i = packet[2]; i <= packet[3]; i += 1) {
                    count_inner();
                    let cell = cell_at(main, slice, i, j);
                    for (var k = cell.x; k < cell.x + cell.y; k += 1u) {
                        count_test();
                        test_triangle(given, k, &best);
                    }
                }
            }
        }

        // Who runs with the packet is done with a hit before the slice's end; others may find a nearer one later
        let leave = leave_slice(ray, slice);
        let behind = with_packet && leave > interval.y;
        let found = select(with_packet && best.t < leave, best.t < limit, anything);
        searching = searching && !behind && !found;
        if (!group_any(searching)) {
            break;
        }
    }
    return best;
}

fn nearest_hit(ray: Ray, alive: bool) -> u32 {
    return march(ray, T_MAX, false, alive).triangle_ref;
}

fn any_hit(ray: Ray, limit: f32, alive: bool) -> bool {
    return march(ray, limit, true, alive).t < limit;
}
