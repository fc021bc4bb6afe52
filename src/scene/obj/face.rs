//! Converts faces to vertices and triangles.

use super::Fault;
use super::lines::{Lines, printable};
use crate::scene::Triangle;
use crate::scene::lamps;
use crate::scene::mesh_builder::Limits;
use crate::scene::polygon::{Triangulator, newell};
use foldhash::fast::RandomState;
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// Corners with equal keys share a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VertexKey {
    /// Index into [`Faces::positions`].
    pub position: u32,
    normal: Normal,
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

    /// Reads the corners of a face and adds its triangles.
    pub fn face(&mut self, lines: &mut Lines, material: u32) -> Result<(), Fault> {
        self.corners.clear();
        self.first.resize(self.positions.len(), NONE);
        while let Some(word) = lines.word() {
            let (position, normal) = self.corner(word, lines.line())?;
            let normal = match (normal, self.smoothing) {
                (Some(index), _) => Normal::Given(index),
                (None, Smoothing::Group(group)) => Normal::Smooth(group),
                (None, Smoothing::Flat) => Normal::Flat(self.faces),
            };
            let vertex = self.vertex(VertexKey { position, normal });
            self.corners.push(vertex);
            if self.corners.len().is_multiple_of(MANY_CORNERS) {
                self.check_memory(lines.line())?;
            }
        }
        self.faces = self.faces.wrapping_add(1);
        let add = |a: u32, b: u32, c: u32| Triangle { vertices: [a, b, c], material };
        match *self.corners.as_slice() {
            [] | [_] | [_, _] => self.small += 1,
            [a, b, c] => self.triangles.push(add(a, b, c)),
            _ => {
                let (keys, positions) = (&self.keys, &self.positions);
                let point = |&v: &u32| positions[keys[v as usize].position as usize].as_dvec3();
                self.points.clear();
                self.points.extend(self.corners.iter().map(point));
                let normal = newell(&self.points);
                let corner = |i: u32| self.corners[i as usize];
                for &[a, b, c] in self.triangulator.triangles(&self.points, &[], normal) {
                    self.triangles.push(add(corner(a), corner(b), corner(c)));
                }
            }
        }
        self.check_memory(lines.line())
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
            + self.corners.len() * PER_CORNER;
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

    /// Parses a corner: `position`, `position/texture`, `position//normal` or `position/texture/normal`. Returns the
    /// indices of position and normal, counted from 0.
    #[inline]
    fn corner(&self, word: &[u8], line: usize) -> Result<(u32, Option<u32>), Fault> {
        let broken = || {
            let problem = format!("`{}` is not a corner of a face", printable(word));
            Fault::new(line, problem, "write v, v/vt, v//vn or v/vt/vn")
        };
        let (position, rest) = index(word).ok_or_else(broken)?;
        let position = resolve(position, self.positions.len(), "vertex", line)?;
        let Some(rest) = rest.strip_prefix(b"/") else {
            return if rest.is_empty() { Ok((position, None)) } else { Err(broken()) };
        };
        // The index of the texture coordinate is checked and ignored.
        let rest = if rest.starts_with(b"/") || rest.is_empty() { rest } else { index(rest).ok_or_else(broken)?.1 };
        match rest.strip_prefix(b"/") {
            None if rest.is_empty() => Ok((position, None)),
            Some(b"") => Ok((position, None)),
            Some(rest) => match index(rest) {
                Some((normal, b"")) => Ok((position, Some(resolve(normal, self.normals.len(), "normal", line)?))),
                _ => Err(broken()),
            },
            None => Err(broken()),
        }
    }
}

/// Parses an integer at the start; also returns the rest.
#[inline]
fn index(bytes: &[u8]) -> Option<(i64, &[u8])> {
    let negative = bytes.first() == Some(&b'-');
    let digits = &bytes[usize::from(negative)..];
    let length = digits.iter().take_while(|b| b.is_ascii_digit()).count();
    if !(1..=18).contains(&length) {
        return None;
    }
    let value = digits[..length].iter().fold(0i64, |value, b| value * 10 + i64::from(b - b'0'));
    Some((if negative { -value } else { value }, &digits[length..]))
}

/// Converts an index, which counts from 1 or backwards from -1, to one that counts from 0. `element` is its name for
/// messages.
#[inline]
fn resolve(given: i64, count: usize, element: &str, line: usize) -> Result<u32, Fault> {
    let index = if given < 0 { given + count as i64 } else { given - 1 };
    if (0..count as i64).contains(&index) {
        return Ok(index as u32);
    }
    let problem = format!("a face uses {element} {given}, but {count} are defined before it");
    Err(Fault::new(line, problem, "indices count from 1, or backwards from -1"))
}
