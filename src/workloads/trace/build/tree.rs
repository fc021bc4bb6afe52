//! The binary radix tree over sorted Morton codes. Twin of `kernels/trace/build/{radix_tree,flags,nodes}.wgsl`.
//!
//! T. Karras: Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees, 2012, section 4. Equal codes
//! are told apart by their places.

/// The range of an inner node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range {
    /// First triangle.
    pub first: u32,
    /// Last triangle.
    pub last: u32,
    /// Last triangle of the left child. The child's node has the same number, the right child's the next one.
    pub split: u32,
}

/// Bits that codes `i` and `j` have in common, or of equal codes their places; -1 outside of all codes.
fn common_bits(keys: &[u32], i: i64, j: i64) -> i64 {
    let Some(&other) = usize::try_from(j).ok().and_then(|j| keys.get(j)) else { return -1 };
    let key = keys[i as usize];
    if key == other {
        return 32 + i64::from(((i ^ j) as u32).leading_zeros());
    }
    i64::from((key ^ other).leading_zeros())
}

/// The range of inner node `index`, of which there is one fewer than codes; `None` for one of at most `max_leaf`
/// triangles.
pub fn range(keys: &[u32], index: usize, max_leaf: u32) -> Option<Range> {
    let i = index as i64;
    let common = |distance: i64| common_bits(keys, i, i + distance);
    let (after, before) = (common(1), common(-1));
    let step = if after > before { 1 } else { -1 };
    let least = after.min(before);
    let mut inside = i64::from(max_leaf);
    if common(inside * step) <= least {
        return None;
    }
    let mut outside = 2 * inside;
    while common(outside * step) > least {
        inside = outside;
        outside *= 2;
    }
    let inside = bisect(inside, outside, |distance| common(distance * step) > least);
    let end = i + inside * step;
    let own = common(inside * step);
    let same = bisect(0, inside, |distance| common(distance * step) > own);
    let split = i + same * step + step.min(0);
    Some(Range { first: i.min(end) as u32, last: i.max(end) as u32, split: split as u32 })
}

/// The greatest number that holds: `inside` does, `outside` does not, and all that do come first.
fn bisect(mut inside: i64, mut outside: i64, holds: impl Fn(i64) -> bool) -> i64 {
    while outside - inside > 1 {
        let middle = (inside + outside) / 2;
        if holds(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}
