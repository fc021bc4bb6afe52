//! Counts and reserves the memory that a scene needs, before any element of an accessor is read.

use super::accessor::Use;
use super::extensions;
use super::json::{Loose, Whole};
use super::nodes::PlacedMesh;
use super::reader::GltfReader;
use super::schema::{Mesh, Mode, Primitive};
use crate::math::Vertex;
use crate::scene::text::Fault;
use crate::scene::{MAX_ELEMENTS, Triangle, lamps};
use foldhash::fast::RandomState;
use glam::{DMat4, Vec3};
use std::collections::HashMap;
use std::rc::Rc;

/// Numbers of elements and memory of a mesh.
#[derive(Clone, Copy, Default)]
struct MeshSize {
    vertices: usize,
    triangles: usize,
    /// Permanent memory in bytes.
    permanent: usize,
    /// The memory that primitives without triangles count for.
    empty: usize,
    /// Temporary memory in bytes while its largest primitive is read.
    temporary: usize,
}

/// The memory in bytes that a primitive without triangles counts for. It takes time in every node that refers to it, so
/// this bounds the time as well.
const EMPTY: usize = 64;

/// A primitive counts at least for this share of its temporary memory, which bounds the time to read long accessors of
/// which little is used.
const TEMPORARY_SHARE: usize = 64;

/// Temporary memory in bytes per normal of the file while it is read and, if it is not valid, computed.
const NORMALS_NOW: usize = size_of::<Vec3>() + size_of::<Vertex>() + 2 * size_of::<usize>();

/// Temporary memory in bytes per instance: its translation, rotation and scale, and its transform.
const PER_INSTANCE: usize = 2 * size_of::<Vec3>() + 4 * size_of::<f64>() + size_of::<DMat4>();

impl<'a> GltfReader<'a> {
    /// Refuses these meshes if they need more memory than they may take, and reserves exactly that memory. Every
    /// instance needs a copy.
    pub(super) fn reserve(&mut self, placed: &[PlacedMesh<'a>]) -> Result<(), Fault> {
        let mut sizes: HashMap<usize, MeshSize, RandomState> = HashMap::default();
        let (mut vertices, mut triangles) = (0usize, 0usize);
        for place in placed {
            let mesh = self.mesh(place)?;
            let size = match sizes.get(&place.mesh) {
                Some(&size) => size,
                None => {
                    let size = self.mesh_size(place.mesh, &mesh)?;
                    self.limits.check_room(size.temporary)?;
                    self.limits.keep(3 * size_of::<(usize, MeshSize)>())?;
                    sizes.insert(place.mesh, size);
                    size
                }
            };
            self.notes.no_surface += mesh.primitives.no_surface;
            self.notes.no_positions += mesh.primitives.no_positions;
            let instances = self.instance_count(place)?;
            self.limits.check_room(instances.saturating_mul(PER_INSTANCE))?;
            self.limits.keep(instances.saturating_mul(size.empty))?;
            self.limits.repeat(instances.saturating_mul(size.permanent))?;
            vertices = vertices.saturating_add(instances.saturating_mul(size.vertices));
            triangles = triangles.saturating_add(instances.saturating_mul(size.triangles));
            if vertices > MAX_ELEMENTS || triangles > MAX_ELEMENTS {
                let problem =
                    format!("there are more than {MAX_ELEMENTS} triangles or vertices, counting every instance");
                return Err(Fault::new(None, problem, "simplify the scene"));
            }
        }
        self.scene.vertices.reserve_exact(vertices);
        self.scene.triangles.reserve_exact(triangles);
        Ok(())
    }

    /// A mesh, which is parsed once.
    pub(super) fn mesh(&mut self, place: &PlacedMesh) -> Result<Rc<Mesh<'a>>, Fault> {
        if let Some(known) = self.meshes.get(&place.mesh) {
            return Ok(Rc::clone(known));
        }
        let mesh: Mesh = self.lists.meshes.get(place.mesh, format_args!("nodes[{}].mesh", place.node))?;
        let primitives = mesh.primitives.surfaces.len() * size_of::<Primitive>();
        self.limits.keep(3 * (primitives + size_of::<(usize, Mesh)>()))?;
        let mesh = Rc::new(mesh);
        self.meshes.insert(place.mesh, Rc::clone(&mesh));
        Ok(mesh)
    }

