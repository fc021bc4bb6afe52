// kd-tree, one ray per invocation with a full stack in private memory: every far child is kept.
// Twin: src/workloads/trace/kdtree/stack.rs.

//!include lib/independent.wgsl
//!include trace/kdtree/node.wgsl

// Far children to visit, and the parts of the ray in their cells
var<private> stack_node: array<u32, STACK_SIZE>;
var<private> stack_min: array<f32, STACK_SIZE>;
var<private> stack_max: array<f32, STACK_SIZE>;

struct Walk {
    node: u32,
    // The part of the ray in the node's cell
    t_min: f32,
    t_max: f32,
    depth: u32,     // entries on the stack
    in_plane: bool, // the ray has branched at a plane that it lies in: far sides do not begin behind near ones
}

// Goes down, near child first, to a leaf. A cell whose two ends round to one distance is still visited, as a triangle
// may lie in it alone.
fn walk_to_leaf(ray: Ray, walk: ptr<function, Walk>) -> vec2<u32> {
    var node = read_kd_node((*walk).node);
    while (!is_leaf(node)) {
        count_inner();
        let plane = plane_distances(ray, node);
        let backwards = on_axis(ray.inv_direction, split_axis(node)) < 0.0;
        let left = (*walk).node + 1u;
        let right = right_child(node);
        let near = select(left, right, backwards);
        let far = select(right, left, backwards);
        if (plane.x > (*walk).t_max) {
            (*walk).node = near;
        } else if (plane.y < (*walk).t_min) {
            (*walk).node = far;
        } else {
            (*walk).in_plane = (*walk).in_plane || plane.x != plane.y;
            stack_node[(*walk).depth] = far;
            stack_min[(*walk).depth] = max((*walk).t_min, plane.x);
            stack_max[(*walk).depth] = (*walk).t_max;
            (*walk).depth += 1u;
            (*walk).node = near;
            (*walk).t_max = min((*walk).t_max, plane.y);
        }
        node = read_kd_node((*walk).node);
    }
    return node;
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    let interval = ray_box(ray, tree.bounds_min, tree.bounds_max);
    var walk = Walk(0u, max(interval.x, 0.0), min(interval.y, limit), 0u, false);
    if (!(interval.x <= interval.y && walk.t_min <= walk.t_max)) {
        return MISS;
    }
    var best = Best(limit, MISS);
    loop {
        let leaf = walk_to_leaf(ray, &walk);
        count_leaf();
        if (test_triangles(ray, leaf_first(leaf), leaf_count(leaf), any, &best)) {
            break;
        }
        // Exactly at the border of this leaf's cell the next leaf may hold a triangle at the same distance with a lower
        // index
        if ((best.t < walk.t_max && !walk.in_plane) || walk.depth == 0u) {
            break;
        }
        count_pop();
        walk.depth -= 1u;
        walk.node = stack_node[walk.depth];
        walk.t_min = stack_min[walk.depth];
        walk.t_max = stack_max[walk.depth];
    }
    return best.triangle_ref;
}
