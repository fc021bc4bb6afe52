//! The nine scenes of the thesis, and which of them a recorded scene is, if any.

use crate::names;
use crate::scene::{Options, catalogue};
use crate::sources::rows::is_own_path;
use std::fmt;

/// A scene of the thesis, in the order of its tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // The variants are scenes.
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

    /// Names of the scene's files.
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

    /// The scene of this name, or of a file of this stem; options behind it (`museum6:time=3`) do not matter.
    pub fn named(name: &str) -> Option<ThesisScene> {
        let name = names::stem(name).to_lowercase();
        ThesisScene::ALL.into_iter().find(|s| s.name() == name || s.aliases().contains(&name.as_str()))
    }

    /// The grid's option where the thesis set its resolution by hand (its table 5.4).
    pub fn grid_setting(self) -> Option<(&'static str, &'static str)> {
        match self {
            Robots => Some(("x", "128")),
            Kitchen => Some(("y", "128")),
            _ => None,
        }
    }

    /// True for the single objects of evenly sized triangles, which have no reflections.
    pub fn is_object(self) -> bool {
        matches!(self, Bunny | Dragon | Buddha)
    }
}

/// Which scene a number belongs to.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SceneKey {
    /// One of the thesis: its triangles, in the pose that the catalogue gives it.
    Thesis(ThesisScene),
    /// Any other, by name and number of triangles: also another tessellation or pose of a scene of the thesis.
    Other(String, u64),
    /// A scene along a camera path that is not its own: the path's name, and the number of triangles.
    Along(Box<SceneKey>, String, u64),
}

impl SceneKey {
    /// Decides by name, counts and options. A scene of the thesis's name with other triangles is another tessellation
    /// of it, one with other options another pose or picture, and neither fills the thesis's rows. If the name is no
    /// scene of the thesis, both counts must be the published ones.
    pub fn of(name: &str, triangles: u64, vertices: u64) -> SceneKey {
        let published = |scene: &ThesisScene| scene.counts().0.contains(&triangles);
        let found = match ThesisScene::named(name) {
            Some(scene) => Some(scene).filter(published),
            None => ThesisScene::ALL.into_iter().filter(published).find(|s| s.counts().1 == vertices),
        };
        match found.map(|scene| (scene, is_as_catalogued(name, scene))) {
            Some((scene, Ok(()))) => SceneKey::Thesis(scene),
            Some((_, Err(difference))) => SceneKey::Other(format!("{name}{difference}"), triangles),
            None => SceneKey::Other(name.to_owned(), triangles),
        }
    }

    /// The same along a camera path, by the path's name and whether there are shadow rays.
    pub fn along(self, name: &str, triangles: u64, path: &str, shadows: bool) -> SceneKey {
        // The files of BART have cameras
        let file_has_camera = self.base_scene().map(|scene| matches!(scene, Robots | Museum | Kitchen));
        if is_own_path(name, path, shadows, file_has_camera) {
            return self;
        }
        SceneKey::Along(Box::new(self), path.to_owned(), triangles)
    }

    /// The scene of the thesis, if it is one.
    pub fn thesis(&self) -> Option<ThesisScene> {
        match self {
            SceneKey::Thesis(scene) => Some(*scene),
            SceneKey::Other(..) | SceneKey::Along(..) => None,
        }
    }

    /// The scene of the thesis of which this is another tessellation, by its name or the first word of it
    /// (`conference-obj`).
    pub fn tessellation_of(&self) -> Option<ThesisScene> {
        match self {
            SceneKey::Other(_, triangles) => self.base_scene().filter(|s| !s.counts().0.contains(triangles)),
            SceneKey::Thesis(_) | SceneKey::Along(..) => None,
        }
    }

    /// The scene of the thesis whose name this one has: itself, another tessellation, another pose, or another camera
    /// path through any of these.
    pub fn base_scene(&self) -> Option<ThesisScene> {
        match self {
            SceneKey::Thesis(scene) => Some(*scene),
            SceneKey::Along(scene, ..) => scene.base_scene(),
            SceneKey::Other(name, _) => {
                let word = name.split([':', ' ']).next().unwrap_or(name);
                ThesisScene::named(word).or_else(|| ThesisScene::named(names::stem(word).split_once('-')?.0))
            }
        }
    }

    /// The scene that structures are built of: no camera path changes them.
    pub fn built(&self) -> &SceneKey {
        match self {
            SceneKey::Along(scene, ..) => scene.built(),
            other => other,
        }
    }

    /// Name without the number of triangles.
    fn name(&self) -> String {
        match self {
            SceneKey::Thesis(scene) => scene.name().to_owned(),
            SceneKey::Other(name, _) => {
                // A built-in scene's size is in the brackets anyway
                let short = name.split_once(":triangles=").filter(|(_, rest)| !rest.contains(','));
                short.map_or(name.as_str(), |(short, _)| short).to_owned()
            }
            SceneKey::Along(scene, path, _) => format!("{} along {path}", scene.name()),
        }
    }
}

/// Is a scene read as the catalogue reads it, so that it is what the thesis measured? A name of the catalogue has its
/// options, and those after the name in addition; a file has only those after its name. The error is a suffix of the
/// name that says what differs.
fn is_as_catalogued(name: &str, scene: ThesisScene) -> Result<(), String> {
    let (bare, settings) = name.split_once(':').unwrap_or((name, ""));
    let catalogued = catalogue::find(scene.name()).map_or("", |entry| entry.options.as_str());
    let all = if bare == scene.name() { format!("{catalogued},{settings}") } else { settings.to_owned() };
    // The folders that includes may be read from and the allowed memory change nothing in the scene
    let read =
        |settings: &str| Options::parse(name, settings).map(|o| Options { outside: false, memory: None, ..o }).ok();
    match (read(&all), read(catalogued)) {
        (Some(this), Some(thesis)) if this == thesis => Ok(()),
        _ if settings.is_empty() => Err(format!(" without {catalogued}")),
        _ => Err(String::new()),
    }
}

impl fmt::Display for SceneKey {
    /// A scene that is not the thesis's has its number of triangles with it, so that nobody takes it for the thesis's.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SceneKey::Thesis(scene) => f.write_str(scene.name()),
            SceneKey::Other(_, triangles) | SceneKey::Along(_, _, triangles) => {
                write!(f, "{} ({triangles})", self.name())
            }
        }
    }
}
