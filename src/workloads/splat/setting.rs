//! What decides the photons and the light of a frame, apart from the scene.

/// How direct light falls off with the distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Falloff {
    /// With its square: radiance is albedo / pi x flux / (4 pi) x cosine / distance^2.
    #[default]
    Square,
    /// As the source prints it: Phong's diffuse and specular light times max(1 - (distance / influence)^2, 0).
    Source,
}

/// What a stored photon carries of the flux that arrives with its ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Energy {
    /// All of it. Only so the estimates converge to the rendering equation.
    #[default]
    Flux,
    /// An equal part for each of the path's stored photons: it is divided by hits - 1.
    Shared,
}

/// Kernel of a density estimate: the weight by distance, which integrates to one over a disc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EstimateKernel {
    /// 2 / (pi r^2) (1 - d^2 / r^2).
    #[default]
    Epanechnikov,
    /// 1 / (pi r^2).
    Constant,
}

/// Weight of a photon by the direction that it came from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Weight {
    /// 1 on the normal's side of the surface, 0 behind it.
    #[default]
    Side,
    /// The cosine between the normal and that direction, 0 behind the surface: the source's.
    Cosine,
}

/// How far an estimate is normalised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Form {
    /// The kernel integrates to one, and sums of directions are divided by the photons' disc.
    #[default]
    Normalised,
    /// As the source prints it: without 2 / (pi r^2) and 1 / (pi r^2).
    Source,
}

/// A density estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// By distance.
    pub kernel: EstimateKernel,
    /// By direction.
    pub weight: Weight,
    /// Its factor.
    pub form: Form,
    /// Of a photon, in the scene's units in memory; a photon exactly this far away does not count.
    pub radius: f32,
}

/// What decides the photons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Setting {
    /// Paths that leave the lights, at least 1.
    pub paths: u32,
    /// Most hits along a path, 2 to [`MAX_HITS`]. All but the first are stored.
    pub hits: u32,
    /// Of the generator.
    pub seed: u32,
    /// Of direct light.
    pub falloff: Falloff,
    /// Of stored photons.
    pub energy: Energy,
}

/// Most hits along a path.
pub const MAX_HITS: u32 = 16;

impl Setting {
    /// Slots for photons: one for each hit but the first of each path. At most 2^32 x 15.
    pub fn slots(&self) -> u64 {
        u64::from(self.paths) * u64::from(self.hits - 1)
    }
}
