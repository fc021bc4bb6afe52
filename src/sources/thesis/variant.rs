//! The options that the thesis measured with.

use super::scenes::ThesisScene;
use super::structures::GRID;

pub use crate::sources::rows::Variant;

impl Variant {
    /// The options of the thesis: the defaults, and the grid's resolution where it was set by hand.
    pub fn of_thesis(scene: Option<ThesisScene>, structure: &str) -> Variant {
        match scene.and_then(ThesisScene::grid_setting).filter(|_| structure == GRID) {
            Some((key, value)) => Variant::of(key, value),
            None => Variant::default(),
        }
    }
}
