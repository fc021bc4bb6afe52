//! Validation notices every kind of damage: each check of it is fed something wrong here.

use super::{build, build_as, scenes};
use rtbench::scene::Scene;
use rtbench::workloads::trace::Structure;
use rtbench::workloads::trace::bih::{Bih, BihNode};
use rtbench::workloads::trace::brute::Brute;
use rtbench::workloads::trace::bvh::stackless::LinkedBvh;
use rtbench::workloads::trace::bvh::{Bvh, BvhNode};
use rtbench::workloads::trace::grid::Grid;
use rtbench::workloads::trace::kdtree::{KdNode, KdTree, NO_ROPE, RopeTree};
use rtbench::workloads::trace::query::SortedTriangles;

pub(super) fn scene() -> Scene {
    scenes::random("good", 400, 1.0, 0.1, 9)
}

/// What is done, words that validation must say about it, and how it is done.
pub(super) type Damage<'a, T> = (&'a str, &'a str, &'a dyn Fn(&mut T));

/// Breaks a good structure and checks that validation says so, in these words.
pub(super) fn assert_noticed<T: Structure + Clone>(good: &T, damages: &[Damage<T>]) {
    let scene = scene();
    good.validate(&scene).expect("good before it is broken");
    for (damage, words, break_it) in damages {
        let mut broken = good.clone();
        break_it(&mut broken);
        match broken.validate(&scene) {
            Ok(()) => panic!("{damage} was not noticed"),
            Err(why) => assert!(why.contains(words), "{damage}: '{why}' does not say '{words}'"),
        }
    }
}

fn leaf_of(bvh: &Bvh) -> usize {
    bvh.nodes.iter().position(|n| n.count > 1).unwrap()
}

fn inner_of(bvh: &Bvh) -> usize {
    // Not the root: its box is compared with the bounds.
    bvh.nodes[2..].iter().position(|n| n.count == 0).unwrap() + 2
}

#[test]
fn in_a_bvh() {
    let good: Bvh = build_as("bvh", &scene());
    let (leaf, inner) = (leaf_of(&good), inner_of(&good));
    let other = good.nodes.iter().rposition(|n| n.count > 1).unwrap();
    let damages: &[Damage<Bvh>] = &[
        ("shrunk leaf", "span", &|b| b.nodes[leaf].max[0] -= 1e-3),
        ("grown leaf", "its content", &|b| b.nodes[leaf].max[0] += 1e-3),
        ("shrunk inner box", "its content", &|b| b.nodes[inner].min[1] += 1e-3),
        ("grown inner box", "its content", &|b| b.nodes[inner].min[1] -= 1e-3),
        ("NaN in a box", "its content", &|b| b.nodes[inner].min[1] = f32::NAN),
        ("NaN in a leaf", "", &|b| b.nodes[leaf].min[2] = f32::NAN),
        ("leaf elsewhere", "outside its leaf", &|b| {
            b.nodes[leaf].min = [5.0; 3];
            b.nodes[leaf].max = [6.0; 3];
        }),
        ("wrong bounds", "bounds", &|b| b.bounds.max.x += 1.0),
        ("dropped last triangle reference", "behind the last triangle reference", &|b| {
            b.triangle_refs.pop();
        }),
        ("one triangle reference too many", "in leaves", &|b| b.triangle_refs.push(b.triangle_refs[0])),
        ("lost triangle", "", &|b| b.triangle_refs[1] = b.triangle_refs[0]),
        ("swapped triangle references", "outside its leaf", &|b| {
            let (i, j) = (b.nodes[leaf].first as usize, b.nodes[other].first as usize);
            b.triangle_refs.swap(i, j);
        }),
        ("wrong vertices", "has vertices", &|b| b.triangle_refs[3].vertices.swap(0, 1)),
        ("triangle out of range", "does not exist", &|b| b.triangle_refs[3].triangle = 1 << 30),
        ("odd link", "the children of node", &|b| b.nodes[inner].first += 1),
        ("link out of range", "behind the last node", &|b| b.nodes[inner].first = b.nodes.len() as u32),
        ("link to the root", "begin at 0", &|b| b.nodes[inner].first = 0),
        ("link to itself", "reached twice", &|b| b.nodes[inner].first = inner as u32 & !1),
        ("link to a cousin", "", &|b| b.nodes[inner].first = b.nodes[0].first),
        ("leaf reaches too far", "", &|b| b.nodes[leaf].count += 1),
        ("leaf too full", "more than", &|b| b.nodes[leaf].count = 16),
        ("leaf begins too late", "not at", &|b| b.nodes[leaf].first += 1),
        ("wrong depth", "depth is", &|b| b.depth += 1),
        ("unreachable pair", "cannot be reached", &|b| b.nodes.extend([BvhNode::NONE; 2])),
        ("odd number of nodes", "even number", &|b| b.nodes.push(BvhNode::NONE)),
        ("no nodes", "even number", &|b| b.nodes.clear()),
        ("no dummy sibling", "no dummy", &|b| b.nodes[1] = b.nodes[0]),
    ];
    assert_noticed(&good, damages);
}

