// trace/intersect/watertight.wgsl for rays without a direction's component of zero, on turned corners from which the
// origin is subtracted. The distance of the hit, or NO_HIT: the same bits as intersect.
//
// Scale and shear are powers of two that are common to all products, so that comparisons and quotients are the same
// without them. They are there for devices that fuse operations: see intersect.

const ALIKE_FORM: bool = true;

// Across the major axis.
fn flat(p: vec3<f32>, scale: vec2<f32>) -> vec2<f32> {
    if (SOFTWARE) {
        return p.xy - p.zz;
    }
    return p.xy * scale - p.zz * scale;
}

fn hit_turned(inverse: vec3<f32>, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> f32 {
    let p0 = v0 * inverse;
    let p1 = v1 * inverse;
    let p2 = v2 * inverse;
    let scale = power_below(inverse).xy;
    let a = flat(p0, scale);
    let b = flat(p1, scale);
    let c = flat(p2, scale);
    let p = vec3<f32>(b.x * c.y, c.x * a.y, a.x * b.y);
    let q = vec3<f32>(b.y * c.x, c.y * a.x, a.y * b.x);
    if (all(p >= q) == all(p <= q)) {
        return NO_HIT;
    }
    let near = min(min(p0, p1), p2);
    let far = max(max(p0, p1), p2);
    let interval = vec2<f32>(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
    let t = hit_within(Projected(p0, p1, p2, vec3<f32>(p0.z, p1.z, p2.z), p - q, true), interval).t;
    return select(NO_HIT, t, interval.x <= interval.y && t > 0.0);
}
