// A packet of 8 * RAYS primary rays, which share their origin, on a tree of WIDTH children a node. Ray k of member i of
// a cluster is pixel k * 8 + i of the packet's tile in Morton order: 4x2, 4x4, 8x4 or 8x8 pixels. The rays k of all
// members are row k. Twin: src/workloads/trace/subgroup/packet.rs.
//
// A node is one read: each member reads and tests one child. Most of its children are dropped by one test for all rays,
// on the interval of their inverse directions. Only rows that met the node's own box test the others one by one. A
// packet without the exact tests would visit the whole tree for rays that go everywhere.
//
// Where rays are alike (no component of a direction near zero, one major axis), the same operations are done with fewer
// instructions: on axes turned so that the major one is the last, and on corners and planes from which the origin is
// subtracted once for all rays.

//!include trace/subgroup/cluster.wgsl

const NONE: u32 = 0xffffffffu;            // the key of no child
const DISTANCE_BITS: u32 = 0xfffff800u;   // of a key; below are the rows that want the child, and its number
const ALIKE_INVERSE: f32 = 1048576.0;     // largest inverse of a direction's component in a packet of alike rays

// Of this invocation's rays, turned.
var<private> inverses: array<vec3<f32>, RAYS>;
var<private> nearest_t: array<f32, RAYS>;   // -1 for pixels outside of the image
var<private> nearest_ref: array<u32, RAYS>; // triangle reference, or MISS

// Of the packet.
var<private> corner_place: vec2<u32>; // its first pixel in the band
var<private> alike: bool;
var<private> turn: u32;               // major axis of all rays; 2 where they are not alike
var<private> inverse_lo: vec3<f32>;   // the smallest and largest inverse directions by axis, turned
var<private> inverse_hi: vec3<f32>;
var<private> origin_hi: vec3<f32>;    // the largest origin_min and the smallest origin_max of its rays, turned
var<private> origin_lo: vec3<f32>;
var<private> farthest: f32;           // the largest of all nearest_t

// The major axis last, the others as intersect projects them.
fn turned(v: vec3<f32>) -> vec3<f32> {
    return select(select(v, v.xzy, turn == 1u), v.yzx, turn == 0u);
}

fn member_place(i: u32) -> vec2<u32> {
    return vec2<u32>((i & 1u) | ((i >> 1u) & 2u), (i >> 1u) & 1u);
}

fn row_place(k: u32) -> vec2<u32> {
    return vec2<u32>((k & 2u) << 1u, ((k & 1u) << 1u) | (k & 4u));
}

fn place_of(k: u32) -> vec2<u32> {
    return corner_place + member_place(member) + row_place(k);
}

fn ray_of(k: u32) -> Ray {
    let place = place_of(k);
    return primary_ray(sample_position(frame.first_column + place.x, frame.first_row + place.y));
}

// Makes the rays; returns a bit for each row that has a pixel in the image.
fn begin_packet() -> u32 {
    var majors = 0u;
    var rows = 0u;
    turn = 2u;
    inverse_lo = vec3<f32>(T_MAX);
    inverse_hi = vec3<f32>(-T_MAX);
    //!repeat RAYS k
    {
        let ray = ray_of({k}u);
        let alive = is_in_band(place_of({k}u));
        inverses[{k}] = ray.inv_direction;
        nearest_t[{k}] = select(-1.0, T_MAX, alive);
        nearest_ref[{k}] = MISS;
        inverse_lo = min(inverse_lo, ray.inv_direction);
        inverse_hi = max(inverse_hi, ray.inv_direction);
        majors |= 1u << ray.major;
        rows |= select(0u, 1u << {k}u, alive);
    }
    //!end
    inverse_lo = -cluster_max3(-inverse_lo);
    inverse_hi = cluster_max3(inverse_hi);
    let steepest = max(abs(inverse_lo), abs(inverse_hi));
    let all_majors = cluster_or(majors);
    alike = ALIKE_FORM && countOneBits(all_majors) == 1u
        && max(max(steepest.x, steepest.y), steepest.z) <= ALIKE_INVERSE;
    // As make_ray shifts them
    let shift = max(abs(frame.origin) * PLANE_SHIFT, vec3<f32>(PLANE_SHIFT_MIN));
    let parallel = inverse_hi == vec3<f32>(INVERSE_OF_ZERO);
    var any_ray = ray_of(0u);
    any_ray.origin_min = select(frame.origin, frame.origin + shift, parallel);
    any_ray.origin_max = select(frame.origin, frame.origin - shift, parallel);
    let wide = widened(any_ray);
    origin_hi = wide.origin_min;
    origin_lo = wide.origin_max;
    if (alike) {
        turn = firstTrailingBit(all_majors);
        inverse_lo = turned(inverse_lo);
        inverse_hi = turned(inverse_hi);
        origin_hi = turned(origin_hi);
        origin_lo = turned(origin_lo);
        //!repeat RAYS k
        inverses[{k}] = turned(inverses[{k}]);
        //!end
    }
    farthest = T_MAX;
    return cluster_or(rows);
}

fn find_farthest() {
    var t = nearest_t[0];
    //!repeat RAYS k
    t = max(t, nearest_t[{k}]);
    //!end
    farthest = cluster_max(t);
}

//!include trace/subgroup/children.wgsl
//!include trace/subgroup/leaf.wgsl

// The children of a node that rays want, one for each member, and what they lead to.
var<private> stack_keys: array<u32, STACK_SIZE>;
var<private> stack_refs: array<u32, STACK_SIZE>;

// Finds the nearest hits, nearer children first. The stack holds the children of a node that are left when one of them
// is entered.
fn trace_packet(all_rows: u32) {
    var depth = 0u;
    var node = 0u;
    var rows = all_rows;
    loop {
        add_rows_inner(rows);
        var children = test_children(node, rows);
        var least = cluster_least(children.key);
        var is_done = false;
        // Through leaves, to the next node
        loop {
            if (least == NONE || bitcast<f32>(least & DISTANCE_BITS) > farthest) {
                is_done = depth == 0u;
                if (is_done) {
                    break;
                }
                // Never below 0: lavapipe reads the stack for clusters that are done as well
                depth = max(depth, 1u) - 1u;
                add_rows_pops(all_rows);
                children = Children(stack_keys[depth], stack_refs[depth]);
                least = cluster_least(children.key);
                continue;
            }
            rows = (least >> 3u) & 255u;
            let reference = from_member(children.reference, least & 7u);
            children.key = select(children.key, NONE, member == (least & 7u));
            least = cluster_least(children.key);
            if (!is_leaf(reference)) {
                if (least != NONE) {
                    stack_keys[depth] = children.key;
                    stack_refs[depth] = children.reference;
                    depth += 1u;
                }
                node = reference;
                break;
            }
            add_rows_leaves(rows);
            test_leaf(leaf_first(reference), leaf_count(reference), rows);
        }
        if (is_done) {
            break;
        }
    }
}
