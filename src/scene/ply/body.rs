//! Reads the body of a PLY file, ASCII or binary: vertices and faces.

use super::header::{Element, Header, PropertyType};
use super::rows::{RowError, RowReader};
use crate::math::Vertex;
use crate::scene::mesh_builder::Limits;
use crate::scene::placement::MAX_COORDINATE;
use crate::scene::polygon::{MAX_CORNERS, Triangulator, newell};
use crate::scene::text::{Fault, quote};
use crate::scene::{MAX_ELEMENTS, Triangle};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// The memory of a polygon's triangles is checked every this many corners.
const MANY: i64 = 4;

/// The content of the body.
#[derive(Default)]
pub struct Body {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<Triangle>,
    pub has_normals: bool,
    /// Number of polygons with fewer than three corners.
    pub small_polygons: usize,
    /// Number of bytes after the last element.
    pub bytes_after: usize,
    limits: Limits,
    triangulator: Triangulator,
    /// Vertices of the current polygon.
    corners: Vec<u32>,
    /// Positions of the current polygon.
    points: Vec<DVec3>,
    /// Triangles of polygons that precede their vertices in the file; they are triangulated at the end.
    pending: Vec<Range<u32>>,
}

/// The names of the properties of a vertex that are used.
const ROLES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Reads the body. `list` is the index of the list property of the faces, `length` the size of the body in bytes.
/// `offset` is subtracted from all positions, in double precision.
pub fn read<S: RowReader>(
    header: &Header,
    vertex: &Element,
    (face, list): (&Element, usize),
    mut source: S,
    length: usize,
    offset: Option<DVec3>,
) -> Result<Body, Fault> {
    for element in [vertex, face] {
        if element.count > MAX_ELEMENTS as u64 {
            return Err(too_many(Some(element.line), element.count, &element.name));
        }
    }
    check_counts::<S>(header, length)?;
    let mut body = Body::default();
    body.limits.read(length);
    body.triangulator.read(length);
    for element in &header.elements {
        if std::ptr::eq(element, vertex) {
            match offset {
                // Without an offset, single precision is enough, and faster.
                None | Some(DVec3::ZERO) => read_vertices(element, &mut source, &mut body, read_vertex)?,
                Some(offset) => {
                    let vertex = |roles: &[_], source: &mut S| read_far_vertex(roles, source, offset);
                    read_vertices(element, &mut source, &mut body, vertex)?;
                }
            }
        } else if std::ptr::eq(element, face) {
            read_faces(element, list, vertex.count, &mut source, &mut body)?;
        } else if !element.properties.is_empty() {
            for row in 0..element.count {
                skip_row(element, &mut source).map_err(|error| explain(error, &source, element, row))?;
            }
        }
    }
    for fan in std::mem::take(&mut body.pending) {
        body.triangulate(fan.start as usize..fan.end as usize);
    }
    body.bytes_after = source.left();
    if body.triangles.is_empty() {
        return Err(Fault::new(Some(face.line), "no face has three corners or more", "export it as a mesh"));
    }
    Ok(body)
}

/// Compares all counts with the size of the file, before memory is allocated.
fn check_counts<S: RowReader>(header: &Header, length: usize) -> Result<(), Fault> {
    // The last value of a text may lack the blank after it.
    let mut left = length as u64 + 1;
    for element in &header.elements {
        let row: u64 = element
            .properties
            .iter()
            .map(|p| match p.kind {
                PropertyType::Scalar(scalar) => S::least(scalar),
                PropertyType::List { count, .. } => S::least(count),
            })
            .sum();
        let least = element.count.saturating_mul(row);
        if least > left {
            return Err(Fault::new(
                Some(element.line),
                format!(
                    "{} elements {} need at least {least} bytes, but only {} bytes are left in the file",
                    element.count,
                    quote(&element.name),
                    left.saturating_sub(1)
                ),
                "the file is truncated or its header is wrong",
            ));
        }
        left -= least;
    }
    Ok(())
}

