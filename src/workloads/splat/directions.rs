//! Directions as indices: six faces of a cube with 3 x 3 cells each. Twin of `kernels/splat/directions.wgsl`.

use glam::Vec3A;

/// Number of directions.
pub const DIRECTIONS: u32 = 54;

/// The face of a cube around the origin that a vector points through: twice the axis of its largest component, and one
/// more where that is negative. Of equal components the first counts.
pub fn face(vector: Vec3A) -> u32 {
    let [x, y, z] = vector.abs().to_array();
    let axis = if x >= y && x >= z { 0 } else { 1 + u32::from(z > y) };
    2 * axis + u32::from(vector[axis as usize] < 0.0)
}

/// The index of a vector's direction: 9 x its face + 3 x its cell along the first of the other two axes + its cell
/// along the second.
pub fn direction_index(vector: Vec3A) -> u32 {
    let face = face(vector);
    let [first, second] = others(face / 2);
    let largest = vector[face as usize / 2].abs();
    let cell = |axis: usize| (((vector[axis] / largest + 1.0) * 1.5) as u32).min(2);
    9 * face + 3 * cell(first) + cell(second)
}

/// The vector through the centre of an index's cell, on the surface of the cube: not a unit vector.
pub fn cell_centre(index: u32) -> Vec3A {
    let (axis, [first, second]) = (index / 18, others(index / 18));
    let place = |cell: u32| (cell as f32 - 1.0) * (2.0 / 3.0);
    let mut vector = Vec3A::ZERO;
    vector[axis as usize] = if (index / 9).is_multiple_of(2) { 1.0 } else { -1.0 };
    vector[first] = place(index / 3 % 3);
    vector[second] = place(index % 3);
    vector
}

/// The unit vector through the centre of an index's cell.
pub fn direction(index: u32) -> Vec3A {
    cell_centre(index).normalize()
}

/// The axes of a face's cells.
fn others(axis: u32) -> [usize; 2] {
    match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_of_a_cell_has_its_index() {
        for index in 0..DIRECTIONS {
            assert_eq!(direction_index(cell_centre(index)), index);
            assert_eq!(direction_index(direction(index)), index);
            assert_eq!(face(direction(index)), index / 9);
        }
    }

    #[test]
    fn cells_have_the_solid_angles_of_a_cube() {
        // A fine grid on the faces, each point with its solid angle
        let mut sums = [0.0_f64; DIRECTIONS as usize];
        let n = 120;
        for face in 0..6 {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let place = |i: i32| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
                let (u, v) = (place(i), place(j));
                let mut vector = Vec3A::ZERO;
                let [first, second] = others(face / 2);
                vector[face as usize / 2] = if face % 2 == 0 { 1.0 } else { -1.0 };
                (vector[first], vector[second]) = (u as f32, v as f32);
                let square = 1.0 + u * u + v * v;
                sums[direction_index(vector) as usize] += 4.0 / f64::from(n * n) / (square * square.sqrt());
            }
        }
        for (index, sum) in sums.iter().enumerate() {
            let centred = [index / 3 % 3, index % 3].into_iter().filter(|&cell| cell == 1).count();
            let expected = [0.1727, 0.2507, 0.4007][centred];
            assert!((sum - expected).abs() < 0.001, "{index}: {sum}");
        }
    }
}
