// Output of the counting kernels: 216 bytes a pixel.

struct CountedPixel {
    triangle: u32,
    rgba: u32,
    t: u32, // bits
    pad: u32,
    counters: array<Counters, RAY_TYPES>,
}

@group(0) @binding(8) var<storage, read_write> pixels: array<CountedPixel>;

fn store(index: u32, triangle: u32, t: f32, rgba: u32) {
    pixels[index] = CountedPixel(triangle, rgba, bitcast<u32>(t), 0u, counters);
}
