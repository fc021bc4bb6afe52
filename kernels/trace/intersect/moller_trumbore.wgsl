// The test of Möller and Trumbore (1997), two-sided. Twin: src/workloads/trace/intersect/moller_trumbore.rs. A ray
// through an edge may miss both of its triangles.

// Numerators of distance and barycentric coordinates over the common denominator det >= 0.
struct Solution {
    t: f32,
    u: f32,
    v: f32,
    det: f32,
}

fn solve(ray: Ray, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> Solution {
    let e1 = v1 - v0;
    let e2 = v2 - v0;
    let p = cross3(ray.direction, e2);
    let signed_det = dot3(e1, p);
    let sign = select(1.0, -1.0, signed_det < 0.0);
    let s = ray.origin - v0;
    let q = cross3(s, e1);
    return Solution(dot3(e2, q) * sign, dot3(s, p) * sign, dot3(ray.direction, q) * sign, signed_det * sign);
}

// The hit, or NO_HIT where the ray does not pass the triangle's own box and `must_pass`.
fn hit_of(ray: Ray, s: Solution, lo: vec3<f32>, hi: vec3<f32>, must_pass: bool) -> TriangleHit {
    let det = max(s.det, DETERMINANT_MIN);
    let interval = ray_box(ray, lo, hi);
    let t = min(max(s.t / det, interval.x), interval.y);
    let u = s.u / det;
    let v = s.v / det;
    return TriangleHit(select(t, NO_HIT, must_pass && !(interval.x <= interval.y && t > 0.0)), u, v, 1.0 - u - v);
}

fn intersect(ray: Ray, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> TriangleHit {
    let s = solve(ray, v0, v1, v2);
    var hit = TriangleHit(NO_HIT, 0.0, 0.0, 0.0);
    if (s.det >= DETERMINANT_MIN && s.u >= 0.0 && s.u <= s.det && s.v >= 0.0 && s.u + s.v <= s.det) {
        hit = hit_of(ray, s, min(min(v0, v1), v2), max(max(v0, v1), v2), true);
    }
    return hit;
}

// Of a triangle that was hit: it cannot miss, however a device compiles it.
fn surface_hit(ray: Ray, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> TriangleHit {
    return hit_of(ray, solve(ray, v0, v1, v2), min(min(v0, v1), v2), max(max(v0, v1), v2), false);
}
