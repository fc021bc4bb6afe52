// A part of a frame, one invocation per pixel. The CPU renderers make the same bits.

//!include spheres/scene.wgsl
//!slot spheres
//!slot algorithm
//!slot store

// What a pixel gets: its colour, how many rays of its path hit before the first miss, and how many searches were made.
struct Path {
    color: real3,
    hits: u32,
    searches: u32,
}

@compute @workgroup_size(GROUP_SIDE, GROUP_SIDE)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= band.columns || id.y >= band.rows) {
        return;
    }
    let x = band.first_column + id.x;
    let y = band.first_row + id.y;
    let path = follow(primary_ray(x, y));
    store(y * band.view.width + x, path);
}
