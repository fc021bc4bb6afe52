//! Sets of faces, of whatever kind, as one face after another.

use super::kind::Kind;
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
    /// Where it stands in the list of indices, ends of faces counted.
    pub place: usize,
    /// Where it stands among all corners.
    pub number: usize,
}

/// A face with its corners counter-clockwise.
pub struct Face<'c> {
    /// The part that it belongs to.
    pub part: usize,
    /// Where it stands among the faces of the file.
    pub number: usize,
    /// Where it stands among those that are visited: a face of a mesh is visited as two triangles.
    pub visit: usize,
    pub corners: &'c [Corner],
}

/// How corners make faces.
#[derive(Clone, Copy)]
enum Layout {
    /// Every run of corners is a face.
    Polygons,
    /// Every run of corners is a strip of triangles.
    Strips,
    /// All corners are a grid of so many columns.
    Mesh { rows: usize, columns: usize },
}

/// Where runs of corners come from.
#[derive(Clone, Copy)]
enum Runs<'t> {
    /// Indices of coordinates; a negative one ends a run.
    Indexed(&'t [f64]),
    /// Numbers of coordinates, in their order; a negative one takes all that are left.
    Counted(&'t [f64]),
}

/// A set of faces.
pub struct Faces<'t> {
    layout: Layout,
    runs: Runs<'t>,
    /// Of corners that have no indices, the first.
    start: usize,
    coordinates: Coordinates<'t>,
    clockwise: bool,
    /// Line of the list of indices or numbers.
    line: usize,
}

/// What sees the faces.
type Visit<'v> = &'v mut dyn FnMut(Face) -> Result<(), Fault>;

/// What sees runs of corners with their numbers, and may turn them around.
type VisitRun<'v> = &'v mut dyn FnMut(usize, &mut [Corner]) -> Result<(), Fault>;