fn too_many(line: Option<usize>, count: u64, name: &str) -> Fault {
    Fault::new(
        line,
        format!("{count} elements {} are more than rtbench supports ({MAX_ELEMENTS})", quote(name)),
        "simplify the mesh",
    )
}

/// Converts the error of a row to a message. Messages are formatted only here, off the fast path.
#[cold]
fn explain<S: RowReader>(error: RowError, source: &S, element: &Element, row: u64) -> Fault {
    let token = String::from_utf8_lossy(source.token()).into_owned();
    let place = format!("{} {row}", element.name);
    let (problem, hint) = match error {
        RowError::End => (
            format!("the file ends within {place} of {}", element.count),
            "the file is truncated: download it again".to_owned(),
        ),
        RowError::Short => (format!("{place} has too few values"), "the header declares more".to_owned()),
        RowError::Long => (format!("{place} has more values than declared: {}", quote(&token)), one_row()),
        RowError::Number => (format!("{place}: {} is not a number", quote(&token)), String::new()),
        RowError::Integer => (format!("{place}: {} is not a whole number", quote(&token)), one_row()),
        RowError::Count => (format!("{place} has a list with a negative number of items"), one_row()),
    };
    Fault::new(source.line(), problem, hint)
}

fn one_row() -> String {
    "a line must hold one element, in the order of the header's properties".to_owned()
}

/// The type of a property, and the index of its name in [`ROLES`] if it is used.
type Role = (PropertyType, Option<usize>);

fn read_vertices<S: RowReader>(
    element: &Element,
    source: &mut S,
    body: &mut Body,
    vertex: impl Fn(&[Role], &mut S) -> Result<[f32; 6], RowError>,
) -> Result<(), Fault> {
    let roles: Vec<Role> =
        element.properties.iter().map(|p| (p.kind, ROLES.iter().position(|&name| name == p.name))).collect();
    let scalar =
        |name: &&str| element.find(name).is_some_and(|i| matches!(element.properties[i].kind, PropertyType::Scalar(_)));
    body.has_normals = ROLES[3..].iter().all(scalar);
    // The count has been compared with the size of the file.
    body.vertices.reserve_exact(element.count as usize);
    for row in 0..element.count {
        let values = vertex(&roles, source).map_err(|error| explain(error, source, element, row))?;
        let position = Vec3::new(values[0], values[1], values[2]);
        if !position.abs().cmple(LARGEST).all() {
            return Err(too_far(source.line(), row, position));
        }
        body.vertices.push(Vertex::new(position, Vec3::new(values[3], values[4], values[5])));
    }
    Ok(())
}

/// The largest valid position.
const LARGEST: Vec3 = Vec3::splat(MAX_COORDINATE as f32);

#[cold]
fn too_far(line: Option<usize>, row: u64, position: Vec3) -> Fault {
    let (fault, hint) = match position.is_finite() {
        true => ("beyond the largest coordinate 1e18", "scale the mesh down, or remove the vertex"),
        false => {
            ("not finite", "coordinates must be finite in single precision: remove the vertex or repair the export")
        }
    };
    let Vec3 { x, y, z } = position;
    Fault::new(line, format!("vertex {row} lies at ({x}, {y}, {z}), which is {fault}"), hint)
}

/// Reads a vertex and subtracts `offset` from its position in double precision. The normal is read in single precision.
fn read_far_vertex<S: RowReader>(roles: &[Role], source: &mut S, offset: DVec3) -> Result<[f32; 6], RowError> {
    let mut values = [0.0; 6];
    source.begin()?;
    for &(kind, role) in roles {
        match (kind, role) {
            (PropertyType::Scalar(scalar), Some(role @ 0..3)) => {
                let value = source.double(scalar)?;
                // A coordinate out of range remains out of range, so that it is refused.
                let within = value.abs() <= MAX_COORDINATE;
                values[role] = if within { (value - offset[role]) as f32 } else { value as f32 };
            }
            (PropertyType::Scalar(scalar), Some(role)) => values[role] = source.float(scalar)?,
            _ => skip(kind, source)?,
        }
    }
    source.end()?;
    Ok(values)
}

