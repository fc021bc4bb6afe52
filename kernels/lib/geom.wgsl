// Rays, boxes, triangles and the two tests. Twin: src/math.rs, operation for operation.
//
// Distances to planes are (plane - origin) * inverse direction everywhere. Both operations round monotonically, so
// a box inside a box has its computed interval inside the other's, and a triangle's distance is clamped into its own
// box's interval: nothing that encloses a hit triangle can be culled by rounding. See src/math.rs.
//
// dot and cross are spelled out so that the order of additions is ours and not the compiler's.

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
    inv_direction: vec3<f32>,
}

// A triangle that was hit; `t` is NO_HIT if it was not.
struct TriangleHit {
    t: f32,
    u: f32, // weight of the second corner
    v: f32, // weight of the third corner
}

const NO_HIT: f32 = 3.3e38; // farther than T_MAX, so that it never wins a comparison

fn dot3(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

fn cross3(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

fn unit(v: vec3<f32>) -> vec3<f32> {
    return v / sqrt(dot3(v, v));
}

fn inverse1(d: f32) -> f32 {
    if (abs(d) < 1.0 / INVERSE_OF_ZERO) {
        return INVERSE_OF_ZERO;
    }
    return 1.0 / d;
}

fn ray_along(origin: vec3<f32>, direction: vec3<f32>) -> Ray {
    let inv = vec3<f32>(inverse1(direction.x), inverse1(direction.y), inverse1(direction.z));
    return Ray(origin, direction, inv);
}

// The interval of distances inside the box, (near, far), empty when near > far. Slab test with min and max only
// (after Smits); not clamped to the ray's start.
fn ray_box(ray: Ray, lo: vec3<f32>, hi: vec3<f32>) -> vec2<f32> {
    let a = (lo - ray.origin) * ray.inv_direction;
    let b = (hi - ray.origin) * ray.inv_direction;
    if (SOFTWARE) {
        // The same without min and max, which cost a software driver three instructions each (one of them for NaN,
        // of which there is none here) where a comparison serves two selections
        let ascending = a < b;
        let near = select(b, a, ascending);
        let far = select(a, b, ascending);
        let near_xy = select(near.y, near.x, near.x > near.y);
        let far_xy = select(far.y, far.x, far.x < far.y);
        return vec2<f32>(select(near_xy, near.z, near.z > near_xy), select(far_xy, far.z, far.z < far_xy));
    }
    let near = min(a, b);
    let far = max(a, b);
    return vec2<f32>(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// Möller and Trumbore's test, two-sided, with one division and only for hits.
fn intersect(ray: Ray, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> TriangleHit {
    var hit = TriangleHit(NO_HIT, 0.0, 0.0);
    let e1 = v1 - v0;
    let e2 = v2 - v0;
    let p = cross3(ray.direction, e2);
    let signed_det = dot3(e1, p);
    let sign = select(1.0, -1.0, signed_det < 0.0);
    let det = signed_det * sign;
    let s = ray.origin - v0;
    let u = dot3(s, p) * sign;
    let q = cross3(s, e1);
    let v = dot3(ray.direction, q) * sign;
    if (det >= DETERMINANT_MIN && u >= 0.0 && u <= det && v >= 0.0 && u + v <= det) {
        let interval = ray_box(ray, min(min(v0, v1), v2), max(max(v0, v1), v2));
        let t = min(max(dot3(e2, q) * sign / det, interval.x), interval.y);
        if (interval.x <= interval.y && t > 0.0) {
            hit = TriangleHit(t, u / det, v / det);
        }
    }
    return hit;
}
