//! Computes and reserves the memory that a scene needs, before any accessor is read.

use super::reader::GltfReader;
use super::{Problem, accessor};
use crate::math::Vertex;
use crate::scene::{MAX_ELEMENTS, Triangle, lamps, text};
use glam::{DMat4, Vec3};
use gltf::mesh::Mode;
use gltf::{Accessor, Node, Primitive};

/// Numbers of elements and memory of a primitive.
struct PrimitiveSize {
    vertices: usize,
    triangles: usize,
    /// Temporary memory in bytes while the primitive is read.
    temporary: usize,
    /// Memory in bytes for converting its emissive triangles to lights.
    lamps: usize,
}

impl PrimitiveSize {
    /// Permanent memory in bytes, at least [`EMPTY`].
    fn permanent(&self) -> usize {
        let vertices = self.vertices.saturating_mul(size_of::<Vertex>());
        let triangles = self.triangles.saturating_mul(size_of::<Triangle>());
        vertices.saturating_add(triangles).saturating_add(self.lamps).max(EMPTY)
    }
}

/// The memory in bytes that an empty primitive counts for. It takes time in every node that refers to it, so this
/// bounds the time as well.
const EMPTY: usize = 64;

/// Temporary memory in bytes per normal of the file while it is read and, if it is not valid, computed.
const NORMALS_NOW: usize = size_of::<Vec3>() + size_of::<Vertex>() + 2 * size_of::<usize>();

impl GltfReader<'_> {
    /// Refuses the meshes of these nodes if they need more memory than the file may take, and reserves exactly that
    /// memory. Every node that refers to a mesh needs a copy.
    pub(super) fn reserve(&mut self, nodes: &[(Node, DMat4)]) -> Result<(), Problem> {
        let (mut vertices, mut triangles) = (0, 0);
        for primitive in nodes.iter().filter_map(|(node, _)| node.mesh()).flat_map(|mesh| mesh.primitives()) {
            let Some(size) = self.primitive_size(&primitive)? else { continue };
            self.limits.keep(size.permanent()).map_err(too_much)?;
            self.limits.check_temporary(size.temporary).map_err(too_much)?;
            vertices += size.vertices;
            triangles += size.triangles;
            if vertices > MAX_ELEMENTS || triangles > MAX_ELEMENTS {
                let problem =
                    format!("there are more than {MAX_ELEMENTS} triangles or vertices, counting every instance");
                return Err((problem, "simplify the scene"));
            }
        }
        self.scene.vertices.reserve_exact(vertices);
        self.scene.triangles.reserve_exact(triangles);
        Ok(())
    }

    /// Checks a primitive's accessors and computes its size; `None` for points and lines.
    fn primitive_size(&self, primitive: &Primitive) -> Result<Option<PrimitiveSize>, Problem> {
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
        Ok(Some(PrimitiveSize {
            vertices: if given { positions } else { triangles.saturating_mul(3) },
            triangles,
            temporary: (positions.saturating_mul(size_of::<Vec3>()))
                .saturating_add(corners.saturating_mul(size_of::<u32>()))
                .saturating_add(triangles.saturating_mul(size_of::<Triangle>()))
                .saturating_add(if given { positions.saturating_mul(NORMALS_NOW) } else { 0 }),
            lamps: if shines { triangles.saturating_mul(lamps::BYTES) } else { 0 },
        }))
    }
}

/// The accessor of a primitive's positions.
pub fn positions<'a>(primitive: &Primitive<'a>) -> Result<Accessor<'a>, Problem> {
    let positions = primitive.get(&gltf::Semantic::Positions);
    positions.ok_or_else(|| ("a primitive has no positions".into(), "export the file again"))
}

/// True for triangles, strips and fans; false for points and lines.
pub fn is_surface(mode: Mode) -> bool {
    matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
}

/// Converts the error that the file needs more memory than it may take.
pub fn too_much(fault: text::Fault) -> Problem {
    (fault.problem, "if many nodes refer to the same mesh, reduce their number, or simplify the mesh")
}
