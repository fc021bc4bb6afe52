// Counters of this invocation, by ray type. Kept private and stored once, at the end.

struct Counters {
    rays: u32,
    inner: u32, // inner nodes; the grid's cells
    leaves: u32,
    tests: u32,
    pops: u32,
    restarts: u32,
}

var<private> counters: array<Counters, 3>;
var<private> ray_kind: u32;

fn count_ray(kind: u32) {
    ray_kind = kind;
    counters[kind].rays += 1u;
}

fn count_inner() {
    counters[ray_kind].inner += 1u;
}

fn count_leaf() {
    counters[ray_kind].leaves += 1u;
}

fn count_test() {
    counters[ray_kind].tests += 1u;
}

fn count_tests(n: u32) {
    counters[ray_kind].tests += n;
}

fn count_pop() {
    counters[ray_kind].pops += 1u;
}

fn count_restart() {
    counters[ray_kind].restarts += 1u;
}
