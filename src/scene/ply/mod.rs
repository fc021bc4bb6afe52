//! Stanford PLY (Turk 1994): ASCII and binary of both byte orders, any properties in any order.
//!
//! Why a reader of our own: ply-rs-bw 4.0.1, the well-kept crate, was measured on the dragon (34 MB ASCII, 871,414
//! triangles) at 1.4 to 1.6 s, above the bar of one second on one core, and it allocates from the counts that stand in
//! the file, so that a broken header can ask for any amount of memory. Here the file is read once, parsed in place, and
//! every count is held against the bytes that are left before anything is allocated from it.
//!
//! What is taken: x, y, z of the vertices, nx, ny, nz if all three are there (otherwise smooth normals are computed, see
//! [`crate::scene::normals`]), and the faces' `vertex_indices` or `vertex_index`, polygons as
//! [`super::polygon`] says. All other properties and elements are passed over.

mod body;
mod header;
mod source;

use super::text::Fault;
use super::{Options, Placement, Scene, normals};
use crate::error::Result;
use body::Body;
use glam::DVec3;
use header::{Element, Encoding, Header, Kind};
use source::{Ascii, Binary};
use std::path::Path;

/// Reads the file.
///
/// # Errors
/// [`crate::Error::Input`] for whatever is wrong with the file.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let bytes = super::read_text(path)?;
    let body = parse(&bytes, options.offset).map_err(|fault| fault.of(path))?;
    // The file's bytes are no longer needed: less memory for what follows.
    drop(bytes);
    Ok(finish(body, options.offset))
}

/// Reads a file that is already in memory; `path` stands in errors only.
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
        return Err(Fault::new(None, "no vertices: the header has no element `vertex`", "is it a mesh?"));
    };
    for name in ["x", "y", "z"] {
        match vertex.find(name).map(|i| vertex.properties[i].kind) {
            Some(Kind::Scalar(_)) => {}
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
            "store it with an `element face` that lists vertex indices"
        };
        Fault::new(line, "no faces: a point cloud cannot be ray traced", hint)
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
        Kind::List { item, .. } if item.is_integer() => Ok((face, list)),
        _ => Err(Fault::new(
            Some(face.line),
            "the faces' vertex indices are not a list of integers",
            "write `property list uchar int vertex_indices` below the element",
        )),
    }
}

/// Normals and warnings.
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
        scene.warnings.push(format!("{} faces with fewer than three corners skipped", body.small_polygons));
    }
    if body.bytes_after > 0 {
        scene.warnings.push(format!("{} bytes behind the last element ignored", body.bytes_after));
    }
    scene
}