/// Divided triangles: the leaves of each together must hold all of it.
#[test]
fn in_a_bvh_with_spatial_splits() {
    let scene = scenes::beams(200, 9);
    let good: Bvh = build_as("bvh:build=spatial,max_leaf=1,alpha=0", &scene);
    good.validate(&scene).unwrap();
    assert!(good.triangle_refs.len() > 220, "hardly any triangle is divided");
    let verdict = |damage: &dyn Fn(&mut Bvh)| {
        let mut broken = good.clone();
        damage(&mut broken);
        broken.validate(&scene).err()
    };
    // A leaf that ends too early, or begins too late
    let mut uncovered = 0;
    for leaf in (0..good.nodes.len()).filter(|&i| good.nodes[i].count > 0) {
        for axis in 0..3 {
            let part = 0.3 * (good.nodes[leaf].max[axis] - good.nodes[leaf].min[axis]);
            for damage in
                [&|b: &mut Bvh| b.nodes[leaf].max[axis] -= part, &|b: &mut Bvh| b.nodes[leaf].min[axis] += part]
                    as [&dyn Fn(&mut Bvh); 2]
            {
                uncovered += usize::from(verdict(damage).is_some_and(|why| why.contains("do not cover it")));
            }
        }
    }
    assert!(uncovered > 0, "no leaf that is too small was noticed by what it does not cover");
    // A leaf whose triangle is another one, which is divided as well
    let times = |triangle: u32| good.triangle_refs.iter().filter(|r| r.triangle == triangle).count();
    let divided: Vec<usize> =
        (0..good.triangle_refs.len()).filter(|&i| times(good.triangle_refs[i].triangle) > 1).collect();
    for pair in divided.windows(2).filter(|p| good.triangle_refs[p[0]] != good.triangle_refs[p[1]]) {
        let damage = |b: &mut Bvh| b.triangle_refs[pair[0]] = b.triangle_refs[pair[1]];
        assert!(verdict(&damage).is_some(), "a part of triangle {} is lost", good.triangle_refs[pair[0]].triangle);
    }
}