impl<'t> Faces<'t> {
    /// The faces of a node that is a set of them.
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
            Kind::IndexedFaceSet | Kind::FaceSet => Layout::Polygons,
            Kind::QuadMesh => Layout::Mesh { rows: size("verticesPerColumn")?, columns: size("verticesPerRow")? },
            _ => Layout::Strips,
        };
        let (runs, field) = match node.kind {
            Kind::IndexedFaceSet | Kind::IndexedTriangleStripSet => {
                (Runs::Indexed(node.numbers("coordIndex")?.unwrap_or(&[])), "coordIndex")
            }
            _ => (Runs::Counted(node.numbers("numVertices")?.unwrap_or(&[-1.0])), "numVertices"),
        };
        let line = node.field(field).map_or(node.line, |field| field.line);
        Ok(Faces { layout, runs, start, coordinates, clockwise, line })
    }

    /// The position of a corner; it is one that was visited.
    pub fn position(&self, corner: &Corner) -> DVec3 {
        self.coordinates.get(corner.coordinate).unwrap_or_default()
    }

    /// Visits all faces, always in the same order.
    ///
    /// # Errors
    /// An index is out of range, or what the visitor says.
    pub fn visit(&self, visit: Visit) -> Result<(), Fault> {
        let mut visits = 0;
        let mut turned = |part: usize, number: usize, corners: &mut [Corner]| {
            if self.clockwise {
                corners.reverse();
            }
            visit(Face { part, number, visit: visits, corners })?;
            visits += 1;
            Ok(())
        };
        match self.layout {
            Layout::Polygons => self.runs(&mut |run, corners| turned(run, run, corners)),
            Layout::Strips => {
                let mut number = 0;
                self.runs(&mut |part, corners| {
                    for (k, window) in corners.windows(3).enumerate() {
                        let [a, b, c] = [window[0], window[1], window[2]];
                        // Every other triangle of a strip turns the other way
                        turned(part, number, &mut if k % 2 == 0 { [a, b, c] } else { [b, a, c] })?;
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
                // Of one column, or none, any number of rows may be had for nothing
                let rows = if columns > 1 { rows } else { 0 };
                let corner = |row: usize, column: usize| self.plain(self.start + row * columns + column);
                for row in 1..rows {
                    for column in 1..columns {
                        let [a, b] = [corner(row - 1, column - 1), corner(row, column - 1)];
                        let [c, d] = [corner(row - 1, column), corner(row, column)];
                        // As in the strip that the format's library makes of a row
                        let number = (row - 1) * (columns - 1) + column - 1;
                        turned(row - 1, number, &mut [a, b, c])?;
                        turned(row - 1, number, &mut [c, b, d])?;
                    }
                }
                Ok(())
            }
        }
    }

    /// A corner without indices.
    fn plain(&self, coordinate: usize) -> Corner {
        Corner { coordinate, place: coordinate, number: coordinate }
    }

    /// Visits all runs of corners.
    fn runs(&self, visit: VisitRun) -> Result<(), Fault> {
        let mut corners = Vec::new();
        let (mut run, mut number) = (0, 0);
        match self.runs {
            Runs::Indexed(indices) => {
                for (place, &index) in indices.iter().enumerate() {
                    if index >= 0.0 {
                        let coordinate = index as usize;
                        if coordinate as f64 != index || coordinate >= self.coordinates.len() {
                            return Err(self.out_of_range(index));
                        }
                        corners.push(Corner { coordinate, place, number });
                        number += 1;
                    }
                    if (index < 0.0 || place + 1 == indices.len()) && !corners.is_empty() {
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
        Fault::new(Some(self.line), problem, "give more, or take fewer of them")
    }
}

/// Which of several normals or materials a corner has.
pub struct Choice<'t> {
    binding: Binding,
    /// Indices of its own, where the file has them.
    indices: Option<(&'t Field, &'t [f64])>,
    /// Those of the coordinates, which stand for them where it does not.
    instead: Option<&'t [f64]>,
}

impl<'t> Choice<'t> {
    /// The choice of a set of faces; `field` is the name of its indices.
    pub fn of(node: &'t Node, field: &str, (binding, indexed): (Binding, bool)) -> Result<Choice<'t>, Fault> {
        if !indexed || !matches!(node.kind, Kind::IndexedFaceSet | Kind::IndexedTriangleStripSet) {
            return Ok(Choice { binding, indices: None, instead: None });
        }
        let own = |field: &'t Field| {
            // The default is -1: go by coordIndex
            Ok(node.numbers(field.name)?.filter(|list| !matches!(list, [] | [-1.0])).map(|list| (field, list)))
        };
        let indices = node.field(field).map_or(Ok(None), own)?;
        Ok(Choice { binding, indices, instead: node.numbers("coordIndex")? })
    }

    /// True if it is always the first.
    pub fn is_overall(&self) -> bool {
        self.binding == Binding::Overall
    }

    /// True if the corners of a face may differ.
    pub fn is_per_corner(&self) -> bool {
        self.binding == Binding::Vertex
    }

    /// The list of indices, where the file has one.
    pub fn field(&self) -> Option<&'t Field> {
        self.indices.map(|(field, _)| field)
    }

    /// True if so many normals or materials are enough for these faces, which can be seen without a look at each. There may be
    /// enough where this says no.
    pub fn is_within(&self, count: usize, faces: &Faces) -> bool {
        match self.binding {
            Binding::Overall => count > 0,
            // A corner without indices has the number of its coordinate
            Binding::Vertex => matches!(faces.runs, Runs::Counted(_)) && count >= faces.coordinates.len(),
            Binding::Part | Binding::Face => false,
        }
    }

    /// The index for a corner of a face.
    pub fn index(&self, face: &Face, corner: &Corner) -> Result<usize, Fault> {
        let (at, number) = match self.binding {
            Binding::Overall => return Ok(0),
            Binding::Part => (face.part, face.part),
            Binding::Face => (face.number, face.number),
            Binding::Vertex => (corner.place, corner.number),
        };
        match (self.indices, self.instead) {
            (Some((field, list)), _) => match list.get(at) {
                Some(&index) if index as usize as f64 == index => Ok(index as usize),
                Some(index) => Err(field.fault(format!("{index}, number {at} of the list, is no index"))),
                None => Err(field.fault(format!("{} indices are too few", list.len()))),
            },
            // As in the format's own library, also for parts and faces; where a face ends there, it goes by its number
            (None, Some(list)) => {
                Ok(list.get(at).filter(|&&index| index >= 0.0).map_or(number, |&index| index as usize))
            }
            (None, None) => Ok(number),
        }
    }
}
