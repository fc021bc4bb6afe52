// Trees of WIDTH children a node, one ray per invocation with a short private stack of ENTRIES, nearest child first
// (Vaidyanathan, Woop and Benthin 2019). Twin: src/workloads/trace/wide/short_stack.rs.
//
// A trail tells, for each level of the way from the root, how many children were met there and which one the ray is in,
// by its place in the order of distances. A hit only takes children off the end of that order. An entry that finds no
// room takes that of the oldest one. Where the stack is empty, the ray goes down from the root again along the trail.

//!include lib/independent.wgsl
//!include trace/wide/node.wgsl
//!include trace/bvh/widened.wgsl

const TRAIL_WORDS: u32 = (STACK_SIZE + 3u) / 4u;

var<private> stack: array<u32, ENTRIES>; // a ring
var<private> stack_t: array<f32, ENTRIES>;
var<private> stack_top: u32;             // the entry behind the newest one
var<private> stack_depth: u32;
var<private> trail: array<u32, TRAIL_WORDS>; // a byte a level: the child, and 16 times their number
var<private> met: array<u32, WIDTH>;         // the children of a node that the ray meets, nearest first
var<private> met_t: array<f32, WIDTH>;

fn trail_at(level: u32) -> u32 {
    return (trail[level / 4u] >> (8u * (level & 3u))) & 0xffu;
}

fn set_trail(level: u32, value: u32) {
    let shift = 8u * (level & 3u);
    trail[level / 4u] = (trail[level / 4u] & ~(0xffu << shift)) | (value << shift);
}

fn push(reference: u32, t: f32) {
    stack[stack_top] = reference;
    stack_t[stack_top] = t;
    stack_top = select(stack_top + 1u, 0u, stack_top + 1u == ENTRIES);
    stack_depth = min(stack_depth + 1u, ENTRIES);
}

// Finds the children of a node that the ray meets before `t`, nearest first, and of equal distances by their places.
// Returns their number.
fn visit(ray: Ray, node: u32, t: f32) -> u32 {
    count_inner();
    var count = 0u;
    for (var i = 0u; i < WIDTH; i += 1u) {
        let child = read_slot(node * WIDTH + i);
        if (child.reference == EMPTY) {
            break;
        }
        count_box_test();
        let interval = ray_box(ray, child.lo, child.hi);
        if (overlaps(interval, t)) {
            var place = count;
            while (place > 0u && interval.x < met_t[place - 1u]) {
                met[place] = met[place - 1u];
                met_t[place] = met_t[place - 1u];
                place -= 1u;
            }
            met[place] = child.reference;
            met_t[place] = interval.x;
            count += 1u;
        }
    }
    return count;
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    var best = Best(limit, MISS);
    let wide = widened(ray);
    let root = read_root();
    if (root.reference == EMPTY || !overlaps(ray_box(wide, root.lo, root.hi), limit)) {
        return MISS;
    }
    stack_top = 0u;
    stack_depth = 0u;
    var node = root.reference;
    var level = 0u; // of the node
    var known = 0u; // levels of the trail that are valid
    loop {
        if (is_leaf(node)) {
            count_leaf();
            if (test_triangles(ray, leaf_first(node), leaf_count(node), any, &best)) {
                break;
            }
        } else {
            let count = visit(wide, node, best.t);
            var child = 0u;
            if (level < known) {
                child = trail_at(level) & 15u;
            }
            set_trail(level, child | (count << 4u));
            known = max(known, level + 1u);
            if (child < count) {
                for (var i = count - 1u; i > child; i -= 1u) {
                    push(met[i], met_t[i]);
                }
                node = met[child];
                level += 1u;
                continue;
            }
        }
        // The next node: another child on the deepest level that has one
        var found = false;
        while (!found && level > 0u) {
            level -= 1u;
            let place = trail_at(level);
            if ((place & 15u) + 1u < (place >> 4u)) {
                set_trail(level, place + 1u);
                known = level + 1u;
                if (stack_depth == 0u) {
                    count_restart();
                    node = root.reference;
                    level = 0u;
                    found = true;
                } else {
                    count_pop();
                    stack_top = select(stack_top, ENTRIES, stack_top == 0u) - 1u;
                    stack_depth -= 1u;
                    level += 1u;
                    node = stack[stack_top];
                    found = stack_t[stack_top] <= best.t;
                }
            }
        }
        if (!found) {
            break;
        }
    }
    return best.triangle_ref;
}
