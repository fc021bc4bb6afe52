// Over the values themselves.
@group(0) @binding(2) var<storage, read_write> values: array<u32>;

fn read_value(i: u32) -> u32 {
    return values[i];
}

fn write_value(i: u32, value: u32) {
    values[i] = value;
}