#[test]
fn in_a_bih() {
    let good: Bih = build_as("bih", &scene());
    let inner = 2 + good.nodes[2..].iter().position(|n| !n.is_leaf()).unwrap();
    let leaf = good.nodes.iter().position(|n| n.is_leaf() && n.count() > 1).unwrap();
    let moved =
        |n: BihNode, low: f32, high: f32| BihNode::inner(n.axis(), n.child(), n.low_end() + low, n.high_begin() + high);
    let linked = |n: BihNode, child: u32| BihNode::inner(n.axis(), child, n.low_end(), n.high_begin());
    let damages: &[Damage<Bih>] = &[
        ("lower child cut off", "lower child ends", &|b| b.nodes[inner] = moved(b.nodes[inner], -1e-3, 0.0)),
        ("lower child too long", "lower child ends", &|b| b.nodes[inner] = moved(b.nodes[inner], 1e-3, 0.0)),
        ("upper child cut off", "upper child begins", &|b| b.nodes[inner] = moved(b.nodes[inner], 0.0, 1e-3)),
        ("upper child too long", "upper child begins", &|b| b.nodes[0] = moved(b.nodes[0], 0.0, -1e-3)),
        ("NaN plane", "lower child ends", &|b| b.nodes[0] = moved(b.nodes[0], f32::NAN, 0.0)),
        ("other axis", "", &|b| {
            let n = b.nodes[0];
            b.nodes[0] = BihNode::inner((n.axis() + 1) % 3, n.child(), n.low_end(), n.high_begin());
        }),
        ("odd link", "the children of node", &|b| b.nodes[inner] = linked(b.nodes[inner], 3)),
        ("link out of range", "behind the last node", &|b| {
            b.nodes[inner] = linked(b.nodes[inner], b.nodes.len() as u32);
        }),
        ("link to the root", "begin at 0", &|b| b.nodes[inner] = linked(b.nodes[inner], 0)),
        ("link to itself", "reached twice", &|b| b.nodes[inner] = linked(b.nodes[inner], inner as u32 & !1)),
        ("link to a cousin", "", &|b| b.nodes[inner] = linked(b.nodes[inner], b.nodes[0].child())),
        ("dropped last triangle reference", "behind the last triangle reference", &|b| {
            b.triangle_refs.pop();
        }),
        ("one triangle reference too many", "in leaves", &|b| b.triangle_refs.push(b.triangle_refs[0])),
        ("doubled triangle", "another place", &|b| b.triangle_refs[1] = b.triangle_refs[0]),
        ("swapped triangle references", "", &|b| {
            let last = b.triangle_refs.len() - 1;
            b.triangle_refs.swap(0, last);
        }),
        ("wrong vertices", "has vertices", &|b| b.triangle_refs[3].vertices.swap(0, 1)),
        ("triangle out of range", "does not exist", &|b| b.triangle_refs[3].triangle = 1 << 30),
        ("leaf reaches too far", "", &|b| b.nodes[leaf].words[0] += 1),
        ("empty leaf", "is empty", &|b| b.nodes[leaf].words[0] = 0),
        ("second word of a leaf", "second word", &|b| b.nodes[leaf].words[1] = 1),
        ("leaf begins too late", "not at", &|b| b.nodes[leaf].link += 4),
        ("wrong depth", "depth is", &|b| b.depth += 1),
        ("wrong bounds", "bounds", &|b| b.bounds.max.x += 1.0),
        ("unreachable pair", "cannot be reached", &|b| b.nodes.extend([BihNode::leaf(0, 0); 2])),
        ("odd number of nodes", "even number", &|b| b.nodes.push(BihNode::leaf(0, 0))),
        ("no nodes", "even number", &|b| b.nodes.clear()),
        ("no dummy sibling", "no dummy", &|b| b.nodes[1] = b.nodes[0]),
    ];
    assert_noticed(&good, damages);
}

