// kd-tree without a full stack: restart, pushdown or a short stack. Twin: src/workloads/trace/kdtree/search.rs.

//!include lib/independent.wgsl
//!include trace/kdtree/trail.wgsl

fn traverse(ray: Ray, limit: f32, any: bool, alive: bool) -> u32 {
    if (!alive) {
        return MISS;
    }
    return search(ray, limit, any, Best(limit, MISS));
}
