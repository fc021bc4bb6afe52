// BVH with quantised boxes, one ray per invocation with a private stack, nearer child first: the loops of bvh-stack,
// whose nodes take half the bytes and half the reads. Twin: src/workloads/trace/wide/pair_stack.rs.

//!include lib/independent.wgsl
//!include trace/wide/pair.wgsl
//!include trace/bvh/while_while.wgsl
