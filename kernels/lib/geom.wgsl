// Rays, boxes, and the ray/box test. Twin: src/math.rs, operation for operation.
//
// Distances to planes are (plane - origin) * inverse direction everywhere. Both operations round monotonically, so
// a box inside a box has its computed interval inside the other's, and a triangle's distance is clamped into its own
// box's interval: nothing that encloses a hit triangle can be culled by rounding. See src/math.rs, which also says how
// directions with a component of zero are treated.
//
// dot and cross are spelled out so that the order of additions is ours and not the compiler's.

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
    inv_direction: vec3<f32>,
    origin_min: vec3<f32>, // slightly above the origin where the direction is zero: for lower planes of boxes
    origin_max: vec3<f32>, // slightly below it there: for upper planes
    scale: vec3<f32>,      // powers of two near the direction's components
    shear: vec3<f32>,      // scale, but zero where the direction is zero
    slack: vec3<f32>,      // SLACK where the direction is zero, zero elsewhere
    major: u32,            // axis of the largest direction component
}

// A triangle that was hit; `t` is NO_HIT if it was not.
struct TriangleHit {
    t: f32,
    u: f32, // weight of the second corner
    v: f32, // weight of the third corner
    w: f32, // weight of the first corner
}

const NO_HIT: f32 = 3.3e38; // farther than T_MAX, so that it never wins a comparison

fn dot3(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

fn cross3(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

fn on_axis(p: vec3<f32>, axis: u32) -> f32 {
    return select(select(p.z, p.y, axis == 1u), p.x, axis == 0u);
}

fn normalize3(v: vec3<f32>) -> vec3<f32> {
    return v / sqrt(dot3(v, v));
}

fn inverse1(d: f32) -> f32 {
    if (abs(d) <= 1.0 / INVERSE_OF_ZERO) {
        return INVERSE_OF_ZERO;
    }
    return 1.0 / d;
}

// The reciprocal of the largest power of two that is not above |x|, by component.
fn power_below(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>(vec3<u32>(0x7f000000u) - (bitcast<vec3<u32>>(x) & vec3<u32>(0x7f800000u)));
}

fn make_ray(origin: vec3<f32>, direction: vec3<f32>) -> Ray {
    let inv = vec3<f32>(inverse1(direction.x), inverse1(direction.y), inverse1(direction.z));
    let zero = vec3<f32>(0.0, 0.0, 0.0);
    let parallel = inv == vec3<f32>(INVERSE_OF_ZERO);
    let shift = select(zero, max(abs(origin) * PLANE_SHIFT, vec3<f32>(PLANE_SHIFT_MIN)), parallel);
    let scale = power_below(inv);
    let steep = abs(inv);
    var major = 2u;
    if (steep.x <= steep.y && steep.x <= steep.z) {
        major = 0u;
    } else if (steep.y <= steep.z) {
        major = 1u;
    }
    return Ray(
        origin, direction, inv, origin + shift, origin - shift, scale, select(scale, zero, parallel),
        select(zero, vec3<f32>(SLACK), parallel), major
    );
}

// The interval of distances inside the box, (near, far), empty when near > far. Slab test with min and max only
// (after Smits); not clamped to the ray's start. An origin exactly in a plane that the ray runs along is inside.
fn ray_box(ray: Ray, lo: vec3<f32>, hi: vec3<f32>) -> vec2<f32> {
    let a = (lo - ray.origin_min) * ray.inv_direction;
    let b = (hi - ray.origin_max) * ray.inv_direction;
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

// intersect(ray, v0, v1, v2), and surface_hit of a triangle that intersect has hit
//!slot intersect
