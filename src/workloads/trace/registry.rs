//! The names of `--structure`, in the order of tables.

use super::algorithm::Algorithm;
use super::{bih, brute, bvh, cwbvh, grid, kdtree, query, subgroup, wide};

static ALGORITHMS: &[&Algorithm] = &[
    &grid::dda::GRID,
    &kdtree::search::KDTREE,
    &bvh::packet::BVH,
    &bvh::stack::BVH_STACK,
    &bvh::stack::PLOC_STACK,
    &wide::pair_stack::BVH_QUANTISED,
    &wide::stack::BVH4,
    &wide::stack::BVH8,
    &cwbvh::stack::CWBVH,
    &subgroup::BVH_SUBGROUP,
    &bvh::stackless::BVH_STACKLESS,
    &bih::stack::BIH,
    &grid::coop::GRID_COOP,
    &grid::packet::GRID_PACKET,
    &query::driver::QUERY,
    &brute::scan::BRUTE,
];

/// All algorithms.
pub fn algorithms() -> &'static [&'static Algorithm] {
    ALGORITHMS
}
