// The level of one group. Its sum is the total.
//!include scan/wraps.wgsl

@group(0) @binding(5) var<storage, read_write> total: array<u32, 2>; // modulo 2^32, and 1 if that is not all of it

fn sum_before(group: u32) -> u32 {
    return 0u;
}

// Called by all invocations; the last one has the sum.
fn end_level(is_last: bool, sum: u32) {
    storageBarrier();
    if (is_last) {
        total[0] = sum;
        total[1] = atomicExchange(&wrapped, 0u);
    }
}
