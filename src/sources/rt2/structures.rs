//! The structures that the document measured or described, each with the options that make it.

use crate::sources::rows::Variant;

/// A structure with its options.
#[derive(Debug, PartialEq, Eq)]
pub struct Structure {
    /// The name in headings.
    pub title: &'static str,
    /// The name in records.
    name: &'static str,
    /// The options that differ from the defaults.
    options: &'static [(&'static str, &'static str)],
    /// The index of its colour in every figure.
    pub colour: usize,
}

/// The kd-tree with ropes, pushed down.
pub static ROPES: Structure =
    Structure { title: "ropes", name: "kdtree", options: &[("build", "sort"), ("search", "ropes")], colour: 0 };

/// The kd-tree with a full stack.
pub static STACK: Structure =
    Structure { title: "kd-tree", name: "kdtree", options: &[("build", "sort"), ("search", "stack")], colour: 1 };

/// The BVH as printed: no box is compared with the nearest hit so far.
pub static BVH: Structure = Structure {
    title: "BVH",
    name: "bvh-stack",
    options: &[("build", "sweep"), ("max_leaf", "3"), ("cull", "off")],
    colour: 2,
};

/// The same with boxes behind the nearest hit left out.
pub static CULLED: Structure =
    Structure { title: "BVH, culled", name: "bvh-stack", options: &[("build", "sweep"), ("max_leaf", "3")], colour: 5 };

/// Ropes that are not pushed down: they end at the highest node that covers the face.
pub static UNPUSHED: Structure = Structure {
    title: "unpushed",
    name: "kdtree",
    options: &[("build", "sort"), ("push", "off"), ("search", "ropes")],
    colour: 3,
};

/// The kd-tree of binned events.
pub static MIN_MAX: Structure =
    Structure { title: "min-max", name: "kdtree", options: &[("build", "min-max"), ("search", "stack")], colour: 3 };

/// The kd-tree of the exact sweep that sorts anew in every node.
pub static SORT: Structure = Structure {
    title: "sort",
    name: "kdtree",
    options: &[("build", "sort"), ("sorting", "every-node"), ("search", "stack")],
    colour: 1,
};

/// The BVH of the full sweep that sorts anew in every node.
pub static SWEEP: Structure = Structure {
    title: "BVH",
    name: "bvh-stack",
    options: &[("build", "sweep"), ("max_leaf", "3"), ("sorting", "every-node")],
    colour: 2,
};

/// The BVH with spatial splits.
pub static SPATIAL: Structure =
    Structure { title: "spatial", name: "bvh-stack", options: &[("build", "spatial"), ("max_leaf", "3")], colour: 4 };

/// The bounding interval hierarchy.
pub static BIH: Structure = Structure { title: "BIH", name: "bih", options: &[], colour: 6 };

/// All of them.
pub static ALL: [&Structure; 10] = [&ROPES, &STACK, &BVH, &CULLED, &UNPUSHED, &MIN_MAX, &SORT, &SWEEP, &SPATIAL, &BIH];

/// Structures of which any will do for sizes and properties, because their trees are equal.
pub type Trees = &'static [&'static Structure];

/// The kd-tree of the exact sweep: no sorting changes it.
pub const KDTREES: Trees = &[&STACK, &SORT];

/// The swept BVH: neither sorting nor culling changes it.
pub const SWEPT: Trees = &[&BVH, &CULLED, &SWEEP];

/// The kd-tree with ropes, which take memory.
pub const WITH_ROPES: Trees = &[&ROPES];

/// The BVH with spatial splits.
pub const SPATIALS: Trees = &[&SPATIAL];

/// Options that only this document's structures have; any value of one is enough.
const KEYS: [&str; 9] =
    ["sorting", "push", "cull", "axes", "alpha", "spatial_bins", "spatial_depth", "overlap", "reflections"];

/// The same for single values.
const VALUES: [(&str, &str); 6] = [
    ("build", "sort"),
    ("build", "min-max"),
    ("build", "sweep"),
    ("build", "spatial"),
    ("search", "stack"),
    ("search", "ropes"),
];

impl Structure {
    /// True for a record of this structure.
    pub fn is(&self, name: &str, variant: &Variant) -> bool {
        self.name == name && variant.is_exactly(self.options)
    }

    /// As `--structure` takes it.
    pub fn selection(&self) -> String {
        let options: Vec<String> = self.options.iter().map(|(key, value)| format!("{key}={value}")).collect();
        if options.is_empty() { self.name.to_owned() } else { format!("{}:{}", self.name, options.join(",")) }
    }
}

/// True for a row that was measured for this document: its structure, or one of its options, is asked for by no other.
pub fn is_own(name: &str, variant: &Variant) -> bool {
    name == BIH.name
        || KEYS.iter().any(|key| variant.get(key).is_some())
        || VALUES.iter().any(|(key, value)| variant.get(key) == Some(value))
}
