//! Trees of more than two children a node: how many children they have, and how many bytes.

use super::{build, build_as, scenes};
use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::triangle::Triangle;
use rtbench::scene::{Scene, load};
use rtbench::workloads::trace::bvh::Bvh;
use rtbench::workloads::trace::cwbvh::Cwbvh;
use rtbench::workloads::trace::wide::collapse::collapse;

fn scenes() -> Vec<Scene> {
    let built_in = ["scan", "terrain", "sphereflake", "stadium", "hall", "room"];
    let mut scenes: Vec<Scene> =
        built_in.map(|name| load(&format!("{name}:triangles=20000")).unwrap()).into_iter().collect();
    scenes.push(scenes::random("random", 5000, 1.0, 0.05, 2));
    scenes
}

/// The same tree in obvhs's type. Its collapse takes leaves of one primitive only, so that every leaf becomes one.
fn to_obvhs(bvh: &Bvh) -> Bvh2 {
    let mut tree = Bvh2::default();
    let mut numbers = 0;
    for node in &bvh.nodes {
        let aabb = obvhs::aabb::Aabb::new(Vec3A::from(node.min), Vec3A::from(node.max));
        let (prim_count, first_index) = if node.count > 0 { (1, numbers) } else { (0, node.first) };
        numbers += u32::from(node.count > 0);
        tree.nodes.push(Bvh2Node::new(aabb, prim_count, first_index));
    }
    tree.primitive_indices = (0..numbers).collect();
    tree
}

/// A BVH is collapsed to at least as many children a node as obvhs reaches from the same one.
#[test]
fn nodes_have_at_least_as_many_children_as_after_obvhs_s_collapse() {
    for scene in scenes() {
        for selection in ["bvh", "bvh:max_leaf=1", "bvh:build=sweep,max_leaf=2", "bvh:build=ploc"] {
            let bvh: Bvh = build_as(selection, &scene);
            let theirs = bvh2_to_cwbvh(&to_obvhs(&bvh), 1, false, false);
            let filled = |node: &obvhs::cwbvh::node::CwBvhNode| (0..8).filter(|&i| !node.is_child_empty(i)).count();
            let their_children = theirs.nodes.iter().map(filled).sum::<usize>();
            let leaves = bvh.nodes.iter().filter(|node| node.count > 0).count();
            assert_eq!(their_children - theirs.nodes.len() + 1, leaves, "{selection} over {}", scene.name);
            let per_node = their_children as f64 / theirs.nodes.len() as f64;
            let ours = collapse(bvh, 8, false);
            let children = ours.slots.iter().filter(|slot| !slot.is_empty()).count();
            let own_per_node = children as f64 / (ours.slots.len() / 8) as f64;
            println!("{selection} over {}: {own_per_node:.3} children a node, obvhs {per_node:.3}", scene.name);
            assert_eq!(children - ours.slots.len() / 8 + 1, leaves, "{selection} over {}", scene.name);
            assert!(own_per_node >= per_node, "{selection} over {}: {own_per_node} < {per_node}", scene.name);
            assert!(own_per_node > 4.0, "{selection} over {}: {own_per_node} children a node", scene.name);
        }
    }
}

/// Fewer and fewer nodes, of as many bytes as they have places.
#[test]
fn wider_trees_have_fewer_nodes() {
    for scene in scenes() {
        let [two, four, eight] = ["bvh-quantised", "bvh4", "bvh8"].map(|name| {
            let structure = build(name, &scene, 0);
            let properties = structure.properties(&scene);
            assert!(properties.children_per_node.unwrap() > 1.9, "{name}");
            (properties, structure.node_bytes())
        });
        assert!(two.0.nodes > four.0.nodes && four.0.nodes > eight.0.nodes, "{}", scene.name);
        assert!([&four.0, &eight.0].iter().all(|wide| wide.leaves == two.0.leaves), "{}", scene.name);
        let bytes = |nodes: Option<u32>, width: usize| nodes.unwrap() as usize * width * 16;
        assert_eq!([two.1, four.1, eight.1], [bytes(two.0.nodes, 2), bytes(four.0.nodes, 4), bytes(eight.0.nodes, 8)]);
        // Half of what bvh-stack has, but for its dummy sibling and its root, which are nobody's children
        assert_eq!(2 * two.1 + 64, build("bvh", &scene, 0).node_bytes(), "{}", scene.name);
        assert_eq!(build("bvh", &scene, 0).properties(&scene).children_per_node, None);
    }
}

/// Nodes of a CWBVH take at most half the bytes of obvhs's BVH of two children: as obvhs has it in memory (48 bytes a
/// node), and without what pads it (32 bytes) where its leaves have at most three triangles as well.
#[test]
fn a_cwbvh_takes_half_the_bytes() {
    for scene in scenes() {
        let triangles: Vec<Triangle> = (0..scene.triangles.len() as u32)
            .map(|i| scene.corners(i))
            .map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
            .collect();
        let nodes = |params| build_bvh2_from_tris(&triangles, params, &mut Default::default()).nodes;
        let medium = BvhBuildParams::medium_build();
        let in_memory = size_of_val(nodes(medium).as_slice());
        let small = nodes(BvhBuildParams { max_prims_per_leaf: 3, ..medium }).len() * 32;
        for selection in ["cwbvh", "cwbvh:build=binned"] {
            let tree: Cwbvh = build_as(selection, &scene);
            let bytes = size_of_val(tree.nodes.as_slice());
            println!("{selection} over {}: {bytes} bytes, obvhs {in_memory}, {small}", scene.name);
            assert!(2 * bytes <= in_memory, "{selection} over {}: {bytes} of {in_memory}", scene.name);
            assert!(2 * bytes <= small, "{selection} over {}: {bytes} of {small}", scene.name);
        }
    }
}
