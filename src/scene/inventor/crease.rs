//! Normals where the file gives none: smooth across edges that are flat enough, sharp at the others.
//!
//! A corner's normal is the mean of the unit normals of all faces that meet at its position and whose own normal is within
//! the crease angle of the corner's face's, as the format's library makes them.

use super::faces::{Face, Faces};
use crate::scene::mesh_builder::MeshBuilder;
use crate::scene::polygon::newell;
use crate::scene::text::Fault;
use foldhash::fast::RandomState;
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::PI;

/// Most faces at a position: with more of them every face keeps its own normal there, or the work would grow with their
/// square.
const MOST: usize = 1000;

/// Memory per corner and per face while normals are made: a position with its index, and a vector; indices.
const PER_CORNER: usize = 64;
const PER_FACE: usize = 48;

/// How much further apart than they are two normals may be taken for, as a cosine, for all that rounding does.
const ROUNDING: f64 = 1e-9;

/// Normals of a set of faces.
pub struct Creased {
    /// Of the crease angle.
    cosine: f64,
    /// Unit normals of the faces.
    normals: Vec<DVec3>,
    /// Of all corners, in the order of visits, the index of their position.
    places: Vec<u32>,
    /// Faces at each position: those of position `i` begin at `begin[i]`.
    faces: Vec<u32>,
    begin: Vec<u32>,
    /// Of each position, the sum of the faces' normals, if all of them are smooth with each other.
    whole: Vec<Option<DVec3>>,
    /// Triangles that the faces make.
    triangles: usize,
}

/// The normal of a corner.
pub struct Smooth {
    /// Of any length; zero where there is none.
    pub normal: DVec3,
    /// The position, if all corners there have this normal.
    pub whole: Option<u32>,
    /// Faces that were looked at for it.
    pub work: usize,
}

impl Creased {
    /// Looks at all faces.
    pub fn new(faces: &Faces, angle: f64, mesh: &MeshBuilder) -> Result<Creased, Fault> {
        let angle = angle.min(PI);
        let mut normals = Vec::new();
        let mut places: Vec<u32> = Vec::new();
        // The first corner behind each face
        let mut ends: Vec<u32> = Vec::new();
        let mut known: HashMap<[u64; 3], u32, RandomState> = HashMap::default();
        let (mut points, mut triangles) = (Vec::new(), 0);
        faces.visit(&mut |face: Face| {
            mesh.charge_for_now(PER_CORNER * (places.len() + face.corners.len()) + PER_FACE * normals.len())?;
            points.clear();
            for corner in face.corners {
                // Adding zero makes -0 and 0 the same
                let point = faces.position(corner) + DVec3::ZERO;
                let next = known.len() as u32;
                places.push(*known.entry(point.to_array().map(f64::to_bits)).or_insert(next));
                points.push(point);
            }
            normals.push(newell(&points).normalize_or_zero());
            ends.push(places.len() as u32);
            triangles += face.corners.len().saturating_sub(2);
            Ok(())
        })?;
        let mut begin = vec![0u32; known.len() + 1];
        drop(known);
        // They stay while the mesh grows
        places.shrink_to_fit();
        normals.shrink_to_fit();
        places.iter().for_each(|&place| begin[place as usize + 1] += 1);
        for i in 1..begin.len() {
            begin[i] += begin[i - 1];
        }
        let mut next = begin.clone();
        let mut at = vec![0; places.len()];
        let mut corner = 0;
        for (face, &end) in ends.iter().enumerate() {
            for &place in &places[corner..end as usize] {
                at[next[place as usize] as usize] = face as u32;
                next[place as usize] += 1;
            }
            corner = end as usize;
        }
        drop((next, ends));
        let whole = begin.windows(2).map(|range| {
            let around = &at[range[0] as usize..range[1] as usize];
            whole(around.iter().map(|&face| normals[face as usize]), angle).filter(|_| around.len() <= MOST)
        });
        Ok(Creased { cosine: angle.cos(), whole: whole.collect(), normals, places, faces: at, begin, triangles })
    }

    /// Positions, and triangles that the faces make.
    pub fn size(&self) -> (usize, usize) {
        (self.whole.len(), self.triangles)
    }

    /// The normal of a corner for its face, both by their places in the order of visits.
    pub fn normal(&self, corner: usize, face: usize) -> Smooth {
        let place = self.places[corner];
        if let Some(normal) = self.whole[place as usize] {
            return Smooth { normal, whole: Some(place), work: 1 };
        }
        let own = self.normals[face];
        let around = &self.faces[self.begin[place as usize] as usize..self.begin[place as usize + 1] as usize];
        if around.len() > MOST {
            return Smooth { normal: own, whole: None, work: 0 };
        }
        let smooth = |normal: &DVec3| normal.dot(own) >= self.cosine;
        let sum: DVec3 = around.iter().map(|&face| self.normals[face as usize]).filter(smooth).sum();
        Smooth { normal: if sum == DVec3::ZERO { own } else { sum }, whole: None, work: around.len() }
    }
}

/// The sum of normals that are all within half the angle of it, and so within the angle of each other. There may be such
/// ones where this finds none.
fn whole(normals: impl Iterator<Item = DVec3> + Clone, angle: f64) -> Option<DVec3> {
    let sum: DVec3 = normals.clone().sum();
    let least = ((angle / 2.0).cos() + ROUNDING) * sum.length();
    (least > 0.0 && normals.clone().all(|normal| normal.dot(sum) >= least)).then_some(sum)
}
