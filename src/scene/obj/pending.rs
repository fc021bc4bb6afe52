//! Faces with vertices that follow them in the file, and the problems of faces that are warnings.

use super::Fault;
use super::face::Faces;
use super::lines::invalid_vertex;
use crate::scene::mesh_builder::{DROPPED, NotFinite, is_valid};
use crate::scene::text::place;
use glam::Vec3;
use std::ops::Range;
use std::path::Path;

/// A face with vertices that follow it in the file. Its triangles are a fan until the end of the file.
pub struct PendingFace {
    pub triangles: Range<u32>,
    pub line: u32,
}

/// The problems of vertices, faces and normals that do not prevent reading the file.
#[derive(Default)]
pub struct Problems {
    pub not_finite: NotFinite,
    /// True if a position is not valid, see [`is_valid`].
    pub has_invalid: bool,
    /// The first position beyond the largest coordinate, with its fault.
    far: Option<(u32, Fault)>,
    /// The fault of the first position that is not finite.
    first: Option<Fault>,
    /// True if the current face has a vertex that is not finite, or one that follows in the file.
    drop: bool,
    forward: bool,
    /// The first line with a texture coordinate that is not an index.
    pub texture: Option<usize>,
    /// The first line with a corner of more than three parts.
    pub surplus: Option<usize>,
    /// The first line of a normal that is not three finite numbers.
    pub normal: Option<usize>,
    /// Number of corners with a normal that cannot exist, and the line of the first.
    pub missing: Option<(usize, usize)>,
    /// The largest index of a normal that a face uses before its definition, counted from 1, and the line of the face.
    pub last_normal: Option<(u32, usize)>,
}

impl Problems {
    #[inline]
    pub fn begin_face(&mut self) {
        (self.drop, self.forward) = (false, false);
    }

    pub fn set_forward(&mut self) {
        self.forward = true;
    }

    /// True if a vertex of the current face follows in the file.
    #[inline]
    pub fn is_forward(&self) -> bool {
        self.forward
    }

    /// True if the current face is dropped, which has this many other corners; it is then counted.
    #[inline]
    pub fn drops_face(&mut self, others: usize) -> bool {
        if self.drop && others > 1 {
            self.not_finite.add_face();
        }
        self.drop
    }

    pub fn add_texture(&mut self, line: usize) {
        self.texture.get_or_insert(line);
    }

    pub fn add_missing_normal(&mut self, line: usize) {
        self.missing.get_or_insert((0, line)).0 += 1;
    }

    pub fn add_forward_normal(&mut self, given: u32, line: usize) {
        if self.last_normal.is_none_or(|(last, _)| last < given) {
            self.last_normal = Some((given, line));
        }
    }

    /// The warnings; `normals` is the number of normals in the file, `unusual` the first line with an unusual number.
    pub fn warnings(&self, path: &Path, normals: usize, unusual: Option<usize>) -> Vec<String> {
        let mut warnings: Vec<String> = self.not_finite.warning().into_iter().collect();
        let mut warn = |line: usize, text: &str| warnings.push(format!("{}: {text}", place(path, line)));
        if let Some(line) = self.surplus {
            warn(line, "a corner of a face has more parts than v/vt/vn: the others are ignored");
        }
        if let Some(line) = self.normal {
            warn(line, "a normal is not three finite numbers: such normals are computed");
        }
        if let Some((count, line)) = self.missing {
            let text =
                format!("a corner has a normal that does not exist: the normals of {count} corners are computed");
            warn(line, &text);
        }
        if let Some((last, line)) = self.last_normal.filter(|(last, _)| *last as usize > normals) {
            let text = format!("a corner has normal {last}, but the file has {normals}: such normals are computed");
            warn(line, &text);
        }
        if let Some(line) = self.texture {
            warn(line, "a texture coordinate of a corner is not an index: texture coordinates are ignored");
        }
        if let Some(line) = unusual {
            warn(
                line,
                "a number has commas, a Fortran exponent, a plus sign or decimals that are not usual: it is read",
            );
        }
        warnings
    }

    /// The fault of a file without triangles, all of whose faces were dropped.
    pub fn nothing_left(&mut self) -> Option<Fault> {
        let fault = self.first.take()?;
        Some(Fault { problem: format!("{}, and no face is without such a vertex", fault.problem), ..fault })
    }
}

impl Faces {
    /// Adds a position that is not valid, with its line and its place for the user.
    #[cold]
    pub fn add_invalid(&mut self, position: Vec3, line: usize, place: impl FnOnce() -> String) {
        let fault = invalid_vertex(line, position);
        let problems = &mut self.problems;
        problems.has_invalid = true;
        if position.is_finite() {
            problems.far.get_or_insert((self.positions.len() as u32, fault));
        } else {
            problems.not_finite.add_vertex(place);
            problems.first.get_or_insert(fault);
        }
        self.positions.push(position);
    }

    /// True unless a known position is not finite; the current face is then dropped.
    ///
    /// # Errors
    /// The position is beyond the largest coordinate.
    #[cold]
    pub(super) fn is_usable(&mut self, position: u32, line: usize) -> Result<bool, Fault> {
        let Some(&place) = self.positions.get(position as usize) else { return Ok(true) };
        if is_valid(place) {
            return Ok(true);
        }
        if place.is_finite() {
            return Err(self.problems.far_fault(position, place, line));
        }
        self.problems.drop = true;
        Ok(false)
    }

    /// Completes the faces that precede their vertices. Triangles of dropped faces have the vertex [`DROPPED`]; returns
    /// whether there are such.
    ///
    /// # Errors
    /// A face uses a vertex that the file does not have, or one beyond the largest coordinate.
    pub fn complete(&mut self) -> Result<bool, Fault> {
        let mut drops = false;
        for PendingFace { triangles, line } in std::mem::take(&mut self.pending) {
            let (fan, line) = (triangles.start as usize..triangles.end as usize, line as usize);
            let mut drop = false;
            for vertex in self.triangles[fan.clone()].iter().flat_map(|triangle| triangle.vertices) {
                let index = self.keys[vertex as usize].position;
                match self.position(vertex) {
                    None => {
                        let count = self.positions.len();
                        let problem = format!("a face uses vertex {}, but the file has {count}", u64::from(index) + 1);
                        return Err(Fault::new(line, problem, "indices count from 1, or backwards from -1"));
                    }
                    Some(place) if is_valid(place) => {}
                    Some(place) if place.is_finite() => {
                        return Err(self.problems.far_fault(index, place, line));
                    }
                    Some(_) => drop = true,
                }
            }
            if drop {
                self.problems.not_finite.add_face();
                self.triangles[fan].iter_mut().for_each(|triangle| triangle.vertices = [DROPPED; 3]);
                drops = true;
            } else if fan.len() > 1 {
                self.triangulate(fan);
            }
        }
        Ok(drops)
    }
}

impl Problems {
    /// The fault of a face in this line that uses a position beyond the largest coordinate.
    fn far_fault(&mut self, index: u32, position: Vec3, line: usize) -> Fault {
        match self.far.take() {
            Some((far, fault)) if far == index => fault,
            _ => invalid_vertex(line, position),
        }
    }
}
