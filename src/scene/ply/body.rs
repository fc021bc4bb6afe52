//! Reads the body of a PLY file, ASCII or binary: vertices, and rows of elements.

use super::faces::FaceList;
use super::header::{Element, Header, PropertyType, Scalar};
use super::rows::{RowError, RowReader};
use crate::math::Vertex;
use crate::scene::mesh_builder::{Limits, NotFinite, drop_invalid, is_valid, narrow_number};
use crate::scene::placement::MAX_COORDINATE;
use crate::scene::polygon::Triangulator;
use crate::scene::text::{Fault, quote};
use crate::scene::{MAX_ELEMENTS, Triangle};
use glam::{DVec3, Vec3};
use std::ops::Range;

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
    pub not_finite: NotFinite,
    /// Lines with warnings about them.
    pub warnings: Vec<(usize, String)>,
    pub(super) limits: Limits,
    pub(super) triangulator: Triangulator,
    /// Vertices of the current polygon.
    pub(super) corners: Vec<u32>,
    /// Positions of the current polygon.
    pub(super) points: Vec<DVec3>,
    /// Triangles of polygons that precede their vertices in the file; they are triangulated at the end.
    pub(super) pending: Vec<Range<u32>>,
    /// True if a vertex is not valid, see [`is_valid`].
    pub(super) has_invalid: bool,
    /// True if vertices that are not valid follow faces in the file.
    pub(super) late_invalid: bool,
    /// The fault of the first vertex that is not finite.
    first: Option<Fault>,
    /// The first vertex beyond the largest coordinate, with its fault.
    pub(super) far: Option<(u32, Fault)>,
}

/// The names of the properties of a vertex that are used.
const ROLES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Reads the body; `length` is its size in bytes. `offset` is subtracted from all positions, in double precision.
pub fn read<S: RowReader>(
    header: &Header,
    vertex: &Element,
    faces: &[FaceList],
    mut source: S,
    length: usize,
    offset: Option<DVec3>,
) -> Result<Body, Fault> {
    for element in faces.iter().map(|list| list.element).chain([vertex]) {
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
        } else if let Some(list) = faces.iter().find(|list| std::ptr::eq(element, list.element)) {
            list.read(vertex.count, &mut source, &mut body)?;
        } else if !element.properties.is_empty() {
            for row in 0..element.count {
                skip_row(element, &mut source).map_err(|error| explain(error, &source, element, row))?;
            }
        }
    }
    body.complete()?;
    if body.has_invalid {
        drop_invalid(&mut body.vertices, &mut body.triangles);
    }
    body.bytes_after = source.left();
    body.warnings = source.warnings();
    if body.triangles.is_empty() {
        let line = faces.first().map(|list| list.element.line);
        return Err(match body.first.take() {
            Some(fault) => {
                Fault { problem: format!("{}, and no face is without such a vertex", fault.problem), ..fault }
            }
            None => Fault::new(line, "no face has three corners or more", "export it as a mesh"),
        });
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

pub(super) fn too_many(line: Option<usize>, count: u64, name: &str) -> Fault {
    Fault::new(
        line,
        format!("{count} elements {} are more than rtbench supports ({MAX_ELEMENTS})", quote(name)),
        "simplify the mesh",
    )
}

/// Converts the error of a row to a message. Messages are formatted only here, off the fast path.
#[cold]
pub(super) fn explain<S: RowReader>(error: RowError, source: &S, element: &Element, row: u64) -> Fault {
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
    let places = ROLES.map(|name| element.find(name));
    let role = |i: usize| places.iter().position(|place| *place == Some(i));
    let roles: Vec<Role> = element.properties.iter().enumerate().map(|(i, p)| (p.kind, role(i))).collect();
    let scalar = |place: &Option<usize>| {
        place.is_some_and(
            |i| matches!(element.properties[i].kind, PropertyType::Scalar(scalar) if scalar != Scalar::Other),
        )
    };
    body.has_normals = places[3..].iter().all(scalar);
    // The count has been compared with the size of the file.
    body.vertices.reserve_exact(element.count as usize);
    for row in 0..element.count {
        let values = vertex(&roles, source).map_err(|error| explain(error, source, element, row))?;
        let position = Vec3::new(values[0], values[1], values[2]);
        if !is_valid(position) {
            body.add_invalid(source.line(), row, position);
        }
        body.vertices.push(Vertex::new(position, Vec3::new(values[3], values[4], values[5])));
    }
    Ok(())
}

impl Body {
    /// Adds a vertex that is not valid.
    #[cold]
    fn add_invalid(&mut self, line: Option<usize>, row: u64, position: Vec3) {
        self.late_invalid |= !self.triangles.is_empty();
        self.has_invalid = true;
        if position.is_finite() {
            self.far.get_or_insert_with(|| (row as u32, invalid_vertex(line, row, position)));
            return;
        }
        self.not_finite.add_vertex(|| match line {
            Some(line) => format!("line {line}"),
            None => format!("vertex {row}"),
        });
        self.first.get_or_insert_with(|| invalid_vertex(line, row, position));
    }
}

/// The fault of a vertex that is not valid.
#[cold]
pub(super) fn invalid_vertex(line: Option<usize>, row: u64, position: Vec3) -> Fault {
    let (fault, hint) = match position.is_finite() && position.abs().max_element() < f32::MAX {
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
                // A coordinate out of range remains out of range, so that it is not valid.
                let within = value.abs() <= MAX_COORDINATE;
                values[role] = if within { (value - offset[role]) as f32 } else { narrow_number(value) };
            }
            (PropertyType::Scalar(scalar), Some(role)) if scalar != Scalar::Other => {
                values[role] = source.normal(scalar)?;
            }
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
            (PropertyType::Scalar(scalar), Some(role @ 0..3)) => values[role] = source.float(scalar)?,
            (PropertyType::Scalar(scalar), Some(role)) if scalar != Scalar::Other => {
                values[role] = source.normal(scalar)?;
            }
            _ => skip(kind, source)?,
        }
    }
    source.end()?;
    Ok(values)
}

fn skip_row<S: RowReader>(element: &Element, source: &mut S) -> Result<(), RowError> {
    source.begin()?;
    for property in &element.properties {
        skip(property.kind, source)?;
    }
    source.end()
}

#[inline]
pub(super) fn skip<S: RowReader>(kind: PropertyType, source: &mut S) -> Result<(), RowError> {
    match kind {
        PropertyType::Scalar(scalar) => source.skip(scalar, 1),
        PropertyType::List { count, item } => {
            let n = u64::try_from(source.integer(count)?).map_err(|_| RowError::Count)?;
            source.skip(item, n)
        }
    }
}
