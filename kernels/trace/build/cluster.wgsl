// Clusters of triangles along the Morton curve, two rows each: lower corner and node, upper corner and triangles.
// Nodes are numbered: first the sorted triangles, then inner nodes as they are made.

fn box_at(lo: vec4<u32>, hi: vec4<u32>) -> Box {
    return Box(ordered(lo.xyz), ordered(hi.xyz));
}
