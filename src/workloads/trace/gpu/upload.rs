//! Scene and structure on a device, and the ledger of their bytes.

use super::shared::LeafTriangle;
use crate::device::vulkan::{AccelerationStructure, Buffer, ReadBuffer, Texel};
use crate::device::{Feature, VulkanDevice};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::method::{Fetch, TriangleLayout};
use crate::workloads::trace::{Method, Structure, TriangleRef};
use bytemuck::Pod;
use std::time::Duration;

/// One scene and one structure on a device.
pub(super) struct Uploaded {
    pub vertices: ReadBuffer,
    pub triangle_refs: ReadBuffer,
    pub nodes: ReadBuffer,
    /// Where triangles are read in leaf order: [`LeafTriangle`] by triangle reference.
    pub corners: Option<ReadBuffer>,
    pub materials: ReadBuffer,
    /// Four a texel.
    pub triangle_materials: ReadBuffer,
    /// All above are textures.
    pub textures: bool,
    pub structure: Buffer,
    /// The driver's own structure, for traversals that query it.
    pub driver_tree: Option<AccelerationStructure>,
    /// Bytes of vertices, materials and the triangles' materials.
    pub geometry_bytes: u64,
    /// Bytes of nodes (or cells) and triangle references.
    pub structure_bytes: u64,
    /// Bytes of the corners in leaf order; 0 where there are none.
    pub leaf_order_bytes: u64,
    /// Until these were on the device, by the host's clock.
    pub structure_time: Duration,
}

const TOO_LARGE: &str = "use a smaller scene, a structure with fewer references, or another device";

impl Uploaded {
    /// Uploads a scene and a structure for a method.
    pub fn new(device: &VulkanDevice, scene: &Scene, structure: &dyn Structure, method: Method) -> Result<Uploaded> {
        let (triangle_refs, nodes) = (structure.triangle_refs(), structure.nodes());
        let triangle_materials = materials_by_triangle(scene);
        let size = |bytes: &[u8]| bytes.len() as u64;
        let corner_bytes = triangle_refs.len() * size_of::<LeafTriangle>();
        let inputs = [
            ("the vertices", bytes(&scene.vertices), Texel::Bytes16),
            ("the structure's triangle references", bytes(triangle_refs), Texel::Bytes16),
            ("the structure's nodes or cells", &*nodes, structure.kind().node_texel),
            ("the materials", bytes(&scene.materials), Texel::Bytes16),
            ("the triangles' materials", bytes(&triangle_materials), Texel::Bytes16),
        ];
        let software = device.info().software_threads() > 0;
        let corners_asked = method.traversal.leaf_order && method.triangles == TriangleLayout::LeafOrder;
        let corners_fit = device.fits_texture(corner_bytes, Texel::Bytes16);
        let textures = match method.fetch {
            Fetch::Auto => {
                software
                    && inputs.iter().all(|(_, contents, texel)| device.fits_texture(contents.len(), *texel))
                    && (corners_fit || !corners_asked)
            }
            Fetch::Buffers => false,
            Fetch::Textures => true,
        };
        let takes_corners = match method.triangles {
            TriangleLayout::Auto => method.traversal.leaf_order && software && textures && corners_fit,
            TriangleLayout::Indexed => false,
            TriangleLayout::LeafOrder => corners_asked,
        };
        let corners = match takes_corners {
            true => {
                let what = "the corners in leaf order";
                check_size(device, what, corner_bytes, Texel::Bytes16, textures)?;
                Some(device.time_upload(|| {
                    input(device, what, bytes(&in_leaf_order(scene, structure)), Texel::Bytes16, textures)
                })?)
            }
            false => None,
        };
        let structure_bytes = size(&nodes) + size(bytes(triangle_refs));
        let leaf_order_bytes = if corners.is_some() { corner_bytes as u64 } else { 0 };
        let [vertices, triangle_refs, nodes, materials, of_triangles] =
            inputs.map(|(what, contents, texel)| device.time_upload(|| input(device, what, contents, texel, textures)));
        let ((triangle_refs, refs_time), (nodes, nodes_time)) = (triangle_refs?, nodes?);
        let (corners, corners_time) = corners.unzip();
        let mut uniform = structure.uniform();
        uniform.resize(uniform.len().next_multiple_of(16).max(16), 0);
        let uploaded = Uploaded {
            vertices: vertices?.0,
            triangle_refs,
            nodes,
            corners,
            materials: materials?.0,
            triangle_materials: of_triangles?.0,
            textures,
            structure: device.uniform("the structure's constants", &uniform)?,
            driver_tree: method
                .traversal
                .needs
                .has(Feature::RayQuery)
                .then(|| driver_tree(device, scene, structure))
                .transpose()?,
            geometry_bytes: size(bytes(&scene.vertices))
                + size(bytes(&scene.materials))
                + size_of::<u32>() as u64 * scene.triangles.len() as u64,
            structure_bytes,
            leaf_order_bytes,
            structure_time: refs_time + nodes_time + corners_time.unwrap_or_default(),
        };
        device.check()?;
        Ok(uploaded)
    }

    /// Further input in the kind of memory that this has, in texels of 16 bytes.
    pub fn input(&self, device: &VulkanDevice, what: &str, contents: &[u8]) -> Result<ReadBuffer> {
        input(device, what, contents, Texel::Bytes16, self.textures)
    }
}

/// The material of each triangle, in whole texels.
fn materials_by_triangle(scene: &Scene) -> Vec<u32> {
    let mut materials: Vec<u32> = scene.triangles.iter().map(|t| t.material).collect();
    materials.resize(materials.len().next_multiple_of(4), 0);
    materials
}

/// The driver's structure over the triangle references, whose order it gets.
fn driver_tree(device: &VulkanDevice, scene: &Scene, structure: &dyn Structure) -> Result<AccelerationStructure> {
    let positions: Vec<[f32; 3]> = scene.vertices.iter().map(|vertex| vertex.position_a().to_array()).collect();
    let indices: Vec<[u32; 3]> = structure.triangle_refs().iter().map(|triangle_ref| triangle_ref.vertices).collect();
    device.acceleration_structure("the driver's structure", &positions, &indices)
}

fn in_leaf_order(scene: &Scene, structure: &dyn Structure) -> Vec<LeafTriangle> {
    let of_reference = |r: &TriangleRef| {
        let [a, b, c] = r.vertices.map(|vertex| scene.vertices[vertex as usize].position);
        LeafTriangle { a, triangle: r.triangle, b, material: scene.triangles[r.triangle as usize].material, c, pad: 0 }
    };
    structure.triangle_refs().iter().map(of_reference).collect()
}

fn input(device: &VulkanDevice, what: &str, contents: &[u8], texel: Texel, textures: bool) -> Result<ReadBuffer> {
    check_size(device, what, contents.len(), texel, textures)?;
    match textures {
        true => device.texture(what, contents, texel).map(ReadBuffer::Texture),
        false => device.storage(what, contents).map(ReadBuffer::Buffer),
    }
}

fn check_size(device: &VulkanDevice, what: &str, bytes: usize, texel: Texel, textures: bool) -> Result<()> {
    match textures {
        true => device.check_texture(what, bytes, texel, "use fetch=buffers, or a smaller scene"),
        false => device.check_size(what, bytes as u64, TOO_LARGE),
    }
}

fn bytes<T: Pod>(contents: &[T]) -> &[u8] {
    bytemuck::cast_slice(contents)
}
