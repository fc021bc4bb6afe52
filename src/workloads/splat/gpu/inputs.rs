//! What passes read of the scene.

use super::uniforms::{Facet, Source};
use crate::device::VulkanDevice;
use crate::device::vulkan::Buffer;
use crate::error::Result;
use crate::workloads::splat::direct::highlight_of;
use crate::workloads::splat::lit::{LightShare, LitScene};
use crate::workloads::splat::setting::Falloff;
use glam::Vec4;

const SCENE: &str = "use a smaller scene";

/// Buffers that no pass writes.
pub(super) struct Inputs {
    /// Holds [`Facet`] of each triangle.
    pub facets: Buffer,
    /// Holds [`Source`] of each light.
    pub sources: Buffer,
    /// Holds each triangle's highlight, with the source's falloff only.
    pub highlights: Option<Buffer>,
    /// Each of the three has a name and a size.
    pub bytes: [(&'static str, u64); 3],
}

impl Inputs {
    /// Uploads what a frame needs of a scene.
    ///
    /// # Errors
    /// [`crate::Error::Refused`] for what the device cannot bind, and the device's.
    pub fn new(device: &VulkanDevice, lit: &LitScene, shares: &[LightShare], falloff: Falloff) -> Result<Inputs> {
        let (scene, triangles) = (&lit.scene, lit.scene.triangles.len());
        let with_highlights = falloff == Falloff::Source;
        let bytes = [
            ("triangles with albedo", (triangles * size_of::<Facet>()) as u64),
            ("lights", size_of_val(shares) as u64 / size_of::<LightShare>() as u64 * size_of::<Source>() as u64),
            ("highlights", if with_highlights { (triangles * size_of::<Vec4>()) as u64 } else { 0 }),
        ];
        for (what, bytes) in bytes {
            device.check_size(&format!("the {what}"), bytes, SCENE)?;
        }
        let facet = |index: usize| {
            let corners = scene.corners(index as u32);
            let albedo = scene.materials[scene.triangles[index].material as usize].diffuse;
            let [red, green, blue] = [0, 1, 2].map(|i| corners[i].extend(albedo[i]));
            Facet { red, green, blue }
        };
        let facets: Vec<Facet> = (0..triangles).map(facet).collect();
        let source = |share: &LightShare| Source {
            position: lit.lights[share.light].position,
            first_path: share.first_path,
            path_flux: share.path_flux,
            paths: share.paths,
        };
        let sources: Vec<Source> = shares.iter().map(source).collect();
        let highlight = |triangle: &crate::scene::Triangle| {
            let (specular, exponent) = highlight_of(&scene.materials[triangle.material as usize]);
            specular.extend(exponent as f32) // exact below 2^24
        };
        let highlights = with_highlights.then(|| scene.triangles.iter().map(highlight).collect::<Vec<Vec4>>());
        Ok(Inputs {
            facets: device.storage("the triangles with albedo", &facets)?,
            sources: device.storage("the lights", &sources)?,
            highlights: highlights.map(|all| device.storage("the highlights", &all)).transpose()?,
            bytes,
        })
    }
}
