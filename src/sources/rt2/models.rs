//! The document's three models, and which measured scenes are taken for each. The models themselves are not public:
//! built-in scans have their numbers of triangles, a scan with spikes has the Dino's pointed shape, and the Dragon is
//! close to Stanford's.

use crate::names;
use crate::sources::rows::is_own_path;
use serde::Deserialize;
use std::fmt;

/// A model of the document, in its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[allow(missing_docs)] // The variants are models.
pub enum Model {
    Alien,
    Dino,
    Dragon,
}

impl Model {
    /// All, in the document's order.
    pub const ALL: [Model; 3] = [Model::Alien, Model::Dino, Model::Dragon];

    /// Its name in the document.
    pub fn name(self) -> &'static str {
        match self {
            Model::Alien => "Alien",
            Model::Dino => "Dino",
            Model::Dragon => "Dragon",
        }
    }
}

/// What a scene is for the document. The order is that of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// A counterpart of a model.
    Of(Model),
    /// Another scene.
    Other,
}

/// A recorded scene, with its camera path if that is not its own.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SceneKey {
    /// What the scene is for the document.
    pub role: Role,
    /// The name in records.
    pub name: String,
    /// Number of triangles.
    pub triangles: u64,
    /// Name of the camera path; empty for the scene's own.
    pub path: String,
}

/// Number of triangles that are asked of the evenly meshed scan for each model.
const SCANS: [(&str, Model); 3] = [("31600", Model::Alien), ("104000", Model::Dino), ("837000", Model::Dragon)];

/// So many spikes give the scan of the Dino's size its order of memory.
const SPIKES: u32 = 1000;

/// Names of Stanford's dragon, and its number of triangles.
const DRAGON: ([&str; 2], u64) = (["dragon", "dragon_vrip"], 871_414);

impl SceneKey {
    /// Decides by name and options, and for a file by the number of triangles as well.
    pub fn of(name: &str, triangles: u64) -> SceneKey {
        let key = SceneKey { role: Role::Other, name: name.to_owned(), triangles, path: String::new() };
        SceneKey { role: key.find_role(), ..key }
    }

    /// The same along a camera path.
    pub fn along(self, path: &str, shadows: bool) -> SceneKey {
        let path = if is_own_path(&self.name, path, shadows, None) { String::new() } else { path.to_owned() };
        SceneKey { path, ..self }
    }

    /// The scene that structures are built of: no camera path changes them.
    pub fn built(&self) -> SceneKey {
        SceneKey { path: String::new(), ..self.clone() }
    }

    /// The model that this scene is a counterpart of.
    pub fn model(&self) -> Option<Model> {
        match self.role {
            Role::Of(model) => Some(model),
            Role::Other => None,
        }
    }

    /// The name without its options.
    pub fn base(&self) -> &str {
        self.name.split(':').next().unwrap_or(&self.name)
    }

    /// True for a scan with spikes: the pointed shape.
    pub fn is_pointed(&self) -> bool {
        self.spikes() > 0
    }

    fn spikes(&self) -> u32 {
        let spikes = self.options().find(|(key, _)| *key == "spikes").filter(|_| self.base() == "scan");
        spikes.and_then(|(_, number)| number.parse().ok()).unwrap_or(0)
    }

    /// The name of a built-in scene, or the stem of a file.
    pub fn stem(&self) -> &str {
        names::stem(self.base())
    }

    /// True for an evenly meshed scan of any size.
    pub fn is_even_scan(&self) -> bool {
        self.base() == "scan" && !self.is_pointed()
    }

    /// Name and number of triangles, short enough for an axis: `scan 32 k`.
    pub fn short(&self) -> String {
        let shape = if self.is_pointed() { "spiky " } else { "" };
        let path = if self.path.is_empty() { String::new() } else { format!(" along {}", self.path) };
        format!("{shape}{} {:.0} k{path}", self.stem(), self.triangles as f64 / 1e3)
    }

    fn options(&self) -> impl Iterator<Item = (&str, &str)> {
        let options = self.name.split_once(':').map_or("", |(_, options)| options);
        options.split(',').filter_map(|option| option.split_once('='))
    }

    fn find_role(&self) -> Role {
        let (names, triangles) = DRAGON;
        let is_dragon = names.contains(&self.stem()) && self.triangles == triangles;
        if is_dragon && !self.name.contains(':') {
            return Role::Of(Model::Dragon);
        }
        let asked = self.options().find(|(key, _)| *key == "triangles").filter(|_| self.base() == "scan");
        let found = asked.and_then(|(_, number)| SCANS.into_iter().find(|(wanted, _)| *wanted == number));
        match found {
            Some((_, model)) if !self.is_pointed() => Role::Of(model),
            Some((_, Model::Dino)) if self.spikes() >= SPIKES => Role::Of(Model::Dino),
            _ => Role::Other,
        }
    }
}

impl fmt::Display for SceneKey {
    /// A built-in scene's own option for its size is left out, because the number of triangles follows.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.base())?;
        let options = self.name.split_once(':').map_or("", |(_, options)| options);
        let kept: Vec<&str> = options.split(',').filter(|o| !o.is_empty() && !o.starts_with("triangles=")).collect();
        if !kept.is_empty() {
            write!(f, ":{}", kept.join(","))?;
        }
        if !self.path.is_empty() {
            write!(f, " along {}", self.path)?;
        }
        write!(f, " ({})", self.triangles)
    }
}