#[inline(always)]
fn read_vertex<S: RowReader>(roles: &[Role], source: &mut S) -> Result<[f32; 6], RowError> {
    let mut values = [0.0; 6];
    source.begin()?;
    for &(kind, role) in roles {
        match (kind, role) {
            (PropertyType::Scalar(scalar), Some(role)) => values[role] = source.float(scalar)?,
            _ => skip(kind, source)?,
        }
    }
    source.end()?;
    Ok(values)
}

fn read_faces<S: RowReader>(
    element: &Element,
    list: usize,
    vertices: u64,
    source: &mut S,
    body: &mut Body,
) -> Result<(), Fault> {
    let least: u64 = match element.properties[list].kind {
        PropertyType::List { count, item } => S::least(count) + 3 * S::least(item),
        PropertyType::Scalar(_) => 1,
    };
    // Reserves one triangle per face, if the file can hold that many.
    body.triangles.reserve(element.count.min(source.left() as u64 / least + 1) as usize);
    for row in 0..element.count {
        read_face(element, list, vertices, source, body).map_err(|error| match error {
            FaceError::Row(error) => explain(error, source, element, row),
            FaceError::Index(index) => Fault::new(
                source.line(),
                format!("face {row} uses vertex {index}, but there are only {vertices} vertices (0 to {})", {
                    vertices.saturating_sub(1)
                }),
                "repair the face or the vertex count",
            ),
            FaceError::TooMany => too_many(source.line(), body.triangles.len() as u64, "triangle"),
            FaceError::Memory(problem) => Fault::new(source.line(), problem, "use polygons with fewer corners"),
        })?;
    }
    Ok(())
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
}

impl Body {
    /// Checks the memory limit: a corner can take a single byte in the file, its triangle takes sixteen.
    fn check_memory(&self, vertices: u64) -> Result<(), FaceError> {
        // Computing normals needs a second copy of the vertices; a growing vector temporarily exists in two sizes.
        let [vertices, triangles] = [vertices as usize * size_of::<Vertex>(), size_of_val(&*self.triangles)];
        let bytes = 2 * vertices + 3 * triangles + 3 * size_of_val(&*self.pending);
        self.limits.check_temporary(bytes).map_err(|fault| FaceError::Memory(fault.problem))
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

    /// Replaces the triangles of a fan by those of [`Triangulator::triangles`].
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

impl From<RowError> for FaceError {
    fn from(error: RowError) -> FaceError {
        FaceError::Row(error)
    }
}

#[inline(always)]
fn read_face<S: RowReader>(
    element: &Element,
    list: usize,
    vertices: u64,
    source: &mut S,
    body: &mut Body,
) -> Result<(), FaceError> {
    source.begin()?;
    for (i, property) in element.properties.iter().enumerate() {
        match property.kind {
            PropertyType::List { count, item } if i == list => {
                let corners = source.integer(count)?;
                if corners < 0 {
                    return Err(RowError::Count.into());
                }
                let mut next = || match source.integer(item)? {
                    index if index >= 0 && (index as u64) < vertices => Ok(index as u32),
                    index => Err(FaceError::Index(index)),
                };
                if corners < 3 {
                    body.small_polygons += 1;
                    for _ in 0..corners {
                        next()?;
                    }
                    continue;
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
                if corners > 3 {
                    body.polygon(begin..body.triangles.len(), vertices);
                }
            }
            kind => skip(kind, source)?,
        }
    }
    Ok(source.end()?)
}

fn skip_row<S: RowReader>(element: &Element, source: &mut S) -> Result<(), RowError> {
    source.begin()?;
    for property in &element.properties {
        skip(property.kind, source)?;
    }
    source.end()
}

#[inline]
fn skip<S: RowReader>(kind: PropertyType, source: &mut S) -> Result<(), RowError> {
    match kind {
        PropertyType::Scalar(scalar) => source.skip(scalar, 1),
        PropertyType::List { count, item } => {
            let n = u64::try_from(source.integer(count)?).map_err(|_| RowError::Count)?;
            source.skip(item, n)
        }
    }
}
