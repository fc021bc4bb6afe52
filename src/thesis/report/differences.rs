//! What is not as it was in 2009 (SPEC section 12), and what that means for the numbers.

use super::html::escape;
use crate::thesis::data::Data;

/// What, and why.
const DIFFERENCES: [(&str, &str); 10] = [
    (
        "The interface",
        "Kernels were CUDA, here they are WGSL through wgpu and Vulkan. There is no constant memory for nodes \
         and triangles: they are read from storage buffers, through whatever caches a device has, or on software drivers \
         from textures.",
    ),
    (
        "Registers",
        "A compiler's register limit cannot be set through wgpu. Tables 5.7 and 5.8 have stand-ins that ask the same \
         question, how many threads fit on a processor: the shape of work-groups, and the memory of the kd-tree's stack.",
    ),
    (
        "Barriers",
        "WGSL demands uniform control flow at barriers. The packet's current node is made uniform explicitly, where CUDA \
         relied on all threads of a block taking the same way.",
    ),
    (
        "Checks",
        "wgpu can put bounds checks and loop limits into kernels. They are off unless a table says otherwise; CUDA had none.",
    ),
    (
        "Infinities",
        "WGSL lets an implementation assume that there are none. Directions along an axis are treated explicitly, and \
         intervals are made so that all structures find the same hit to the bit.",
    ),
    (
        "Verification",
        "Every configuration is compared with a reference before it is timed; one that disagrees has no number here. The \
         thesis does not say how its images were checked.",
    ),
    (
        "What a time is",
        "A frame's time is its median over several passes along the path, by the device's timestamps where there are any. \
         The thesis recorded single frames; its minimum and maximum therefore hold disturbances that ours do not.",
    ),
    (
        "Builders",
        "The kd-tree and the BVH are built on all cores unless --threads says otherwise, the grid on one; the thesis built \
         everything on one core. The constants of its builders were not printed: ours are one set for all scenes.",
    ),
    (
        "Cameras",
        "The framing of single objects and the walks through theatre, office and conference were not printed. Counts of \
         these scenes depend on the path that was chosen here; those of BART's scenes follow the path in their files.",
    ),
    (
        "Steps",
        "What the thesis counted as a step in a tree is not known. Ours are stated below tables 5.10 and 5.11, inner nodes, \
         leaves and stack entries are recorded apart, and --convention forms others.",
    ),
];

/// The list, and what this page's own devices add to it.
pub fn write(data: &Data) -> String {
    let mut entries: Vec<(String, String)> =
        DIFFERENCES.iter().map(|(what, why)| ((*what).to_owned(), (*why).to_owned())).collect();
    for device in data.devices.iter().filter(|d| d.is_software()) {
        entries.push((
            device.label.clone(),
            "Computes on the CPU. Barriers are dear there and divergence is cheap, the reverse of a GPU: packets look worse \
             and single rays better than they are. Its counts are as good as any device's."
                .into(),
        ));
    }
    for device in data.devices.iter().filter(|d| d.checked) {
        entries.push((device.label.clone(), "Measured with wgpu's checks on, at least in part.".into()));
    }
    let list: String =
        entries.iter().map(|(what, why)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(what), escape(why))).collect();
    format!("<dl>\n{list}</dl>\n")
}
