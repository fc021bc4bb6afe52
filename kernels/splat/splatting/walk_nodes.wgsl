// Down the levels with a stack of masks: on each level the children that are still to be visited. `key` is the node at
// hand.

@group(0) @binding(6) var<storage, read> masks: array<u32>;
@group(0) @binding(7) var<storage, read> node_boxes: array<u32>;
@group(0) @binding(8) var<storage, read> places: array<u32>;

fn mask_at(word: u32) -> u32 {
    return masks[word];
}

//!include splat/clusters/lookup.wgsl

fn walk(photon: Photon) {
    var left: array<u32, 5>;
    var level = 0u;
    var key = 0u;
    left[0] = masks[0];
    loop {
        let mask = left[level];
        if (mask == 0u) {
            if (level == 0u) {
                break;
            }
            level -= 1u;
            key = key >> 5u;
            continue;
        }
        left[level] = mask & (mask - 1u);
        let child = (key << 5u) | firstTrailingBit(mask);
        if (level == 4u) {
            let cluster = identifier_of(child, job.level_offsets.w);
            let low = cluster_low(cluster);
            let high = cluster_high(cluster);
            if (touches(photon, low, high) && !faces_away(child, photon)) {
                visit(cluster, photon, low, high);
            }
            continue;
        }
        let node = job.level_offsets[level] + child;
        let first = 6u * node;
        let low = vec3<f32>(
            unordered(node_boxes[first]), unordered(node_boxes[first + 1u]), unordered(node_boxes[first + 2u])
        );
        let high = vec3<f32>(
            unordered(node_boxes[first + 3u]), unordered(node_boxes[first + 4u]), unordered(node_boxes[first + 5u])
        );
        if (touches(photon, low, high)) {
            if (level + 1u == job.level) {
                visit(child, photon, low, high);
            } else {
                level += 1u;
                key = child;
                left[level] = masks[node];
            }
        }
    }
}
