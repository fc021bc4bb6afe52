// Random numbers by counting, and unit vectors made of them: pcg4d of Jarzynski and Olano (2020), integers only. Twin:
// src/workloads/random.rs, operation for operation.

const DRAWS: u32 = 16u; // most calls of the hash for a unit vector

fn stir(key: vec4<u32>) -> vec4<u32> {
    var v = key;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

fn pcg4d(key: vec4<u32>) -> vec4<u32> {
    var v = stir(key * 1664525u + vec4<u32>(1013904223u));
    v = v ^ (v >> vec4<u32>(16u));
    return stir(v);
}

// Numbers in [-1, 1) with 24 bits; no operation rounds.
fn signed_numbers(words: vec4<u32>) -> vec4<f32> {
    return vec4<f32>(words >> vec4<u32>(8u)) * (1.0 / 8388608.0) - vec4<f32>(1.0);
}

// A vector of unit length, uniform over the sphere, after Marsaglia (1972): the first pair inside the circle.
fn unit_vector(seed: u32, path: u32, bounce: u32) -> vec3<f32> {
    for (var draw = 0u; draw < DRAWS; draw += 1u) {
        let numbers = signed_numbers(pcg4d(vec4<u32>(seed, path, bounce, draw)));
        var pair = numbers.xy;
        var s = pair.x * pair.x + pair.y * pair.y;
        if (s >= 1.0) {
            pair = numbers.zw;
            s = pair.x * pair.x + pair.y * pair.y;
        }
        if (s < 1.0) {
            let root = sqrt(1.0 - s);
            return vec3<f32>(2.0 * pair.x * root, 2.0 * pair.y * root, 1.0 - 2.0 * s);
        }
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}
