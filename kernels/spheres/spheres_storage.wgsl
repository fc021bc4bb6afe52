// Spheres in a storage buffer: any number.

@group(0) @binding(1) var<storage, read> spheres: array<Sphere>;
