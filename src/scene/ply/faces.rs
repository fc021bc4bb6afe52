//! Reads faces and triangle strips.

use super::body::{Body, explain, invalid_vertex, skip, too_many};
use super::header::{Element, PropertyType, Scalar};
use super::rows::{RowError, RowReader};
use crate::math::Vertex;
use crate::scene::mesh_builder::{DROPPED, is_valid};
use crate::scene::polygon::{MAX_CORNERS, newell};
use crate::scene::text::Fault;
use crate::scene::{MAX_ELEMENTS, Triangle};
use std::ops::Range;

/// The memory of a polygon's triangles is checked every this many corners.
const MANY: i64 = 4;

/// An element with a list of vertex indices.
pub struct FaceList<'h> {
    pub element: &'h Element,
    /// The index of the list among the properties.
    pub list: usize,
    /// True if a list is a strip of triangles, in which negative indices begin another strip.
    pub is_strip: bool,
}

/// The error of a face.
enum FaceError {
    Row(RowError),
    /// The index of a vertex is out of range.
    Index(i64),
    /// There are too many triangles.
    TooMany,
    /// The memory limit is exceeded.
    Memory(String),
    /// A vertex is beyond the largest coordinate.
    Far(u32),
}

impl From<RowError> for FaceError {
    fn from(error: RowError) -> FaceError {
        FaceError::Row(error)
    }
}

impl FaceList<'_> {
    /// Reads all rows of the element; there are `vertices` vertices.
    pub fn read<S: RowReader>(&self, vertices: u64, source: &mut S, body: &mut Body) -> Result<(), Fault> {
        let FaceList { element, list, .. } = *self;
        let least: u64 = match element.properties[list].kind {
            PropertyType::List { count, item } => S::least(count) + 3 * S::least(item),
            PropertyType::Scalar(_) => 1,
        };
        // Reserves one triangle per face, if the file can hold that many.
        body.triangles.reserve(element.count.min(source.left() as u64 / least + 1) as usize);
        for row in 0..element.count {
            self.read_row(vertices, source, body).map_err(|error| match error {
                FaceError::Row(error) => explain(error, source, element, row),
                FaceError::Index(index) => Fault::new(
                    source.line(),
                    format!(
                        "{} {row} uses vertex {index}, but there are only {vertices} vertices (0 to {})",
                        element.name,
                        { vertices.saturating_sub(1) }
                    ),
                    "repair the face or the vertex count",
                ),
                FaceError::TooMany => too_many(source.line(), body.triangles.len() as u64, "triangle"),
                FaceError::Memory(problem) => Fault::new(source.line(), problem, "use polygons with fewer corners"),
                FaceError::Far(vertex) => body.far_fault(vertex, source.line()),
            })?;
        }
        Ok(())
    }

    #[inline(always)]
    fn read_row<S: RowReader>(&self, vertices: u64, source: &mut S, body: &mut Body) -> Result<(), FaceError> {
        source.begin()?;
        for (i, property) in self.element.properties.iter().enumerate() {
            match property.kind {
                PropertyType::List { count, item } if i == self.list => {
                    let corners = source.integer(count)?;
                    if corners < 0 {
                        return Err(RowError::Count.into());
                    }
                    if self.is_strip {
                        read_strip(corners, item, vertices, source, body)?;
                    } else {
                        read_polygon(corners, item, vertices, source, body)?;
                    }
                }
                kind => skip(kind, source)?,
            }
        }
        Ok(source.end()?)
    }
}

/// Reads the indices of a polygon.
#[inline(always)]
fn read_polygon<S: RowReader>(
    corners: i64,
    item: Scalar,
    vertices: u64,
    source: &mut S,
    body: &mut Body,
) -> Result<(), FaceError> {
    let mut next = || match source.integer(item)? {
        index if index >= 0 && (index as u64) < vertices => Ok(index as u32),
        index => Err(FaceError::Index(index)),
    };
    if corners < 3 {
        body.small_polygons += 1;
        for _ in 0..corners {
            next()?;
        }
        return Ok(());
    }
    let begin = body.triangles.len();
    let (first, mut previous) = (next()?, next()?);
    for i in 2..corners {
        let corner = next()?;
        body.triangles.push(Triangle { vertices: [first, previous, corner], material: 0 });
        previous = corner;
        if i % MANY == 0 {
            body.check_memory(vertices)?;
        }
    }
    if body.triangles.len() > MAX_ELEMENTS {
        return Err(FaceError::TooMany);
    }
    if body.has_invalid && body.drops(begin)? {
        return Ok(());
    }
    if corners > 3 {
        body.polygon(begin..body.triangles.len(), vertices);
    }
    Ok(())
}

