//! The same for trees of more than two children a node, and of quantised boxes.

use super::broken::{Damage, assert_noticed, scene};
use super::{build_as, scenes};
use rtbench::workloads::trace::Structure;
use rtbench::workloads::trace::cwbvh::{CwChild, CwNode, Cwbvh};
use rtbench::workloads::trace::wide::{Slot, Wide};

/// Slots of an inner child that is not the root's, and of a leaf of several triangles.
fn slots_of(tree: &Wide) -> (usize, usize) {
    let inner = tree.slots[tree.width..].iter().position(|slot| !slot.is_leaf()).unwrap() + tree.width;
    let leaf = tree.slots.iter().position(|slot| slot.is_leaf() && slot.reference >> 27 & 15 > 1).unwrap();
    (inner, leaf)
}

#[test]
fn in_a_tree_of_quantised_boxes() {
    for selection in ["bvh-quantised", "bvh4", "bvh8", "bvh4:order=octant", "bvh8:order=octant"] {
        let good: Wide = build_as(selection, &scene());
        let (inner, leaf) = slots_of(&good);
        let nodes = (good.slots.len() / good.width) as u32;
        let damages: &[Damage<Wide>] = &[
            ("shrunk leaf", "", &|t| t.slots[leaf].max[0] -= 1),
            ("grown leaf", "around its content", &|t| t.slots[leaf].max[0] += 1),
            ("shrunk inner box", "does not hold its content", &|t| t.slots[inner].min[1] += 1),
            ("grown inner box", "around its content", &|t| t.slots[inner].min[1] -= 1),
            ("leaf elsewhere", "outside its leaf", &|t| {
                (t.slots[leaf].min, t.slots[leaf].max) = ([0; 3], [1; 3]);
            }),
            ("lower and upper planes changed", "", &|t| {
                (t.slots[leaf].min, t.slots[leaf].max) = (t.slots[leaf].max, t.slots[leaf].min);
            }),
            ("planes moved", "", &|t| t.planes.lo.x += 0.01),
            ("planes nearer to each other", "", &|t| t.planes.step.y *= 0.5),
            ("no power of two", "no power of two", &|t| t.planes.step.z *= 1.5),
            ("no distance between planes", "no power of two", &|t| t.planes.step.z = 0.0),
            ("plane 0 nowhere", "plane 0", &|t| t.planes.lo.z = f32::NAN),
            ("wrong bounds", "bounds", &|t| t.bounds.max.x += 1.0),
            ("another width", "children a node", &|t| t.width = 3),
            ("half a node", "a multiple of", &|t| {
                t.slots.pop();
            }),
            ("no nodes", "a multiple of", &|t| t.slots.clear()),
            ("link out of range", "behind the last one", &|t| t.slots[inner].reference = nodes),
            ("link to the root", "reached twice", &|t| t.slots[inner].reference = 0),
            ("link to itself", "reached twice", &|t| t.slots[inner].reference = (inner / t.width) as u32),
            ("unreachable node", "cannot be reached", &|t| {
                let root = t.node(0).to_vec();
                t.slots.extend(root);
            }),
            ("leaf reaches too far", "", &|t| t.slots[leaf].reference += 1 << 27),
            ("leaf begins behind the last reference", "behind the last triangle reference", &|t| {
                t.slots[leaf].reference |= 0x07ff_0000;
            }),
            ("leaf is cut off", "", &|t| t.slots[leaf].reference -= 1 << 27),
            ("one triangle reference too many", "is in no leaf", &|t| t.triangle_refs.push(t.triangle_refs[0])),
            ("lost triangle", "", &|t| t.triangle_refs[1] = t.triangle_refs[0]),
            ("wrong vertices", "has vertices", &|t| t.triangle_refs[3].vertices.swap(0, 1)),
            ("triangle out of range", "does not exist", &|t| t.triangle_refs[3].triangle = 1 << 30),
            ("wrong depth", "depth is", &|t| t.depth += 1),
            ("stack that is too small", "a stack needs", &|t| t.stack -= 1),
            ("only child", "", &|t| {
                let node = inner / t.width * t.width;
                t.slots[node + 1..node + t.width].fill(Slot::EMPTY);
            }),
            ("lost child", "", &|t| t.slots[inner] = Slot::EMPTY),
            ("leaf without references", "", &|t| t.slots[leaf].reference &= !(15 << 27)),
        ];
        assert_noticed(&good, damages);
    }
    // A node that is not full, with a box in an empty slot, and with a child behind one
    let good: Wide = build_as("bvh8", &scene());
    let hole = good.slots.windows(2).position(|pair| !pair[0].is_empty() && pair[1].is_empty()).unwrap() + 1;
    let last = hole / good.width * good.width + good.width - 1;
    let damages: &[Damage<Wide>] = &[
        ("box of nothing", "an empty slot with a box", &|t| t.slots[hole].max[0] = 5),
        ("child behind an empty slot", "behind an empty slot", &|t| t.slots.swap(hole - 1, last)),
    ];
    assert_noticed(&good, damages);
}

