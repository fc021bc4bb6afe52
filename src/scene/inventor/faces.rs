//! Iterates over the faces of all kinds of face sets.

use super::node_type::NodeType;
use super::state::Binding;
use super::state::Coordinates;
use super::tree::{Field, Node};
use crate::scene::text::Fault;
use glam::DVec3;

/// A corner of a face.
#[derive(Clone, Copy, Debug, Default)]
pub struct Corner {
    /// Index of its position.
    pub coordinate: usize,
    /// Index of its entry in `coordIndex`, which also has entries for the ends of faces.
    pub entry: usize,
    /// Its number among all corners.
    pub number: usize,
}

/// A face with its corners counter-clockwise.
pub struct Face<'c> {
    /// The part that it belongs to.
    pub part: usize,
    /// Its number among the faces of the file.
    pub number: usize,
    /// Its number among the visited faces; a face of a mesh is visited as two triangles.
    pub visit: usize,
    pub corners: &'c [Corner],
}

/// The way in which corners are combined to faces.
#[derive(Clone, Copy)]
enum Layout {
    /// Every run of corners is a face.
    Polygons,
    /// Every run of corners is a strip of triangles.
    Strips,
    /// All corners form a grid.
    Mesh { rows: usize, columns: usize },
}

/// The definition of the runs of corners.
#[derive(Clone, Copy)]
enum Runs<'t> {
    /// Indices of coordinates; a negative index ends a run.
    Indexed(&'t [f64]),
    /// Numbers of consecutive coordinates; a negative number takes all remaining ones.
    Counted(&'t [f64]),
}

/// A set of faces.
pub struct Faces<'t> {
    layout: Layout,
    runs: Runs<'t>,
    /// Index of the first coordinate, for runs without indices.
    start: usize,
    coordinates: Coordinates<'t>,
    clockwise: bool,
    /// Line of the list of indices or numbers.
    line: usize,
}

/// A callback for faces.
type Visit<'v> = &'v mut dyn FnMut(Face) -> Result<(), Fault>;

/// A callback for runs of corners with their numbers; it may reverse the corners.
type VisitRun<'v> = &'v mut dyn FnMut(usize, &mut [Corner]) -> Result<(), Fault>;

impl<'t> Faces<'t> {
    /// The faces of a face set.
    pub fn of(node: &'t Node, coordinates: Coordinates<'t>, clockwise: bool) -> Result<Faces<'t>, Fault> {
        let start = node.integer("startIndex", 0)?;
        let Ok(start) = usize::try_from(start) else {
            return Err(Fault::new(None, format!("startIndex: {start} is negative"), "give 0 or more"));
        };
        let size = |name| -> Result<usize, Fault> {
            let size = node.integer(name, 1)?;
            usize::try_from(size).map_err(|_| Fault::new(None, format!("{name}: {size} is negative"), ""))
        };
        let layout = match node.kind {
            NodeType::IndexedFaceSet | NodeType::FaceSet => Layout::Polygons,
            NodeType::QuadMesh => Layout::Mesh { rows: size("verticesPerColumn")?, columns: size("verticesPerRow")? },
            _ => Layout::Strips,
        };
        let (runs, field) = match node.kind {
            NodeType::IndexedFaceSet | NodeType::IndexedTriangleStripSet => {
                (Runs::Indexed(node.numbers("coordIndex")?.unwrap_or(&[])), "coordIndex")
            }
            _ => (Runs::Counted(node.numbers("numVertices")?.unwrap_or(&[-1.0])), "numVertices"),
        };
        let line = node.field(field).map_or(node.line, |field| field.line);
        Ok(Faces { layout, runs, start, coordinates, clockwise, line })
    }

    /// The position of a visited corner.
    pub fn position(&self, corner: &Corner) -> DVec3 {
        self.coordinates.get(corner.coordinate).unwrap_or_default()
    }

    /// Visits all faces in file order.
    ///
    /// # Errors
    /// An index is out of range; errors of the callback.
    pub fn visit(&self, visit: Visit) -> Result<(), Fault> {
        let mut visits = 0;
        let mut visit_face = |part: usize, number: usize, corners: &mut [Corner]| {
            if self.clockwise {
                corners.reverse();
            }
            visit(Face { part, number, visit: visits, corners })?;
            visits += 1;
            Ok(())
        };
        match self.layout {
            Layout::Polygons => self.runs(&mut |run, corners| visit_face(run, run, corners)),
            Layout::Strips => {
                let mut number = 0;
                self.runs(&mut |part, corners| {
                    for (k, window) in corners.windows(3).enumerate() {
                        let [a, b, c] = [window[0], window[1], window[2]];
                        // Every other triangle of a strip has the opposite orientation.
                        visit_face(part, number, &mut if k % 2 == 0 { [a, b, c] } else { [b, a, c] })?;
                        number += 1;
                    }
                    Ok(())
                })
            }
            Layout::Mesh { rows, columns } => {
                let needed = rows.saturating_mul(columns).saturating_add(self.start);
                if needed > self.coordinates.len() {
                    return Err(self.too_few(needed));
                }
                // With at most one column there are no faces, for any number of rows.
                let rows = if columns > 1 { rows } else { 0 };
                let corner = |row: usize, column: usize| self.plain(self.start + row * columns + column);
                for row in 1..rows {
                    for column in 1..columns {
                        let [a, b] = [corner(row - 1, column - 1), corner(row, column - 1)];
                        let [c, d] = [corner(row - 1, column), corner(row, column)];
                        // The diagonal is that of the reference implementation, which makes a strip of each row.
                        let number = (row - 1) * (columns - 1) + column - 1;
                        visit_face(row - 1, number, &mut [a, b, c])?;
                        visit_face(row - 1, number, &mut [c, b, d])?;
                    }
                }
                Ok(())
            }
        }
    }

    /// A corner of a set without `coordIndex`.
    fn plain(&self, coordinate: usize) -> Corner {
        Corner { coordinate, entry: coordinate, number: coordinate }
    }

    /// Visits all runs of corners.
    fn runs(&self, visit: VisitRun) -> Result<(), Fault> {
        let mut corners = Vec::new();
        let (mut run, mut number) = (0, 0);
        match self.runs {
            Runs::Indexed(indices) => {
                for (entry, &index) in indices.iter().enumerate() {
                    if index >= 0.0 {
                        let coordinate = index as usize;
                        if coordinate as f64 != index || coordinate >= self.coordinates.len() {
                            return Err(self.out_of_range(index));
                        }
                        corners.push(Corner { coordinate, entry, number });
                        number += 1;
                    }
                    if (index < 0.0 || entry + 1 == indices.len()) && !corners.is_empty() {
                        visit(run, &mut corners)?;
                        corners.clear();
                        run += 1;
                    }
                }
            }
            Runs::Counted(counts) => {
                let mut next = self.start;
                for &count in counts {
                    let left = self.coordinates.len().saturating_sub(next);
                    let count = if count < 0.0 { left } else { count as usize };
                    if count > left {
                        return Err(self.too_few(next.saturating_add(count)));
                    }
                    corners.clear();
                    corners.extend((next..next + count).map(|coordinate| self.plain(coordinate)));
                    next += count;
                    visit(run, &mut corners)?;
                    run += 1;
                }
            }
        }
        Ok(())
    }

    #[cold]
    fn out_of_range(&self, index: f64) -> Fault {
        let hint = match self.coordinates.len() {
            0 => "there are no coordinates".into(),
            count => format!("give 0 to {}", count - 1),
        };
        Fault::new(Some(self.line), format!("coordIndex: index {index} is out of range"), hint)
    }

    #[cold]
    fn too_few(&self, needed: usize) -> Fault {
        let problem = format!("{needed} coordinates are needed, but there are {}", self.coordinates.len());
        Fault::new(Some(self.line), problem, "give more coordinates, or use fewer")
    }
}

