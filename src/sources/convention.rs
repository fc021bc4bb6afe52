//! What a step of a ray in a tree is. Records hold inner nodes, leaves and stack entries apart, and a source may not
//! say which of them it counted (the thesis does not), so steps are formed here. A step in a grid is always a cell.

/// Which counters of a tree make a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Convention {
    /// Inner nodes and leaves: every node that a ray (for packets: its packet) looks into
    #[default]
    Nodes,
    /// Inner nodes alone
    Inner,
    /// Inner nodes and entries taken from the stack
    InnerPops,
    /// Inner nodes, leaves and entries taken from the stack
    NodesPops,
}

impl Convention {
    /// All conventions.
    pub const ALL: [Convention; 4] =
        [Convention::Nodes, Convention::Inner, Convention::InnerPops, Convention::NodesPops];

    /// The convention in words.
    pub fn in_words(self) -> &'static str {
        match self {
            Convention::Nodes => "inner nodes + leaves",
            Convention::Inner => "inner nodes",
            Convention::InnerPops => "inner nodes + pops",
            Convention::NodesPops => "inner nodes + leaves + pops",
        }
    }
}

/// Steps per ray of one type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// Published steps, by an unknown convention.
    Printed(f64),
    /// The cells of a grid.
    Cells(f64),
    /// The counts of a tree.
    Nodes {
        /// Inner nodes that a ray looks into.
        inner: f64,
        /// Leaves that a ray looks into.
        leaves: f64,
        /// Entries taken from the stack.
        pops: f64,
    },
}

impl Steps {
    /// Steps per ray by a convention.
    pub fn by(self, convention: Convention) -> f64 {
        match (self, convention) {
            (Steps::Printed(steps) | Steps::Cells(steps), _) => steps,
            (Steps::Nodes { inner, leaves, .. }, Convention::Nodes) => inner + leaves,
            (Steps::Nodes { inner, .. }, Convention::Inner) => inner,
            (Steps::Nodes { inner, pops, .. }, Convention::InnerPops) => inner + pops,
            (Steps::Nodes { inner, leaves, pops }, Convention::NodesPops) => inner + leaves + pops,
        }
    }
}
