//! Built structures of the thesis's scenes: by any builder, or by one.

use super::data::{Built, Data};
use super::scenes::SceneKey;
use super::structures::STRUCTURES;
use super::variant::Variant;
use crate::sources::rows::{self, BuiltBy};

impl Data {
    /// All builders, the fewest threads first because the thesis built on one; then in the order of the runs.
    pub fn builders(&self) -> Vec<BuiltBy<'_>> {
        rows::builders(self.built.iter())
    }

    /// A structure each time that it was built, the last one last; a camera path makes no difference to it.
    pub fn all_built(
        &self,
        scene: &SceneKey,
        structure: &str,
        variant: &Variant,
    ) -> impl DoubleEndedIterator<Item = &Built> {
        let scene = scene.built();
        self.built.of(scene, structure, variant).filter(move |b| b.structure == structure && b.scene == *scene)
    }

    /// A built structure, by any builder.
    pub fn built_of(&self, scene: &SceneKey, structure: &str, variant: &Variant) -> Option<&Built> {
        self.all_built(scene, structure, variant).next_back()
    }

    /// A built structure, with the thesis's options.
    pub fn thesis_built(&self, scene: &SceneKey, structure: &str) -> Option<&Built> {
        self.thesis_built_by(None, scene, structure)
    }

    /// A structure with the thesis's options by this builder, or by any; of several, the last. Builder and camera path
    /// change nothing in it but the build time.
    pub fn thesis_built_by(&self, by: Option<BuiltBy>, scene: &SceneKey, structure: &str) -> Option<&Built> {
        let scene = scene.built();
        let variant = Variant::of_thesis(scene.thesis(), structure);
        let of_builder = |b: &Built| by.is_none_or(|by| b.by() == by);
        self.all_built(scene, structure, &variant).rfind(|b| of_builder(b))
    }

    /// Grid, kd-tree and BVH of a scene, all three by the same builder or, for `None`, by anyone.
    pub fn thesis_trio(&self, by: Option<BuiltBy>, scene: &SceneKey) -> Option<[&Built; 3]> {
        let [grid, kdtree, bvh] = STRUCTURES.map(|structure| self.thesis_built_by(by, scene, structure));
        Some([grid?, kdtree?, bvh?])
    }
}
