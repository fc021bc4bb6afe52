//! Normals where the file gives none: smooth across edges that are flat enough, sharp at the others.
//!
//! A corner's normal is the mean of the unit normals of all faces that meet at its position and whose own normal is within
//! the crease angle of the corner's face's, as the format's library makes them.

use super::faces::{Face, Faces};
use crate::scene::mesh_builder::MeshBuilder;
use crate::scene::polygon::newell;
use crate::scene::text::Fault;
use glam::DVec3;
use std::collections::HashMap;

/// Most faces at a position: with more of them every face keeps its own normal there, or the work would grow with their
/// square.
const MOST: usize = 1000;

/// Memory per corner and per face while normals are made: a position with its index, and a vector; indices.
const PER_CORNER: usize = 64;
const PER_FACE: usize = 32;

/// Normals of a set of faces.
pub struct Creased {
    cosine: f64,
    /// Unit normals of the faces.
    normals: Vec<DVec3>,
    /// Of all corners, in the order of visits, the index of their position.
    places: Vec<u32>,
    /// Faces at each position: those of position `i` begin at `begin[i]`.
    faces: Vec<u32>,
    begin: Vec<u32>,
}

impl Creased {
    /// Looks at all faces.
    pub fn new(faces: &Faces, angle: f64, mesh: &MeshBuilder) -> Result<Creased, Fault> {
        let mut normals = Vec::new();
        let mut places: Vec<u32> = Vec::new();
        let mut known: HashMap<[u64; 3], u32> = HashMap::new();
        let mut points = Vec::new();
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
            Ok(())
        })?;
        let mut begin = vec![0u32; known.len() + 1];
        places.iter().for_each(|&place| begin[place as usize + 1] += 1);
        for i in 1..begin.len() {
            begin[i] += begin[i - 1];
        }
        let mut next = begin.clone();
        let mut at = vec![0; places.len()];
        let mut corners = places.iter();
        faces.visit(&mut |face: Face| {
            for &place in corners.by_ref().take(face.corners.len()) {
                at[next[place as usize] as usize] = face.visit as u32;
                next[place as usize] += 1;
            }
            Ok(())
        })?;
        Ok(Creased { cosine: angle.min(std::f64::consts::PI).cos(), normals, places, faces: at, begin })
    }

    /// The normal of a corner for its face, both by their places in the order of visits; zero where there is none. Also the
    /// number of faces that were looked at.
    pub fn normal(&self, corner: usize, face: usize) -> (DVec3, usize) {
        let own = self.normals[face];
        let place = self.places[corner] as usize;
        let around = &self.faces[self.begin[place] as usize..self.begin[place + 1] as usize];
        if around.len() > MOST {
            return (own, 0);
        }
        let smooth = |normal: &DVec3| normal.dot(own) >= self.cosine;
        let sum: DVec3 = around.iter().map(|&face| self.normals[face as usize]).filter(smooth).sum();
        (if sum == DVec3::ZERO { own } else { sum }, around.len())
    }
}
