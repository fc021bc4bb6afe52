//! Subtrees of a binary tree that several threads build side by side, and how they become one array of nodes: siblings
//! together, the root and a dummy first.

use bytemuck::Pod;

/// A node whose links can be moved.
pub(crate) trait PartNode: Pod + Send {
    /// The root's dummy sibling.
    const NONE: Self;

    /// With its link moved.
    fn moved(self, base: Base) -> Self;
}

/// A finished subtree: its root, and what lies below it.
pub(crate) struct Part<N> {
    pub root: N,
    pub below: Below<N>,
    /// Levels of inner nodes.
    pub depth: u32,
}

pub(crate) enum Below<N> {
    /// Pairs of siblings, whose links count from the start of this vector, and the triangles of leaves, whose links
    /// count from the start of that vector.
    Nodes(Vec<N>, Vec<u32>),
    /// Two subtrees that were built side by side.
    Parts(Box<[Part<N>; 2]>),
}

/// Where a part is placed.
#[derive(Clone, Copy)]
pub(crate) struct Base {
    /// Its first node below the root.
    pub node: u32,
    /// Its first triangle.
    pub triangle: u32,
}

impl<N: PartNode> Part<N> {
    /// Two subtrees below a root that links to the start of their nodes.
    pub fn of(root: N, parts: [Part<N>; 2]) -> Part<N> {
        let depth = 1 + parts[0].depth.max(parts[1].depth);
        Part { root, below: Below::Parts(Box::new(parts)), depth }
    }

    fn len(&self) -> usize {
        match &self.below {
            Below::Nodes(nodes, _) => nodes.len(),
            Below::Parts(parts) => 2 + parts[0].len() + parts[1].len(),
        }
    }

    /// Number of triangles that its leaves list; 0 for leaves whose links already are those of the whole tree.
    fn triangles(&self) -> usize {
        match &self.below {
            Below::Nodes(_, triangles) => triangles.len(),
            Below::Parts(parts) => parts[0].triangles() + parts[1].triangles(),
        }
    }

    /// Lays the parts out one after another behind the root pair and moves their links. Also returns the triangles,
    /// leaf by leaf.
    pub fn into_nodes(self) -> (Vec<N>, Vec<u32>) {
        let mut nodes: Vec<N> = bytemuck::zeroed_vec(2 + self.len());
        let mut triangles = vec![0; self.triangles()];
        let (pair, rest) = nodes.split_at_mut(2);
        let root = self.place(rest, &mut triangles, Base { node: 2, triangle: 0 });
        pair.copy_from_slice(&[root, N::NONE]);
        (nodes, triangles)
    }

    /// Writes everything below this part's root to `out`, which begins at `base`; returns the root.
    fn place(self, out: &mut [N], out_triangles: &mut [u32], base: Base) -> N {
        match self.below {
            Below::Nodes(nodes, triangles) => {
                out.iter_mut().zip(&nodes).for_each(|(out, node)| *out = node.moved(base));
                out_triangles.copy_from_slice(&triangles);
                self.root.moved(base)
            }
            Below::Parts(parts) => {
                let [a, b] = *parts;
                let (pair, rest) = out.split_at_mut(2);
                let (a_len, a_triangles) = (a.len(), a.triangles());
                let (a_out, b_out) = rest.split_at_mut(a_len);
                let (a_list, b_list) = out_triangles.split_at_mut(a_triangles);
                let a_base = Base { node: base.node + 2, ..base };
                let b_base = Base { node: a_base.node + a_len as u32, triangle: base.triangle + a_triangles as u32 };
                let (left, right) = rayon::join(|| a.place(a_out, a_list, a_base), || b.place(b_out, b_list, b_base));
                pair.copy_from_slice(&[left, right]);
                self.root.moved(base)
            }
        }
    }
}
