//! Scenes: the two of the thesis by their names, and others.

use std::fmt;

/// What a scene is for the thesis. The order is that of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Any Sponza: the thesis had Crytek's.
    Sponza,
    /// Any Sibenik.
    Sibenik,
    /// A scene that the thesis does not have.
    Other,
}

/// A recorded scene.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SceneKey {
    /// What the scene is for the thesis.
    pub role: Role,
    /// The name in records.
    pub name: String,
    /// Content hash. A scene that changed under its name is another one.
    pub hash: String,
}

impl Role {
    /// The scenes of the thesis.
    pub const THESIS: [Role; 2] = [Role::Sponza, Role::Sibenik];

    /// The name in published numbers; empty for other scenes.
    pub fn published(self) -> &'static str {
        match self {
            Role::Sponza => "Sponza (Crytek)",
            Role::Sibenik => "Sibenik",
            Role::Other => "",
        }
    }
}

impl SceneKey {
    /// Decides by the name, also by that of a file.
    pub fn of(name: &str, hash: &str) -> SceneKey {
        let lower = name.to_lowercase();
        let role = match () {
            () if lower.contains("sponza") => Role::Sponza,
            () if lower.contains("sibenik") => Role::Sibenik,
            () => Role::Other,
        };
        SceneKey { role, name: name.to_owned(), hash: hash.to_owned() }
    }
}

impl fmt::Display for SceneKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}
