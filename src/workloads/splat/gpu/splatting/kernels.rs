//! Kernel variants that bring photons to clusters and samples.

use crate::device::vulkan::{Binding, BindingKind};
use crate::device::{Constants, Source, assemble};
use crate::error::{Error, Result};
use crate::math;
use crate::workloads::kernel_files::FILES;
use crate::workloads::splat::clusters::NONE;
use crate::workloads::splat::clusters::setting::{ClusterSetting, HierarchyBy, Normals, Unique};
use crate::workloads::splat::estimate::BLOCK;
use crate::workloads::splat::gpu::{GROUP_SIZE, Variant};
use crate::workloads::splat::setting::{EstimateKernel, Weight};
use crate::workloads::splat::splatting::buckets::{LANES, WORDS};
use crate::workloads::splat::splatting::setting::{Atomics, Share};
use BindingKind::{MovingUniform, Read, ReadWrite, Uniform};

/// What photons find clusters by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finder {
    /// Nodes, and a table of identifiers by key.
    Keys,
    /// Nodes, and bits of keys.
    Bits,
    /// All clusters in turn.
    All,
}

/// How photons find clusters, and what keys say of normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Walk {
    /// Of clusters.
    pub finder: Finder,
    /// True if clusters whose normals face away are left out.
    pub normals: bool,
}

impl Walk {
    /// That of a setting.
    pub fn new(setting: &ClusterSetting) -> Walk {
        let finder = match (setting.hierarchy, setting.unique) {
            (HierarchyBy::None, _) => Finder::All,
            (_, Unique::Bits) => Finder::Bits,
            _ => Finder::Keys,
        };
        Walk { finder, normals: setting.normals != Normals::Off }
    }
}

/// What a photon does where it is near.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// It is counted.
    Count,
    /// It is listed.
    Fill,
    /// Its flux is added.
    Add(Atomics, Share, EstimateKernel),
}

/// A kernel of splatting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // each is described by its file
pub enum Kernel {
    PhotonGroups,
    Needs,
    ClearCounts,
    /// Of clusters or of nodes.
    ClearWords {
        nodes: bool,
    },
    Splat(Walk, Action),
    Scale,
    Order,
    PerSample(EstimateKernel, Weight),
    Tasks,
    Queue(EstimateKernel, Weight),
    /// Of whole numbers or floats, of clusters or of nodes.
    ReadBuckets {
        fixed: bool,
        nodes: bool,
    },
    Blur,
    Tiled(EstimateKernel, Weight),
}

impl Kernel {
    /// Every variant.
    pub fn all() -> Vec<Kernel> {
        use Kernel::*;
        let mut all = vec![PhotonGroups, Needs, ClearCounts, Scale, Order, Tasks, Blur];
        let both = [false, true];
        all.extend(both.map(|nodes| ClearWords { nodes }));
        all.extend(both.iter().flat_map(|&fixed| both.map(|nodes| ReadBuckets { fixed, nodes })));
        let kernels = [EstimateKernel::Epanechnikov, EstimateKernel::Constant];
        for kernel in kernels {
            for weight in [Weight::Side, Weight::Cosine] {
                all.extend([PerSample(kernel, weight), Queue(kernel, weight), Tiled(kernel, weight)]);
            }
        }
        let mut actions = vec![Action::Count, Action::Fill];
        for atomics in [Atomics::Fixed, Atomics::Exchange, Atomics::Float] {
            actions.push(Action::Add(atomics, Share::All, EstimateKernel::default()));
            actions.extend(kernels.map(|kernel| Action::Add(atomics, Share::Centre, kernel)));
        }
        for finder in [Finder::Keys, Finder::Bits, Finder::All] {
            for normals in both {
                all.extend(actions.iter().map(|&action| Splat(Walk { finder, normals }, action)));
            }
        }
        all
    }