/// Reads the indices of triangle strips. A negative index begins another strip, as does the largest value of an
/// unsigned type.
fn read_strip<S: RowReader>(
    corners: i64,
    item: Scalar,
    vertices: u64,
    source: &mut S,
    body: &mut Body,
) -> Result<(), FaceError> {
    let largest = match item {
        Scalar::U8 => u8::MAX.into(),
        Scalar::U16 => u16::MAX.into(),
        Scalar::U32 => u32::MAX.into(),
        _ => i64::MAX,
    };
    let (mut strip, mut length) = ([0; 2], 0u64);
    for i in 0..corners {
        let index = source.integer(item)?;
        if index < 0 || index == largest && index as u64 >= vertices {
            body.small_polygons += usize::from((1..3).contains(&length));
            length = 0;
            continue;
        }
        if index as u64 >= vertices {
            return Err(FaceError::Index(index));
        }
        let corner = index as u32;
        if length >= 2 {
            // Every other triangle of a strip has the opposite orientation.
            let [a, b] = if length.is_multiple_of(2) { strip } else { [strip[1], strip[0]] };
            body.triangles.push(Triangle { vertices: [a, b, corner], material: 0 });
            if body.has_invalid {
                body.drops(body.triangles.len() - 1)?;
            }
            if i % MANY == 0 {
                body.check_memory(vertices)?;
            }
        }
        strip = [strip[1], corner];
        length += 1;
    }
    body.small_polygons += usize::from((1..3).contains(&length));
    if body.triangles.len() > MAX_ELEMENTS { Err(FaceError::TooMany) } else { Ok(()) }
}

impl Body {
    /// Checks the memory limit: a corner can take a single byte in the file, its triangle takes sixteen.
    fn check_memory(&self, vertices: u64) -> Result<(), FaceError> {
        // Computing normals needs a second copy of the vertices; a growing vector temporarily exists in two sizes.
        let [vertices, triangles] = [vertices as usize * size_of::<Vertex>(), size_of_val(&*self.triangles)];
        let bytes = 2 * vertices + 3 * triangles + 3 * size_of_val(&*self.pending);
        self.limits.check_temporary(bytes).map_err(|fault| FaceError::Memory(fault.problem))
    }

    /// Drops the last face, of which the triangles begin at `begin`, if it uses a vertex that is not finite.
    #[cold]
    fn drops(&mut self, begin: usize) -> Result<bool, FaceError> {
        let corners = self.triangles[begin..].iter().flat_map(|triangle| triangle.vertices);
        let mut drop = false;
        for corner in corners {
            match self.vertices.get(corner as usize).map(|vertex| vertex.position) {
                Some(position) if is_valid(position) => {}
                Some(position) if position.is_finite() => return Err(FaceError::Far(corner)),
                Some(_) => drop = true,
                None => {}
            }
        }
        if drop {
            self.not_finite.add_face();
            self.triangles.truncate(begin);
        }
        Ok(drop)
    }

    /// The fault of a face in this line that uses a vertex beyond the largest coordinate.
    #[cold]
    fn far_fault(&mut self, vertex: u32, line: Option<usize>) -> Fault {
        match self.far.take() {
            Some((far, fault)) if far == vertex => fault,
            _ => invalid_vertex(line, vertex.into(), self.vertices[vertex as usize].position),
        }
    }

    /// Triangulates a polygon, of which `fan` are the triangles so far, once its vertices have been read.
    fn polygon(&mut self, fan: Range<usize>, vertices: u64) {
        if fan.len() > MAX_CORNERS - 2 {
            return;
        }
        if (self.vertices.len() as u64) < vertices {
            self.pending.push(fan.start as u32..fan.end as u32);
        } else {
            self.triangulate(fan);
        }
    }

    /// Completes the polygons that precede their vertices in the file, and marks the triangles of those that are
    /// dropped, see [`DROPPED`].
    ///
    /// # Errors
    /// A face uses a vertex beyond the largest coordinate.
    pub(super) fn complete(&mut self) -> Result<(), Fault> {
        let pending = std::mem::take(&mut self.pending);
        let fans = || pending.iter().map(|fan| fan.start as usize..fan.end as usize);
        if self.late_invalid {
            fans().try_for_each(|fan| self.mark(fan))?;
            (0..self.triangles.len()).try_for_each(|triangle| self.mark(triangle..triangle + 1))?;
        }
        for fan in fans() {
            if self.triangles[fan.start].vertices[0] != DROPPED {
                self.triangulate(fan);
            }
        }
        Ok(())
    }

    /// Marks the triangles of a face if it uses a vertex that is not finite.
    fn mark(&mut self, face: Range<usize>) -> Result<(), Fault> {
        let mut drop = false;
        for corner in self.triangles[face.clone()].iter().flat_map(|triangle| triangle.vertices) {
            match self.vertices.get(corner as usize).map(|vertex| vertex.position) {
                Some(position) if is_valid(position) => {}
                Some(position) if position.is_finite() => return Err(self.far_fault(corner, None)),
                Some(_) => drop = true,
                // It is marked already.
                None => return Ok(()),
            }
        }
        if drop {
            self.not_finite.add_face();
            self.triangles[face].iter_mut().for_each(|triangle| triangle.vertices = [DROPPED; 3]);
        }
        Ok(())
    }

    /// Replaces the triangles of a fan by those of [`crate::scene::polygon::Triangulator::triangles`].
    fn triangulate(&mut self, fan: Range<usize>) {
        let Body { vertices, triangles, corners, points, triangulator, .. } = self;
        let fan = &mut triangles[fan];
        corners.clear();
        corners.extend(&fan[0].vertices[..2]);
        corners.extend(fan.iter().map(|triangle| triangle.vertices[2]));
        points.clear();
        points.extend(corners.iter().map(|&corner| vertices[corner as usize].position.as_dvec3()));
        let found = triangulator.triangles(points, &[], newell(points));
        for (triangle, found) in fan.iter_mut().zip(found) {
            triangle.vertices = found.map(|i| corners[i as usize]);
        }
    }
}
