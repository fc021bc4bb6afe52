// Counters of a packet's rays: what its rows make them test. Every ray of the packet counts what is taken from the
// stack. A loop over the rows that count is not unrolled: unrolled, lavapipe takes 18 s to compile the kernel.

var<private> row_counters: array<Counters, RAYS>;

fn begin_rows() {
    for (var k = 0u; k < RAYS; k += 1u) {
        row_counters[k].rays = 1u;
    }
}

fn add_rows_inner(rows: u32) {
    for (var left = rows; left != 0u; left &= left - 1u) {
        row_counters[firstTrailingBit(left)].inner += 1u;
    }
}

fn add_rows_leaves(rows: u32) {
    for (var left = rows; left != 0u; left &= left - 1u) {
        row_counters[firstTrailingBit(left)].leaves += 1u;
    }
}

fn add_rows_pops(rows: u32) {
    for (var left = rows; left != 0u; left &= left - 1u) {
        row_counters[firstTrailingBit(left)].pops += 1u;
    }
}

fn add_rows_boxes(rows: u32, n: u32) {
    for (var left = rows; left != 0u; left &= left - 1u) {
        row_counters[firstTrailingBit(left)].boxes += n;
    }
}

fn add_rows_tests(rows: u32, n: u32) {
    for (var left = rows; left != 0u; left &= left - 1u) {
        row_counters[firstTrailingBit(left)].tests += n;
    }
}

fn keep_hit(index: u32, triangle_ref: u32, k: u32) {
    pixels[index].triangle = triangle_ref;
    pixels[index].counters = array<Counters, RAY_TYPES>();
    pixels[index].counters[PRIMARY] = row_counters[k];
}
