// BVH, one ray per invocation with a private stack, nearer child first. Twin: src/workloads/trace/bvh/stack.rs.

//!include lib/independent.wgsl
//!include trace/bvh/node.wgsl
//!slot loop
