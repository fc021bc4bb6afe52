//! Positions of samples along the axes of the boxes, and their keys. Twin of `kernels/splat/clusters/keys.wgsl`.

use super::setting::Normals;
use super::{KeyLayout, NONE, Placement};
use crate::workloads::splat::directions;
use crate::workloads::splat::samples::Samples;
use glam::{Vec3A, Vec4};
use rayon::prelude::*;

/// The slice of a depth: the last that begins no farther away; the first for what is nearer than all.
pub fn slice_of(borders: &[f32], depth: f32) -> u32 {
    borders.partition_point(|&border| border <= depth).saturating_sub(1) as u32
}

/// The part of a key that a unit normal makes.
pub fn normal_index(normals: Normals, normal: Vec3A) -> u32 {
    match normals {
        Normals::Off => 0,
        Normals::Faces => directions::face(normal),
        Normals::Cells => directions::direction_index(normal),
    }
}

/// Positions and keys of all pixels, as [`super::Clusters`] holds them; `borders` are those of
/// [`KeyLayout::borders`].
pub fn of(
    normals: Normals,
    layout: &KeyLayout,
    placement: &Placement,
    borders: &[f32],
    samples: &Samples,
) -> (Vec<Vec4>, Vec<u32>) {
    let spread = layout.spread();
    let (columns, rest) = spread.split_at(layout.columns as usize);
    let (rows, slices) = rest.split_at(layout.rows as usize);
    let width = layout.size.width as usize;
    let sample = |(pixel, (&position, &normal)): (usize, (&Vec4, &Vec4))| {
        // Not a number is no sample
        if !(position.w > 0.0) {
            return (Vec4::ZERO, NONE);
        }
        let (x, y) = (pixel % width / layout.tile as usize, pixel / width / layout.tile as usize);
        let slice = slice_of(borders, position.w) as usize;
        let key = columns[x] | rows[y] | slices[slice] | normal_index(normals, Vec3A::from_vec4(normal));
        (placement.placed(Vec3A::from_vec4(position)).extend(position.w), key)
    };
    samples.positions.par_iter().zip(&samples.normals).enumerate().map(sample).unzip()
}
