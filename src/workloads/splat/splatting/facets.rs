//! Normals of keys as cones: how far a photon may come from behind before no normal of a cell sees it.

use crate::workloads::splat::directions::{DIRECTIONS, cell_centre, face};
use glam::{Vec3A, Vec4};

/// Added to sines: more than products of unit vectors are rounded by.
const SLACK: f32 = 1.0 / (1 << 18) as f32;

/// For keys with so many bits of normals, an element for each index of a normal: the axis of its cell, and as `w` the
/// sine of the angle to the cell's farthest corner. No normal of the cell faces a photon whose direction of travel has
/// a product of at least this with the axis. Empty without such bits.
pub fn facets(bits: u32) -> Vec<Vec4> {
    match bits {
        0 => Vec::new(),
        3 => (0..6).map(|face| cone(cell_centre(9 * face + 4).normalize(), corners(9 * face + 4, 1.0))).collect(),
        _ => (0..DIRECTIONS).map(|cell| cone(cell_centre(cell).normalize(), corners(cell, 1.0 / 3.0))).collect(),
    }
}

/// The corners of a square around the centre of a cell, on the surface of the cube; `half` is half its side.
fn corners(cell: u32, half: f32) -> [Vec3A; 4] {
    let centre = cell_centre(cell);
    let axis = face(centre) as usize / 2;
    [(-half, -half), (-half, half), (half, -half), (half, half)].map(|(first, second)| {
        let mut corner = centre;
        corner[(axis + 1) % 3] += first;
        corner[(axis + 2) % 3] += second;
        corner
    })
}

fn cone(axis: Vec3A, corners: [Vec3A; 4]) -> Vec4 {
    let sine = |corner: Vec3A| axis.cross(corner.normalize()).length();
    axis.extend(corners.map(sine).into_iter().fold(0.0, f32::max) + SLACK)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workloads::splat::directions::direction_index;
    use crate::workloads::splat::random::unit_vector;

    #[test]
    fn no_normal_of_a_cell_faces_what_its_cone_rejects() {
        let (faces, cells) = (facets(3), facets(6));
        assert_eq!((faces.len(), cells.len(), facets(0).len()), (6, 54, 0));
        let (mut rejected, mut away) = ([0; 2], 0);
        for path in 0..40_000 {
            let (normal, direction) = (unit_vector(1, path, 0), unit_vector(2, path, 0));
            away += u32::from(-normal.dot(direction) <= 0.0);
            let facets = [faces[face(normal) as usize], cells[direction_index(normal) as usize]];
            for (count, facet) in rejected.iter_mut().zip(facets) {
                if Vec3A::from_vec4(facet).dot(direction) >= facet.w {
                    *count += 1;
                    assert!(-normal.dot(direction) <= 0.0, "{normal} {direction}");
                }
            }
        }
        // Half of all directions come from behind; the cones find (1 - sine) / 2 of all: 0.09 and about 0.32
        assert!((19_000..21_000).contains(&away), "{away}");
        assert!(rejected[0] > 3000 && rejected[1] > 11_000 && rejected[1] < away, "{rejected:?}");
    }
}
