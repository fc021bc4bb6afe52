// The grid's cells and the walk from one to the next. Twin: src/cpu/traverse/grid.rs.
//
// The distances of the next cell borders are computed from the cell's index, not summed up: with the formula that the
// builder used (src/accel/grid.rs), so that a triangle at distance t lies in the cell that the ray is in at t.

struct Walk {
    cell: vec3<i32>,
    step: vec3<i32>,
    end: vec3<i32>,       // index at which the ray has left the grid
    ahead: vec3<i32>,     // 1 where the border ahead is the cell's upper one
    t_next: vec3<f32>,    // distances of the borders ahead
    inside: bool,
}

fn border_distance(ray: Ray, index: vec3<i32>) -> vec3<f32> {
    let plane = structure.bounds_min + vec3<f32>(index) * structure.cell_size;
    return (plane - ray.origin) * ray.inv_direction;
}

fn start_walk(ray: Ray, limit: f32) -> Walk {
    let interval = ray_box(ray, structure.bounds_min, structure.bounds_max);
    let t_start = max(interval.x, 0.0);
    let negative = ray.inv_direction < vec3<f32>(0.0, 0.0, 0.0);
    let octant = structure.octants[u32(negative.x) | (u32(negative.y) << 1u) | (u32(negative.z) << 2u)];
    var walk: Walk;
    walk.inside = interval.x <= interval.y && interval.y >= 0.0 && t_start <= limit;
    walk.step = octant.step.xyz;
    walk.end = octant.end.xyz;
    walk.ahead = select(vec3<i32>(1, 1, 1), vec3<i32>(0, 0, 0), negative);

    // Find the first cell; rounding may put it one too far along the ray, which would skip the one before
    let last = vec3<f32>(structure.resolution) - 1.0;
    let place = floor((ray.origin + ray.direction * t_start - structure.bounds_min) / structure.cell_size);
    walk.cell = vec3<i32>(min(max(place, vec3<f32>(0.0, 0.0, 0.0)), last));
    let behind = border_distance(ray, walk.cell + 1 - walk.ahead);
    let back = walk.cell - walk.step;
    let possible = back >= vec3<i32>(0, 0, 0) & back < vec3<i32>(structure.resolution);
    walk.cell = select(walk.cell, back, behind > vec3<f32>(t_start, t_start, t_start) & possible);
    walk.t_next = border_distance(ray, walk.cell + walk.ahead);
    return walk;
}

// A cell's first record, and how many it has.
fn read_cell(cell: vec3<i32>) -> vec2<u32> {
    let c = vec3<u32>(cell);
    return read_pair(c.x + structure.resolution.x * (c.y + structure.resolution.y * c.z));
}

// Go to the neighbour behind the nearest border; false if that leaves the grid.
fn advance(ray: Ray, walk: ptr<function, Walk>) -> bool {
    let t = (*walk).t_next;
    var axis = vec3<i32>(0, 0, 1);
    if (t.x <= t.y && t.x <= t.z) {
        axis = vec3<i32>(1, 0, 0);
    } else if (t.y <= t.z) {
        axis = vec3<i32>(0, 1, 0);
    }
    (*walk).cell += axis * (*walk).step;
    (*walk).t_next = select(t, border_distance(ray, (*walk).cell + (*walk).ahead), axis == vec3<i32>(1, 1, 1));
    return all((*walk).cell != (*walk).end);
}
