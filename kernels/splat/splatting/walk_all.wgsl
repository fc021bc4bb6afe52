// Every cluster, one after another.

@group(0) @binding(6) var<storage, read> clusters: array<u32>; // the first word is their number
@group(0) @binding(7) var<storage, read> cluster_keys: array<u32>;

fn walk(photon: Photon) {
    let count = clusters[0];
    for (var cluster = 0u; cluster < count; cluster += 1u) {
        let low = cluster_low(cluster);
        let high = cluster_high(cluster);
        if (touches(photon, low, high) && !faces_away(cluster_keys[cluster], photon)) {
            visit(cluster, photon, low, high);
        }
    }
}
