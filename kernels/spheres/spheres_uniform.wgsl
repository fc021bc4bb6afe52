// Spheres as constants: as many as the device's limit allows.

@group(0) @binding(1) var<uniform> spheres: array<Sphere, SPHERES>;
