// Output of the counting kernels: 24 bytes a pixel, the last 8 of them the number of hits and of searches.

@group(0) @binding(2) var<storage, read_write> pixels: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> work_of: array<vec2<u32>>;

fn store(index: u32, path: Path) {
    pixels[index] = vec4<f32>(vec3<f32>(path.color), band.view.one);
    work_of[index] = vec2<u32>(path.hits, path.searches);
}
