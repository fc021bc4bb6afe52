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

// Distance of the plane below cell `index` of an axis.
fn border_distance(ray: Ray, axis: u32, index: i32) -> f32 {
    let plane = on_axis(structure.bounds_min, axis) + f32(index) * structure.cell_size;
    return (plane - on_axis(ray.origin, axis)) * on_axis(ray.inv_direction, axis);
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
    if (!walk.inside) {
        return walk;
    }

    // Guess the first cell by the ray's position, and find it by the distances of borders
    let last = vec3<f32>(structure.resolution) - 1.0;
    let guess = floor((ray.origin + ray.direction * t_start - structure.bounds_min) / structure.cell_size);
    let cell = vec3<i32>(min(max(guess, vec3<f32>(0.0, 0.0, 0.0)), last));
    for (var axis = 0u; axis < 3u; axis += 1u) {
        walk.cell[axis] = first_cell(ray, axis, t_start, cell[axis], walk);
        walk.t_next[axis] = border_distance(ray, axis, walk.cell[axis] + walk.ahead[axis]);
        if (ray.slack[axis] > 0.0) {
            walk.t_next[axis] = T_MAX;
        }
    }
    return walk;
}

// On one axis, the first cell that the ray touches at `t_start`. Where the direction is zero, the ray stays in the cell
// whose lower plane is the last at or below it, which holds the triangles on both sides of that plane.
fn first_cell(ray: Ray, axis: u32, t_start: f32, guess: i32, walk: Walk) -> i32 {
    let parallel = ray.slack[axis] > 0.0;
    let step = walk.step[axis];
    let last = walk.end[axis] - step;
    let first = i32(structure.resolution[axis]) - 1 - last;
    var cell = guess;
    while (cell != last) {
        let t = border_distance(ray, axis, cell + walk.ahead[axis]);
        if (!select(t < t_start, t <= 0.0, parallel)) {
            break;
        }
        cell += step;
    }
    while (cell != first) {
        let t = border_distance(ray, axis, cell + 1 - walk.ahead[axis]);
        if (!select(t >= t_start, t > 0.0, parallel)) {
            break;
        }
        cell -= step;
    }
    return cell;
}

// A cell's first record, and how many it has.
fn read_cell(cell: vec3<i32>) -> vec2<u32> {
    let c = vec3<u32>(cell);
    return read_pair(c.x + structure.resolution.x * (c.y + structure.resolution.y * c.z));
}

// Go to the neighbour behind the nearest border; false if that leaves the grid. Where several borders are at that distance,
// the ray touches all cells between them: those before the last one are tested here.
fn advance(ray: Ray, walk: ptr<function, Walk>, best: ptr<function, Best>) -> bool {
    let t = (*walk).t_next;
    var axis = 2u;
    if (t.x <= t.y && t.x <= t.z) {
        axis = 0u;
    } else if (t.y <= t.z) {
        axis = 1u;
    }
    let chosen = vec3<bool>(axis == 0u, axis == 1u, axis == 2u);
    let cell = select((*walk).cell, (*walk).cell + (*walk).step, chosen);
    let ahead = cell + (*walk).ahead;
    let index = select(select(ahead.z, ahead.y, axis == 1u), ahead.x, axis == 0u);
    let t_next = select(t, vec3<f32>(border_distance(ray, axis, index)), chosen);
    let t_border = on_axis(t, axis);
    if (min(min(t_next.x, t_next.y), t_next.z) <= t_border) {
        return cross_borders(ray, walk, t_border, best);
    }
    (*walk).cell = cell;
    (*walk).t_next = t_next;
    return all(cell != (*walk).end);
}

// Crosses all borders at distance `t`. From far away, that may be those of many cells.
fn cross_borders(ray: Ray, walk: ptr<function, Walk>, t: f32, best: ptr<function, Best>) -> bool {
    let first = (*walk).cell;
    var last = first;
    var leaves = false;
    for (var axis = 0u; axis < 3u; axis += 1u) {
        while ((*walk).t_next[axis] <= t && last[axis] + (*walk).step[axis] != (*walk).end[axis]) {
            last[axis] += (*walk).step[axis];
            (*walk).t_next[axis] = border_distance(ray, axis, last[axis] + (*walk).ahead[axis]);
        }
        leaves = leaves || (*walk).t_next[axis] <= t;
    }
    let low = min(first, last);
    let high = max(first, last);
    for (var z = low.z; z <= high.z; z += 1) {
        for (var y = low.y; y <= high.y; y += 1) {
            for (var x = low.x; x <= high.x; x += 1) {
                let place = vec3<i32>(x, y, z);
                if (any(place != first) && (any(place != last) || leaves)) {
                    count_inner();
                    let cell = read_cell(place);
                    for (var i = cell.x; i < cell.x + cell.y; i += 1u) {
                        count_test();
                        test_record(ray, i, best);
                    }
                }
            }
        }
    }
    (*walk).cell = last;
    return !leaves;
}
