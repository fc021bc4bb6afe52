// The loops of trace/bvh/walk.wgsl over pairs of boxes.

//!include trace/bvh/pairs.wgsl
//!include trace/bvh/walk.wgsl
