// The camera of a frame.

struct View {
    origin: vec3<f32>,
    width: u32,          // of the image
    corner: vec3<f32>,   // from the eye to the image plane's top left corner
    pixels: u32,
    right: vec3<f32>,    // one pixel to the right
    row_groups: u32,
    down: vec3<f32>,     // one pixel down
    epsilon: f32,        // how far samples lie off the surface
    forward: vec3<f32>,  // unit vector
    pad: u32,
}

@group(0) @binding(0) var<uniform> view: View;
