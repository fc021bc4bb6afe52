//! Rows of recorded runs in the form that sources read: devices, frames, built structures and measurements without a
//! result, each by a source's own name of the scene (`S`). Published values have the same form, so that the same code
//! reads both.

mod built;
mod conditions;
mod device;
mod frame;
mod modelled;
mod paths;
mod variant;

pub use built::{Built, BuiltBy, builders, choose_built, threads_in_words};
pub use conditions::{choose_frames, unlike_devices};
pub use device::{Device, Devices};
pub use frame::{Failure, Frame};
pub use modelled::{ModelledRows, modelled};
pub use paths::is_own_path;
pub use variant::Variant;
