//! The check whether a file lies in the folder of a scene.

use std::path::{Path, PathBuf};

/// The folders of a scene: that of its file and, if the file is a link, that of the link's target.
pub struct SceneFolders {
    /// Canonical paths.
    folders: [Option<PathBuf>; 2],
}

impl SceneFolders {
    /// The folders of the scene in the file `path`.
    pub fn of(path: &Path) -> SceneFolders {
        let named = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let linked = path.canonicalize().ok().and_then(|whole| whole.parent().map(Path::to_owned));
        SceneFolders { folders: [named.canonicalize().ok(), linked] }
    }

    /// True if the file, with all links resolved, lies in one of the folders or does not exist.
    pub fn contain(&self, file: &Path) -> bool {
        let inside = |whole: &PathBuf| self.folders.iter().flatten().any(|folder| whole.starts_with(folder));
        file.canonicalize().ok().as_ref().is_none_or(inside)
    }
}
