//! What is known of the structures that the thesis has or is compared with, by name.

use crate::workloads::trace::{Selection, algorithms};

/// The structures of the thesis, in its order.
pub const STRUCTURES: [&str; 3] = [GRID, KDTREE, BVH];

/// The uniform grid.
pub const GRID: &str = "grid";
/// The kd-tree.
pub const KDTREE: &str = "kdtree";
/// The BVH that a packet of rays walks.
pub const BVH: &str = "bvh";

/// Options of the grid that change nothing but its resolution.
pub const RESOLUTION_OPTIONS: [&str; 4] = ["x", "y", "z", "factor"];

/// Properties of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Structure {
    /// The name in records.
    pub name: &'static str,
    /// The name in headings.
    pub title: &'static str,
    /// The index of its colour in every figure.
    pub colour: usize,
    /// The structure of the thesis whose options it has: traversals of one structure are built alike.
    pub family: &'static str,
    /// True if a ray may restart at the root.
    pub restarts: bool,
}

/// What a step of a ray is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// A cell of a grid.
    Cell,
    /// Inner nodes, leaves or entries of the stack, by a convention ([`crate::sources::convention`]).
    Node,
}

/// A traversal of a tree without restarts.
const fn tree(name: &'static str, title: &'static str, colour: usize, family: &'static str) -> Structure {
    Structure { name, title, colour, family, restarts: false }
}

/// A traversal of the grid.
const fn grid(name: &'static str, colour: usize) -> Structure {
    Structure { name, title: name, colour, family: "grid", restarts: false }
}

/// All that are known, in the order of their colours.
pub const KNOWN: [Structure; 8] = [
    grid("grid", 0),
    Structure { restarts: true, ..tree("kdtree", "kd-tree", 1, "kdtree") },
    tree("bvh", "BVH", 2, "bvh"),
    tree("bvh-stack", "bvh-stack", 3, "bvh-stack"),
    tree("ploc-stack", "ploc-stack", 4, "ploc-stack"),
    grid("grid-coop", 5),
    tree("brute", "brute", 6, "brute"),
    grid("grid-packet", 7),
];

/// A structure by its name in records.
pub fn known(name: &str) -> Option<&'static Structure> {
    KNOWN.iter().find(|structure| structure.name == name)
}

/// The name for headings.
pub fn title(name: &str) -> &str {
    known(name).map_or(name, |structure| structure.title)
}

/// The index of the colour; unknown structures share the last one.
pub fn colour(name: &str) -> usize {
    known(name).map_or(KNOWN.len() - 1, |structure| structure.colour)
}

/// The structure of the thesis whose options this one has; itself if it is unknown.
pub fn family(name: &str) -> &str {
    known(name).map_or(name, |structure| structure.family)
}

/// What a step of a ray is, by the structure's registration; one that is not registered any more is taken for a tree.
pub fn step(name: &str) -> Step {
    let registered = algorithms().iter().any(|algorithm| algorithm.name == name);
    let selection = registered.then(|| Selection::parse(name).ok()).flatten();
    let has_cells = selection.is_some_and(|selection| selection.method().traversal.structure.has_cells);
    if has_cells { Step::Cell } else { Step::Node }
}

/// True if a ray may restart at the root.
pub fn restarts(name: &str) -> bool {
    known(name).is_some_and(|structure| structure.restarts)
}
