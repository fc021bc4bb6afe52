// Output of the counting kernels: 20 bytes a pixel.

@group(0) @binding(2) var<storage, read_write> pixels: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> hits_of: array<u32>;

fn store(index: u32, path: Path) {
    pixels[index] = vec4<f32>(vec3<f32>(path.color), band.view.one);
    hits_of[index] = path.hits;
}
