// One frame, or a band of its rows, by persistent threads (Aila and Laine 2009): a fixed number of work-groups, each of
// which takes the next GROUP_WIDTH x GROUP_HEIGHT pixels until none are left. Twin: src/workloads/trace/render.rs.

//!include trace/pixel.wgsl

// Groups of pixels that have been taken, by band (frame.part).
@group(0) @binding(15) var<storage, read_write> taken: array<atomic<u32>>;

var<workgroup> fetched: u32;

// The next group of pixels, the same for the whole work-group.
fn take_group() -> u32 {
    if (lane == 0u) {
        fetched = atomicAdd(&taken[frame.part], 1u);
    }
    return workgroupUniformLoad(&fetched);
}

// Software drivers end a loop after 65,535 turns (lavapipe), taking it for endless.
const TURNS: u32 = 32768u;

@compute @workgroup_size(GROUP_SIZE)
fn main(@builtin(local_invocation_index) local_index: u32) {
    lane = local_index;
    let across = (frame.columns + GROUP_WIDTH - 1u) / GROUP_WIDTH;
    let groups = across * ((frame.rows + GROUP_HEIGHT - 1u) / GROUP_HEIGHT);
    var group = take_group();
    while (group < groups) {
        for (var turn = 0u; turn < TURNS && group < groups; turn += 1u) {
            begin_pixel();
            let corner = vec2<u32>((group % across) * GROUP_WIDTH, (group / across) * GROUP_HEIGHT);
            render_pixel(corner + place_in_group(lane));
            group = take_group();
        }
    }
}
