//! How rays are traced: the traversal, which rays there are, and how the device is used. Kernels and their twins take
//! the same [`Method`].

use crate::device::DeviceInfo;
use crate::workloads::trace::algorithm::{Agreement, Parameters, Traversal};
use crate::workloads::trace::intersect::TriangleTest;

/// Start and end of a shadow ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ShadowRays {
    /// From the light towards the point.
    #[default]
    FromLight,
    /// From the point towards the light.
    ToLight,
}

/// Which primary rays a frame has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Pattern {
    /// The camera's.
    #[default]
    Image,
    /// Four different ones only: each work-group has one of them for all its pixels, and squares of 2 x 2 work-groups
    /// repeat over the image. For the experiment of the thesis's figure 5.3.
    Four,
}

/// How the passes of a frame follow reflections.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Reflections {
    /// One pass: each invocation follows the path of its pixel to its end.
    #[default]
    Fused,
    /// One pass for all primary rays, then one for each reflection over a list of the pixels that reflect.
    Staged,
}

/// Which pixels an invocation renders; ignored by CPU twins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Threads {
    /// One.
    #[default]
    PerPixel,
    /// One of each group of pixels that its work-group takes, until none are left.
    Persistent,
}

/// Where a kernel reads the scene and the structure from; ignored by CPU twins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Fetch {
    /// Textures where the device computes on the CPU and they hold everything, buffers elsewhere.
    #[default]
    Auto,
    /// Storage buffers.
    Buffers,
    /// Textures whose texels are plain words.
    Textures,
}

/// Where a kernel reads the corners of triangles from; ignored by CPU twins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TriangleLayout {
    /// In leaf order where the traversal takes it, the device computes on the CPU and textures hold it; indexed
    /// elsewhere.
    #[default]
    Auto,
    /// A reference to three vertices.
    Indexed,
    /// 48 bytes more for each triangle reference: its corners, in the order of the references.
    LeafOrder,
}

/// Pixels of a work-group: both powers of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Group {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Group {
    /// The shape in all measurements of the thesis.
    pub const SQUARE: Group = Group { width: 8, height: 8 };

    /// Invocations.
    pub fn size(self) -> u32 {
        self.width * self.height
    }

    /// Place of an invocation in its group, column and row. Consecutive invocations lie in squares (Morton order) as
    /// far as the shape allows, so that those that share an instruction stream have neighbouring rays in both
    /// directions.
    pub fn place(self, index: u32) -> (u32, u32) {
        let (mut x, mut y, mut from) = (0, 0, 0);
        for bit in 0.. {
            if (1 << bit) >= self.width.max(self.height) {
                break;
            }
            for (side, place) in [(self.width, &mut x), (self.height, &mut y)] {
                if (1 << bit) < side {
                    *place |= (index >> from & 1) << bit;
                    from += 1;
                }
            }
        }
        (x, y)
    }
}

/// How rays are traced, apart from the ray configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Method {
    /// How the structure is walked.
    pub traversal: &'static Traversal,
    /// What the traversal is specialised by.
    pub parameters: Parameters,
    /// Shadow rays' direction.
    pub shadows: ShadowRays,
    /// Primary rays.
    pub pattern: Pattern,
    /// Ray/triangle test.
    pub intersect: TriangleTest,
    /// Passes of a frame.
    pub reflections: Reflections,
    /// Pixels of an invocation, in frames of one pass.
    pub threads: Threads,
    /// A work-group's pixels.
    pub group: Group,
    /// The image is split into so many tiles on each side, which are rendered one after another.
    pub tiles: u32,
    /// Compile the kernel with bounds checks and loop bounds.
    pub checked: bool,
    /// Where it reads from.
    pub fetch: Fetch,
    /// Where it reads corners of triangles from.
    pub triangles: TriangleLayout,
}

/// What of a method decides which rays there are and what they hit: methods that agree in it make the same image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rays {
    /// Primary rays.
    pub pattern: Pattern,
    /// Shadow rays.
    pub shadows: ShadowRays,
    /// Ray/triangle test.
    pub intersect: TriangleTest,
    /// A work-group's pixels, where the pattern depends on it.
    pub group: Option<Group>,
}

impl Method {
    /// The same rays by another traversal.
    pub fn by(self, traversal: &'static Traversal, parameters: Parameters) -> Method {
        Method { traversal, parameters, ..self }
    }

    /// True if a frame with this many reflections takes several passes.
    pub fn is_staged(self, bounces: u32) -> bool {
        self.reflections == Reflections::Staged && bounces > 0
    }

    /// True if a device must agree with the reference to the bit.
    pub fn is_exact_on(self, device: &DeviceInfo) -> bool {
        self.traversal.agreement == Agreement::Exact && device.agrees_with_twins()
    }

    /// Which rays it traces.
    pub fn rays(self) -> Rays {
        let group = (self.pattern == Pattern::Four).then_some(self.group);
        Rays { pattern: self.pattern, shadows: self.shadows, intersect: self.intersect, group }
    }
}
