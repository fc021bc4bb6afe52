// kd-tree with ropes (Popov, Günther, Seidel, Slusallek: Stackless KD-Tree Traversal for High Performance GPU Ray
// Tracing, 2007): from a leaf straight on to the node behind the face through which the ray leaves it.
// Twin: src/workloads/trace/kdtree/ropes.rs.
//
// Where a ray passes an edge of cells, or a plane exactly where it enters a node, a stack visits cells of no length
// that no rope leads to. Such a ray is given up, and finished by the search with a trail, which needs no memory either.

//!include lib/independent.wgsl
//!include trace/kdtree/trail.wgsl

// A leaf that is found for a ray.
struct Found {
    leaf: vec2<u32>, // its two words
    unsure: bool,    // the ray is in a plane of a node above at exactly this distance
}

// Goes down from a node to the leaf that the ray is in from distance `t` on.
fn find_leaf(ray: Ray, start: u32, t: f32) -> Found {
    var index = start;
    var unsure = false;
    var node = read_kd_node(index);
    while (!is_leaf(node)) {
        count_inner();
        let plane = plane_distances(ray, node);
        let before = plane.x > t;
        let behind = plane.y < t;
        unsure = unsure || !(before || behind);
        let backwards = on_axis(ray.inv_direction, split_axis(node)) < 0.0;
        index = select(index + 1u, right_child(node), behind != backwards);
        node = read_kd_node(index);
    }
    return Found(node, unsure);
}

// Where a ray leaves a box, and through which face.
struct Exit {
    t: f32,
    axis: u32,
    edge: bool, // through several faces at once
}

fn leave_box(ray: Ray, lo: vec3<f32>, hi: vec3<f32>) -> Exit {
    let far = (select(hi, lo, ray.inv_direction < vec3<f32>(0.0)) - ray.origin_max) * ray.inv_direction;
    let x_first = far.x < far.y;
    let t_xy = select(far.y, far.x, x_first);
    if (far.z < t_xy) {
        return Exit(far.z, 2u, false);
    }
    return Exit(t_xy, select(1u, 0u, x_first), far.x == far.y || far.z == t_xy);
}

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    let interval = ray_box(ray, tree.bounds_min, tree.bounds_max);
    var t = max(interval.x, 0.0);
    if (!(interval.x <= interval.y && t <= min(interval.y, limit))) {
        return MISS;
    }
    var best = Best(limit, MISS);
    var node = 0u;
    loop {
        let found = find_leaf(ray, node, t);
        if (found.unsure) {
            break;
        }
        count_leaf();
        let row = found.leaf.x;
        let low = read_node16(row);
        let high = read_node16(row + 1u);
        if (test_triangles(ray, low.w, high.w, any, &best)) {
            return best.triangle_ref;
        }
        let exit = leave_box(ray, bitcast<vec3<f32>>(low.xyz), bitcast<vec3<f32>>(high.xyz));
        if (best.t < exit.t) {
            return best.triangle_ref;
        }
        // A cell of no length is treated like an edge
        if (exit.edge || exit.t <= t) {
            break;
        }
        let backwards = on_axis(ray.inv_direction, exit.axis) < 0.0;
        let ropes = read_node16(row + select(3u, 2u, backwards));
        node = select(select(ropes.z, ropes.y, exit.axis == 1u), ropes.x, exit.axis == 0u);
        if (node == MISS) {
            return best.triangle_ref;
        }
        count_rope();
        t = exit.t;
    }
    count_fallback();
    return search(ray, limit, any, best);
}
