//! Reader of Stanford PLY (Turk 1994): ASCII and binary in both byte orders, any properties in any order.
//!
//! The crate ply-rs-bw 4.0.1 is not used for these reasons: for the dragon (34 MB ASCII, 871,414 triangles) it was
//! measured at 1.4 to 1.6 s, above the required second on one core; and it allocates memory by the counts in the file,
//! so that a broken header can request any amount. This reader parses the file in place, in one pass, and compares
//! every count with the remaining bytes before it allocates memory.
//!
//! The reader supports x, y, z of the vertices; nx, ny, nz if all three exist (otherwise smooth normals are computed,
//! see [`crate::scene::normals`]); `vertex_indices` or `vertex_index` of the faces; and triangle strips.
//! [`super::polygon`] triangulates polygons. All other properties and elements are ignored.

mod ascii;
mod body;
mod faces;
mod header;
mod rows;

use super::text::{Fault, place, refuse_zeros};
use super::{Options, Placement, Scene, normals};
use crate::error::Result;
use ascii::{Ascii, Layout};
use body::Body;
use faces::FaceList;
use glam::DVec3;
use header::{Element, Encoding, FACES, Header, PropertyType};
use rows::Binary;
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
    Ok(finish(path, body, options.offset))
}

/// Reads a file from memory; `path` is only used for errors.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8]) -> Result<Scene> {
    let body = parse(bytes, None).map_err(|fault| fault.of(path))?;
    Ok(finish(path, body, None))
}

fn parse(bytes: &[u8], offset: Option<DVec3>) -> Result<Body, Fault> {
    let mut header = header::parse(bytes)?;
    let mut warnings = std::mem::take(&mut header.warnings);
    let vertex = vertex_element(&header)?;
    let faces = face_elements(&header)?;
    let body = &bytes[header.body..];
    let ascii = |layout| {
        let rows = Ascii::new(body, header.body_line, header.newline, layout);
        body::read(&header, vertex, &faces, rows, body.len(), offset)
    };
    let mut body = match header.encoding {
        Encoding::Ascii => {
            // A comment in the header may have zero bytes; the body has no comments.
            let line = |fault: Fault| Fault { line: fault.line.map(|line| line + header.body_line - 1), ..fault };
            refuse_zeros(body).map_err(line)?;
            ascii(Layout::Lines).or_else(|fault| {
                let whole = |body: &Body| body.bytes_after == 0;
                let free = ascii(Layout::Free).ok().filter(whole);
                free.or_else(|| ascii(Layout::Surplus).ok().filter(whole)).ok_or(fault)
            })
        }
        Encoding::LittleEndian => body::read(&header, vertex, &faces, Binary::<false>::new(body), body.len(), offset),
        Encoding::BigEndian => body::read(&header, vertex, &faces, Binary::<true>::new(body), body.len(), offset),
    }?;
    warnings.append(&mut body.warnings);
    body.warnings = warnings;
    Ok(body)
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

/// The elements with faces: polygons or triangle strips.
fn face_elements(header: &Header) -> Result<Vec<FaceList<'_>>, Fault> {
    let elements: Vec<&Element> = FACES.iter().filter_map(|name| header.element(name)).collect();
    let mut faces = Vec::new();
    for element in elements.iter().filter(|element| element.count > 0) {
        faces.push(face_list(element)?);
    }
    if faces.is_empty() {
        let line = elements.first().map(|element| element.line);
        let hint = "export it with an `element face` that lists vertex indices";
        return Err(Fault::new(line, "there are no faces: a point cloud cannot be ray traced", hint));
    }
    Ok(faces)
}

/// The list of vertex indices of an element.
fn face_list(element: &Element) -> Result<FaceList<'_>, Fault> {
    let hint = "write `property list uchar int vertex_indices` below the element";
    let list = element.find("vertex_indices").or_else(|| element.find("vertex_index"));
    let Some(list) = list else {
        return Err(Fault::new(Some(element.line), "the faces have no list `vertex_indices`", hint));
    };
    match element.properties[list].kind {
        PropertyType::List { .. } => {
            Ok(FaceList { element, list, is_strip: element.name.eq_ignore_ascii_case("tristrips") })
        }
        PropertyType::Scalar(_) => {
            let problem = "the faces' vertex indices are not a list of integers";
            Err(Fault::new(Some(element.line), problem, hint))
        }
    }
}

/// The scene with normals and warnings.
fn finish(path: &Path, body: Body, offset: Option<DVec3>) -> Scene {
    let placement = Placement { offset: offset.unwrap_or(DVec3::ZERO), exponent: 0 };
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut scene = Scene { vertices: body.vertices, triangles: body.triangles, placement, ..Scene::default() };
    if body.has_normals {
        let repaired = normals::normalise_or_smooth(&mut scene.vertices, &scene.triangles);
        if repaired > 0 {
            scene.warnings.push(format!("{repaired} normals in the file are zero or not finite: computed instead"));
        }
    } else {
        normals::smooth(&mut scene.vertices, &scene.triangles);
    }
    scene.warnings.extend(body.not_finite.warning().map(|warning| format!("{name}: {warning}")));
    scene.warnings.extend(body.warnings.iter().map(|(line, text)| format!("{}: {text}", place(path, *line))));
    if body.small_polygons > 0 {
        scene.warnings.push(format!("{} faces with fewer than three corners ignored", body.small_polygons));
    }
    if body.bytes_after > 0 {
        scene.warnings.push(format!("{} bytes after the last element ignored", body.bytes_after));
    }
    scene
}
