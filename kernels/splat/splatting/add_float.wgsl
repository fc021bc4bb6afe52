// As floats, by the device's own operation.

@group(0) @binding(ACTION + 1) var<storage, read_write> words: array<atomic<f32>>;

fn add(at: u32, part: f32) {
    if (part > 0.0) {
        atomicAdd(&words[at], part);
    }
}
