// Output of the timed kernels: 8 bytes a pixel.

struct Pixel {
    triangle: u32,
    rgba: u32,
}

@group(0) @binding(8) var<storage, read_write> pixels: array<Pixel>;

fn store(index: u32, triangle: u32, t: f32, rgba: u32) {
    pixels[index] = Pixel(triangle, rgba);
}
