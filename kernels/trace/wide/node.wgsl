// Trees of WIDTH children a node with quantised boxes: a child is one texel, 16 bits a plane in units of the scene.
// Twin: src/workloads/trace/wide/layout.rs.

//!include trace/bvh/reference.wgsl

struct Wide {
    bounds_min: vec3<f32>,
    root: u32, // what the whole tree is: its one leaf, node 0, or EMPTY
    bounds_max: vec3<f32>,
    axes: u32, // of four places: the axis of the low bit, and from bit 2 on that of the high bit
    lo: vec3<f32>, // plane 0 on each axis
    pad1: u32,
    step: vec3<f32>, // between neighbouring planes: a power of two
    pad2: u32,
}

@group(0) @binding(7) var<uniform> tree: Wide;

struct Slot {
    lo: vec3<f32>,
    reference: u32, // EMPTY if it holds no child
    hi: vec3<f32>,
}

// The i-th slot of all: those of a node are WIDTH together. The product is exact, so that a fused operation rounds
// alike.
fn read_slot(i: u32) -> Slot {
    let words = read_node16(i);
    let low = vec3<u32>(words.x & 0xffffu, words.x >> 16u, words.y & 0xffffu);
    let high = vec3<u32>(words.y >> 16u, words.z & 0xffffu, words.z >> 16u);
    let lo = tree.lo + vec3<f32>(low) * tree.step;
    let hi = tree.lo + vec3<f32>(high) * tree.step;
    return Slot(lo, words.w, hi);
}

// Where the i-th slot leads to.
fn read_reference(i: u32) -> u32 {
    return read_node16(i).w;
}

fn read_root() -> Slot {
    return Slot(tree.bounds_min, tree.root, tree.bounds_max);
}
