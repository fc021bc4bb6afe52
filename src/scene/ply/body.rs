//! The body of a PLY file: vertices and faces, from text or bytes.

use super::header::{Element, Header, Kind};
use super::source::{Bad, Source};
use crate::math::Vertex;
use crate::scene::mesh_builder::Limits;
use crate::scene::placement::MAX_COORDINATE;
use crate::scene::polygon::{MAX_CORNERS, Triangulator, newell};
use crate::scene::text::{Fault, quote};
use crate::scene::{MAX_ELEMENTS, Triangle};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// Corners of a polygon from which on the memory of its triangles is looked at, every so many of them.
const MANY: i64 = 4;

/// What the body holds.
#[derive(Default)]
pub struct Body {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<Triangle>,
    pub has_normals: bool,
    pub small_polygons: usize,
    pub bytes_after: usize,
    /// What the file may take of memory.
    limits: Limits,
    triangulator: Triangulator,
    /// Corners of the present polygon: its vertices, and where they lie.
    corners: Vec<u32>,
    points: Vec<DVec3>,
    /// Fans of polygons whose vertices stand behind them in the file.
    waiting: Vec<Range<u32>>,
}

/// Where the values of a vertex go: index of the property of x, y, z, nx, ny, nz.
const ROLES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Reads the body. `list` is the index of the faces' list; `length` the number of the body's bytes; `offset` what
/// positions are counted from, in double precision if there is one.
pub fn read<S: Source>(
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
                // A declared float is read as one, which takes less time
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
                skip_row(element, &mut source).map_err(|bad| explain(bad, &source, element, row))?;
            }
        }
    }
    for fan in std::mem::take(&mut body.waiting) {
        body.cut(fan.start as usize..fan.end as usize);
    }
    body.bytes_after = source.left();
    if body.triangles.is_empty() {
        return Err(Fault::new(Some(face.line), "no face has three corners or more: there is nothing to trace", ""));
    }
    Ok(body)
}

