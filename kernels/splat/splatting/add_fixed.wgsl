// As whole numbers. `scale` is chosen by scale.wgsl so that no word overflows.

@group(0) @binding(ACTION + 1) var<storage, read_write> words: array<atomic<u32>>;

fn add(at: u32, part: f32) {
    let word = u32(part * scale + 0.5);
    if (word > 0u) {
        atomicAdd(&words[at], word);
    }
}
