//! The nine scenes of the thesis, and which of them a recorded scene is, if any.

use crate::results::record::SceneRecord;
use std::fmt;

/// A scene of the thesis, in the order of its tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // The names are the scenes.
pub enum ThesisScene {
    Bunny,
    Dragon,
    Buddha,
    Robots,
    Museum,
    Kitchen,
    Theatre,
    Office,
    Conference,
}

use ThesisScene::{Buddha, Bunny, Conference, Dragon, Kitchen, Museum, Office, Robots, Theatre};

impl ThesisScene {
    /// All, in the order of table 5.1.
    pub const ALL: [ThesisScene; 9] = [Bunny, Dragon, Buddha, Robots, Museum, Kitchen, Theatre, Office, Conference];

    /// Name in the catalogue and in `results/thesis-2009`.
    pub fn name(self) -> &'static str {
        match self {
            Bunny => "bunny",
            Dragon => "dragon",
            Buddha => "buddha",
            Robots => "robots",
            Museum => "museum",
            Kitchen => "kitchen",
            Theatre => "theatre",
            Office => "office",
            Conference => "conference",
        }
    }

    /// Names that files of the scene have.
    fn aliases(self) -> &'static [&'static str] {
        match self {
            Bunny => &["bun_zipper"],
            Dragon => &["dragon_vrip"],
            Buddha => &["happy", "happy_vrip", "happy-buddha", "budha"],
            Robots => &["robot"],
            Museum => &["museum6"],
            Kitchen => &[],
            Theatre => &["theater"],
            Office => &[],
            Conference => &[],
        }
    }

    /// Triangles (table 5.1) and vertices. The office has two published numbers, see `results/thesis-2009/README.md`.
    fn counts(self) -> (&'static [u64], u64) {
        match self {
            Bunny => (&[69_451], 35_947),
            Dragon => (&[871_414], 437_645),
            Buddha => (&[1_087_716], 543_652),
            Robots => (&[71_708], 136_640),
            Museum => (&[14_380], 17_889),
            Kitchen => (&[110_559], 68_889),
            Theatre => (&[53_832], 62_925),
            Office => (&[35_916, 36_310], 22_844),
            Conference => (&[298_866], 229_642),
        }
    }

    /// The scene of this name; options behind it (`museum6:time=3`) do not matter.
    pub fn named(name: &str) -> Option<ThesisScene> {
        let name = name.split(':').next().unwrap_or(name).to_lowercase();
        ThesisScene::ALL.into_iter().find(|s| s.name() == name || s.aliases().contains(&name.as_str()))
    }

    /// The grid's option where the thesis set its resolution by hand (SPEC section 2).
    pub fn grid_setting(self) -> Option<(&'static str, &'static str)> {
        match self {
            Robots => Some(("x", "128")),
            Kitchen => Some(("y", "128")),
            _ => None,
        }
    }

    /// True for the single objects of evenly sized triangles, which have no reflections (SPEC section 8).
    pub fn is_object(self) -> bool {
        matches!(self, Bunny | Dragon | Buddha)
    }
}

/// Which scene a number belongs to.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SceneKey {
    /// One of the thesis.
    Thesis(ThesisScene),
    /// Any other, by name and number of triangles: also another tessellation of a scene of the thesis.
    Other(String, u64),
}

impl SceneKey {
    /// Decides by name, and by counts: a scene of the thesis's name with other triangles is another tessellation of it
    /// and never fills the thesis's rows. Where the name says nothing, both counts must be the published ones.
    pub fn of(record: &SceneRecord) -> SceneKey {
        SceneKey::from_counts(&record.name, record.triangles, record.vertices)
    }

    /// The same from a name and counts.
    pub fn from_counts(name: &str, triangles: u64, vertices: u64) -> SceneKey {
        let published = |scene: &ThesisScene| scene.counts().0.contains(&triangles);
        let found = match ThesisScene::named(name) {
            Some(scene) => Some(scene).filter(published),
            None => ThesisScene::ALL.into_iter().filter(published).find(|s| s.counts().1 == vertices),
        };
        found.map_or_else(|| SceneKey::Other(name.to_owned(), triangles), SceneKey::Thesis)
    }

    /// The scene of the thesis, if it is one.
    pub fn thesis(&self) -> Option<ThesisScene> {
        match self {
            SceneKey::Thesis(scene) => Some(*scene),
            SceneKey::Other(..) => None,
        }
    }

    /// The scene of the thesis of which this is another tessellation, by its name or the first word of it
    /// (`conference-obj`).
    pub fn tessellation_of(&self) -> Option<ThesisScene> {
        match self {
            SceneKey::Thesis(_) => None,
            SceneKey::Other(name, _) => {
                ThesisScene::named(name).or_else(|| ThesisScene::named(name.split_once('-')?.0))
            }
        }
    }
}

impl fmt::Display for SceneKey {
    /// A scene that is not the thesis's has its number of triangles with it, so that nobody takes it for the thesis's.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SceneKey::Thesis(scene) => f.write_str(scene.name()),
            SceneKey::Other(name, triangles) => {
                // A built-in scene's size stands in the brackets anyway
                let short = name.split_once(":triangles=").filter(|(_, rest)| !rest.contains(','));
                write!(f, "{} ({triangles})", short.map_or(name.as_str(), |(short, _)| short))
            }
        }
    }
}
