// A pass over elements: each invocation takes every `stride`-th one from its own index on.

struct Job {
    count: u32,    // elements
    stride: u32,   // invocations of the dispatch
    workers: u32,  // invocations that sort
    chunk: u32,    // elements of each of them
    shift: u32,    // first bit of the digit that is sorted by
    level: u32,    // level of the nodes whose children have boxes
    max_leaf: u32, // most triangles of a leaf
    first: u32,    // first inner node of the pass
    radius: u32,   // places between partners
    forced: u32,   // 1 where all clusters merge in pairs
    leaves: u32,   // triangles of the tree
    unit: f32,     // about 1 over the scene's extent
    lo: vec3<f32>, // the corner where cells of Morton codes begin
    pad0: f32,
    scale: vec3<f32>, // cells per unit
    pad1: f32,
}

@group(0) @binding(0) var<uniform> job: Job;
