//! What was noticed while reading, which becomes warnings.

/// Counts of what was ignored or computed.
#[derive(Default)]
pub struct Notes {
    /// Primitives that are points or lines.
    pub no_surface: usize,
    pub no_positions: usize,
    pub orthographic: bool,
    pub skinned: bool,
    pub coloured: bool,
    /// Normals that were computed instead of the file's.
    pub repaired: usize,
    /// Triangles that were dropped because a corner is not finite.
    pub dropped: usize,
    /// The first malformed material, light or camera, and how many there are.
    malformed: Option<String>,
    malformed_count: usize,
    /// The first malformed normals or morph weights, and how many there are.
    surface: Option<String>,
    surface_count: usize,
}

impl Notes {
    /// Notes a fault that concerns no geometry. Only the first one is described, because that takes time.
    pub fn malformed(&mut self, fault: impl FnOnce() -> String) {
        self.malformed_count += 1;
        self.malformed.get_or_insert_with(fault);
    }

    /// Notes normals or morph weights that are malformed. Only the first are described.
    pub fn surface(&mut self, fault: impl FnOnce() -> String) {
        self.surface_count += 1;
        self.surface.get_or_insert_with(fault);
    }

    /// The warnings; `has_camera` is true if the scene has one.
    pub fn warnings(&self, has_camera: bool) -> Vec<String> {
        let mut all = Vec::new();
        let mut warn = |if_any: bool, warning: String| all.extend(if_any.then_some(warning));
        let Notes { no_surface, no_positions, repaired, dropped, .. } = *self;
        warn(no_surface > 0, format!("{no_surface} primitives that are points or lines ignored"));
        warn(no_positions > 0, format!("{no_positions} primitives without POSITION ignored"));
        warn(self.orthographic && !has_camera, "orthographic camera ignored".into());
        warn(self.coloured, "vertex colours ignored".into());
        warn(self.skinned, "skins ignored: meshes are in their rest pose".into());
        warn(repaired > 0, format!("{repaired} normals in the file are zero or not finite: computed instead"));
        warn(dropped > 0, format!("{dropped} triangles dropped: a corner is not finite"));
        for (what, first, count) in [
            ("material, light or camera", &self.malformed, self.malformed_count),
            ("normals or morph targets", &self.surface, self.surface_count),
        ] {
            let others = if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() };
            all.extend(first.iter().map(|first| format!("{what} ignored: {first}{others}")));
        }
        all
    }
}
