//! Photon splatting: what makes photons, what sees them, and the estimates of indirect light.
//!
//! A frame has stages. Photons: paths leave the lights, one pass per hit, and every hit but the first is stored. Samples:
//! the camera's nearest hits, with their direct light. Estimate: the indirect light of each sample. `docs/splat.md` says
//! what of it is the source's.

pub mod lit;
pub mod photons;
pub mod samples;
pub mod setting;
