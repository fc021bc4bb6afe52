// Arithmetic in half precision: every input and every result is rounded.

enable f16;

alias real = f16;
alias real3 = vec3<f16>;

// Spheres are stored in the kernel's precision.
struct Sphere {
    center: vec3<f16>,
    radius2: f16,
    color: vec3<f16>,
    pad: f16,
}
