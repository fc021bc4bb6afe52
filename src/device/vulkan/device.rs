//! An opened Vulkan device. The driver's errors are kept until somebody asks; nothing panics.

use super::adapters::{Adapter, wgpu_features};
use super::binding::Pipeline;
use crate::device::{DeviceInfo, Feature, Features, lock};
use crate::error::{Error, Refusal, Result, one_line};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

/// How kernels are compiled and dispatched.
#[derive(Clone, Copy, Debug)]
pub struct VulkanOptions {
    /// Compile all kernels with wgpu's bounds checks and loop bounds.
    pub checked: bool,
    /// Longer dispatches risk a driver's watchdog: a workload splits its frames so that none takes longer. Software
    /// rasterisers have no watchdog.
    pub max_dispatch: Duration,
    /// A submission that takes longer counts as a lost device.
    pub timeout: Duration,
    /// Larger buffers are refused, even if the device can bind them; in bytes.
    pub max_binding: u64,
}

impl Default for VulkanOptions {
    fn default() -> Self {
        VulkanOptions {
            checked: false,
            max_dispatch: Duration::from_millis(500),
            timeout: Duration::from_secs(300),
            max_binding: u64::MAX,
        }
    }
}

/// Errors that the driver reported since the last look.
#[derive(Default)]
struct PendingErrors {
    error: Option<Error>,
    lost: Option<String>,
}

/// An opened Vulkan device.
pub struct VulkanDevice {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) limits: wgpu::Limits,
    pub(super) pipelines: Mutex<HashMap<blake3::Hash, Arc<Pipeline>>>,
    /// What results are filled with before they are there.
    pub(super) poison: OnceLock<wgpu::Buffer>,
    options: VulkanOptions,
    features: Features,
    info: DeviceInfo,
    errors: Arc<Mutex<PendingErrors>>,
}

impl VulkanDevice {
    /// Opens an adapter with all its limits.
    ///
    /// # Errors
    /// [`Error::Device`] if the driver refuses.
    pub fn open(adapter: &Adapter, options: VulkanOptions) -> Result<VulkanDevice> {
        let (features, mut info) = (adapter.features, adapter.info().clone());
        let limits = adapter.adapter.limits();
        let experimental_features = match features.has(Feature::RayQuery) {
            // SAFETY: wgpu asks for consent to interfaces of its own that may still have bugs. They are used only by
            // algorithms that name the feature.
            #[allow(unsafe_code)]
            true => unsafe { wgpu::ExperimentalFeatures::enabled() },
            false => wgpu::ExperimentalFeatures::disabled(),
        };
        let (device, queue) = pollster::block_on(adapter.adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("rtbench"),
            required_features: wgpu_features(features),
            required_limits: limits.clone(),
            memory_hints: wgpu::MemoryHints::Performance,
            experimental_features,
            ..Default::default()
        }))
        .map_err(|e| Error::Device(format!("cannot open {}: {e}", info.name)))?;

        let errors = Arc::new(Mutex::new(PendingErrors::default()));
        let pending = errors.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let message = one_line(&error);
            let error = match error {
                wgpu::Error::OutOfMemory { .. } => Error::Refused(Refusal::OutOfMemory(message)),
                _ => Error::Device(message),
            };
            lock(&pending).error.get_or_insert(error);
        }));
        let pending = errors.clone();
        device.set_device_lost_callback(move |reason, message| {
            lock(&pending).lost.get_or_insert(one_line(&format!("{reason:?} {message}")));
        });

        info.checked = options.checked;
        if features.has(Feature::Timestamps) {
            info.timestamp_period_ns = Some(queue.get_timestamp_period());
        }
        Ok(VulkanDevice {
            device,
            queue,
            limits,
            pipelines: Default::default(),
            poison: Default::default(),
            options,
            features,
            info,
            errors,
        })
    }

    /// The description for a run's provenance.
    pub fn info(&self) -> &DeviceInfo {
        &self.info
    }

    /// The optional features that kernels may use.
    pub fn features(&self) -> Features {
        self.features
    }

    /// The options it was opened with.
    pub fn options(&self) -> VulkanOptions {
        self.options
    }

    /// Bytes of memory that a work-group can have.
    pub fn max_workgroup_memory(&self) -> u64 {
        self.limits.max_compute_workgroup_storage_size.into()
    }

    /// Most work-groups of a dispatch in each dimension.
    pub fn max_groups(&self) -> u32 {
        self.limits.max_compute_workgroups_per_dimension
    }

    /// Work-groups of a dispatch with at least `invocations` invocations, in rows as long as the device allows: columns
    /// and rows.
    ///
    /// # Errors
    /// [`Error::Refused`] if the device has not so many.
    pub fn groups_for(&self, invocations: u64, group_size: u32) -> Result<(u32, u32)> {
        let (groups, most) = (invocations.div_ceil(group_size.into()).max(1), u64::from(self.max_groups()));
        let columns = groups.min(most);
        let rows = groups.div_ceil(columns);
        if rows > most {
            let need = format!("{groups} work-groups are more than this device's {most} x {most}");
            return Err(Error::too_large("a dispatch", need, "use a smaller input"));
        }
        Ok((columns as u32, rows as u32))
    }

    /// Ends the device as a crashing driver would: everything after it reports a lost device. For tests.
    pub fn destroy(&self) {
        self.device.destroy();
        lock(&self.errors).lost.get_or_insert("destroyed".into());
    }

    /// Turns what the driver has reported meanwhile into an error.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] from the loss on, [`Error::Device`] or a refusal for lack of memory once for every other
    /// report.
    pub fn check(&self) -> Result<()> {
        let mut errors = lock(&self.errors);
        if let Some(lost) = &errors.lost {
            return Err(Error::DeviceLost(lost.clone()));
        }
        match errors.error.take() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    /// Waits for a submission.
    pub(super) fn wait(&self, submission: wgpu::SubmissionIndex) -> Result<()> {
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(self.options.timeout) };
        if let Err(error) = self.device.poll(wait) {
            self.check()?;
            let seconds = self.options.timeout.as_secs();
            let problem = format!("a kernel did not finish within {seconds} s: {error}");
            lock(&self.errors).lost.get_or_insert(problem.clone());
            // Dropping the last handle to a device waits until the device is idle, for ever if need be
            std::mem::forget((self.device.clone(), self.queue.clone()));
            return Err(Error::DeviceLost(problem));
        }
        self.check()
    }
}

#[cfg(test)]
mod tests {
    use super::super::adapters::{WANTED, adapters, list};
    use super::*;

    #[test]
    fn features_are_requested_only_if_they_are_wanted() {
        // Without a driver there is nothing to test; tests/it/device.rs says so where one is required
        let Some(usual) = adapters().pop() else { return };
        let wanted = Features::of(&[Feature::Subgroups]);
        let usual = VulkanDevice::open(&usual, VulkanOptions::default()).unwrap();
        assert!(usual.features().missing_in(WANTED).is_empty());
        assert_eq!(usual.info().timestamp_period_ns.is_some(), usual.features().has(Feature::Timestamps));

        let other = VulkanDevice::open(&list(wanted).pop().unwrap(), VulkanOptions::default()).unwrap();
        assert!(other.features().missing_in(wanted).is_empty());
        let others = Features::of(&[Feature::Timestamps, Feature::Half, Feature::FloatAtomics]);
        assert_eq!(other.device.features() & wgpu_features(others), wgpu::Features::empty());
        assert!(other.device.features().contains(wgpu_features(other.features())));
        assert_eq!(other.info().features.len(), other.features().iter().count());
        assert_eq!(other.info().timestamp_period_ns, None);
    }
}
