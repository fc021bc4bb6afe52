// Rays, and the nearest sphere on one. The CPU renderers do the same operations in the same order.

const NONE: u32 = 0xffffffffu;

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

// Where a ray last hit; a search that misses leaves it as it is.
struct Hit {
    position: vec3<f32>,
    normal: vec3<f32>,
    color: vec3<f32>,
}

fn product(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

fn unit(v: vec3<f32>) -> vec3<f32> {
    return v / sqrt(product(v, v));
}

// The ray through the centre of a pixel.
fn primary_ray(x: u32, y: u32) -> Ray {
    let px = f32(x) + band.view.half;
    let py = f32(y) + band.view.half;
    let direction = (band.view.corner + band.view.right * px) + band.view.down * py;
    return Ray(band.view.origin, unit(direction));
}

// The record before the first search.
fn no_hit() -> Hit {
    return Hit(band.view.origin, vec3<f32>(0.0), vec3<f32>(0.0));
}

// True if the ray hits; then the record is that of the nearest hit.
fn search(ray: Ray, hit: ptr<function, Hit>) -> bool {
    let a = product(ray.direction, ray.direction);
    var best = band.view.far;
    var nearest = NONE;
    for (var i = 0u; i < band.view.spheres; i += 1u) {
        let to_center = spheres[i].center - ray.origin;
        let b = product(to_center, ray.direction);
        let q = product(to_center, to_center) - spheres[i].radius2;
        let discriminant = b * b - a * q;
        if (discriminant > 0.0) {
            let root = sqrt(discriminant);
            var t = (b - root) / a;
            if (!(t > band.view.epsilon)) {
                t = (b + root) / a;
            }
            if (t > band.view.epsilon && t < best) {
                best = t;
                nearest = i;
            }
        }
    }
    if (nearest == NONE) {
        return false;
    }
    let position = ray.origin + ray.direction * best;
    *hit = Hit(position, unit(position - spheres[nearest].center), spheres[nearest].color);
    return true;
}

// The ray that goes on in the mirror of the last hit.
fn reflected(ray: Ray, hit: Hit) -> Ray {
    let along = product(ray.direction, hit.normal);
    return Ray(hit.position, unit(ray.direction - hit.normal * (band.view.two * along)));
}

// Phong shading; the exponent is 32.
fn lighting(direction: vec3<f32>, hit: Hit) -> vec3<f32> {
    let facing = product(hit.normal, band.view.light);
    let lit = facing > 0.0;
    let diffuse = select(0.0, facing, lit);
    let mirrored = hit.normal * (band.view.two * facing) - band.view.light;
    let towards = -product(mirrored, direction);
    var specular = select(0.0, towards, lit && towards > 0.0);
    specular *= specular;
    specular *= specular;
    specular *= specular;
    specular *= specular;
    specular *= specular;
    let matt = hit.color * (band.view.ambient + band.view.light_color * diffuse);
    return matt + band.view.light_color * specular;
}
