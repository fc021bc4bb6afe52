// The grid's cells and the walk from one to the next. Twin: src/workloads/trace/grid/dda.rs.
//
// The distances of the next cell borders are computed from the cell's index, not summed up: with the formula that the
// builder used (src/workloads/trace/grid/layout.rs), so that a triangle at distance t lies in the cell that the ray is
// in at t.

struct Grid {
    bounds_min: vec3<f32>,
    cell_size: f32,
    bounds_max: vec3<f32>,
    pad0: u32,
    resolution: vec3<u32>,
    pad1: u32,
    octants: array<Octant, 8>,
}

// Constants by the signs of the ray's direction (bit 0: x is negative, 1: y, 2: z).
struct Octant {
    step: vec4<i32>, // +1 or -1 per axis
    end: vec4<i32>,  // first cell index outside the grid per axis
}

@group(0) @binding(7) var<uniform> grid: Grid;

struct Walk {
    cell: vec3<i32>,
    step: vec3<i32>,
    end: vec3<i32>,       // index at which the ray has left the grid
    ahead: vec3<i32>,     // 1 where the border ahead is the cell's upper one
    t_next: vec3<f32>,    // distances of the borders ahead
    inside: bool,
}

// Distance of the plane below cell `index`, on each axis.
fn border_distance(ray: Ray, index: vec3<i32>) -> vec3<f32> {
    let plane = grid.bounds_min + vec3<f32>(index) * grid.cell_size;
    return (plane - ray.origin) * ray.inv_direction;
}

fn start_walk(ray: Ray, limit: f32) -> Walk {
    let interval = ray_box(ray, grid.bounds_min, grid.bounds_max);
    let t_start = max(interval.x, 0.0);
    let negative = ray.inv_direction < vec3<f32>(0.0, 0.0, 0.0);
    let octant = grid.octants[u32(negative.x) | (u32(negative.y) << 1u) | (u32(negative.z) << 2u)];
    var walk: Walk;
    walk.inside = interval.x <= interval.y && interval.y >= 0.0 && t_start <= limit;
    walk.step = octant.step.xyz;
    walk.end = octant.end.xyz;
    walk.ahead = select(vec3<i32>(1, 1, 1), vec3<i32>(0, 0, 0), negative);

    // Guess the first cell by the ray's position, and find it by the distances of borders: the first one that the ray
    // touches at `t_start`. Where the direction is zero, the ray stays in the cell whose lower plane is the last at or
    // below it, which holds the triangles on both sides of that plane.
    let parallel = ray.slack > vec3<f32>(0.0, 0.0, 0.0);
    let resolution = vec3<i32>(grid.resolution);
    let last = walk.end - walk.step;
    let first = resolution - 1 - last;
    let guess = floor((ray.origin + ray.direction * t_start - grid.bounds_min) / grid.cell_size);
    walk.cell = vec3<i32>(min(max(guess, vec3<f32>(0.0, 0.0, 0.0)), vec3<f32>(resolution - 1)));
    loop {
        let t = border_distance(ray, walk.cell + walk.ahead);
        let behind = select(t < vec3<f32>(t_start), t <= vec3<f32>(0.0), parallel) & (walk.cell != last);
        if (!walk.inside || !any(behind)) {
            break;
        }
        walk.cell = select(walk.cell, walk.cell + walk.step, behind);
    }
    loop {
        let t = border_distance(ray, walk.cell + 1 - walk.ahead);
        let beyond = select(t >= vec3<f32>(t_start), t > vec3<f32>(0.0), parallel) & (walk.cell != first);
        if (!walk.inside || !any(beyond)) {
            break;
        }
        walk.cell = select(walk.cell, walk.cell - walk.step, beyond);
    }
    walk.t_next = select(border_distance(ray, walk.cell + walk.ahead), vec3<f32>(T_MAX), parallel);
    return walk;
}

// A cell's first triangle reference, and how many it has.
fn read_cell(cell: vec3<i32>) -> vec2<u32> {
    let c = vec3<u32>(cell);
    return read_node8(c.x + grid.resolution.x * (c.y + grid.resolution.y * c.z));
}

// The nearest of the borders ahead: where the ray leaves its cell.
struct Border {
    t: f32,
    axis: vec3<bool>, // the first of equals
}

fn nearest_border(walk: Walk) -> Border {
    let t = walk.t_next;
    let x = t.x <= t.y && t.x <= t.z;
    let y = t.y <= t.z;
    return Border(select(select(t.z, t.y, y), t.x, x), vec3<bool>(x, !x && y, !x && !y));
}

// What a step leads to: out of the grid, into the neighbour behind the nearest border, or, where several borders are at
// its distance, nowhere yet: cross_borders must follow.
const OUTSIDE: u32 = 0u;
const INSIDE: u32 = 1u;
const TIED: u32 = 2u;

fn advance(ray: Ray, border: Border, walk: ptr<function, Walk>) -> u32 {
    let cell = select((*walk).cell, (*walk).cell + (*walk).step, border.axis);
    let t_next = select((*walk).t_next, border_distance(ray, cell + (*walk).ahead), border.axis);
    if (any(t_next <= vec3<f32>(border.t))) {
        return TIED;
    }
    (*walk).cell = cell;
    (*walk).t_next = t_next;
    return select(OUTSIDE, INSIDE, all(cell != (*walk).end));
}

// Crosses all borders at the distance of the nearest one; false if that leaves the grid. The ray touches every cell
// between them: those before the last one are tested here. From far away, that may be many.
//
// It is called between two loops of steps and not within one: a software driver goes through the text of a branch for
// every step, whether a ray takes it or not.
fn cross_borders(ray: Ray, walk: ptr<function, Walk>, best: ptr<function, Best>) -> bool {
    let t = vec3<f32>(nearest_border(*walk).t);
    let first = (*walk).cell;
    let end = (*walk).end - (*walk).step;
    loop {
        let further = ((*walk).t_next <= t) & ((*walk).cell != end);
        if (!any(further)) {
            break;
        }
        (*walk).cell = select((*walk).cell, (*walk).cell + (*walk).step, further);
        (*walk).t_next = select((*walk).t_next, border_distance(ray, (*walk).cell + (*walk).ahead), further);
    }
    let last = (*walk).cell;
    let leaves = any((*walk).t_next <= t);
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
                        test_triangle(ray, i, best);
                    }
                }
            }
        }
    }
    return !leaves;
}
