//! Scenes of spheres: the paper's three by their names, generated ones, and others.

use std::fmt;

/// What a scene is for the paper. The order is that of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// `default`, 3 spheres.
    Default,
    /// `random20`.
    Random20,
    /// `random100`.
    Random100,
    /// `random:spheres=N`.
    Generated,
    /// A file.
    Other,
}

/// A recorded scene.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SceneKey {
    /// What the scene is for the paper.
    pub role: Role,
    /// Number of spheres.
    pub spheres: u64,
    /// The name in records.
    pub name: String,
    /// Content hash; empty for published values. A scene that changed under its name is another one.
    pub hash: String,
}

impl Role {
    /// The paper's scenes.
    pub const PAPER: [Role; 3] = [Role::Default, Role::Random20, Role::Random100];

    /// The name of a scene of the paper.
    pub fn name(self) -> &'static str {
        match self {
            Role::Default => "default",
            Role::Random20 => "random20",
            Role::Random100 => "random100",
            Role::Generated => "random",
            Role::Other => "other",
        }
    }

    /// The number of spheres of a scene of the paper; 0 for others.
    pub fn spheres(self) -> u64 {
        match self {
            Role::Default => 3,
            Role::Random20 => 20,
            Role::Random100 => 100,
            Role::Generated | Role::Other => 0,
        }
    }
}

impl SceneKey {
    /// Decides by name and number of spheres: what has a name of the paper and another number is another scene.
    pub fn of(name: &str, spheres: u64, hash: &str) -> SceneKey {
        let of_paper = |role: &Role| role.name() == name && role.spheres() == spheres;
        let role = match Role::PAPER.into_iter().find(of_paper) {
            Some(role) => role,
            None if name == "random" || name.starts_with("random:") => Role::Generated,
            None => Role::Other,
        };
        SceneKey { role, spheres, name: name.to_owned(), hash: hash.to_owned() }
    }

    /// The paper's scene of a role.
    pub fn published(role: Role) -> SceneKey {
        SceneKey::of(role.name(), role.spheres(), "")
    }

    /// True for a scene of the paper.
    pub fn is_of_paper(&self) -> bool {
        Role::PAPER.contains(&self.role)
    }
}

impl fmt::Display for SceneKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}
