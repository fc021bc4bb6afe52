// Floats as integers of the same order. Minima and maxima of these are the same on every device, whatever it does to
// denormal numbers; of the zeros there is one.

struct Box {
    lo: vec3<u32>,
    hi: vec3<u32>,
}

const NOTHING = Box(vec3<u32>(0xffffffffu), vec3<u32>(0u)); // a box around nothing

fn ordered(x: vec3<u32>) -> vec3<u32> {
    let bits = select(x, vec3<u32>(0u), x == vec3<u32>(0x80000000u));
    return select(bits ^ vec3<u32>(0x80000000u), ~bits, bits >= vec3<u32>(0x80000000u));
}

// The bits of the floats.
fn floats(x: vec3<u32>) -> vec3<u32> {
    return select(x ^ vec3<u32>(0x80000000u), ~x, x < vec3<u32>(0x80000000u));
}

fn around(a: Box, b: Box) -> Box {
    return Box(min(a.lo, b.lo), max(a.hi, b.hi));
}

// Half the centroid: so it is finite in every scene. The products are exact, so that no fused operation differs.
fn half_centroid(box: Box) -> vec3<f32> {
    return bitcast<vec3<f32>>(floats(box.lo)) * 0.25 + bitcast<vec3<f32>>(floats(box.hi)) * 0.25;
}
