// The ray for box tests. With WIDENED, for trees with clipped boxes, it meets boxes that are a little larger: by 2^-20
// of the largest distance on an axis between its origin and the scene. Twin: src/workloads/trace/bvh/widened.rs.
fn widened(ray: Ray) -> Ray {
    if (!WIDENED) {
        return ray;
    }
    let root = read_root();
    let reach = max(abs(root.lo - ray.origin), abs(root.hi - ray.origin));
    let margin = vec3<f32>(max(max(reach.x, reach.y), reach.z) * (1.0 / 1048576.0));
    var wide = ray;
    wide.origin_min = ray.origin_min + margin;
    wide.origin_max = ray.origin_max - margin;
    return wide;
}