/// Divided triangles: the leaves of each together must hold all of it.
#[test]
fn in_trees_with_spatial_splits() {
    let scene = scenes::beams(200, 9);
    for selection in ["bvh-quantised", "bvh4", "bvh8"] {
        let good: Wide = build_as(&format!("{selection}:build=spatial,max_leaf=1,alpha=0"), &scene);
        good.validate(&scene).unwrap();
        assert!(good.triangle_refs.len() > 220, "hardly any triangle is divided");
        let leaves = (0..good.slots.len()).filter(|&i| good.slots[i].is_leaf() && !good.slots[i].is_empty());
        let mut uncovered = 0;
        for (leaf, axis) in leaves.flat_map(|leaf| [0, 1, 2].map(|axis| (leaf, axis))) {
            let mut broken = good.clone();
            let slot = &mut broken.slots[leaf];
            slot.max[axis] -= (slot.max[axis] - slot.min[axis]) / 3;
            uncovered += usize::from(broken.validate(&scene).is_err_and(|why| why.contains("do not cover it")));
        }
        assert!(uncovered > 0, "no leaf that is too small was noticed by what it does not cover");
    }
}

#[test]
fn in_a_cwbvh() {
    for selection in ["cwbvh", "cwbvh:build=binned"] {
        let good: Cwbvh = build_as(selection, &scene());
        let nodes = good.nodes.len() as u32;
        let find = |is_wanted: &dyn Fn(CwChild) -> bool, from: usize| {
            let places = (from..good.nodes.len()).flat_map(|node| (0..8).map(move |place| (node, place)));
            let is_it = |&(node, place): &(usize, usize)| good.nodes[node].child(place).is_some_and(is_wanted);
            places.into_iter().find(is_it).unwrap()
        };
        let (node, place) = find(&|child| matches!(child, CwChild::Node(_)), 1);
        let (leaf_node, leaf) = find(&|child| matches!(child, CwChild::Leaf(_, 1)), 0);
        let places = (0..good.nodes.len()).flat_map(|node| (0..8).map(move |place| (node, place)));
        let (gap_node, gap) =
            places.into_iter().find(|&(node, place)| good.nodes[node].child(place).is_none()).unwrap();
        let grow = |node: &mut CwNode, place: usize| {
            node.planes.iter_mut().for_each(|[min, max]| (min[place], max[place]) = (0, 255));
        };
        let shrink =
            |node: &mut CwNode, place: usize| node.planes[1][0][place] = node.planes[1][0][place].wrapping_add(1);
        let damages: &[Damage<Cwbvh>] = &[
            ("shrunk leaf", "", &|t| shrink(&mut t.nodes[leaf_node], leaf)),
            ("grown leaf", "around its content", &|t| grow(&mut t.nodes[leaf_node], leaf)),
            ("shrunk inner box", "", &|t| shrink(&mut t.nodes[node], place)),
            ("grown inner box", "around its content", &|t| grow(&mut t.nodes[node], place)),
            ("node elsewhere", "", &|t| t.nodes[node].origin[0] += 0.1),
            ("NaN", "begins at", &|t| t.nodes[node].origin[0] = f32::NAN),
            ("other exponent", "", &|t| t.nodes[node].exponents[2] -= 1),
            ("exponent of zero", "has steps", &|t| t.nodes[node].exponents[2] = 0),
            ("infinite step", "has steps", &|t| t.nodes[node].exponents[2] = 255),
            ("wrong bounds", "bounds", &|t| t.bounds.max.x += 1.0),
            ("link out of range", "behind the last one", &|t| t.nodes[node].first_child = nodes),
            ("link to the root", "reached twice", &|t| t.nodes[node].first_child = 0),
            ("a node's word", "is a node, but", &|t| t.nodes[node].meta[place] ^= 1),
            ("a leaf's word", "is a leaf, but", &|t| t.nodes[leaf_node].meta[leaf] = 5 << 5),
            ("a leaf's offset", "", &|t| t.nodes[leaf_node].meta[leaf] ^= 1),
            ("a leaf too far", "begins at offset", &|t| t.nodes[leaf_node].meta[leaf] = 1 << 5 | 24),
            ("leaf taken for a node", "is a node, but", &|t| t.nodes[leaf_node].inner |= 1 << leaf),
            ("node taken for a leaf", "", &|t| t.nodes[node].inner ^= 1 << place),
            ("unreachable node", "cannot be reached", &|t| t.nodes.push(CwNode::EMPTY)),
            ("no nodes", "no nodes", &|t| t.nodes.clear()),
            ("references elsewhere", "", &|t| t.nodes[leaf_node].first_ref += 1),
            ("references behind the last", "behind the last triangle reference", &|t| {
                t.nodes[leaf_node].first_ref = t.triangle_refs.len() as u32;
            }),
            ("one triangle reference too many", "is in no leaf", &|t| t.triangle_refs.push(t.triangle_refs[0])),
            ("lost triangle", "", &|t| t.triangle_refs[1] = t.triangle_refs[0]),
            ("wrong vertices", "has vertices", &|t| t.triangle_refs[3].vertices.swap(0, 1)),
            ("wrong depth", "depth is", &|t| t.depth += 1),
            ("box of nothing", "is empty, but has a box", &|t| t.nodes[gap_node].planes[0][1][gap] = 1),
        ];
        assert_noticed(&good, damages);
    }
}
