//! What a "step" is. The thesis prints steps per ray and does not say what it counted (SPEC section 6); our kernels count
//! inner nodes, leaves and stack pops apart, and only here they become steps. A grid's steps are its cells, always.

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
    /// All.
    pub const ALL: [Convention; 4] =
        [Convention::Nodes, Convention::Inner, Convention::InnerPops, Convention::NodesPops];

    /// In a table's note.
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
    /// As printed, by a convention that is not known.
    Printed(f64),
    /// Cells of a grid.
    Cells(f64),
    /// Of a tree.
    Nodes {
        /// Inner nodes.
        inner: f64,
        /// Leaves.
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