    fn file(self) -> &'static str {
        match self {
            Kernel::PhotonGroups => "splat/splatting/photon_groups.wgsl",
            Kernel::Needs => "splat/splatting/needs.wgsl",
            Kernel::ClearCounts => "splat/splatting/clear_counts.wgsl",
            Kernel::ClearWords { .. } => "splat/splatting/clear_words.wgsl",
            Kernel::Splat(..) => "splat/splatting/splat.wgsl",
            Kernel::Scale => "splat/splatting/scale.wgsl",
            Kernel::Order => "splat/splatting/order.wgsl",
            Kernel::PerSample(..) => "splat/splatting/per_sample.wgsl",
            Kernel::Tasks => "splat/splatting/tasks.wgsl",
            Kernel::Queue(..) => "splat/splatting/queue.wgsl",
            Kernel::ReadBuckets { .. } => "splat/splatting/read_buckets.wgsl",
            Kernel::Blur => "splat/splatting/blur.wgsl",
            Kernel::Tiled(..) => "splat/splatting/tiled.wgsl",
        }
    }

    fn options(self) -> Vec<&'static str> {
        let of_kernel = |kernel| if kernel == EstimateKernel::Constant { "constant" } else { "epanechnikov" };
        let of_nodes = |nodes| if nodes { "nodes" } else { "clusters" };
        match self {
            Kernel::PerSample(kernel, weight) | Kernel::Queue(kernel, weight) | Kernel::Tiled(kernel, weight) => {
                vec![of_kernel(kernel), if weight == Weight::Cosine { "cosine" } else { "side" }]
            }
            Kernel::ClearWords { nodes } => vec![of_nodes(nodes)],
            Kernel::ReadBuckets { fixed, nodes } => vec![if fixed { "fixed" } else { "floats" }, of_nodes(nodes)],
            Kernel::Splat(Walk { finder, normals }, action) => {
                let mut options = match action {
                    Action::Count => vec!["count"],
                    Action::Fill => vec!["fill"],
                    Action::Add(atomics, share, kernel) => {
                        let mut options = vec![match atomics {
                            Atomics::Fixed => "fixed",
                            Atomics::Exchange => "exchange",
                            Atomics::Float => "float",
                        }];
                        options.extend((share == Share::Centre).then(|| of_kernel(kernel)));
                        options
                    }
                };
                options.push(match finder {
                    Finder::Keys => "keys",
                    Finder::Bits => "bits",
                    Finder::All => "all",
                });
                options.extend(normals.then_some("normals"));
                options
            }
            _ => Vec::new(),
        }
    }

    /// The files of its slots.
    fn slots(self) -> Vec<(&'static str, &'static str)> {
        let mut slots = vec![("intersect", "trace/intersect/watertight.wgsl")];
        let Kernel::Splat(walk, action) = self else { return slots };
        slots.push(match walk.finder {
            Finder::All => ("walk", "splat/splatting/walk_all.wgsl"),
            _ => ("walk", "splat/splatting/walk_nodes.wgsl"),
        });
        slots.push(match action {
            Action::Count => ("visit", "splat/splatting/count.wgsl"),
            Action::Fill => ("visit", "splat/splatting/fill.wgsl"),
            Action::Add(..) => ("visit", "splat/splatting/buckets.wgsl"),
        });
        if let Action::Add(atomics, ..) = action {
            slots.push(match atomics {
                Atomics::Fixed => ("add", "splat/splatting/add_fixed.wgsl"),
                Atomics::Exchange => ("add", "splat/splatting/add_exchange.wgsl"),
                Atomics::Float => ("add", "splat/splatting/add_float.wgsl"),
            });
        }
        slots
    }

    fn constants(self) -> Constants {
        let mut constants = Constants::default();
        constants.unsigned("GROUP_SIZE", GROUP_SIZE);
        constants.unsigned("BLOCK", BLOCK as u32);
        constants.unsigned("LANES", LANES as u32);
        constants.unsigned("BUCKET_WORDS", WORDS as u32);
        constants.float("MIN_POSITIVE", f32::MIN_POSITIVE);
        constants.float("INVERSE_OF_ZERO", math::INVERSE_OF_ZERO);
        constants.float("PLANE_SHIFT", math::PLANE_SHIFT);
        constants.float("PLANE_SHIFT_MIN", math::PLANE_SHIFT_MIN);
        constants.float("SLACK", math::SLACK);
        constants.flag("SOFTWARE", false);
        match self {
            Kernel::Splat(Walk { finder, normals }, action) => {
                constants.flag("NORMALS", normals);
                constants.flag("BITS", finder == Finder::Bits);
                // The number of the first binding of the action
                constants.unsigned("ACTION", if finder == Finder::All { 8 } else { 9 });
                if let Action::Add(_, share, kernel) = action {
                    constants.flag("CENTRE", share == Share::Centre);
                    constants.flag("CONSTANT_KERNEL", kernel == EstimateKernel::Constant);
                }
            }
            Kernel::PerSample(kernel, weight) | Kernel::Queue(kernel, weight) | Kernel::Tiled(kernel, weight) => {
                constants.flag("CONSTANT_KERNEL", kernel == EstimateKernel::Constant);
                constants.flag("COSINE_WEIGHT", weight == Weight::Cosine);
                constants.unsigned("NONE", NONE);
            }
            Kernel::Tasks => constants.unsigned("NONE", NONE),
            Kernel::ReadBuckets { fixed, nodes } => {
                constants.flag("FIXED", fixed);
                constants.flag("NODES", nodes);
                constants.unsigned("NONE", NONE);
            }
            Kernel::ClearWords { nodes } => constants.flag("NODES", nodes),
            _ => {}
        }
        constants
    }
}

