// Appends to the list of the next pass. Its order depends on timing, and no result on its order: rays do not wait for
// each other.

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
