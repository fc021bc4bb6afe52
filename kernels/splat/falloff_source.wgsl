// As the source prints it: Phong's diffuse and specular light times 1 - distance^2 / influence^2, at least 0. The power
// is by products and square roots only, which give the same bits everywhere.

@group(0) @binding(6) var<storage, read> rays: array<TraceRay>;
@group(0) @binding(7) var<storage, read> hits: array<TraceHit>;
// Of each triangle: specular colour, and the exponent in units of 1 / 256, a whole number
@group(0) @binding(8) var<storage, read> highlights: array<vec4<f32>>;

const TINY: f32 = 1.0e-18; // products of numbers below it are zero

fn product(a: f32, b: f32) -> f32 {
    if (a < TINY || b < TINY) {
        return 0.0;
    }
    return a * b;
}

fn raised(x: f32, exponent: u32) -> f32 {
    var result = 1.0;
    var root = x;
    for (var bit = 1u; bit <= 8u; bit += 1u) {
        root = sqrt(root);
        if (((exponent >> (8u - bit)) & 1u) == 1u) {
            result = product(result, root);
        }
    }
    var square = x;
    for (var rest = exponent >> 8u; rest > 0u; rest = rest >> 1u) {
        if ((rest & 1u) == 1u) {
            result = product(result, square);
        }
        square = product(square, square);
    }
    return result;
}

fn light_of(at: Sample, pixel: u32) -> vec3<f32> {
    let falloff = job.one - at.square / job.influence2;
    if (at.square < SQUARE_MIN || falloff <= 0.0) {
        return vec3<f32>(0.0, 0.0, 0.0);
    }
    let to_light = at.way / sqrt(at.square);
    let cosine = dot3(at.normal, to_light);
    if (cosine <= 0.0) {
        return vec3<f32>(0.0, 0.0, 0.0);
    }
    let highlight = highlights[hits[pixel].triangle];
    let mirrored = at.normal * (2.0 * cosine) - to_light;
    let towards = min(max(-dot3(mirrored, rays[pixel].direction.xyz), 1.0e-6), 1.0);
    let shine = raised(towards, u32(highlight.w));
    return (at.albedo * cosine + highlight.xyz * shine) * job.intensity * falloff;
}
