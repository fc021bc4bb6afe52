// Counting that costs nothing: the timed kernels.

fn count_ray(kind: u32) {}
fn count_inner() {}
fn count_leaf() {}
fn count_test() {}
fn count_tests(n: u32) {}
fn count_pop() {}
fn count_restart() {}
