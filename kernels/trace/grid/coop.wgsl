// Grid whose work-group shares out the triangle tests of all its rays. Twin: src/workloads/trace/grid/coop.rs.
//
// Every ray goes on to its next cell that holds triangles. A running sum of the cells' sizes leaves out the rays that
// have none and numbers all tests of the group; each invocation does every GROUP_SIZE-th of them, whichever ray it is
// for. A segmented reduction finds each ray's nearest among the results, and so on until no ray has anything left to
// test.

//!include lib/cooperative.wgsl
//!include trace/grid/walk.wgsl

var<workgroup> group_ray: array<Ray, GROUP_SIZE>;
var<workgroup> first_ref: array<u32, GROUP_SIZE>; // of the ray's cell
var<workgroup> running: array<u32, GROUP_SIZE>;      // tests of this and all earlier rays
var<workgroup> owner: array<u32, GROUP_SIZE>;        // for which ray invocation i has tested
var<workgroup> result: array<Found, GROUP_SIZE>;     // and what it has found

struct Found {
    t: f32,
    triangle: u32,
    triangle_ref: u32,
}

const NOTHING: Found = Found(NO_HIT, MISS, MISS);

fn nearer(a: Found, b: Found) -> Found {
    if (b.t < a.t || (b.t == a.t && b.triangle < a.triangle)) {
        return b;
    }
    return a;
}

// `running` of all rays; the same total for all.
fn number_tests(tests: u32) -> u32 {
    running[lane] = tests;
    workgroupBarrier();
    for (var reach = 1u; reach < GROUP_SIZE; reach = reach << 1u) {
        var sum = running[lane];
        if (lane >= reach) {
            sum += running[lane - reach];
        }
        workgroupBarrier();
        running[lane] = sum;
        workgroupBarrier();
    }
    return workgroupUniformLoad(&running[GROUP_SIZE - 1u]);
}

// The ray for which test number `test` is: the first whose running sum is beyond it.
fn owner_of(test: u32) -> u32 {
    var ray = 0u;
    for (var reach = GROUP_SIZE / 2u; reach > 0u; reach = reach >> 1u) {
        if (running[ray + reach - 1u] <= test) {
            ray += reach;
        }
    }
    return ray;
}

// Test number `test` of the group.
fn do_test(test: u32, ray: u32) -> Found {
    var before = 0u;
    if (ray > 0u) {
        before = running[ray - 1u];
    }
    let triangle_ref = first_ref[ray] + test - before;
    let r = read_triangle_ref(triangle_ref);
    let hit = intersect(group_ray[ray], read_position(r.x), read_position(r.y), read_position(r.z));
    if (hit.t > T_MAX) {
        return NOTHING;
    }
    return Found(hit.t, r.w, triangle_ref);
}

// The nearest result among neighbours with the same owner, at the first of them.
fn reduce_segments() {
    for (var reach = 1u; reach < GROUP_SIZE; reach = reach << 1u) {
        var mine = result[lane];
        if (lane + reach < GROUP_SIZE) {
            if (owner[lane + reach] == owner[lane]) {
                mine = nearer(mine, result[lane + reach]);
            }
        }
        workgroupBarrier();
        result[lane] = mine;
        workgroupBarrier();
    }
}

// With `any`, all tests of the first cell that has a hit are done. Reached by the whole work-group.
fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    var best = Found(limit, 0u, MISS); // no index is lower than 0: nothing exactly at the limit is a hit
    var walk = start_walk(ray, limit);
    var searching = alive && walk.inside;
    var leave = false; // the cell has been visited
    group_ray[lane] = ray;
    loop {
        // On to the next cell that holds anything
        var tests = 0u;
        loop {
            var step = INSIDE;
            while (searching && tests == 0u) {
                if (leave) {
                    step = step_or_stop(ray, limit, any, best.t, &walk);
                    searching = step != OUTSIDE;
                }
                if (step != INSIDE) {
                    break;
                }
                count_inner();
                let cell = read_cell(walk.cell);
                first_ref[lane] = cell.x;
                tests = cell.y;
                leave = true;
            }
            if (step != TIED) {
                break;
            }
            searching = cross_borders_to(ray, &walk, &best);
            leave = false;
        }
        add_tests(tests);
        let total = number_tests(tests);
        if (total == 0u) {
            break;
        }

        // All tests of the group, GROUP_SIZE at a time
        for (var first = 0u; first < total; first += GROUP_SIZE) {
            var found = NOTHING;
            var ray_of_test = GROUP_SIZE; // no ray's
            if (first + lane < total) {
                ray_of_test = owner_of(first + lane);
                found = do_test(first + lane, ray_of_test);
            }
            owner[lane] = ray_of_test;
            result[lane] = found;
            workgroupBarrier();
            reduce_segments();
            // This ray's tests among these begin at
            let begin = max(running[lane] - tests, first);
            if (begin < min(running[lane], first + GROUP_SIZE)) {
                best = nearer(best, result[begin - first]);
            }
            workgroupBarrier();
        }
    }
    return best.triangle_ref;
}

// Leaves a cell; OUTSIDE also at the end of the search.
fn step_or_stop(ray: Ray, limit: f32, any: bool, best: f32, walk: ptr<function, Walk>) -> u32 {
    let border = nearest_border(*walk);
    if (best < border.t || (any && best < limit)) {
        return OUTSIDE;
    }
    return advance(ray, border, walk);
}

fn cross_borders_to(ray: Ray, walk: ptr<function, Walk>, best: ptr<function, Found>) -> bool {
    var nearest = Best((*best).t, (*best).triangle_ref);
    let inside = cross_borders(ray, walk, &nearest);
    if (nearest.triangle_ref != (*best).triangle_ref) {
        *best = Found(nearest.t, read_triangle_ref(nearest.triangle_ref).w, nearest.triangle_ref);
    }
    return inside;
}
