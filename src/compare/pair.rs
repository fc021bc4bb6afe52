//! Like with like: rows are compared only if they were measured under the same conditions.
//!
//! Runs may differ in conditions for the same scene, configuration and size. Then the conditions of one row hold for
//! its group: those that were measured with most structures; of equals those with most variants, then the later ones.
//! The other rows of the group are left out, so that no table and no judgement sets one against the other.

use std::collections::HashMap;
use std::hash::Hash;

/// What the frames of a measurement show. The default means unknown conditions, as of published values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Conditions {
    /// Content hash of the scene.
    pub scene: String,
    /// Name of the camera path.
    pub path: String,
    /// Content hash of the camera path.
    pub path_hash: String,
    /// Number of frames of the path.
    pub frames: usize,
    /// True if all kernels of the run had wgpu's checks. Checks of a single structure are an option of it.
    pub checked: bool,
}

impl Conditions {
    /// How these conditions differ from others, in words.
    pub fn difference_from(&self, other: &Conditions) -> String {
        let mut words = Vec::new();
        if self.frames != other.frames {
            words.push(if self.frames == 1 { "1 frame".to_owned() } else { format!("{} frames", self.frames) });
        }
        if self.path_hash != other.path_hash {
            words.push(["camera path", self.path.as_str(), short(&self.path_hash)].join(" ").replace("  ", " "));
        }
        if self.scene != other.scene {
            words.push(format!("scene {}", short(&self.scene)));
        }
        if self.checked != other.checked {
            words.push(if self.checked { "shader checks on" } else { "shader checks off" }.into());
        }
        words.join(", ").trim_end().to_owned()
    }
}

/// As much of a hash as a reader compares.
fn short(hash: &str) -> &str {
    hash.get(..8).unwrap_or(hash)
}

/// A row as far as [`choose`] looks at it.
#[derive(Clone, Copy, Debug)]
pub struct Comparable<'a, G, V> {
    /// Rows of the same group are compared with each other.
    pub group: G,
    /// The conditions that the row was measured under.
    pub conditions: &'a Conditions,
    /// The structure's name.
    pub structure: &'a str,
    /// The structure's options.
    pub variant: V,
}

/// For each row, in the order of measurement: nothing if its conditions are its group's, otherwise the group's.
pub fn choose<'a, G: Eq + Hash, V: Ord + Copy>(rows: &[Comparable<'a, G, V>]) -> Vec<Option<&'a Conditions>> {
    let mut groups: HashMap<&G, Vec<&Comparable<'a, G, V>>> = HashMap::new();
    for row in rows {
        groups.entry(&row.group).or_default().push(row);
    }
    let chosen: HashMap<&G, &'a Conditions> = groups.iter().map(|(group, rows)| (*group, best(rows))).collect();
    let of_group = |row: &Comparable<'a, G, V>| {
        let conditions = *chosen.get(&row.group)?;
        (conditions != row.conditions).then_some(conditions)
    };
    rows.iter().map(of_group).collect()
}

/// The conditions that hold for a group, which has at least one row.
fn best<'a, G, V: Ord + Copy>(group: &[&Comparable<'a, G, V>]) -> &'a Conditions {
    // The usual case, in which nothing has to be counted
    if group.iter().all(|row| row.conditions == group[0].conditions) {
        return group[0].conditions;
    }
    let rank = |(index, row): (usize, &&Comparable<'a, G, V>)| {
        let same = || group.iter().filter(|other| other.conditions == row.conditions);
        let mut structures: Vec<&str> = same().map(|other| other.structure).collect();
        let mut variants: Vec<(&str, V)> = same().map(|other| (other.structure, other.variant)).collect();
        structures.sort_unstable();
        structures.dedup();
        variants.sort_unstable();
        variants.dedup();
        (structures.len(), variants.len(), index, row.conditions)
    };
    let ranked = group.iter().enumerate().map(rank);
    ranked
        .max_by_key(|(structures, variants, index, _)| (*structures, *variants, *index))
        .map_or(group[0].conditions, |(.., conditions)| conditions)
}
