//! Options of `--structure name:key=value,...`: what they take, and what they are about.

use super::algorithm::Agreement;
use super::method::Threads;
use super::selection::Selection;

/// An option of an algorithm.
#[derive(Clone, Copy, Debug)]
pub struct OptionInfo {
    /// What it is about.
    pub axis: Axis,
    /// Left of `=`.
    pub key: &'static str,
    /// Its value if it is not given.
    pub default: &'static str,
    /// One line for `--help`.
    pub meaning: &'static str,
    pub(crate) kind: Kind,
    /// Says why the option has no effect in a selection; giving it is an error then.
    pub(crate) idle: Option<fn(&Selection) -> Option<String>>,
}

/// What an option is about: what is compared with what follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The structure.
    Build,
    /// The way through it.
    Traversal,
    /// Which rays there are, and what they hit.
    Rays,
    /// How the device is used: it changes times only.
    Device,
}

impl Axis {
    /// Name of the axis of a row that holds such options.
    pub const fn name(self) -> &'static str {
        match self {
            Axis::Build => "build",
            Axis::Traversal => "traversal",
            Axis::Rays => "ray_options",
            Axis::Device => "device_options",
        }
    }
}

impl OptionInfo {
    pub(crate) const fn new(
        axis: Axis,
        key: &'static str,
        default: &'static str,
        meaning: &'static str,
        kind: Kind,
    ) -> OptionInfo {
        OptionInfo { axis, key, default, meaning, kind, idle: None }
    }

    /// The same option, with no effect where `idle` says why.
    pub(crate) const fn idle_if(self, idle: fn(&Selection) -> Option<String>) -> OptionInfo {
        OptionInfo { idle: Some(idle), ..self }
    }

    /// Values that lead through other code: all words, or the ends of a range.
    pub(crate) fn examples(&self) -> Vec<String> {
        match self.kind {
            Kind::Count(from, to) | Kind::CountOrAuto(from, to) => vec![from.to_string(), to.to_string()],
            Kind::Number(from, to) => vec![from.to_string(), to.to_string()],
            Kind::Word(words) => words.iter().map(|word| word.to_string()).collect(),
        }
    }

    /// What its value may be, in words: a list, or a range.
    pub fn values(&self) -> String {
        match self.kind {
            Kind::Count(from, to) => format!("{from} to {to}"),
            Kind::CountOrAuto(from, to) => format!("auto, or {from} to {to}"),
            Kind::Number(from, to) => format!("a number from {from} to {to}"),
            Kind::Word(words) => words.join(", "),
        }
    }
}

/// What an option's value may be.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// A whole number from .. to.
    Count(u32, u32),
    /// A whole number from .. to, or `auto`.
    CountOrAuto(u32, u32),
    /// A number from .. to.
    Number(f64, f64),
    /// One of these words.
    Word(&'static [&'static str]),
}

/// Shapes of a work-group that a packet can have, which shares bits of one word.
pub(crate) const PACKET: OptionInfo = OptionInfo::new(
    Axis::Traversal,
    "packet",
    "8x8",
    "pixels of a packet, which is a work-group",
    Kind::Word(&["8x8", "8x4", "4x8", "4x4", "16x4", "4x16"]),
);

/// Shapes of a work-group whose rays do not wait for each other.
pub(crate) const GROUP: OptionInfo = OptionInfo::new(
    Axis::Device,
    "group",
    "8x8",
    "pixels of a work-group",
    Kind::Word(&["8x8", "4x4", "8x4", "4x8", "16x4", "4x16", "32x1", "64x1", "16x8", "16x16", "32x8"]),
);

/// Options that every algorithm has, after its own.
pub const COMMON_OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(
        Axis::Rays,
        "shadows",
        "from-light",
        "direction of shadow rays",
        Kind::Word(&["from-light", "to-light"]),
    ),
    OptionInfo::new(
        Axis::Device,
        "tiles",
        "1",
        "render the image in N x N tiles one after another",
        Kind::Count(1, 64),
    ),
    OptionInfo::new(
        Axis::Rays,
        "pattern",
        "image",
        "primary rays: the camera's, or only four different ones, one per work-group",
        Kind::Word(&["image", "four"]),
    ),
    OptionInfo::new(
        Axis::Rays,
        "intersect",
        "watertight",
        "ray/triangle test: watertight, or the one of Möller and Trumbore, which loses rays at edges",
        Kind::Word(&["watertight", "moller-trumbore"]),
    )
    .idle_if(has_own_test),
    OptionInfo::new(
        Axis::Device,
        "reflections",
        "fused",
        "passes of a frame under PSR: one, or one for primary rays and one for each reflection over a list of pixels",
        Kind::Word(&["fused", "staged"]),
    )
    .idle_if(goes_together),
    OptionInfo::new(
        Axis::Device,
        "checks",
        "off",
        "compile the kernel with bounds checks and loop bounds",
        Kind::Word(&["off", "on"]),
    ),
    OptionInfo::new(
        Axis::Device,
        "fetch",
        "auto",
        "read scene and structure from storage buffers or textures (auto: buffers, on software drivers textures)",
        Kind::Word(&["auto", "buffers", "textures"]),
    ),
    OptionInfo::new(
        Axis::Device,
        "triangles",
        "auto",
        "read corners by the indices of vertices, or in leaf order from a copy (auto: on software drivers the copy)",
        Kind::Word(&["auto", "indexed", "leaf-order"]),
    )
    .idle_if(reads_indexed),
];

fn reads_indexed(s: &Selection) -> Option<String> {
    (!s.method().traversal.leaf_order).then(|| format!("{} reads all triangles by their vertices", s.name()))
}

fn has_own_test(s: &Selection) -> Option<String> {
    let is_known = s.method().traversal.agreement != Agreement::HitsOnly;
    (!is_known).then(|| "the driver has a test of its own".to_owned())
}

fn goes_together(s: &Selection) -> Option<String> {
    if s.method().threads == Threads::Persistent {
        return Some("persistent threads follow their reflections".to_owned());
    }
    if s.method().traversal.packets.is_some() {
        return Some(format!("frames of {} have a pass for primary rays and one for all others", s.name()));
    }
    s.method().traversal.cooperative.then(|| format!("the rays of a work-group of {} go together", s.name()))
}

impl Kind {
    /// The value in its one spelling, or what would be one.
    pub(crate) fn parse(&self, value: &str) -> Result<String, String> {
        let count = |from: u32, to: u32| {
            let n = value.parse::<u32>().ok().filter(|n| (from..=to).contains(n));
            n.map(|n| n.to_string())
        };
        match *self {
            Kind::Count(from, to) => count(from, to).ok_or(format!("a whole number from {from} to {to}")),
            Kind::CountOrAuto(..) if value == "auto" => Ok(value.to_owned()),
            Kind::CountOrAuto(from, to) => {
                count(from, to).ok_or(format!("'auto' or a whole number from {from} to {to}"))
            }
            Kind::Number(from, to) => {
                let n = value.parse::<f64>().ok().filter(|n| (from..=to).contains(n));
                n.map(|n| n.to_string()).ok_or(format!("a number from {from} to {to}"))
            }
            Kind::Word(words) if words.contains(&value) => Ok(value.to_owned()),
            Kind::Word(words) => Err(format!("one of {}", words.join(", "))),
        }
    }
}
