//! How photons reach samples.

/// The order of photons in a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Order {
    /// As they arrive: it depends on timing.
    #[default]
    Any,
    /// Ascending: sums have the same bits in every frame.
    Sorted,
}

/// What an invocation of the estimate works on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tasks {
    /// A sample with the whole list of its cluster.
    #[default]
    Sample,
    /// One task after another of a queue: a sample with a block of its list.
    Queue,
}

/// How flux is added to a bucket.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Atomics {
    /// As a whole number: the sum has the same bits in any order.
    #[default]
    Fixed,
    /// As a float, by comparing and exchanging.
    Exchange,
    /// As a float, by the device's own operation.
    Float,
}

/// How much of a photon's flux a cluster gets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Share {
    /// All of it: the source's.
    #[default]
    All,
    /// Its kernel's value at the centre of the cluster's box.
    Centre,
}

/// Sums by direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BucketSetting {
    /// Of the sums.
    pub atomics: Atomics,
    /// Of photons.
    pub share: Share,
    /// Standard deviation of the blur that follows, in pixels, at most [`MAX_BLUR`]; 0 for none.
    pub blur: u32,
    /// The level that has the buckets: 1 to 4 for nodes, 5 for clusters.
    pub level: u32,
}

/// Widest blur.
pub const MAX_BLUR: u32 = 16;

impl BucketSetting {
    /// The source's.
    pub const DEFAULT: BucketSetting = BucketSetting { atomics: Atomics::Fixed, share: Share::All, blur: 0, level: 5 };
}

/// Which photons a sample gets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Gather {
    /// All of them.
    #[default]
    Reference,
    /// Those near the box of its tile, which every tile finds among all.
    Tiled,
    /// Those in the list of its cluster.
    PerSample {
        /// Of the list.
        order: Order,
        /// Of the estimate.
        tasks: Tasks,
    },
    /// The sums of its cluster.
    Buckets(BucketSetting),
}

impl Gather {
    /// True if the image is divided into tiles.
    pub fn has_tiles(self) -> bool {
        self != Gather::Reference
    }

    /// True if photons are put into lists.
    pub fn has_lists(self) -> bool {
        matches!(self, Gather::PerSample { .. })
    }

    /// True if it needs clusters.
    pub fn has_clusters(self) -> bool {
        matches!(self, Gather::PerSample { .. } | Gather::Buckets(_))
    }

    /// True if equal frames have equal bits: no sum depends on timing.
    pub fn is_repeatable(self) -> bool {
        match self {
            Gather::Reference | Gather::Tiled => true,
            Gather::PerSample { order, tasks } => order == Order::Sorted && tasks == Tasks::Sample,
            Gather::Buckets(BucketSetting { atomics, .. }) => atomics == Atomics::Fixed,
        }
    }
}
