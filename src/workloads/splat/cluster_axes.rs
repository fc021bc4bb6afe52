//! How samples are put into clusters, and what of it a frame waits for, as axes.

use super::case::{number, values};
use super::clusters::setting::*;
use super::technique::Technique;
use crate::error::{Error, Result};
use crate::harness::workload::Part;
use crate::workloads::words::{flag, name, word};

const KEYS: [(&str, KeyOrder); 2] = [("morton", KeyOrder::Morton), ("concat", KeyOrder::Concat)];
const NORMALS: [(&str, Normals); 3] = [("off", Normals::Off), ("faces", Normals::Faces), ("cells", Normals::Cells)];
const UNIQUE: [(&str, Unique); 3] = [("flags", Unique::Flags), ("sort", Unique::Sort), ("bits", Unique::Bits)];
const BOUNDS: [(&str, BoundsBy); 2] = [("direct", BoundsBy::Direct), ("two-step", BoundsBy::TwoStep)];
const HIERARCHIES: [(&str, HierarchyBy); 2] = [("masks", HierarchyBy::Masks), ("none", HierarchyBy::None)];
const SPACES: [(&str, Space); 2] = [("view", Space::View), ("world", Space::World)];
const SYNCS: [(&str, Sync); 2] = [("device", Sync::Device), ("readback", Sync::Readback)];

/// Who knows the numbers of clusters and list entries in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sync {
    /// The device alone: passes are dispatched by numbers that it wrote.
    #[default]
    Device,
    /// The host as well: it reads them back in the middle of the frame, and dispatches by them.
    Readback,
}

/// Most entries of the lists of all clusters: 128 MiB.
pub const MAX_CAPACITY: u32 = 1 << 25;

/// What decides the work of techniques with tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Clustering {
    /// True for techniques with clusters; the others have the side of tiles only.
    pub has_clusters: bool,
    /// The clusters.
    pub setting: ClusterSetting,
    /// Entries of the lists of all clusters at most; `None` for techniques without lists.
    pub capacity: Option<u32>,
    /// Who knows how many there are.
    pub sync: Sync,
}

/// The axes, in the order of columns.
pub const AXES: [&str; 9] = ["tile", "key", "normals", "unique", "bounds", "hierarchy", "space", "capacity", "sync"];

impl Clustering {
    /// Every combination of the values of a part for a technique with tiles.
    ///
    /// # Errors
    /// [`Error::Input`] for the first value that cannot be.
    pub fn all(part: &Part, technique: Technique) -> Result<Vec<Clustering>> {
        let has_clusters = technique.gather.has_clusters();
        let setting = ClusterSetting::default();
        let mut all = vec![Clustering { has_clusters, setting, capacity: None, sync: Sync::Device }];
        fn combined<T: Copy>(all: &mut Vec<Clustering>, values: &[T], set: impl Fn(&mut Clustering, T)) {
            *all = all
                .iter()
                .flat_map(|known| values.iter().map(move |&value| (*known, value)))
                .map(|(mut known, value)| {
                    set(&mut known, value);
                    known
                })
                .collect();
        }
        let of = |axis| move |text: &str| number(axis, text, 1..=MAX_CAPACITY);
        let tiles = values(part, "tile", |text| number("tile", text, MIN_TILE..=MAX_TILE))?;
        combined(&mut all, &tiles, |known, tile| known.setting.tile = tile);
        if !has_clusters {
            return Ok(all);
        }
        combined(&mut all, &words(part, "key", &KEYS)?, |known, key| known.setting.key = key);
        combined(&mut all, &words(part, "normals", &NORMALS)?, |known, normals| known.setting.normals = normals);
        combined(&mut all, &words(part, "unique", &UNIQUE)?, |known, unique| known.setting.unique = unique);
        combined(&mut all, &words(part, "bounds", &BOUNDS)?, |known, bounds| known.setting.bounds = bounds);
        combined(&mut all, &words(part, "hierarchy", &HIERARCHIES)?, |known, by| known.setting.hierarchy = by);
        combined(&mut all, &words(part, "space", &SPACES)?, |known, space| known.setting.space = space);
        let capacities = values(part, "capacity", of("capacity"))?;
        if technique.gather.has_lists() {
            combined(&mut all, &capacities, |known, capacity| known.capacity = Some(capacity));
        }
        combined(&mut all, &words(part, "sync", &SYNCS)?, |known, sync| known.sync = sync);
        Ok(all)
    }