#[test]
fn in_a_kdtree() {
    let good: KdTree = build_as("kdtree", &scene());
    let inner = 1 + good.nodes[1..].iter().position(|n| !n.is_leaf()).unwrap();
    let leaf = good.nodes.iter().position(|n| n.is_leaf() && n.count() > 1).unwrap();
    let first = good.nodes[leaf].first() as usize;
    let moved = |n: KdNode, by: f32| KdNode::inner(n.axis() as u32, n.split() + by, n.right());
    let damages: &[Damage<KdTree>] = &[
        ("moved plane", "instead of", &|t| t.nodes[0] = moved(t.nodes[0], 0.05)),
        ("plane outside its cell", "not inside its cell", &|t| t.nodes[inner] = moved(t.nodes[inner], 9.0)),
        ("plane on the border", "not inside its cell", &|t| {
            let n = t.nodes[0];
            t.nodes[0] = KdNode::inner(n.axis() as u32, t.bounds.min[n.axis()], n.right());
        }),
        ("NaN plane", "not inside its cell", &|t| t.nodes[inner] = moved(t.nodes[inner], f32::NAN)),
        ("other axis", "", &|t| {
            let n = t.nodes[0];
            t.nodes[0] = KdNode::inner((n.axis() as u32 + 1) % 3, n.split(), n.right());
        }),
        ("wrong link", "right child", &|t| t.nodes[inner].link += 4),
        ("link backwards", "right child", &|t| {
            let n = t.nodes[inner];
            t.nodes[inner] = KdNode::inner(n.axis() as u32, n.split(), 0);
        }),
        ("tree cut off", "behind the last node", &|t| {
            t.nodes.pop();
        }),
        ("node too many", "reached", &|t| t.nodes.push(KdNode::leaf(0, 0))),
        ("inner node at the end", "behind the last node", &|t| {
            *t.nodes.last_mut().unwrap() = KdNode::inner(0, 0.5, 1);
        }),
        ("lost triangle reference", "", &|t| {
            t.triangle_refs.remove(first);
        }),
        ("doubled triangle reference", "instead of", &|t| t.triangle_refs[first] = t.triangle_refs[first + 1]),
        ("triangle reference of another triangle", "instead of", &|t| {
            let stranger =
                *t.triangle_refs.iter().find(|r| t.triangle_refs[first..first + 2].iter().all(|o| o != *r)).unwrap();
            t.triangle_refs[first] = stranger;
        }),
        ("triangle reference too many", "in leaves", &|t| t.triangle_refs.push(t.triangle_refs[0])),
        ("leaf begins too late", "not at", &|t| t.nodes[leaf].word += 1),
        ("leaf too long", "", &|t| t.nodes[leaf].link += 4),
        ("wrong vertices", "has vertices", &|t| t.triangle_refs[3].vertices.swap(1, 2)),
        ("triangle out of range", "does not exist", &|t| t.triangle_refs[3].triangle = u32::MAX),
        ("wrong depth", "depth is", &|t| t.depth -= 1),
        ("wrong bounds", "bounds", &|t| t.bounds.min.y -= 1.0),
    ];
    assert_noticed(&good, damages);
}

/// A leaf, an axis and a side (lower is 0) that a rope is of.
type Place = (usize, usize, usize);

fn rope(tree: &mut RopeTree, (leaf, axis, side): Place) -> &mut u32 {
    let leaf = &mut tree.leaves_mut()[leaf];
    if side == 0 { &mut leaf.low[axis] } else { &mut leaf.high[axis] }
}

/// All ropes for which something holds.
fn ropes(tree: &RopeTree, mut holds: impl FnMut(Place, u32) -> bool) -> Vec<Place> {
    let mut tree = tree.clone();
    let places = (0..tree.leaves().len()).flat_map(|leaf| (0..6).map(move |face| (leaf, face % 3, face / 3)));
    places.filter(|&place| holds(place, *rope(&mut tree, place))).collect()
}

