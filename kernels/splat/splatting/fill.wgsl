// The photons of each cluster are listed, from the end of its list; the counts become 0. What exceeds the capacity is
// left out.

@group(0) @binding(ACTION) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(ACTION + 1) var<storage, read> offsets: array<u32>;
@group(0) @binding(ACTION + 2) var<storage, read_write> entries: array<u32>;

fn begin(photon: Photon) {
}

fn visit(cluster: u32, photon: Photon, low: vec3<f32>, high: vec3<f32>) {
    let place = offsets[cluster] + atomicSub(&counts[cluster], 1u) - 1u;
    if (place < job.capacity) {
        entries[place] = photon.index;
    }
}
