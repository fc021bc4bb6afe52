// Radiance: albedo / pi x flux / (4 pi) x cosine / distance^2.

fn light_of(at: Sample, pixel: u32) -> vec3<f32> {
    if (at.square < SQUARE_MIN) {
        return vec3<f32>(0.0, 0.0, 0.0);
    }
    let cosine = dot3(at.normal, at.way / sqrt(at.square));
    if (cosine <= 0.0) {
        return vec3<f32>(0.0, 0.0, 0.0);
    }
    return at.albedo * job.inverse_pi * job.intensity * (cosine / at.square);
}