    /// Its axes; those without effect are left out.
    pub fn axes(&self) -> Vec<(&'static str, String)> {
        let ClusterSetting { tile, key, normals, unique, bounds, hierarchy, space } = self.setting;
        let axes = [
            ("tile", tile.to_string()),
            ("key", name(&KEYS, key).to_owned()),
            ("normals", name(&NORMALS, normals).to_owned()),
            ("unique", name(&UNIQUE, unique).to_owned()),
            ("bounds", name(&BOUNDS, bounds).to_owned()),
            ("hierarchy", name(&HIERARCHIES, hierarchy).to_owned()),
            ("space", name(&SPACES, space).to_owned()),
            ("capacity", self.capacity.map_or(String::new(), |capacity| capacity.to_string())),
            ("sync", name(&SYNCS, self.sync).to_owned()),
        ];
        let has = |(axis, value): &(&str, String)| *axis == "tile" || self.has_clusters && !value.is_empty();
        axes.into_iter().filter(has).collect()
    }

    /// Reads the axes of a case; `None` where it has none.
    ///
    /// # Errors
    /// [`Error::Input`] for a value that cannot be.
    pub fn of_axes<'a>(axis: impl Fn(&'static str) -> &'a str) -> Result<Option<Clustering>> {
        if axis("tile").is_empty() {
            return Ok(None);
        }
        let capacity = match axis("capacity") {
            "" => None,
            text => Some(number("capacity", text, 1..=MAX_CAPACITY)?),
        };
        let tile = number("tile", axis("tile"), MIN_TILE..=MAX_TILE)?;
        if axis("key").is_empty() {
            let setting = ClusterSetting { tile, ..ClusterSetting::default() };
            return Ok(Some(Clustering { has_clusters: false, setting, capacity: None, sync: Sync::Device }));
        }
        let setting = ClusterSetting {
            tile,
            key: word("key", &KEYS, axis("key"))?,
            normals: word("normals", &NORMALS, axis("normals"))?,
            unique: word("unique", &UNIQUE, axis("unique"))?,
            bounds: word("bounds", &BOUNDS, axis("bounds"))?,
            hierarchy: word("hierarchy", &HIERARCHIES, axis("hierarchy"))?,
            space: word("space", &SPACES, axis("space"))?,
        };
        Ok(Some(Clustering { has_clusters: true, setting, capacity, sync: word("sync", &SYNCS, axis("sync"))? }))
    }
}

/// The values of an axis of words.
fn words<T: Copy + PartialEq>(part: &Part, axis: &str, all: &[(&str, T)]) -> Result<Vec<T>> {
    values(part, axis, |text| word(axis, all, text))
}

/// Refuses values of these axes that the user gave and that no technique has a use for.
///
/// # Errors
/// [`Error::Input`].
pub fn check_given(part: &Part, techniques: &[Technique]) -> Result<()> {
    // Parts of a preset have techniques of their own, and some have no clusters
    if !(part.given.contains("technique") || part.of("technique").is_empty()) {
        return Ok(());
    }
    let is_used = |axis: &str| {
        techniques.iter().any(|technique| match axis {
            "tile" => technique.gather.has_tiles(),
            "capacity" => technique.gather.has_lists(),
            _ => technique.gather.has_clusters(),
        })
    };
    match AXES.iter().find(|axis| part.given.contains(**axis) && !is_used(axis)) {
        Some(axis) => Err(Error::argument(
            flag(axis),
            "it has no effect on these techniques",
            "leave it out, or name a --technique that it is for: per-sample, buckets (--tile: tiled as well)",
        )),
        None => Ok(()),
    }
}
