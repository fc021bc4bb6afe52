//! Stages of a frame, the five groups of figure 5.2 that they belong to, and the bands of a stacked figure.

/// A group of stages. The order is that of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Deserialize)]
pub enum Group {
    /// Rays, materials, photons.
    A,
    /// What the camera sees, and direct light.
    B,
    /// Clusters and hierarchy.
    C,
    /// Splatting.
    D,
    /// Estimate and mix.
    E,
}

impl Group {
    /// All groups.
    pub const ALL: [Group; 5] = [Group::A, Group::B, Group::C, Group::D, Group::E];

    /// Its letter.
    pub fn letter(self) -> &'static str {
        match self {
            Group::A => "A",
            Group::B => "B",
            Group::C => "C",
            Group::D => "D",
            Group::E => "E",
        }
    }

    /// What its stages do.
    pub fn title(self) -> &'static str {
        match self {
            Group::A => "photons",
            Group::B => "samples, direct light",
            Group::C => "clusters, hierarchy",
            Group::D => "splatting",
            Group::E => "estimate, mix",
        }
    }
}

/// The stages after those of the hits, with their group, in the order of a frame.
pub const STAGES: [(&str, Group); 16] = [
    ("compaction", Group::A),
    ("samples", Group::B),
    ("direct", Group::B),
    ("keys", Group::C),
    ("unique", Group::C),
    ("bounds", Group::C),
    ("hierarchy", Group::C),
    ("count", Group::D),
    ("offsets", Group::D),
    ("fill", Group::D),
    ("order", Group::D),
    ("scale", Group::D),
    ("buckets", Group::D),
    ("estimate", Group::E),
    ("blur", Group::E),
    ("mix", Group::E),
];

/// The group of a stage; `None` for one that is not known here.
pub fn group(stage: &str) -> Option<Group> {
    if stage.starts_with("hit-") {
        return Some(Group::A);
    }
    STAGES.iter().find(|(name, _)| *name == stage).map(|(_, group)| *group)
}

/// The bands of a stacked figure, from the bottom.
pub const BANDS: [&str; 8] = [
    "A photons",
    "B samples, direct",
    "C keys, unique",
    "C bounds",
    "C hierarchy",
    "D splatting",
    "E estimate",
    "mix, blur, others",
];

/// Index of the band of a stage.
pub fn band(stage: &str) -> usize {
    match (stage, group(stage)) {
        (_, Some(Group::A)) => 0,
        (_, Some(Group::B)) => 1,
        ("keys" | "unique", _) => 2,
        ("bounds", _) => 3,
        (_, Some(Group::C)) => 4,
        (_, Some(Group::D)) => 5,
        ("estimate", _) => 6,
        _ => 7,
    }
}