#[test]
fn in_ropes() {
    let good: RopeTree = build_as("kdtree:build=sort,search=ropes", &scene());
    let tied: RopeTree = build_as("kdtree:build=sort,push=off,search=ropes", &scene());
    let (mut other, last) = (tied.clone(), good.tree.nodes.len() as u32);
    let pushed = ropes(&good, |place, target| target != *rope(&mut other, place));
    let there = ropes(&good, |_, target| target != NO_ROPE);
    let outside = ropes(&good, |_, target| target == NO_ROPE)[3];
    let (some, high) = (there[there.len() / 2], pushed[pushed.len() / 2]);
    let both = there.iter().find(|&&(leaf, axis, side)| side == 0 && there.contains(&(leaf, axis, 1))).unwrap();
    let full = good.leaves().iter().position(|leaf| leaf.count > 0).unwrap();
    let leaf_node = good.tree.nodes.iter().position(|node| node.is_leaf()).unwrap();
    let damages: &[Damage<RopeTree>] = &[
        ("swapped ropes", "lies behind", &|t| {
            let leaf = &mut t.leaves_mut()[both.0];
            std::mem::swap(&mut leaf.low[both.1], &mut leaf.high[both.1]);
        }),
        ("a rope that ends too high", "does not cut the face", &|t| *rope(t, high) = *rope(&mut tied.clone(), high)),
        ("a missing rope", "is missing", &|t| *rope(t, some) = NO_ROPE),
        ("a rope out of the root", "leads out of the root", &|t| *rope(t, outside) = 0),
        ("a rope to nowhere", "behind the last one", &|t| *rope(t, some) = last),
        ("a rope to the root", "which begins at", &|t| *rope(t, some) = 0),
        ("a box that is too small", "have a volume of", &|t| t.leaves_mut()[full].max[1] -= 0.01),
        ("a NaN in a box", "have a volume of", &|t| t.leaves_mut()[full].min[1] = f32::NAN),
        ("a box that is off by a bit", "its cell is", &|t| {
            let max = &mut t.leaves_mut()[full].max[2];
            *max = max.next_up();
        }),
        ("a triangle too many", "triangle references from", &|t| t.leaves_mut()[full].count += 1),
        ("other triangles", "triangle references from", &|t| t.leaves_mut()[full].first += 1),
        ("a node with the rows of another leaf", "its own begin at", &|t| {
            t.rows[leaf_node / 2][leaf_node % 2 * 2] += 4;
        }),
        ("another plane in the rows", "in the tree", &|t| t.rows[0][0] ^= 1),
        ("a row too few", "rows of nodes and leaves", &|t| {
            t.rows.pop();
        }),
        ("a tree that is wrong itself", "depth is", &|t| t.tree.depth += 1),
        ("ropes that should not be pushed down", "below one that touches", &|t| t.pushed = false),
    ];
    assert_noticed(&good, damages);
    tied.validate(&scene()).expect("good before it is broken");
    // One step too low: next to the face, or over a part of it
    let low = |&place: &Place| {
        let mut broken = good.clone();
        let target = *rope(&mut broken, place);
        let node = good.tree.nodes[target as usize];
        *rope(&mut broken, place) = [target + 1, node.right()][place.0 % 2];
        broken.validate(&scene()).expect_err("a rope that ends too low was not noticed")
    };
    let inner = |_, target: u32| target != NO_ROPE && !good.tree.nodes[target as usize].is_leaf();
    let found: Vec<String> = ropes(&good, inner).iter().take(60).map(low).collect();
    for words in ["lies behind", "does not cover the face"] {
        assert!(found.iter().any(|why| why.contains(words)), "no rope that ends too low '{words}': {found:?}");
    }
}

#[test]
fn in_a_grid() {
    let good: Grid = build_as("grid", &scene());
    let full = good.cells.iter().position(|c| c.count > 1).unwrap();
    let empty = good.cells.iter().position(|c| c.count == 0).unwrap();
    let first = good.cells[full].first as usize;
    let damages: &[Damage<Grid>] = &[
        ("resolution", "cells instead of", &|g| g.resolution[0] += 1),
        ("swapped resolution", "", &|g| {
            let [x, y, z] = g.resolution;
            g.resolution = [x * y, 1, z];
        }),
        ("no cells", "resolution", &|g| g.resolution[2] = 0),
        ("larger cells", "", &|g| g.cell_size *= 1.5),
        ("smaller cells", "inside the bounds", &|g| g.cell_size *= 0.9),
        ("cells without size", "cells of size", &|g| g.cell_size = 0.0),
        ("NaN cells", "cells of size", &|g| g.cell_size = f32::NAN),
        ("cell begins too late", "begins at", &|g| g.cells[full].first += 1),
        ("cell too long", "", &|g| g.cells[full].count += 1),
        ("cell far too long", "behind the last", &|g| g.cells[full].count = u32::MAX),
        ("triangle reference too many", "in cells", &|g| g.triangle_refs.push(g.triangle_refs[0])),
        ("not ascending", "ascending", &|g| g.triangle_refs.swap(first, first + 1)),
        ("doubled triangle reference", "ascending", &|g| g.triangle_refs[first] = g.triangle_refs[first + 1]),
        ("triangle reference in another cell", "", &|g| {
            // Moves the border between two neighbouring cells: all in order, but one triangle reference is in the wrong
            // cell.
            let next = (full + 1..g.cells.len()).find(|&c| c != full).unwrap();
            g.cells[full].count -= 1;
            g.cells[next].first -= 1;
            g.cells[next].count += 1;
        }),
        ("triangle reference in a cell that it does not overlap", "does not overlap", &|g| {
            let stranger = g.triangle_refs[if empty < full { first } else { 0 }];
            g.triangle_refs.insert(g.cells[empty].first as usize, stranger);
            g.cells[empty].count += 1;
            g.cells[empty + 1..].iter_mut().for_each(|c| c.first += 1);
        }),
        ("wrong vertices", "has vertices", &|g| g.triangle_refs[3].vertices.swap(1, 2)),
        ("wrong bounds", "bounds", &|g| g.bounds.max.z += 1.0),
    ];
    assert_noticed(&good, damages);
}

