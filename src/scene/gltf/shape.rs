//! The triangles of a primitive in the coordinates of its mesh.

use super::accessor::Use;
use super::json::{Loose, Whole};
use super::nodes::PlacedMesh;
use super::reader::GltfReader;
use super::schema::{Attributes, Mesh, Mode, Primitive};
use crate::scene::Triangle;
use crate::scene::text::Fault;
use glam::Vec3;
use serde_json::value::RawValue;

/// Bytes of JSON that are parsed again for a node in the time that a byte of memory counts for.
const BYTES_PER_CHARGE: usize = 4;

/// A primitive in the coordinates of its mesh.
pub struct Shape {
    pub positions: Vec<Vec3>,
    /// As many as positions.
    pub normals: Option<Vec<Vec3>>,
    /// Corners are indices of positions.
    pub triangles: Vec<Triangle>,
}

/// The memory that the use of a morph target counts for, in addition to a share of its elements. It bounds the time.
const PER_TARGET: usize = 64;

impl<'a> GltfReader<'a> {
    /// The weights of the morph targets: those of the node, otherwise of the mesh.
    pub(super) fn weights(&mut self, place: &PlacedMesh<'a>, mesh: &Mesh<'a>) -> Result<Vec<f32>, Fault> {
        if mesh.primitives.surfaces.iter().all(|primitive| primitive.targets.is_none()) {
            return Ok(Vec::new());
        }
        let Some(raw) = place.weights.or(mesh.weights) else { return Ok(Vec::new()) };
        // This bounds the time: many nodes may share a long list.
        self.limits.keep(raw.get().len() / BYTES_PER_CHARGE)?;
        let weights = match place.weights {
            Some(_) => self.json.value::<Option<Vec<f32>>>(format_args!("nodes[{}].weights", place.node), raw),
            None => self.json.value(format_args!("meshes[{}].weights", place.mesh), raw),
        };
        Ok(weights
            .unwrap_or_else(|fault| {
                self.notes.surface(|| fault.problem);
                None
            })
            .unwrap_or_default())
    }

    /// Reads a primitive. `weights` are those of its morph targets.
    pub(super) fn shape(
        &mut self,
        mesh: usize,
        primitive: &Primitive<'a>,
        weights: &[f32],
        material: u32,
    ) -> Result<Shape, Fault> {
        let place = format!("meshes[{mesh}].primitives[{}]", primitive.index);
        let mut positions = self.vectors(primitive.positions, Use::Vectors, &place)?;
        let mut normals = self.normals(primitive, positions.len(), &place);
        if let Some(raw) = primitive.targets.filter(|_| weights.iter().any(|&weight| weight != 0.0)) {
            self.limits.keep(raw.get().len() / BYTES_PER_CHARGE)?;
            for (index, weight, target) in self.targets(raw, weights, &place) {
                let place = format!("{place}.targets[{index}]");
                self.limits.keep(PER_TARGET + size_of_val(positions.as_slice()) / PER_TARGET)?;
                if let Some(accessor) = target.positions {
                    self.add_weighted(&mut positions, accessor.0, weight, &place)?;
                }
                let Some(given) = &mut normals else { continue };
                let added = match target.normals {
                    Loose::Absent => Ok(()),
                    Loose::Malformed => Err(format!("{place}.NORMAL is not an index")),
                    Loose::Given(Whole(accessor)) => {
                        self.add_weighted(given, accessor, weight, &place).map_err(|fault| fault.problem)
                    }
                };
                if let Err(problem) = added {
                    self.notes.surface(|| problem);
                    // The size of the primitive was computed with normals. Those that are zero are computed.
                    given.fill(Vec3::ZERO);
                }
            }
        }
        let GltfReader { accessors, limits, .. } = self;
        let indices = match primitive.indices {
            Some(index) => {
                let accessor = accessors.get(index, Use::Indices, &place, limits)?;
                accessors.indices(accessor, limits)?
            }
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|&&i| i as usize >= positions.len()) {
            let problem = format!("{place}: a primitive uses vertex {index} of {}", positions.len());
            return Err(Fault::new(None, problem, "export the file again"));
        }
        let triangles = corners(primitive.mode, &indices, material);
        let mut shape = Shape { positions, normals, triangles };
        self.notes.dropped += shape.drop_not_finite();
        Ok(shape)
    }

