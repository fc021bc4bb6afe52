//! Vulkan devices through wgpu: adapters, kernels, buffers, and frames with timestamps. Only this folder names wgpu's
//! types; workloads build what they need from the thin ones here.

mod acceleration;
mod adapters;
mod binding;
mod buffers;
mod cost;
mod device;
mod pipeline;
mod read_buffer;
mod run;

pub use acceleration::AccelerationStructure;
pub use adapters::{Adapter, Selector, WANTED, adapters, adapters_with, choose, fitting};
pub use binding::{Binding, BindingKind, Pipeline, Texel};
pub use buffers::Buffer;
pub use cost::{EVENT_MARKS, KernelCost};
pub use device::{VulkanDevice, VulkanOptions};
pub use pipeline::{Bindings, PipelineDescription, Resource};
pub use read_buffer::{ReadBuffer, TEXTURE_WIDTH, Texture};
pub use run::{Dispatch, Groups, MAX_TIMESTAMPS};
