//! Scene and structure on a device, and the ledger of their bytes.

use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::BvhNode;
use crate::workloads::trace::gpu::device::GpuBackend;
use crate::workloads::trace::gpu::shared::StructureUniform;
use crate::workloads::trace::gpu::words::{FOUR_WORDS, Words, node_format};
use crate::workloads::trace::grid::octants::octants;
use crate::workloads::trace::method::Fetch;
use crate::workloads::trace::{Method, Structure, TriangleRef};
use bytemuck::{NoUninit, Pod};
use glam::Vec3;

/// One scene and one structure.
pub(super) struct Uploaded {
    pub vertices: Words,
    pub triangle_refs: Words,
    pub nodes: Words,
    /// These three are textures.
    pub textures: bool,
    pub materials: wgpu::Buffer,
    pub triangle_materials: wgpu::Buffer,
    pub structure: wgpu::Buffer,
    /// Bytes of vertices, materials and the triangles' materials.
    pub geometry_bytes: u64,
    /// Bytes of nodes (or cells) and triangle references.
    pub structure_bytes: u64,
}

/// Smallest storage buffer: an empty one cannot be bound, and a binding must hold one element.
const SMALLEST: usize = 96;

impl GpuBackend {
    /// A storage buffer with contents.
    pub(super) fn storage<T: NoUninit>(&self, what: &str, contents: &[T]) -> Result<wgpu::Buffer> {
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        self.check_size(what, bytes.len() as u64)?;
        self.filled(what, bytes, wgpu::BufferUsages::STORAGE)
    }

    /// A buffer with contents. (wgpu's `create_buffer_init` panics on a lost device.)
    pub(super) fn filled(&self, what: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
        let buffer = self.buffer(what, bytes.len() as u64, usage | wgpu::BufferUsages::COPY_DST)?;
        self.queue.write_buffer(&buffer, 0, bytes);
        self.check()?;
        Ok(buffer)
    }

    /// An uninitialised buffer.
    pub(super) fn buffer(&self, what: &str, size: u64, usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
        self.check_size(what, size)?;
        let size = size.max(SMALLEST as u64).next_multiple_of(4);
        Ok(self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(what),
            size,
            usage,
            mapped_at_creation: false,
        }))
    }

    fn check_size(&self, what: &str, bytes: u64) -> Result<()> {
        let limit = self.limits.max_storage_buffer_binding_size.min(self.limits.max_buffer_size);
        if bytes <= limit {
            return Ok(());
        }
        let mib = |bytes: u64| bytes.div_ceil(1 << 20);
        Err(Error::Device(format!(
            "{what} needs {} MiB, but this device binds at most {} MiB as one buffer (use a smaller scene, a structure \
             with fewer references, or another device)",
            mib(bytes),
            limit >> 20
        )))
    }

    /// Uploads a scene and a structure for a method.
    pub(super) fn upload(&self, scene: &Scene, structure: &Structure, method: Method) -> Result<Uploaded> {
        let packed: Vec<BvhNode>;
        let (triangle_refs, nodes): (&[TriangleRef], &[u8]) = match structure {
            Structure::Brute(brute) => (&brute.triangle_refs, &[]),
            Structure::Grid(grid) => (&grid.triangle_refs, bytes(&grid.cells)),
            Structure::KdTree(tree) => (&tree.triangle_refs, bytes(&tree.nodes)),
            Structure::Bvh(bvh) => {
                // One word says where a node leads, so that kernels need not read two
                packed = bvh.nodes.iter().map(|node| BvhNode { first: node.reference(), ..*node }).collect();
                (&bvh.triangle_refs, bytes(&packed))
            }
        };
        let triangle_materials: Vec<u32> = scene.triangles.iter().map(|t| t.material).collect();
        let size = |bytes: &[u8]| bytes.len() as u64;
        let inputs = [
            ("the vertices", bytes(&scene.vertices), FOUR_WORDS),
            ("the structure's triangle references", bytes(triangle_refs), FOUR_WORDS),
            ("the structure's nodes or cells", nodes, node_format(method.traversal)),
        ];
        let textures = match method.fetch {
            Fetch::Auto => {
                self.software_threads() > 0
                    && inputs.iter().all(|(_, contents, format)| self.fits_texture(contents, *format))
            }
            Fetch::Buffers => false,
            Fetch::Textures => true,
        };
        let structure_bytes = size(nodes) + size(bytes(triangle_refs));
        let [vertices, triangle_refs, nodes] =
            inputs.map(|(what, contents, format)| self.words(what, contents, format, textures));
        let uploaded = Uploaded {
            vertices: vertices?,
            triangle_refs: triangle_refs?,
            nodes: nodes?,
            textures,
            materials: self.storage("the materials", &scene.materials)?,
            triangle_materials: self.storage("the triangles' materials", &triangle_materials)?,
            structure: self.filled(
                "the structure's constants",
                bytemuck::bytes_of(&structure_uniform(structure)),
                wgpu::BufferUsages::UNIFORM,
            )?,
            geometry_bytes: size(bytes(&scene.vertices))
                + size(bytes(&scene.materials))
                + size(bytes(&triangle_materials)),
            structure_bytes,
        };
        self.check()?;
        Ok(uploaded)
    }
}

fn bytes<T: Pod>(contents: &[T]) -> &[u8] {
    bytemuck::cast_slice(contents)
}

fn structure_uniform(structure: &Structure) -> StructureUniform {
    let (bounds, triangle_refs) = match structure {
        Structure::Brute(s) => (s.bounds, &s.triangle_refs),
        Structure::Grid(s) => (s.bounds, &s.triangle_refs),
        Structure::KdTree(s) => (s.bounds, &s.triangle_refs),
        Structure::Bvh(s) => (s.bounds, &s.triangle_refs),
    };
    // An empty box is infinite the wrong way round; WGSL may assume that nothing is
    let bounds = if bounds.is_empty() { Aabb { min: Vec3::ONE, max: Vec3::NEG_ONE } } else { bounds };
    let (resolution, cell_size) = match structure {
        Structure::Grid(grid) => (grid.resolution, grid.cell_size),
        _ => ([1; 3], 1.0),
    };
    StructureUniform {
        bounds_min: bounds.min,
        cell_size,
        bounds_max: bounds.max,
        triangle_refs: triangle_refs.len() as u32,
        resolution,
        pad: 0,
        octants: octants(resolution),
    }
}
