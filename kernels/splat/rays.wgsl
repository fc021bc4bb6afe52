// Rays and hits in buffers, as trace/given.wgsl reads and writes them.

struct TraceRay {
    origin: vec4<f32>,
    direction: vec4<f32>, // zero: the ray is not traced and hits nothing
}

struct TraceHit {
    t: f32,
    triangle: u32, // MISS if nothing is hit
}

fn trace_ray(origin: vec3<f32>, direction: vec3<f32>) -> TraceRay {
    return TraceRay(vec4<f32>(origin, 0.0), vec4<f32>(direction, 0.0));
}

fn no_ray() -> TraceRay {
    return trace_ray(vec3<f32>(0.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 0.0));
}
