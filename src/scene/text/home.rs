//! Where the files that a scene names may lie.

use std::path::{Path, PathBuf};

/// The folders of a scene: the one that its file was named in and, if that is a link, the one that it leads to.
pub struct Home {
    /// Without links.
    folders: [Option<PathBuf>; 2],
}

impl Home {
    /// The folders of the scene whose file is `path`.
    pub fn of(path: &Path) -> Home {
        let named = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let linked = path.canonicalize().ok().and_then(|whole| whole.parent().map(Path::to_owned));
        Home { folders: [named.canonicalize().ok(), linked] }
    }

    /// False for a file that lies elsewhere, be it by way of links. One that is not there is for others to find out.
    pub fn holds(&self, file: &Path) -> bool {
        let inside = |whole: &PathBuf| self.folders.iter().flatten().any(|folder| whole.starts_with(folder));
        file.canonicalize().ok().as_ref().is_none_or(inside)
    }
}
