//! Faces: corners, their vertices, triangles.

use super::Fault;
use super::lines::{Lines, printable};
use crate::scene::Triangle;
use crate::scene::lamps;
use crate::scene::mesh_builder::Limits;
use crate::scene::polygon::{Triangulator, newell};
use foldhash::fast::RandomState;
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// What makes two corners at the same position one vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// Index into [`Faces::positions`].
    pub position: u32,
    normal: Normal,
}

impl Key {
    /// Index into [`Faces::normals`], if the corner has one.
    pub fn normal(&self) -> Option<usize> {
        match self.normal {
            Normal::Given(index) => Some(index as usize),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Normal {
    /// The file's.
    Given(u32),
    /// Smooth over all triangles of this group.
    Smooth(u32),
    /// This face's own.
    Flat(u32),
}

/// How normals are computed where the file has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothing {
    /// Over a group; 0 is everything before the first `s`.
    Group(u32),
    /// `s off`.
    Flat,
}

impl Smoothing {
    /// A group by its number. 0 means off; what is no number is a group of its own.
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

/// Most vertices in a chain: further ones at its position are found by their key. Hardly any position has so many, and a
/// chain is the faster of the two.
const LONGEST: usize = 24;

/// Memory, while vectors grow and at the end: per position and normal of the file; per vertex, which has a key, a link and
/// finally its numbers twice; per vertex that is found by its key; per triangle; per corner of the present face.
const PER_POSITION: usize = 32;
const PER_NORMAL: usize = 24;
const PER_VERTEX: usize = 112;
const PER_CROWDED: usize = 64;
const PER_TRIANGLE: usize = 32;
const PER_CORNER: usize = 112;

/// Corners after which a face's memory is looked at.
const MANY_CORNERS: usize = 4096;

/// What has been read of vertices and faces.
pub struct Faces {
    /// `v`.
    pub positions: Vec<Vec3>,
    /// `vn`, as they stand.
    pub normals: Vec<Vec3>,
    /// One per vertex.
    pub keys: Vec<Key>,
    /// The next vertex at the same position.
    next: Vec<u32>,
    /// The first vertex at a position.
    first: Vec<u32>,
    /// Vertices that no chain has room for.
    crowded: HashMap<Key, u32, RandomState>,
    /// In file order.
    pub triangles: Vec<Triangle>,
    /// The current material.
    pub material: Option<u32>,
    /// Faces with fewer than three corners.
    pub small: usize,
    smoothing: Smoothing,
    faces: u32,
    /// Corners of the current face: its vertices, and where they lie.
    corners: Vec<u32>,
    points: Vec<DVec3>,
    triangulator: Triangulator,
    /// What the file may take of memory.
    pub limits: Limits,
    /// Triangles that shine.
    pub shining: usize,
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
            shining: 0,
        }
    }
}

impl Faces {
    /// Tells the size of a file that is being read: what may be made of it grows.
    pub fn read(&mut self, bytes: usize) {
        self.limits.read(bytes);
        self.triangulator.read(bytes);
    }

    /// `s`.
    pub fn smoothing(&mut self, smoothing: Smoothing) {
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
            let vertex = self.vertex(Key { position, normal });
            self.corners.push(vertex);
            if self.corners.len().is_multiple_of(MANY_CORNERS) {
                self.hold(lines.line())?;
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
        self.hold(lines.line())
    }

    /// Holds the memory that all of it takes against what the file may take.
    #[inline]
    pub fn hold(&self, line: usize) -> Result<(), Fault> {
        let bytes = self.positions.len() * PER_POSITION
            + self.normals.len() * PER_NORMAL
            + self.keys.len() * PER_VERTEX
            + self.crowded.len() * PER_CROWDED
            + self.triangles.len() * PER_TRIANGLE
            + self.shining * lamps::BYTES
            + self.corners.len() * PER_CORNER;
        let hint = "it has many faces of few vertices: store them another way, as in a binary PLY";
        self.limits.passing(bytes).map_err(|fault| Fault::new(line, fault.problem, hint))
    }

    /// The vertex of that key, a new one if there is none yet.
    #[inline]
    fn vertex(&mut self, key: Key) -> u32 {
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

    /// `position`, `position/texture`, `position//normal` or `position/texture/normal`.
    #[inline]
    fn corner(&self, word: &[u8], line: usize) -> Result<(u32, Option<u32>), Fault> {
        let broken = || {
            let problem = format!("`{}` is no corner of a face", printable(word));
            Fault::new(line, problem, "write v, v/vt, v//vn or v/vt/vn")
        };
        let (position, rest) = index(word).ok_or_else(broken)?;
        let position = resolve(position, self.positions.len(), "vertex", line)?;
        let Some(rest) = rest.strip_prefix(b"/") else {
            return if rest.is_empty() { Ok((position, None)) } else { Err(broken()) };
        };
        // The texture's index is of no use, but must be one.
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

/// A whole number at the start, and what follows it.
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

/// An index that counts from 1, or backwards from the last, -1.
#[inline]
fn resolve(given: i64, count: usize, what: &str, line: usize) -> Result<u32, Fault> {
    let index = if given < 0 { given + count as i64 } else { given - 1 };
    if (0..count as i64).contains(&index) {
        return Ok(index as u32);
    }
    let problem = format!("a face uses {what} {given}, but {count} stand above it");
    Err(Fault::new(line, problem, "indices count from 1, or backwards from -1"))
}
