// A watertight ray/triangle test in distance space. Twin: src/workloads/trace/intersect/watertight.rs, which says why
// it loses no ray.
//
// Corners become distances along the ray by axis, p = (corner - origin) * inverse direction. Across the ray's major
// axis each has one rounded 2D position, and the ray is the point 0. It is inside where three comparisons of rounded
// products agree. Comparisons cannot be contracted, and scale and shear are powers of two or zero, so that fusing one
// of their products with the subtraction changes nothing.

// A triangle as a ray sees it.
struct Projected {
    p0: vec3<f32>,    // distances of the corners, by axis
    p1: vec3<f32>,
    p2: vec3<f32>,
    along: vec3<f32>, // of the corners, along the major axis
    edges: vec3<f32>, // twice the signed areas between the ray and the edge opposite each corner
    inside: bool,
}

// The components on the two axes other than the major one.
fn across(p: vec3<f32>, major: u32) -> vec2<f32> {
    return vec2<f32>(select(p.x, p.y, major == 0u), select(p.z, p.y, major == 2u));
}

fn project(ray: Ray, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> Projected {
    let p0 = (v0 - ray.origin) * ray.inv_direction;
    let p1 = (v1 - ray.origin) * ray.inv_direction;
    let p2 = (v2 - ray.origin) * ray.inv_direction;
    let along = vec3<f32>(on_axis(p0, ray.major), on_axis(p1, ray.major), on_axis(p2, ray.major));
    let scale = across(ray.scale, ray.major);
    let shear = across(ray.shear, ray.major);
    let a = across(p0, ray.major) * scale - along.x * shear;
    let b = across(p1, ray.major) * scale - along.y * shear;
    let c = across(p2, ray.major) * scale - along.z * shear;
    let p = vec3<f32>(b.x * c.y, c.x * a.y, a.x * b.y);
    let q = vec3<f32>(b.y * c.x, c.y * a.x, a.y * b.x);
    return Projected(p0, p1, p2, along, p - q, all(p >= q) != all(p <= q));
}

// The interval of the triangle's own box.
fn own_interval(ray: Ray, seen: Projected) -> vec2<f32> {
    let near = min(min(seen.p0, seen.p1), seen.p2) - ray.slack;
    let far = max(max(seen.p0, seen.p1), seen.p2) + ray.slack;
    return vec2<f32>(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// Each weight is made of its own edge. With 1 - u - v for the first one, Mesa 25.0 summed the edges in another order in
// kernels that need no distance, and one pixel of 74,000 had another colour.
fn hit_within(seen: Projected, interval: vec2<f32>) -> TriangleHit {
    let e = seen.edges;
    let sum = e.x + e.y + e.z;
    let scale = 1.0 / select(sum, 1.0, sum == 0.0);
    let t = (e.x * seen.along.x + e.y * seen.along.y + e.z * seen.along.z) * scale;
    return TriangleHit(min(max(t, interval.x), interval.y), e.y * scale, e.z * scale, e.x * scale);
}

fn intersect(ray: Ray, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> TriangleHit {
    let seen = project(ray, v0, v1, v2);
    var hit = TriangleHit(NO_HIT, 0.0, 0.0, 0.0);
    if (seen.inside) {
        let interval = own_interval(ray, seen);
        let found = hit_within(seen, interval);
        if (interval.x <= interval.y && found.t > 0.0) {
            hit = found;
        }
    }
    return hit;
}

// Of a triangle that was hit: it cannot miss, however a device compiles it.
fn surface_hit(ray: Ray, v0: vec3<f32>, v1: vec3<f32>, v2: vec3<f32>) -> TriangleHit {
    let seen = project(ray, v0, v1, v2);
    return hit_within(seen, own_interval(ray, seen));
}