#[test]
fn in_a_list() {
    let good: Brute = build_as("brute", &scene());
    let damages: &[Damage<Brute>] = &[
        ("lost", "not all", &|b| {
            b.triangle_refs.pop();
        }),
        ("swapped", "not all", &|b| b.triangle_refs.swap(4, 5)),
        ("doubled", "not all", &|b| b.triangle_refs.push(b.triangle_refs[0])),
        ("wrong bounds", "bounds", &|b| b.bounds.max.z = f32::NAN),
    ];
    assert_noticed(&good, damages);
}

#[test]
fn triangles_that_cannot_be_hit_must_not_be_listed() {
    let mut scene = scene();
    let good = build("brute", &scene, 1);
    good.validate(&scene).unwrap();
    scene.vertices[0].position.x = f32::NAN;
    assert!(good.validate(&scene).is_err());
    build("brute", &scene, 1).validate(&scene).unwrap();
}

#[test]
fn in_links_to_parents() {
    let good: LinkedBvh = build_as("bvh-stackless", &scene());
    let last = good.links.len() - 1;
    let damages: &[Damage<LinkedBvh>] = &[
        ("a link to the root", "is not to their parent", &|t| t.links[last] &= 7 << 28),
        ("a link to itself", "is not to their parent", &|t| {
            t.links[last] = (t.links[last] & 7 << 28) | (2 * last as u32)
        }),
        ("a link to a neighbour", "is not to their parent", &|t| t.links[last] ^= 1),
        ("a link to a leaf", "is not to their parent", &|t| {
            t.links[last] = t.links[last] & 7 << 28 | leaf_of(&t.bvh) as u32;
        }),
        ("a link behind the last node", "is not to their parent", &|t| t.links[last] |= (1 << 28) - 1),
        ("another axis", "have the order", &|t| t.links[last] ^= 1 << 28),
        ("another direction", "have the order", &|t| t.links[last] ^= 4 << 28),
        ("a bit above the order", "have the order", &|t| t.links[last] ^= 1 << 31),
        ("a link of the root", "the root has the link", &|t| t.links[0] = 2),
        ("a link too few", "links for", &|t| {
            t.links.pop();
        }),
        ("a link too many", "links for", &|t| t.links.push(0)),
        ("a tree that is wrong itself", "depth is", &|t| t.bvh.depth += 1),
    ];
    assert_noticed(&good, damages);
}

#[test]
fn in_sorted_triangles() {
    let good: SortedTriangles = build_as("query", &scene());
    let damages: &[Damage<SortedTriangles>] = &[
        ("lost", "each once", &|b| {
            b.triangle_refs.pop();
        }),
        ("doubled", "each once", &|b| b.triangle_refs.push(b.triangle_refs[0])),
        ("another one", "each once", &|b| b.triangle_refs[3] = b.triangle_refs[4]),
        ("wrong vertices", "has vertices", &|b| b.triangle_refs[3].vertices.swap(0, 1)),
        ("wrong bounds", "bounds", &|b| b.bounds.max.z = f32::NAN),
    ];
    assert_noticed(&good, damages);
}
