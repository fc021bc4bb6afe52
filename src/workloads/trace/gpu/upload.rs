//! Scene and structure on a device, and the ledger of their bytes.

use crate::device::VulkanDevice;
use crate::device::vulkan::{Buffer, ReadBuffer, Texel, Texture};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::method::Fetch;
use crate::workloads::trace::{Method, Structure};
use bytemuck::Pod;
use std::time::Duration;

/// One scene and one structure on a device.
pub(super) struct Uploaded {
    pub vertices: ReadBuffer,
    pub triangle_refs: ReadBuffer,
    pub nodes: ReadBuffer,
    /// The three above are textures.
    pub textures: bool,
    pub materials: Buffer,
    pub triangle_materials: Buffer,
    pub structure: Buffer,
    /// Bytes of vertices, materials and the triangles' materials.
    pub geometry_bytes: u64,
    /// Bytes of nodes (or cells) and triangle references.
    pub structure_bytes: u64,
    /// Until these were on the device, by the host's clock.
    pub structure_time: Duration,
}

const TOO_LARGE: &str = "use a smaller scene, a structure with fewer references, or another device";

impl Uploaded {
    /// Uploads a scene and a structure for a method.
    pub fn new(device: &VulkanDevice, scene: &Scene, structure: &dyn Structure, method: Method) -> Result<Uploaded> {
        let (triangle_refs, nodes) = (structure.triangle_refs(), structure.nodes());
        let triangle_materials: Vec<u32> = scene.triangles.iter().map(|t| t.material).collect();
        let size = |bytes: &[u8]| bytes.len() as u64;
        let inputs = [
            ("the vertices", bytes(&scene.vertices), Texel::Bytes16),
            ("the structure's triangle references", bytes(triangle_refs), Texel::Bytes16),
            ("the structure's nodes or cells", &*nodes, structure.kind().node_texel),
        ];
        let textures = match method.fetch {
            Fetch::Auto => {
                device.info().software_threads() > 0
                    && inputs.iter().all(|(_, contents, texel)| device.fits_texture(contents.len(), *texel))
            }
            Fetch::Buffers => false,
            Fetch::Textures => true,
        };
        let structure_bytes = size(&nodes) + size(bytes(triangle_refs));
        let upload = |(what, contents, texel): (&str, &[u8], Texel)| match textures {
            true => texture(device, what, contents, texel).map(ReadBuffer::Texture),
            false => storage(device, what, contents).map(ReadBuffer::Buffer),
        };
        let [vertices, triangle_refs, nodes] = inputs.map(|input| device.time_upload(|| upload(input)));
        let (vertices, (triangle_refs, refs_time), (nodes, nodes_time)) = (vertices?.0, triangle_refs?, nodes?);
        let mut uniform = structure.uniform();
        uniform.resize(uniform.len().next_multiple_of(16).max(16), 0);
        let uploaded = Uploaded {
            vertices,
            triangle_refs,
            nodes,
            textures,
            materials: storage(device, "the materials", bytes(&scene.materials))?,
            triangle_materials: storage(device, "the triangles' materials", bytes(&triangle_materials))?,
            structure: device.uniform("the structure's constants", &uniform)?,
            geometry_bytes: size(bytes(&scene.vertices))
                + size(bytes(&scene.materials))
                + size(bytes(&triangle_materials)),
            structure_bytes,
            structure_time: refs_time + nodes_time,
        };
        device.check()?;
        Ok(uploaded)
    }
}

fn storage(device: &VulkanDevice, what: &str, contents: &[u8]) -> Result<Buffer> {
    device.check_size(what, contents.len() as u64, TOO_LARGE)?;
    device.storage(what, contents)
}

fn texture(device: &VulkanDevice, what: &str, contents: &[u8], texel: Texel) -> Result<Texture> {
    device.check_texture(what, contents.len(), texel, "use fetch=buffers, or a smaller scene")?;
    device.texture(what, contents, texel)
}

fn bytes<T: Pod>(contents: &[T]) -> &[u8] {
    bytemuck::cast_slice(contents)
}
