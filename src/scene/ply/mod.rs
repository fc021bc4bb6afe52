//! Reader of Stanford PLY (Turk 1994): ASCII and binary in both byte orders, any properties in any order.
//!
//! The crate ply-rs-bw 4.0.1 is not used for these reasons: for the dragon (34 MB ASCII, 871,414 triangles) it was
//! measured at 1.4 to 1.6 s, above the required second on one core; and it allocates memory by the counts in the file,
//! so that a broken header can request any amount. This reader parses the file in place, in one pass, and compares
//! every count with the remaining bytes before it allocates memory.
//!
//! The reader supports x, y, z of the vertices; nx, ny, nz if all three exist (otherwise smooth normals are computed,
//! see [`crate::scene::normals`]); and `vertex_indices` or `vertex_index` of the faces. [`super::polygon`] triangulates
//! polygons. All other properties and elements are ignored.

mod body;
mod header;
mod rows;

use super::text::Fault;
use super::{Options, Placement, Scene, normals};
use crate::error::Result;
use body::Body;
use glam::DVec3;
use header::{Element, Encoding, Header, PropertyType};
use rows::{Ascii, Binary};
use std::path::Path;

/// Reads the file.
///
/// # Errors
/// [`crate::Error::Input`] if the file is not valid.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let bytes = super::read_text(path)?;
    let body = parse(&bytes, options.offset).map_err(|fault| fault.of(path))?;
    // The file's bytes are released before more memory is allocated.
    drop(bytes);
    Ok(finish(body, options.offset))
}

/// Reads a file from memory; `path` is only used for errors.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8]) -> Result<Scene> {
    let body = parse(bytes, None).map_err(|fault| fault.of(path))?;
    Ok(finish(body, None))
}

fn parse(bytes: &[u8], offset: Option<DVec3>) -> Result<Body, Fault> {
    let header = header::parse(bytes)?;
    let vertex = vertex_element(&header)?;
    let face = face_element(&header)?;
    let body = &bytes[header.body..];
    match header.encoding {
        Encoding::Ascii => {
            body::read(&header, vertex, face, Ascii::new(body, header.body_line, header.newline), body.len(), offset)
        }
        Encoding::LittleEndian => body::read(&header, vertex, face, Binary::<false>::new(body), body.len(), offset),
        Encoding::BigEndian => body::read(&header, vertex, face, Binary::<true>::new(body), body.len(), offset),
    }
}

fn vertex_element(header: &Header) -> Result<&Element, Fault> {
    let Some(vertex) = header.element("vertex") else {
        return Err(Fault::new(
            None,
            "there are no vertices: the header has no element `vertex`",
            "export it as a mesh",
        ));
    };
    for name in ["x", "y", "z"] {
        match vertex.find(name).map(|i| vertex.properties[i].kind) {
            Some(PropertyType::Scalar(_)) => {}
            _ => {
                return Err(Fault::new(
                    Some(vertex.line),
                    format!("the vertices have no coordinate `{name}`"),
                    "a vertex needs the properties x, y and z",
                ));
            }
        }
    }
    Ok(vertex)
}

/// The face element and the index of its list.
fn face_element(header: &Header) -> Result<(&Element, usize), Fault> {
    let no_faces = |line| {
        let hint = if header.element("tristrips").is_some() {
            "it holds triangle strips: convert them to faces, for instance with MeshLab"
        } else {
            "export it with an `element face` that lists vertex indices"
        };
        Fault::new(line, "there are no faces: a point cloud cannot be ray traced", hint)
    };
    let face = header.element("face").ok_or_else(|| no_faces(None))?;
    if face.count == 0 {
        return Err(no_faces(Some(face.line)));
    }
    let list = face.find("vertex_indices").or_else(|| face.find("vertex_index"));
    let Some(list) = list else {
        return Err(Fault::new(
            Some(face.line),
            "the faces have no list `vertex_indices`",
            "write `property list uchar int vertex_indices` below the element",
        ));
    };
    match face.properties[list].kind {
        PropertyType::List { item, .. } if item.is_integer() => Ok((face, list)),
        _ => Err(Fault::new(
            Some(face.line),
            "the faces' vertex indices are not a list of integers",
            "write `property list uchar int vertex_indices` below the element",
        )),
    }
}

/// The scene with normals and warnings.
fn finish(body: Body, offset: Option<DVec3>) -> Scene {
    let placement = Placement { offset: offset.unwrap_or(DVec3::ZERO), exponent: 0 };
    let mut scene = Scene { vertices: body.vertices, triangles: body.triangles, placement, ..Scene::default() };
    if body.has_normals {
        let repaired = normals::normalise_or_smooth(&mut scene.vertices, &scene.triangles);
        if repaired > 0 {
            scene.warnings.push(format!("{repaired} normals in the file are zero or not finite: computed instead"));
        }
    } else {
        normals::smooth(&mut scene.vertices, &scene.triangles);
    }
    if body.small_polygons > 0 {
        scene.warnings.push(format!("{} faces with fewer than three corners ignored", body.small_polygons));
    }
    if body.bytes_after > 0 {
        scene.warnings.push(format!("{} bytes after the last element ignored", body.bytes_after));
    }
    scene
}
