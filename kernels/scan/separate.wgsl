// From one buffer into another.
@group(0) @binding(1) var<storage, read> values: array<u32>;
@group(0) @binding(2) var<storage, read_write> scanned: array<u32>;

fn read_value(i: u32) -> u32 {
    return values[i];
}

fn write_value(i: u32, value: u32) {
    scanned[i] = value;
}
