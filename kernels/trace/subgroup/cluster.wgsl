// Eight neighbouring invocations of a subgroup, whatever its size is. Only shuffles are needed, and they stay inside of
// the cluster: clusters of one subgroup may be in different places of the kernel.

var<private> cluster_first: u32; // the cluster's first invocation in the subgroup
var<private> member: u32;        // this invocation's number in the cluster

fn from_member(x: u32, i: u32) -> u32 {
    return subgroupShuffle(x, cluster_first + i);
}

fn vector_from_member(x: vec3<f32>, i: u32) -> vec3<f32> {
    return subgroupShuffle(x, cluster_first + i);
}

fn cluster_or(x: u32) -> u32 {
    let two = x | subgroupShuffleXor(x, 1u);
    let four = two | subgroupShuffleXor(two, 2u);
    return four | subgroupShuffleXor(four, 4u);
}

fn cluster_least(x: u32) -> u32 {
    let two = min(x, subgroupShuffleXor(x, 1u));
    let four = min(two, subgroupShuffleXor(two, 2u));
    return min(four, subgroupShuffleXor(four, 4u));
}

fn cluster_max(x: f32) -> f32 {
    let two = max(x, subgroupShuffleXor(x, 1u));
    let four = max(two, subgroupShuffleXor(two, 2u));
    return max(four, subgroupShuffleXor(four, 4u));
}

fn cluster_max3(x: vec3<f32>) -> vec3<f32> {
    let two = max(x, subgroupShuffleXor(x, 1u));
    let four = max(two, subgroupShuffleXor(two, 2u));
    return max(four, subgroupShuffleXor(four, 4u));
}
