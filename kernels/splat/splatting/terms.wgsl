// What photons add to the irradiance of a sample. Twin: src/workloads/splat/splatting/terms.rs.

//!include lib/geom.wgsl
//!include splat/random.wgsl

struct Terms {
    radius2: f32, // square of the radius
    peak: f32,    // the kernel's value at distance 0
    one: f32,     // 1, not known to the compiler
}

fn term(
    terms: Terms,
    sample: vec3<f32>,
    normal: vec3<f32>,
    position: vec3<f32>,
    direction: vec3<f32>,
    flux: vec3<f32>,
) -> vec3<f32> {
    let way = position - sample;
    let square = dot3(way, way);
    if (square < terms.radius2) {
        let facing = -dot3(normal, direction);
        if (facing > 0.0) {
            var share = terms.peak;
            if (!CONSTANT_KERNEL) {
                share = terms.peak * (terms.one - square / terms.radius2);
            }
            if (COSINE_WEIGHT) {
                share = facing * share;
            }
            return flushed(flux * share);
        }
    }
    return vec3<f32>(0.0, 0.0, 0.0);
}