impl Variant for Kernel {
    /// Such as `splat fill bits normals`.
    fn label(&self) -> String {
        let name = self.file().trim_start_matches("splat/splatting/").trim_end_matches(".wgsl");
        let mut words = vec![name];
        words.extend(self.options());
        words.join(" ")
    }

    fn assemble(&self) -> Result<Source> {
        assemble(FILES, self.file(), &self.slots(), self.constants()).map_err(Error::Device)
    }

    fn layout(&self) -> Vec<Binding> {
        let mut kinds = match *self {
            Kernel::PhotonGroups | Kernel::Needs => vec![Uniform, Read, ReadWrite],
            Kernel::ClearCounts => vec![Uniform, ReadWrite],
            Kernel::ClearWords { .. } | Kernel::Scale => vec![Uniform, Read, ReadWrite],
            Kernel::Order => vec![Uniform, Read, Read, ReadWrite],
            Kernel::Splat(Walk { finder: Finder::All, .. }, _) => [&[Uniform][..], &[Read; 7]].concat(),
            Kernel::Splat(..) => [&[Uniform][..], &[Read; 8]].concat(),
            Kernel::PerSample(..) => [&[Uniform][..], &[Read; 8], &[ReadWrite]].concat(),
            Kernel::Tasks => vec![Uniform, Read, Read, ReadWrite, ReadWrite, ReadWrite],
            Kernel::Queue(..) => [&[Uniform][..], &[Read; 9], &[ReadWrite; 2]].concat(),
            Kernel::ReadBuckets { .. } => [&[Uniform][..], &[Read; 5], &[ReadWrite]].concat(),
            Kernel::Blur => vec![Uniform, Read, Read, Read, ReadWrite],
            Kernel::Tiled(..) => [&[MovingUniform, Uniform][..], &[Read; 6], &[ReadWrite]].concat(),
        };
        if let Kernel::Splat(_, action) = *self {
            kinds.extend_from_slice(match action {
                Action::Count => &[ReadWrite],
                Action::Fill => &[ReadWrite, Read, ReadWrite],
                Action::Add(..) => &[Read, ReadWrite],
            });
        }
        (0..).zip(kinds).map(|(number, kind)| Binding::new(number, kind)).collect()
    }
}

/// Every variant: its name and its text.
///
/// # Errors
/// [`Error::Device`] for an include that does not exist (a mistake in `kernels/`).
pub fn kernels() -> Result<Vec<(String, Source)>> {
    Kernel::all().into_iter().map(|kernel| Ok((kernel.label(), kernel.assemble()?))).collect()
}
