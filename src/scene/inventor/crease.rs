//! Computes normals for shapes without normals: smooth across edges below the crease angle, sharp at the others.
//!
//! The normal of a corner is the sum of the unit normals of all faces at its position that differ from the corner's
//! face by at most the crease angle, as in the format's reference implementation.

use super::faces::{Face, Faces};
use crate::scene::mesh_builder::MeshBuilder;
use crate::scene::polygon::newell;
use crate::scene::text::Fault;
use foldhash::fast::RandomState;
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::PI;

/// The largest number of faces at a position for which normals are smooth. At positions with more faces each face has
/// its own normal, since the work would grow with the square of their number.
const MAX_FACES: usize = 1000;

/// Upper bound of the temporary memory per corner in bytes: a position with its index in the map, and its entry.
const PER_CORNER: usize = 64;
/// Upper bound of the temporary memory per face in bytes: a normal and indices.
const PER_FACE: usize = 48;

/// Tolerance for rounding errors in the comparison of two normals, as a cosine.
const ROUNDING: f64 = 1e-9;

/// Computed normals of a set of faces.
pub struct Creased {
    /// Cosine of the crease angle.
    cosine: f64,
    /// Unit normals of the faces.
    normals: Vec<DVec3>,
    /// The index of the position of each corner, in the order of visits.
    positions: Vec<u32>,
    /// The faces at each position; those of position `i` begin at `begin[i]`.
    faces: Vec<u32>,
    begin: Vec<u32>,
    /// The sum of the faces' normals for each position at which all of them are smooth with each other.
    shared: Vec<Option<DVec3>>,
    /// Number of triangles of the faces.
    triangles: usize,
}

/// The normal of a corner.
pub struct CornerNormal {
    /// The normal, of any length; zero if there is none.
    pub normal: DVec3,
    /// Index of the position, if all corners there have this normal.
    pub shared: Option<u32>,
    /// Number of faces that were examined.
    pub work: usize,
}

impl Creased {
    /// Visits all faces and collects their normals by position.
    pub fn new(faces: &Faces, angle: f64, mesh: &MeshBuilder) -> Result<Creased, Fault> {
        let angle = angle.min(PI);
        let mut normals = Vec::new();
        let mut positions: Vec<u32> = Vec::new();
        // For each face, the number of corners up to its end
        let mut ends: Vec<u32> = Vec::new();
        let mut known: HashMap<[u64; 3], u32, RandomState> = HashMap::default();
        let (mut points, mut triangles) = (Vec::new(), 0);
        faces.visit(&mut |face: Face| {
            mesh.check_temporary(PER_CORNER * (positions.len() + face.corners.len()) + PER_FACE * normals.len())?;
            points.clear();
            for corner in face.corners {
                // Adding zero turns -0 into 0, so that both are the same position.
                let point = faces.position(corner) + DVec3::ZERO;
                let next = known.len() as u32;
                positions.push(*known.entry(point.to_array().map(f64::to_bits)).or_insert(next));
                points.push(point);
            }
            normals.push(newell(&points).normalize_or_zero());
            ends.push(positions.len() as u32);
            triangles += face.corners.len().saturating_sub(2);
            Ok(())
        })?;
        let mut begin = vec![0u32; known.len() + 1];
        drop(known);
        // Both live while the mesh grows.
        positions.shrink_to_fit();
        normals.shrink_to_fit();
        positions.iter().for_each(|&position| begin[position as usize + 1] += 1);
        for i in 1..begin.len() {
            begin[i] += begin[i - 1];
        }
        let mut next = begin.clone();
        let mut at = vec![0; positions.len()];
        let mut corner = 0;
        for (face, &end) in ends.iter().enumerate() {
            for &position in &positions[corner..end as usize] {
                at[next[position as usize] as usize] = face as u32;
                next[position as usize] += 1;
            }
            corner = end as usize;
        }
        drop((next, ends));
        let shared = begin.windows(2).map(|range| {
            let around = &at[range[0] as usize..range[1] as usize];
            shared_normal(around.iter().map(|&face| normals[face as usize]), angle)
                .filter(|_| around.len() <= MAX_FACES)
        });
        Ok(Creased { cosine: angle.cos(), shared: shared.collect(), normals, positions, faces: at, begin, triangles })
    }

    /// The numbers of positions and of triangles.
    pub fn size(&self) -> (usize, usize) {
        (self.shared.len(), self.triangles)
    }

    /// The normal of a corner of a face; `corner` and `face` are numbers in the order of visits.
    pub fn normal(&self, corner: usize, face: usize) -> CornerNormal {
        let position = self.positions[corner];
        if let Some(normal) = self.shared[position as usize] {
            return CornerNormal { normal, shared: Some(position), work: 1 };
        }
        let own = self.normals[face];
        let around = &self.faces[self.begin[position as usize] as usize..self.begin[position as usize + 1] as usize];
        if around.len() > MAX_FACES {
            return CornerNormal { normal: own, shared: None, work: 0 };
        }
        let smooth = |normal: &DVec3| normal.dot(own) >= self.cosine;
        let sum: DVec3 = around.iter().map(|&face| self.normals[face as usize]).filter(smooth).sum();
        CornerNormal { normal: if sum == DVec3::ZERO { own } else { sum }, shared: None, work: around.len() }
    }
}

/// The sum of the normals, if each of them is within half the angle of the sum, and so all are within the angle of each
/// other. This is sufficient, not necessary: `None` does not prove the opposite.
fn shared_normal(normals: impl Iterator<Item = DVec3> + Clone, angle: f64) -> Option<DVec3> {
    let sum: DVec3 = normals.clone().sum();
    let least = ((angle / 2.0).cos() + ROUNDING) * sum.length();
    (least > 0.0 && normals.clone().all(|normal| normal.dot(sum) >= least)).then_some(sum)
}
