// A short stack per invocation in private memory.

var<private> stack_node: array<u32, RING>;
var<private> stack_min: array<f32, RING>;
var<private> stack_max: array<f32, RING>;

fn stack_place(place: u32) -> u32 {
    return place;
}
