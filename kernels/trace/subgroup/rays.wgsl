// Secondary and given rays where primary rays go in packets: one ray per invocation.

//!include trace/wide/stack.wgsl
