//! Camera paths of rows.

use crate::camera;
use crate::names;
use crate::scene::catalogue;

/// Is a path the one that its scene is measured along if the user names none (`CameraPath::for_scene`)? The camera of a
/// scene's file has the scene's name, and some scenes have a path that was made for them; scenes with neither are
/// circled. A row without a path's name is taken to be along the scene's own. `file_has_camera` is `None` where nothing
/// but the name tells.
pub fn is_own_path(scene: &str, path: &str, shadows: bool, file_has_camera: Option<bool>) -> bool {
    let bare = scene.split(':').next().unwrap_or(scene);
    if path.is_empty() || path == bare {
        return true;
    }
    let stem = names::stem(bare);
    if let Some(own) = catalogue::find(stem).and_then(|entry| entry.camera_path.as_deref()) {
        return path == own;
    }
    let has_own = file_has_camera.unwrap_or_else(|| camera::names().contains(&stem));
    !has_own && path == if shadows { "light-orbit" } else { "orbit" }
}
