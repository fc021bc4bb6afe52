// Appends to the list of the next pass. The order differs from run to run, and no result depends on it: each path is
// traced by itself.

struct Growing {
    groups: atomic<u32>,
    one_y: u32,
    one_z: u32,
    paths: atomic<u32>,
}

@group(0) @binding(9) var<storage, read_write> next_lengths: array<Growing>;
@group(0) @binding(10) var<storage, read_write> next_paths: array<Waiting>;

fn append(pixel: u32, path: Path) {
    let index = atomicAdd(&next_lengths[frame.part].paths, 1u);
    if (index % GROUP_SIZE == 0u) {
        atomicAdd(&next_lengths[frame.part].groups, 1u);
    }
    next_paths[index] = Waiting(path.ray.origin, pixel, path.ray.direction, path.weight, path.colour, 0u);
}
