// The photons of each cluster are counted.

@group(0) @binding(ACTION) var<storage, read_write> counts: array<atomic<u32>>;

fn begin(photon: Photon) {
}

fn visit(cluster: u32, photon: Photon, low: vec3<f32>, high: vec3<f32>) {
    atomicAdd(&counts[cluster], 1u);
}
