// A short stack per invocation in work-group memory, as separate arrays (the thesis's). Entry `place` of all
// invocations lies together, so that equal depths fall into different banks.

var<workgroup> stack_node: array<u32, RING * GROUP_SIZE>;
var<workgroup> stack_min: array<f32, RING * GROUP_SIZE>;
var<workgroup> stack_max: array<f32, RING * GROUP_SIZE>;

fn stack_place(place: u32) -> u32 {
    return place * GROUP_SIZE + lane;
}
