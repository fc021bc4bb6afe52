//! Converts faces to vertices and triangles.

use super::Fault;
use super::lines::Lines;
use super::pending::{PendingFace, Problems};
use crate::scene::Triangle;
use crate::scene::lamps;
use crate::scene::mesh_builder::Limits;
use crate::scene::polygon::{Triangulator, newell};
use foldhash::fast::RandomState;
use glam::{DVec3, Vec3};
use std::collections::HashMap;
use std::ops::Range;

/// Corners with equal keys share a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VertexKey {
    /// Index into [`Faces::positions`].
    pub position: u32,
    normal: Normal,
}

/// The indices of a corner, counted from 0; the normal's index may be out of range.
#[derive(Clone, Copy)]
pub struct Corner {
    pub position: u32,
    pub normal: Option<u32>,
}

impl VertexKey {
    /// Index into [`Faces::normals`], if the corner has a normal in the file.
    pub fn normal(&self) -> Option<usize> {
        match self.normal {
            Normal::Given(index) => Some(index as usize),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Normal {
    /// The normal in the file with this index.
    Given(u32),
    /// The smooth normal over all triangles of this smoothing group.
    Smooth(u32),
    /// The normal of the face with this number.
    Flat(u32),
}

/// The computation of normals if the file has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothing {
    /// Smooth over this group; group 0 is in effect before the first `s`.
    Group(u32),
    /// Flat, as after `s off`.
    Flat,
}

impl Smoothing {
    /// The parameter of `s`: the number of a group, or 0 for flat shading. All other words mean one additional group.
    pub fn group(word: &[u8]) -> Smoothing {
        match std::str::from_utf8(word).ok().and_then(|text| text.parse().ok()) {
            Some(0) => Smoothing::Flat,
            Some(group) => Smoothing::Group(group),
            None => Smoothing::Group(u32::MAX),
        }
    }
}

/// The end of a chain.
const NONE: u32 = u32::MAX;

/// The largest number of vertices in a chain; further vertices at a position are found in a map. Few positions have so
/// many vertices, and short chains are faster than the map.
const LONGEST: usize = 24;

// Upper bounds of the memory in bytes, while vectors grow and at the end. A vertex has a key, a link, and finally two
// copies of its position and normal; a crowded vertex also has an entry in the map.
const PER_POSITION: usize = 32;
const PER_NORMAL: usize = 24;
const PER_VERTEX: usize = 112;
const PER_CROWDED: usize = 64;
const PER_TRIANGLE: usize = 32;
const PER_CORNER: usize = 112;
const PER_PENDING: usize = 36;
const PER_INDEX: usize = 12;

/// The memory of a face is checked after this number of corners.
const MANY_CORNERS: usize = 4096;

/// The vertices and triangles so far.
pub struct Faces {
    /// Positions of the file (`v`), relative to the offset.
    pub positions: Vec<Vec3>,
    /// Normals of the file (`vn`), not normalised.
    pub normals: Vec<Vec3>,
    /// The key of each vertex.
    pub keys: Vec<VertexKey>,
    /// For each vertex, the next vertex at the same position.
    next: Vec<u32>,
    /// For each position, the first vertex.
    first: Vec<u32>,
    /// Vertices at positions with full chains.
    crowded: HashMap<VertexKey, u32, RandomState>,
    /// Triangles in file order.
    pub triangles: Vec<Triangle>,
    /// Index of the current material.
    pub material: Option<u32>,
    /// Number of faces with fewer than three corners.
    pub small: usize,
    smoothing: Smoothing,
    faces: u32,
    /// Vertices of the current face.
    corners: Vec<u32>,
    /// Positions of the current face.
    points: Vec<DVec3>,
    triangulator: Triangulator,
    pub limits: Limits,
    /// Number of emissive triangles.
    pub emissive: usize,
    /// Faces with vertices that follow them in the file.
    pub(super) pending: Vec<PendingFace>,
    pub(super) problems: Problems,
}

impl Default for Faces {
    fn default() -> Faces {
        Faces {
            positions: Vec::new(),
            normals: Vec::new(),
            keys: Vec::new(),
            next: Vec::new(),
            first: Vec::new(),
            crowded: HashMap::default(),
            triangles: Vec::new(),
            material: None,
            small: 0,
            smoothing: Smoothing::Group(0),
            faces: 0,
            corners: Vec::new(),
            points: Vec::new(),
            triangulator: Triangulator::default(),
            limits: Limits::default(),
            emissive: 0,
            pending: Vec::new(),
            problems: Problems::default(),
        }
    }
}

impl Faces {
    /// Adds the size of a file, which raises the limits.
    pub fn read(&mut self, bytes: usize) {
        self.limits.read(bytes);
        self.triangulator.read(bytes);
    }

    pub fn set_smoothing(&mut self, smoothing: Smoothing) {
        self.smoothing = smoothing;
    }

    /// Reads the corners of a face and adds its triangles. A face with a vertex that is not finite is dropped.
    pub fn face(&mut self, lines: &mut Lines, material: u32) -> Result<(), Fault> {
        self.corners.clear();
        self.problems.begin_face();
        if self.first.len() < self.positions.len() {
            self.first.resize(self.positions.len(), NONE);
        }
        while let Some(word) = lines.word() {
            match self.plain_corner(word) {
                Some(corner) => self.add_corner(corner, lines.line())?,
                None => self.odd_corners(word, lines)?,
            }
            if self.corners.len().is_multiple_of(MANY_CORNERS) {
                self.check_memory(lines.line())?;
            }
        }
        self.faces = self.faces.wrapping_add(1);
        if self.problems.drops_face(self.corners.len()) {
            return self.check_memory(lines.line());
        }
        let begin = self.triangles.len();
        let add = |a: u32, b: u32, c: u32| Triangle { vertices: [a, b, c], material };
        match *self.corners.as_slice() {
            [] | [_] | [_, _] => self.small += 1,
            [a, b, c] => self.triangles.push(add(a, b, c)),
            [first, ref rest @ ..] => {
                self.triangles.extend(rest.windows(2).map(|pair| add(first, pair[0], pair[1])));
                if !self.problems.is_forward() {
                    self.triangulate(begin..self.triangles.len());
                }
            }
        }
        if self.problems.is_forward() && self.triangles.len() > begin {
            let triangles = begin as u32..self.triangles.len() as u32;
            self.pending.push(PendingFace { triangles, line: lines.line() as u32 });
        }
        self.check_memory(lines.line())
    }

    /// Adds a corner to the current face.
    #[inline]
    pub(super) fn add_corner(&mut self, Corner { position, normal }: Corner, line: usize) -> Result<(), Fault> {
        if self.problems.has_invalid && !self.is_usable(position, line)? {
            return Ok(());
        }
        let normal = match (normal, self.smoothing) {
            (Some(index), _) => Normal::Given(index),
            (None, Smoothing::Group(group)) => Normal::Smooth(group),
            (None, Smoothing::Flat) => Normal::Flat(self.faces),
        };
        let vertex = self.vertex(VertexKey { position, normal });
        self.corners.push(vertex);
        Ok(())
    }

    /// The position of a vertex.
    pub(super) fn position(&self, vertex: u32) -> Option<Vec3> {
        self.positions.get(self.keys[vertex as usize].position as usize).copied()
    }

    /// Enlarges the table of positions for a position that follows in the file.
    pub(super) fn make_room(&mut self, position: usize) {
        if self.first.len() <= position {
            self.first.resize(position + 1, NONE);
        }
    }

    /// Replaces the triangles of a fan by those of [`Triangulator::triangles`].
    pub(super) fn triangulate(&mut self, fan: Range<usize>) {
        let Faces { keys, positions, triangles, corners, points, triangulator, .. } = self;
        let fan = &mut triangles[fan];
        corners.clear();
        corners.extend(&fan[0].vertices[..2]);
        corners.extend(fan.iter().map(|triangle| triangle.vertices[2]));
        points.clear();
        points.extend(corners.iter().map(|&v| positions[keys[v as usize].position as usize].as_dvec3()));
        let found = triangulator.triangles(points, &[], newell(points));
        for (triangle, found) in fan.iter_mut().zip(found) {
            triangle.vertices = found.map(|i| corners[i as usize]);
        }
    }

    /// Checks the memory of all vertices and triangles against the limit.
    #[inline]
    pub fn check_memory(&self, line: usize) -> Result<(), Fault> {
        let bytes = self.positions.len() * PER_POSITION
            + self.normals.len() * PER_NORMAL
            + self.keys.len() * PER_VERTEX
            + self.crowded.len() * PER_CROWDED
            + self.triangles.len() * PER_TRIANGLE
            + self.emissive * lamps::BYTES
            + self.corners.len() * PER_CORNER
            + self.pending.len() * PER_PENDING
            + self.first.len().saturating_sub(self.positions.len()) * PER_INDEX;
        let hint = "the file has many faces with few vertices: convert it to another format, such as binary PLY";
        self.limits.check_temporary(bytes).map_err(|fault| Fault::new(line, fault.problem, hint))
    }

    /// The vertex with this key, which is created if necessary.
    #[inline]
    fn vertex(&mut self, key: VertexKey) -> u32 {
        let (mut at, mut length) = (self.first[key.position as usize], 0);
        while at != NONE {
            if self.keys[at as usize] == key {
                return at;
            }
            at = self.next[at as usize];
            length += 1;
        }
        let index = self.keys.len() as u32;
        if length == LONGEST {
            if let Some(&known) = self.crowded.get(&key) {
                return known;
            }
            self.crowded.insert(key, index);
            self.keys.push(key);
            self.next.push(NONE);
            return index;
        }
        self.keys.push(key);
        self.next.push(std::mem::replace(&mut self.first[key.position as usize], index));
        index
    }
}