/// Selects the normal or material of a corner.
pub struct BindingIndices<'t> {
    binding: Binding,
    /// The field of indices, if the file has it.
    indices: Option<(&'t Field, &'t [f64])>,
    /// The indices of coordinates, which are used if the file has no indices.
    fallback: Option<&'t [f64]>,
}

impl<'t> BindingIndices<'t> {
    /// The indices of a face set; `field` is the name of the field with the indices.
    pub fn of(node: &'t Node, field: &str, (binding, indexed): (Binding, bool)) -> Result<BindingIndices<'t>, Fault> {
        if !indexed || !matches!(node.kind, NodeType::IndexedFaceSet | NodeType::IndexedTriangleStripSet) {
            return Ok(BindingIndices { binding, indices: None, fallback: None });
        }
        let own = |field: &'t Field| {
            // The default -1 means that coordIndex is used.
            Ok(node.numbers(field.name)?.filter(|list| !matches!(list, [] | [-1.0])).map(|list| (field, list)))
        };
        let indices = node.field(field).map_or(Ok(None), own)?;
        Ok(BindingIndices { binding, indices, fallback: node.numbers("coordIndex")? })
    }

    /// True if all corners have the first normal or material.
    pub fn is_overall(&self) -> bool {
        self.binding == Binding::Overall
    }

    /// True if the corners of a face may differ.
    pub fn is_per_corner(&self) -> bool {
        self.binding == Binding::Vertex
    }

    /// The field of indices, if the file has it.
    pub fn field(&self) -> Option<&'t Field> {
        self.indices.map(|(field, _)| field)
    }

    /// True if `count` normals or materials are certainly enough for these faces, without visiting them. False does not
    /// prove the opposite.
    pub fn is_within(&self, count: usize, faces: &Faces) -> bool {
        match self.binding {
            Binding::Overall => count > 0,
            // Without coordIndex, the number of a corner is the index of its coordinate.
            Binding::Vertex => {
                let plain = self.indices.is_none() && matches!(faces.runs, Runs::Counted(_));
                plain && count >= faces.coordinates.len()
            }
            Binding::Part | Binding::Face => false,
        }
    }

    /// The index of the normal or material of a corner.
    pub fn index(&self, face: &Face, corner: &Corner) -> Result<usize, Fault> {
        let (at, number) = match self.binding {
            Binding::Overall => return Ok(0),
            Binding::Part => (face.part, face.part),
            Binding::Face => (face.number, face.number),
            Binding::Vertex => (corner.entry, corner.number),
        };
        match (self.indices, self.fallback) {
            (Some((field, list)), _) => match list.get(at) {
                Some(&index) if index as usize as f64 == index => Ok(index as usize),
                Some(index) => Err(field.fault(format!("{index}, entry {at} of the list, is not an index"))),
                None => Err(field.fault(format!("{} indices are not enough", list.len()))),
            },
            // The reference implementation also does this for parts and faces. If the entry is the end of a face, the
            // number is used.
            (None, Some(list)) => {
                Ok(list.get(at).filter(|&&index| index >= 0.0).map_or(number, |&index| index as usize))
            }
            (None, None) => Ok(number),
        }
    }
}
