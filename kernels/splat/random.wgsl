// Random numbers, and floats without denormal ones. Twin: src/workloads/splat/random.rs.

//!include lib/random.wgsl

// Zero in place of components below the smallest normal float, which some devices flush and others do not.
fn flushed(v: vec3<f32>) -> vec3<f32> {
    return select(v, vec3<f32>(0.0, 0.0, 0.0), v < vec3<f32>(MIN_POSITIVE));
}
