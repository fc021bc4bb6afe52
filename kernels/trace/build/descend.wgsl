// From the inner nodes that one pass made to their children, which are of earlier ones: where the triangles of each
// begin, how deep it lies, and the nodes of the tree. Twin: `node` of src/workloads/trace/build/ploc.rs.

//!include trace/build/job.wgsl
//!include trace/build/ordered.wgsl
//!include trace/build/read_box.wgsl

@group(0) @binding(3) var<storage, read> order: array<u32>;
@group(0) @binding(4) var<storage, read> inner: array<vec4<u32>>; // as in trace/build/merge.wgsl
@group(0) @binding(5) var<storage, read> triangles: array<u32>;   // of each inner node
@group(0) @binding(6) var<storage, read> ranks: array<u32>;       // of inner nodes that are kept, the last one first
@group(0) @binding(7) var<storage, read_write> places: array<vec2<u32>>; // of inner nodes: first triangle, and depth
@group(0) @binding(8) var<storage, read_write> sorted: array<u32>;       // triangles, leaf by leaf
@group(0) @binding(9) var<storage, read_write> nodes: array<vec4<u32>>;  // as src/workloads/trace/bvh/layout.rs says
@group(0) @binding(10) var<storage, read_write> deepest: atomic<u32>;     // levels of inner nodes

fn pair_of(own: u32) -> u32 {
    return 2u + 2u * ranks[job.leaves - 2u - own];
}

// Passes on to a child where its triangles begin, and writes its node unless it is within a leaf. Returns its
// triangles.
fn child(node: u32, first: u32, depth: u32, is_kept: bool, slot: u32) -> u32 {
    var lo = vec3<u32>(0u);
    var hi = vec3<u32>(0u);
    var begin = first;
    var count = 1u;
    if (node < job.leaves) {
        let triangle = order[node];
        sorted[first] = triangle;
        let box = read_box(triangle);
        lo = floats(box.lo);
        hi = floats(box.hi);
    } else {
        let own = node - job.leaves;
        count = triangles[own];
        places[own] = vec2<u32>(first, depth);
        lo = inner[2u * own].xyz;
        hi = inner[2u * own + 1u].xyz;
        if (count > job.max_leaf) {
            begin = pair_of(own);
        }
    }
    if (is_kept) {
        nodes[2u * slot] = vec4<u32>(lo, begin);
        nodes[2u * slot + 1u] = vec4<u32>(hi, select(count, 0u, count > job.max_leaf));
    }
    return count;
}

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < job.count; i += job.stride) {
        let own = job.first + i;
        let is_kept = triangles[own] > job.max_leaf;
        var place = vec2<u32>(0u, 0u);
        if (own == job.leaves - 2u) {
            child(own + job.leaves, 0u, 0u, true, 0u);
        } else {
            place = places[own];
        }
        var slot = 0u;
        if (is_kept) {
            slot = pair_of(own);
            atomicMax(&deepest, place.y + 1u);
        }
        let left = inner[2u * own].w;
        let right = inner[2u * own + 1u].w;
        let count = child(left, place.x, place.y + 1u, is_kept, slot);
        child(right, place.x + count, place.y + 1u, is_kept, slot + 1u);
    }
}
