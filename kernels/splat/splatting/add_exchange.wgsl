// As floats, by comparing and exchanging.

@group(0) @binding(ACTION + 1) var<storage, read_write> words: array<atomic<u32>>;

fn add(at: u32, part: f32) {
    if (part > 0.0) {
        var before = atomicLoad(&words[at]);
        loop {
            let sum = bitcast<u32>(bitcast<f32>(before) + part);
            let result = atomicCompareExchangeWeak(&words[at], before, sum);
            if (result.exchanged) {
                break;
            }
            before = result.old_value;
        }
    }
}
