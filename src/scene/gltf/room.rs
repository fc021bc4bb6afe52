//! How much room a scene needs, which is known before anything is read.

use super::walk::Walk;
use super::{Fault, accessor};
use crate::math::Vertex;
use crate::scene::{MAX_ELEMENTS, Triangle, lamps, text};
use glam::{DMat4, Vec3};
use gltf::mesh::Mode;
use gltf::{Accessor, Node, Primitive};

/// What a primitive becomes.
struct Need {
    vertices: usize,
    triangles: usize,
    /// Bytes while it is read.
    for_now: usize,
    /// Bytes for finding its lamps.
    lamps: usize,
}

impl Need {
    /// Bytes for good. An empty primitive takes time as well, in every node that shows it.
    fn kept(&self) -> usize {
        let vertices = self.vertices.saturating_mul(size_of::<Vertex>());
        let triangles = self.triangles.saturating_mul(size_of::<Triangle>());
        vertices.saturating_add(triangles).saturating_add(self.lamps).max(EMPTY)
    }
}

/// Bytes that an empty primitive counts for.
const EMPTY: usize = 64;

/// Bytes per given normal while it is read and, if it is no good, computed.
const NORMALS_NOW: usize = size_of::<Vec3>() + size_of::<Vertex>() + 2 * size_of::<usize>();

impl Walk<'_> {
    /// Holds what these nodes show against what the file may take of memory, and sets just that aside: every node that
    /// shows a mesh has a copy.
    pub(super) fn make_room(&mut self, nodes: &[(Node, DMat4)]) -> Result<(), Fault> {
        let (mut vertices, mut triangles) = (0, 0);
        for primitive in nodes.iter().filter_map(|(node, _)| node.mesh()).flat_map(|mesh| mesh.primitives()) {
            let Some(need) = self.need(&primitive)? else { continue };
            self.limits.keep(need.kept()).map_err(too_much)?;
            self.limits.passing(need.for_now).map_err(too_much)?;
            vertices += need.vertices;
            triangles += need.triangles;
            if vertices > MAX_ELEMENTS || triangles > MAX_ELEMENTS {
                let problem = format!("there are more than {MAX_ELEMENTS} triangles or vertices, instances counted");
                return Err((problem, "simplify the scene"));
            }
        }
        self.scene.vertices.reserve_exact(vertices);
        self.scene.triangles.reserve_exact(triangles);
        Ok(())
    }

    /// What a primitive needs once it is known to be whole; nothing if it is no surface.
    fn need(&self, primitive: &Primitive) -> Result<Option<Need>, Fault> {
        if !is_surface(primitive.mode()) {
            return Ok(None);
        }
        let positions = positions(primitive)?;
        accessor::check(&positions, self.buffers)?;
        if let Some(indices) = primitive.indices() {
            accessor::check_indices(&indices, self.buffers)?;
        }
        let positions = positions.count();
        let corners = primitive.indices().map_or(positions, |indices| indices.count());
        let triangles = match primitive.mode() {
            Mode::Triangles => corners / 3,
            _ => corners.saturating_sub(2),
        };
        let given = primitive.get(&gltf::Semantic::Normals).is_some();
        let shines = primitive.material().index().is_some_and(|i| self.emission[i] != Vec3::ZERO);
        Ok(Some(Need {
            vertices: if given { positions } else { triangles.saturating_mul(3) },
            triangles,
            for_now: (positions.saturating_mul(size_of::<Vec3>()))
                .saturating_add(corners.saturating_mul(size_of::<u32>()))
                .saturating_add(triangles.saturating_mul(size_of::<Triangle>()))
                .saturating_add(if given { positions.saturating_mul(NORMALS_NOW) } else { 0 }),
            lamps: if shines { triangles.saturating_mul(lamps::BYTES) } else { 0 },
        }))
    }
}

/// The accessor of a surface's positions.
pub fn positions<'a>(primitive: &Primitive<'a>) -> Result<Accessor<'a>, Fault> {
    let positions = primitive.get(&gltf::Semantic::Positions);
    positions.ok_or_else(|| ("a primitive has no positions".into(), "export the file again"))
}

/// False for points and lines.
pub fn is_surface(mode: Mode) -> bool {
    matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
}

/// The file needs more memory than it may take.
pub fn too_much(fault: text::Fault) -> Fault {
    (fault.problem, "do many nodes show the same mesh? Show it less often, or simplify it")
}
