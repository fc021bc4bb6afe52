// Arithmetic in single precision.

alias real = f32;
alias real3 = vec3<f32>;

// Spheres are stored in the kernel's precision.
struct Sphere {
    center: vec3<f32>,
    radius2: f32,
    color: vec3<f32>,
    pad: f32,
}
