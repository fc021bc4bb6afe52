// A list of the paths that go on in a mirror, and the work-groups that a dispatch over it takes.

// A path: its pixel, its next ray, and what it has gathered.
struct Waiting {
    origin: vec3<f32>,
    pixel: u32,
    direction: vec3<f32>,
    weight: f32,
    colour: vec3<f32>,
    pad: u32,
}

// One for each band of the frames of an upload (frame.part): what an indirect dispatch reads, and the list's length.
struct Length {
    groups: u32,
    one_y: u32,
    one_z: u32,
    paths: u32,
}