    fn mesh_size(&mut self, index: usize, mesh: &Mesh<'a>) -> Result<MeshSize, Fault> {
        let mut all = MeshSize {
            empty: EMPTY * (mesh.primitives.no_surface + mesh.primitives.no_positions),
            ..MeshSize::default()
        };
        for primitive in &mesh.primitives.surfaces {
            let size = self.primitive_size(index, primitive)?;
            all.vertices = all.vertices.saturating_add(size.vertices);
            all.triangles = all.triangles.saturating_add(size.triangles);
            all.permanent = all.permanent.saturating_add(size.permanent);
            all.empty = all.empty.saturating_add(size.empty);
            all.temporary = all.temporary.max(size.temporary);
        }
        Ok(all)
    }

    /// Checks a primitive's accessors and computes its size.
    fn primitive_size(&mut self, mesh: usize, primitive: &Primitive) -> Result<MeshSize, Fault> {
        let GltfReader { accessors, limits, bad_normals, .. } = self;
        let place = format!("meshes[{mesh}].primitives[{}]", primitive.index);
        let from = format_args!("{place}.attributes.POSITION");
        let positions = accessors.get(primitive.positions, Use::Vectors, from, limits)?;
        if primitive.compressed && !positions.has_bytes() {
            let problem = format!("{place} is compressed (KHR_draco_mesh_compression), which is not supported");
            return Err(Fault::new(None, problem, extensions::UNPACK));
        }
        let corners = match primitive.indices {
            Some(index) => accessors.get(index, Use::Indices, format_args!("{place}.indices"), limits)?.count,
            None => positions.count,
        };
        let normals = match primitive.normals {
            // Normals that are malformed are dropped where they are read, with a warning.
            Loose::Given(Whole(index)) if !bad_normals.contains_key(&index) => {
                let found = accessors.get(index, Use::Normals, format_args!("{place}.attributes.NORMAL"), limits);
                // A search for the problem in each of many primitives would take time.
                found.map_err(|fault| bad_normals.insert(index, fault.problem)).ok()
            }
            _ => None,
        };
        let given = normals.is_some_and(|normals| normals.count == positions.count);
        let positions = positions.count;
        let triangles = match primitive.mode {
            Mode::List => corners / 3,
            Mode::Strip | Mode::Fan => corners.saturating_sub(2),
        };
        let shines = self.material_of(primitive).is_some_and(|material| self.emission[material] != Vec3::ZERO);
        let vertices = if given { positions } else { triangles.saturating_mul(3) };
        // Morph targets take positions and normals again.
        let copies = if primitive.targets.is_some() { 2 } else { 1 };
        let temporary = (positions.saturating_mul(copies * size_of::<Vec3>() + size_of::<Option<u32>>()))
            .saturating_add(corners.saturating_mul(size_of::<u32>()))
            .saturating_add(triangles.saturating_mul(size_of::<Triangle>()))
            .saturating_add(positions.saturating_mul(if given { copies * NORMALS_NOW } else { 0 }));
        let permanent = vertices
            .saturating_mul(size_of::<Vertex>())
            .saturating_add(triangles.saturating_mul(size_of::<Triangle>()))
            .saturating_add(if shines { triangles.saturating_mul(lamps::BYTES) } else { 0 })
            .max(temporary / TEMPORARY_SHARE);
        let empty = if triangles == 0 { EMPTY } else { 0 };
        Ok(MeshSize { vertices, triangles, permanent, empty, temporary })
    }

    /// Number of instances of a node's mesh.
    fn instance_count(&mut self, place: &PlacedMesh) -> Result<usize, Fault> {
        let Some(instances) = &place.instances else { return Ok(1) };
        let uses = [
            (instances.translation, Use::Vectors, "TRANSLATION"),
            (instances.rotation, Use::Rotations, "ROTATION"),
            (instances.scale, Use::Vectors, "SCALE"),
        ];
        let mut count = None;
        for (accessor, used, name) in uses {
            let Some(accessor) = accessor else { continue };
            let from = format_args!("nodes[{}].extensions.EXT_mesh_gpu_instancing.attributes.{name}", place.node);
            let found = self.accessors.get(accessor.0, used, from, &mut self.limits)?.count;
            if *count.get_or_insert(found) != found {
                let problem = format!("nodes[{}] has instances with attributes of different lengths", place.node);
                return Err(Fault::new(None, problem, "export the file again"));
            }
        }
        Ok(count.unwrap_or(1))
    }
}
