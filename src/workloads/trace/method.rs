//! How rays go through a built structure: the traversal, and all else that a kernel is specialised by beside the ray
//! configuration. Kernels and their twins take the same [`Method`].

use crate::workloads::trace::intersect::TriangleTest;

/// How a structure is walked; each is one file in `kernels/trace/STRUCTURE/` and its twin in [`crate::workloads::trace`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Traversal {
    /// Every triangle.
    Brute,
    /// Grid, 3D-DDA.
    Grid,
    /// Grid, 3D-DDA; the work-group shares out the triangle tests of all its rays.
    GridCoop,
    /// Grid, a packet that marches slice by slice.
    GridPacket,
    /// kd-tree without a full stack.
    KdTree(KdSearch),
    /// BVH, a packet with one shared stack.
    Bvh(Vote),
    /// BVH, one ray per invocation with a private stack.
    BvhStack,
}

impl Traversal {
    /// True where the rays of a work-group go together, so that its shape decides what is counted.
    pub fn is_cooperative(self) -> bool {
        matches!(self, Traversal::GridCoop | Traversal::GridPacket | Traversal::Bvh(_))
    }
}

/// What a ray does in a kd-tree after a leaf without a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct KdSearch {
    /// Entries of the short stack (Horn et al. 2007), at most [`MAX_SHORT_STACK`]; with 0 it restarts at once.
    pub stack: u32,
    /// Restart at the deepest node above which the ray never had to branch (Horn et al. 2007), not at the root (Foley
    /// and Sugerman 2005).
    pub pushdown: bool,
    /// Where the short stack lies: private memory instead of work-group memory.
    pub private: bool,
}

/// Most entries of a short stack.
pub const MAX_SHORT_STACK: u32 = 32;

impl KdSearch {
    /// The thesis's: four entries in work-group memory, and pushdown (SPEC section 3).
    pub const THESIS: KdSearch = KdSearch { stack: 4, pushdown: true, private: false };
}

/// Who votes on the order in which a packet visits two children (SPEC section 4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Vote {
    /// Rays that want a child: the thesis's correction.
    Corrected,
    /// All rays, also those that want neither child: they vote by which box begins first on their line (Günther et
    /// al. 2007).
    Original,
}

/// From where to where a shadow ray goes.
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

/// Where a kernel reads the scene and the structure from; a CPU twin does not care.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Fetch {
    /// What the device is good at: textures where it computes on the CPU and they hold everything, buffers elsewhere.
    #[default]
    Auto,
    /// Storage buffers.
    Buffers,
    /// Textures whose texels are plain words.
    Textures,
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
    /// What all measurements of the thesis have.
    pub const SQUARE: Group = Group { width: 8, height: 8 };

    /// Invocations.
    pub fn size(self) -> u32 {
        self.width * self.height
    }

    /// Place of an invocation in its group, column and row. Consecutive invocations lie in squares (Morton order) as far
    /// as the shape allows, so that those that share an instruction stream have neighbouring rays in both directions.
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

/// How rays are traced, beside the ray configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Method {
    /// How the structure is walked.
    pub traversal: Traversal,
    /// Shadow rays' direction.
    pub shadows: ShadowRays,
    /// Primary rays.
    pub pattern: Pattern,
    /// Ray/triangle test.
    pub intersect: TriangleTest,
    /// A work-group's pixels.
    pub group: Group,
    /// The image is split into so many tiles on each side, which are rendered one after another.
    pub tiles: u32,
    /// Compile the kernel with bounds checks and loop bounds.
    pub checked: bool,
    /// Where it reads from.
    pub fetch: Fetch,
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
    /// Which rays it traces.
    pub fn rays(self) -> Rays {
        let group = (self.pattern == Pattern::Four).then_some(self.group);
        Rays { pattern: self.pattern, shadows: self.shadows, intersect: self.intersect, group }
    }
}

impl From<Traversal> for Method {
    /// The traversal, and all else as the thesis measured it.
    fn from(traversal: Traversal) -> Method {
        Method {
            traversal,
            shadows: ShadowRays::default(),
            pattern: Pattern::default(),
            intersect: TriangleTest::default(),
            group: Group::SQUARE,
            tiles: 1,
            checked: false,
            fetch: Fetch::default(),
        }
    }
}
