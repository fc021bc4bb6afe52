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
    first_border: u32,   // index of the first border of slices for this field of view
    axis_x: vec3<f32>,   // of the boxes of clusters, a unit vector
    height: u32,         // of the image
    axis_y: vec3<f32>,
    pad0: u32,
    axis_z: vec3<f32>,
    pad1: u32,
    axes_origin: vec3<f32>,
    margin: f32,         // what a distance along these axes may be too large by
}

@group(0) @binding(0) var<uniform> view: View;
