// Nothing is counted.

fn begin_rows() {}

fn add_rows_inner(rows: u32) {}

fn add_rows_leaves(rows: u32) {}

fn add_rows_pops(rows: u32) {}

fn add_rows_boxes(rows: u32, n: u32) {}

fn add_rows_tests(rows: u32, n: u32) {}

fn keep_hit(index: u32, triangle_ref: u32, k: u32) {
    pixels[index].triangle = triangle_ref;
}