    /// The normals of a primitive; `None` if it has none, or malformed ones, which is noted.
    fn normals(&mut self, primitive: &Primitive, count: usize, place: &str) -> Option<Vec<Vec3>> {
        let index = match primitive.normals {
            Loose::Given(Whole(index)) => index,
            Loose::Absent => return None,
            Loose::Malformed => {
                self.notes.surface(|| format!("{place}.NORMAL is not an index"));
                return None;
            }
        };
        if let Some(problem) = self.bad_normals.get(&index) {
            self.notes.surface(|| problem.clone());
            return None;
        }
        let accessor = self.accessors.get(index, Use::Normals, place, &mut self.limits);
        let Some(accessor) = accessor.ok().filter(|accessor| accessor.count == count) else {
            self.notes.surface(|| format!("{place} has different numbers of normals and positions"));
            return None;
        };
        Some(self.accessors.vectors(accessor, &mut self.limits).unwrap_or_else(|fault| {
            self.notes.surface(|| fault.problem);
            // The size of the primitive was computed with normals. Those that are zero are computed.
            vec![Vec3::ZERO; count]
        }))
    }

    /// The morph targets with a weight other than zero: index, weight and attributes. If one of them is malformed,
    /// there are none, which is noted.
    fn targets(&mut self, raw: &'a RawValue, weights: &[f32], place: &str) -> Vec<(usize, f32, Attributes)> {
        let used = weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
        let found = self.json.list("targets", "morph target", Some(raw)).and_then(|targets| {
            let used = used.take_while(|(index, _)| *index < targets.len());
            used.map(|(index, &weight)| Ok((index, weight, targets.get(index, place)?))).collect()
        });
        found.unwrap_or_else(|fault: Fault| {
            self.notes.surface(|| format!("{place}: {}", fault.problem));
            Vec::new()
        })
    }

    fn vectors(&mut self, index: usize, used: Use, place: &str) -> Result<Vec<Vec3>, Fault> {
        let accessor = self.accessors.get(index, used, place, &mut self.limits)?;
        self.accessors.vectors(accessor, &mut self.limits)
    }

    /// Adds the weighted elements of a morph target.
    fn add_weighted(&mut self, elements: &mut [Vec3], accessor: usize, weight: f32, place: &str) -> Result<(), Fault> {
        let offsets = self.accessors.get(accessor, Use::Vectors, place, &mut self.limits)?;
        if offsets.count != elements.len() {
            let problem = format!("{place} has {} elements, but the primitive {}", offsets.count, elements.len());
            return Err(Fault::new(None, problem, "export the file again"));
        }
        let offsets = self.accessors.vectors(offsets, &mut self.limits)?;
        elements.iter_mut().zip(offsets).for_each(|(element, offset)| *element += offset * weight);
        Ok(())
    }
}

impl Shape {
    /// Drops vertices that are not finite and the triangles that use them. Returns the number of these triangles.
    fn drop_not_finite(&mut self) -> usize {
        if self.positions.iter().all(|p| p.is_finite()) {
            return 0;
        }
        let mut next = 0;
        let place = |p: &Vec3| {
            next += u32::from(p.is_finite());
            p.is_finite().then(|| next - 1)
        };
        let kept: Vec<Option<u32>> = self.positions.iter().map(place).collect();
        let before = self.triangles.len();
        self.triangles.retain_mut(|triangle| {
            let [a, b, c] = triangle.vertices.map(|v| kept[v as usize]);
            let (Some(a), Some(b), Some(c)) = (a, b, c) else { return false };
            triangle.vertices = [a, b, c];
            true
        });
        self.positions.retain(|p| p.is_finite());
        if let Some(normals) = &mut self.normals {
            let mut kept = kept.iter();
            normals.retain(|_| kept.next().is_some_and(|kept| kept.is_some()));
        }
        before - self.triangles.len()
    }
}

/// The triangles of a list, strip or fan, with consistent winding; an incomplete triangle at the end is dropped.
fn corners(mode: Mode, i: &[u32], material: u32) -> Vec<Triangle> {
    let all = i.len().saturating_sub(2);
    let triangle = |vertices| Triangle { vertices, material };
    match mode {
        Mode::Strip => (0..all)
            .map(|k| if k % 2 == 0 { [i[k], i[k + 1], i[k + 2]] } else { [i[k + 1], i[k], i[k + 2]] })
            .map(triangle)
            .collect(),
        Mode::Fan => (0..all).map(|k| [i[0], i[k + 1], i[k + 2]]).map(triangle).collect(),
        Mode::List => i.as_chunks().0.iter().copied().map(triangle).collect(),
    }
}
