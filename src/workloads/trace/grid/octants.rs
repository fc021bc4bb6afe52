//! The grid traversal's constants by ray octant: looked up instead of computed, which saves registers.

use bytemuck::{Pod, Zeroable};

/// Constants of one octant; `Octant` of `kernels/trace/grid/walk.wgsl`. The fourth components are zero.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
#[repr(C)]
pub struct Octant {
    /// +1 or -1 per axis.
    pub step: [i32; 4],
    /// First cell index outside the grid per axis, in the direction of `step`.
    pub end: [i32; 4],
}

/// The eight octants of a grid; bit `axis` of the index is set where the ray's direction is negative on that axis.
pub fn octants(resolution: [u32; 3]) -> [Octant; 8] {
    std::array::from_fn(|index| {
        let mut octant = Octant::default();
        for axis in 0..3 {
            let negative = index >> axis & 1 == 1;
            octant.step[axis] = if negative { -1 } else { 1 };
            octant.end[axis] = if negative { -1 } else { resolution[axis] as i32 };
        }
        octant
    })
}