/// Holds all counts against the size of the file, before anything is allocated.
fn check_counts<S: Source>(header: &Header, length: usize) -> Result<(), Fault> {
    // The last value of a text may lack the blank behind it.
    let mut left = length as u64 + 1;
    for element in &header.elements {
        let row: u64 = element
            .properties
            .iter()
            .map(|p| match p.kind {
                Kind::Scalar(scalar) => S::least(scalar),
                Kind::List { count, .. } => S::least(count),
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
        format!("{count} elements {} are more than rtbench handles ({MAX_ELEMENTS})", quote(name)),
        "simplify the mesh",
    )
}

/// Puts a failed row into words; only here, off the fast path, is text made.
#[cold]
fn explain<S: Source>(bad: Bad, source: &S, element: &Element, row: u64) -> Fault {
    let token = String::from_utf8_lossy(source.token()).into_owned();
    let place = format!("{} {row}", element.name);
    let (problem, hint) = match bad {
        Bad::End => (
            format!("the file ends within {place} of {}", element.count),
            "the file is truncated: fetch it again".to_owned(),
        ),
        Bad::Short => (format!("{place} has too few values"), "the header declares more".to_owned()),
        Bad::Long => (format!("{place} has more values than declared: {}", quote(&token)), one_row()),
        Bad::Number => (format!("{place}: {} is not a number", quote(&token)), String::new()),
        Bad::Integer => (format!("{place}: {} is not a whole number", quote(&token)), one_row()),
        Bad::Count => (format!("{place} has a list with a negative number of items"), one_row()),
    };
    Fault::new(source.line(), problem, hint)
}

fn one_row() -> String {
    "a line holds one element, in the order of the header's properties".to_owned()
}

/// The type of a property, and the index of what it is in [`ROLES`].
type Role = (Kind, Option<usize>);

fn read_vertices<S: Source>(
    element: &Element,
    source: &mut S,
    body: &mut Body,
    vertex: impl Fn(&[Role], &mut S) -> Result<[f32; 6], Bad>,
) -> Result<(), Fault> {
    let roles: Vec<Role> =
        element.properties.iter().map(|p| (p.kind, ROLES.iter().position(|&name| name == p.name))).collect();
    let scalar =
        |name: &&str| element.find(name).is_some_and(|i| matches!(element.properties[i].kind, Kind::Scalar(_)));
    body.has_normals = ROLES[3..].iter().all(scalar);
    // Bounded: the count was held against the size of the file.
    body.vertices.reserve_exact(element.count as usize);
    for row in 0..element.count {
        let values = vertex(&roles, source).map_err(|bad| explain(bad, source, element, row))?;
        let position = Vec3::new(values[0], values[1], values[2]);
        if !position.abs().cmple(MOST).all() {
            return Err(too_far(source.line(), row, position));
        }
        body.vertices.push(Vertex::new(position, Vec3::new(values[3], values[4], values[5])));
    }
    Ok(())
}

/// The largest coordinates.
const MOST: Vec3 = Vec3::splat(MAX_COORDINATE as f32);

#[cold]
fn too_far(line: Option<usize>, row: u64, position: Vec3) -> Fault {
    let (what, hint) = match position.is_finite() {
        true => ("beyond 1e18", "scale the mesh down, or remove the vertex"),
        false => {
            ("not finite", "coordinates must be finite in single precision: remove the vertex or repair the export")
        }
    };
    let Vec3 { x, y, z } = position;
    Fault::new(line, format!("vertex {row} lies at ({x}, {y}, {z}), which is {what}"), hint)
}

/// A vertex whose position is counted from a point, and rounded then. The normal is still read in single precision.
fn read_far_vertex<S: Source>(roles: &[Role], source: &mut S, offset: DVec3) -> Result<[f32; 6], Bad> {
    let mut values = [0.0; 6];
    source.begin()?;
    for &(kind, role) in roles {
        match (kind, role) {
            (Kind::Scalar(scalar), Some(role @ 0..3)) => {
                let value = source.double(scalar)?;
                // What was refused before anything was moved is refused after that as well
                let within = value.abs() <= MAX_COORDINATE;
                values[role] = if within { (value - offset[role]) as f32 } else { value as f32 };
            }
            (Kind::Scalar(scalar), Some(role)) => values[role] = source.float(scalar)?,
            _ => skip(kind, source)?,
        }
    }
    source.end()?;
    Ok(values)
}

#[inline(always)]
fn read_vertex<S: Source>(roles: &[Role], source: &mut S) -> Result<[f32; 6], Bad> {
    let mut values = [0.0; 6];
    source.begin()?;
    for &(kind, role) in roles {
        match (kind, role) {
            (Kind::Scalar(scalar), Some(role)) => values[role] = source.float(scalar)?,
            _ => skip(kind, source)?,
        }
    }
    source.end()?;
    Ok(values)
}

fn read_faces<S: Source>(
    element: &Element,
    list: usize,
    vertices: u64,
    source: &mut S,
    body: &mut Body,
) -> Result<(), Fault> {
    let least: u64 = match element.properties[list].kind {
        Kind::List { count, item } => S::least(count) + 3 * S::least(item),
        Kind::Scalar(_) => 1,
    };
    // As many triangles as there are faces, if the file can hold them.
    body.triangles.reserve(element.count.min(source.left() as u64 / least + 1) as usize);
    for row in 0..element.count {
        read_face(element, list, vertices, source, body).map_err(|trouble| match trouble {
            Trouble::Bad(bad) => explain(bad, source, element, row),
            Trouble::Index(index) => Fault::new(
                source.line(),
                format!("face {row} uses vertex {index}, but there are only {vertices} vertices (0 to {})", {
                    vertices.saturating_sub(1)
                }),
                "repair the face or the vertex count",
            ),
            Trouble::TooMany => too_many(source.line(), body.triangles.len() as u64, "triangle"),
            Trouble::Memory(problem) => Fault::new(source.line(), problem, "store polygons of fewer corners"),
        })?;
    }
    Ok(())
}

/// Why a face could not be read.
enum Trouble {
    Bad(Bad),
    Index(i64),
    TooMany,
    Memory(String),
}

impl Body {
    /// Holds what is read against what the file may take: a corner may be a single byte, its triangle is sixteen.
    fn hold(&self, vertices: u64) -> Result<(), Trouble> {
        // Normals may have to be made anew beside the old ones; a vector that grows is there in two sizes for a moment
        let [vertices, triangles] = [vertices as usize * size_of::<Vertex>(), size_of_val(&*self.triangles)];
        let bytes = 2 * vertices + 3 * triangles + 3 * size_of_val(&*self.waiting);
        self.limits.passing(bytes).map_err(|fault| Trouble::Memory(fault.problem))
    }

    /// Takes a polygon that stands as a fan, and cuts it as [`crate::scene::polygon`] says once its vertices are there.
    fn polygon(&mut self, fan: Range<usize>, vertices: u64) {
        if fan.len() > MAX_CORNERS - 2 {
            return;
        }
        if (self.vertices.len() as u64) < vertices {
            self.waiting.push(fan.start as u32..fan.end as u32);
        } else {
            self.cut(fan);
        }
    }

    /// Puts other triangles in the place of a fan that does not cover its polygon.
    fn cut(&mut self, fan: Range<usize>) {
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

impl From<Bad> for Trouble {
    fn from(bad: Bad) -> Trouble {
        Trouble::Bad(bad)
    }
}

#[inline(always)]
fn read_face<S: Source>(
    element: &Element,
    list: usize,
    vertices: u64,
    source: &mut S,
    body: &mut Body,
) -> Result<(), Trouble> {
    source.begin()?;
    for (i, property) in element.properties.iter().enumerate() {
        match property.kind {
            Kind::List { count, item } if i == list => {
                let corners = source.integer(count)?;
                if corners < 0 {
                    return Err(Bad::Count.into());
                }
                let mut next = || match source.integer(item)? {
                    index if index >= 0 && (index as u64) < vertices => Ok(index as u32),
                    index => Err(Trouble::Index(index)),
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
                        body.hold(vertices)?;
                    }
                }
                if body.triangles.len() > MAX_ELEMENTS {
                    return Err(Trouble::TooMany);
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

fn skip_row<S: Source>(element: &Element, source: &mut S) -> Result<(), Bad> {
    source.begin()?;
    for property in &element.properties {
        skip(property.kind, source)?;
    }
    source.end()
}

#[inline]
fn skip<S: Source>(kind: Kind, source: &mut S) -> Result<(), Bad> {
    match kind {
        Kind::Scalar(scalar) => source.skip(scalar, 1),
        Kind::List { count, item } => {
            let n = u64::try_from(source.integer(count)?).map_err(|_| Bad::Count)?;
            source.skip(item, n)
        }
    }
}
