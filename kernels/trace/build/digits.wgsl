// Sorting by one digit: each worker has a chunk of neighbouring keys and a row of counters of its own. In `table` the
// counters of a digit are side by side, so that a prefix sum over it makes them the places of each worker's keys.

@group(0) @binding(1) var<storage, read> keys: array<u32>;
@group(0) @binding(2) var<storage, read_write> table: array<u32>;

fn digit_of(key: u32) -> u32 {
    return (key >> job.shift) & (DIGITS - 1u);
}
