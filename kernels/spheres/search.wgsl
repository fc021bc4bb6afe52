// Rays, and the nearest sphere on one. The CPU renderers do the same operations in the same order.

const NONE: u32 = 0xffffffffu;

struct Ray {
    origin: real3,
    direction: real3,
}

// Where a ray last hit; a search that misses leaves it as it is.
struct Hit {
    position: real3,
    normal: real3,
    color: real3,
}

fn product(a: real3, b: real3) -> real {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

fn unit(v: real3) -> real3 {
    return v / sqrt(product(v, v));
}

// The ray through the centre of a pixel.
fn primary_ray(x: u32, y: u32) -> Ray {
    let px = real(x) + real(band.view.half);
    let py = real(y) + real(band.view.half);
    let direction = (real3(band.view.corner) + real3(band.view.right) * px) + real3(band.view.down) * py;
    return Ray(real3(band.view.origin), unit(direction));
}

// The record before the first search.
fn no_hit() -> Hit {
    return Hit(real3(band.view.origin), real3(0.0), real3(0.0));
}

// True if the ray hits; then the record is that of the nearest hit.
fn search(ray: Ray, hit: ptr<function, Hit>) -> bool {
    let a = product(ray.direction, ray.direction);
    var best = real(band.view.far);
    var nearest = NONE;
    for (var i = 0u; i < band.view.spheres; i += 1u) {
        let to_center = spheres[i].center - ray.origin;
        let b = product(to_center, ray.direction);
        let q = product(to_center, to_center) - spheres[i].radius2;
        let discriminant = b * b - a * q;
        if (discriminant > 0.0) {
            let root = sqrt(discriminant);
            var t = (b - root) / a;
            if (!(t > real(band.view.epsilon))) {
                t = (b + root) / a;
            }
            if (t > real(band.view.epsilon) && t < best) {
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
    return Ray(hit.position, unit(ray.direction - hit.normal * (real(band.view.two) * along)));
}

// Phong shading; the exponent is 32.
fn lighting(direction: real3, hit: Hit) -> real3 {
    let facing = product(hit.normal, real3(band.view.light));
    let lit = facing > 0.0;
    let diffuse = select(real(0.0), facing, lit);
    let mirrored = hit.normal * (real(band.view.two) * facing) - real3(band.view.light);
    let towards = -product(mirrored, direction);
    var specular = select(real(0.0), towards, lit && towards > 0.0);
    specular *= specular;
    specular *= specular;
    specular *= specular;
    specular *= specular;
    specular *= specular;
    let matt = hit.color * (real3(band.view.ambient) + real3(band.view.light_color) * diffuse);
    return matt + real3(band.view.light_color) * specular;
}
