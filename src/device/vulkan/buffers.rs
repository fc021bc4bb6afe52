//! Buffers: contents go up, results come back.

use super::device::VulkanDevice;
use crate::device::POISON;
use crate::error::{Error, Result};
use bytemuck::{AnyBitPattern, NoUninit};

/// Memory of a device; a clone is the same memory.
#[derive(Clone)]
pub struct Buffer {
    pub(super) buffer: wgpu::Buffer,
    /// The bytes that were asked for; the allocation may be larger.
    bytes: u64,
}

/// An empty buffer cannot be bound, and a binding must hold one element: every buffer has at least this many bytes.
const SMALLEST: u64 = 96;

/// Bytes of [`POISON`] that are copied at a time.
const POISON_BYTES: u64 = 1 << 20;

impl Buffer {
    /// True for the same memory.
    pub fn is(&self, other: &Buffer) -> bool {
        self.buffer == other.buffer
    }

    /// The bytes that were asked for.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl VulkanDevice {
    /// A buffer with contents that kernels read.
    ///
    /// # Errors
    /// [`Error::Device`] if it does not fit the device's limits.
    pub fn storage<T: NoUninit>(&self, what: &str, contents: &[T]) -> Result<Buffer> {
        self.filled(what, bytemuck::cast_slice(contents), wgpu::BufferUsages::STORAGE)
    }

    /// A buffer with contents that kernels declare as `var<uniform>`.
    ///
    /// # Errors
    /// [`Error::Device`] if it does not fit the device's limits.
    pub fn uniform<T: NoUninit>(&self, what: &str, contents: &[T]) -> Result<Buffer> {
        self.filled(what, bytemuck::cast_slice(contents), wgpu::BufferUsages::UNIFORM)
    }

    /// The distance in bytes between windows of `bytes` bytes in a uniform buffer.
    pub fn uniform_stride(&self, bytes: usize) -> u32 {
        (bytes as u32).next_multiple_of(self.limits.min_uniform_buffer_offset_alignment)
    }

    /// A buffer for results, filled with [`POISON`].
    ///
    /// # Errors
    /// [`Error::Device`] if it does not fit the device's limits.
    pub fn poisoned(&self, what: &str, bytes: u64) -> Result<Buffer> {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let buffer = self.buffer(what, bytes, usage)?;
        self.poison(&buffer);
        Ok(buffer)
    }

    /// Fills a buffer that [`VulkanDevice::poisoned`] made with [`POISON`] again.
    pub fn poison(&self, buffer: &Buffer) {
        // A write as large as the buffer would take its memory twice more
        let source = self.poison.get_or_init(|| {
            let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
            let descriptor = wgpu::BufferDescriptor {
                label: Some("the poison"),
                size: POISON_BYTES,
                usage,
                mapped_at_creation: false,
            };
            let source = self.device.create_buffer(&descriptor);
            self.queue.write_buffer(&source, 0, bytemuck::cast_slice(&vec![POISON; POISON_BYTES as usize / 4]));
            source
        });
        let size = buffer.bytes.next_multiple_of(4);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for at in (0..size).step_by(POISON_BYTES as usize) {
            encoder.copy_buffer_to_buffer(source, 0, &buffer.buffer, at, (size - at).min(POISON_BYTES));
        }
        self.queue.submit([encoder.finish()]);
    }

    /// A buffer that one pass writes and a later one reads, zero at first. It may hold the numbers of groups of
    /// indirect dispatches.
    ///
    /// # Errors
    /// [`Error::Device`] if it does not fit the device's limits.
    pub fn zeroed(&self, what: &str, bytes: u64) -> Result<Buffer> {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_SRC;
        self.buffer(what, bytes, usage)
    }

    /// A buffer with contents that passes change: numbers of groups of indirect dispatches among them.
    ///
    /// # Errors
    /// [`Error::Device`] if it does not fit the device's limits.
    pub fn indirect<T: NoUninit>(&self, what: &str, contents: &[T]) -> Result<Buffer> {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT;
        self.filled(what, bytemuck::cast_slice(contents), usage)
    }

    /// The most bytes that can be bound as one buffer.
    pub fn max_binding(&self) -> u64 {
        let limits = &self.limits;
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(self.options().max_binding)
    }

    /// The most bytes that a kernel can declare as one `var<uniform>`.
    pub fn max_uniform_binding(&self) -> u64 {
        self.limits.max_uniform_buffer_binding_size.min(self.limits.max_buffer_size)
    }

    /// Copies all bytes of a buffer to the begin of another.
    pub fn copy(&self, from: &Buffer, to: &Buffer) {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&from.buffer, 0, &to.buffer, 0, from.bytes.next_multiple_of(4));
        self.queue.submit([encoder.finish()]);
    }

    /// The first `count` elements of a buffer, once everything submitted so far has run.
    ///
    /// # Errors
    /// The device's.
    pub fn read<T: AnyBitPattern + NoUninit>(&self, buffer: &Buffer, count: usize) -> Result<Vec<T>> {
        let size = (count * size_of::<T>()) as u64;
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let staging = self.buffer("the read-back", size, usage)?.buffer;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&buffer.buffer, 0, &staging, 0, size);
        let submission = self.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, 0..size, |_| ());
        self.wait(submission)?;
        let view =
            staging.get_mapped_range(0..size).map_err(|e| Error::DeviceLost(format!("cannot read back: {e}")))?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }

    /// Refuses sizes that the device cannot bind as one buffer; `hint` says what helps.
    ///
    /// # Errors
    /// [`Error::Refused`].
    pub fn check_size(&self, what: &str, bytes: u64, hint: &str) -> Result<()> {
        let limit = self.max_binding();
        if bytes <= limit {
            return Ok(());
        }
        let mib = |bytes: u64| bytes.div_ceil(1 << 20);
        let need =
            format!("{} MiB are needed, this device binds at most {} MiB as one buffer", mib(bytes), limit >> 20);
        Err(Error::too_large(what, need, hint))
    }

    /// A buffer with contents. (wgpu's `create_buffer_init` panics on a lost device.)
    pub(super) fn filled(&self, what: &str, contents: &[u8], usage: wgpu::BufferUsages) -> Result<Buffer> {
        let buffer = self.buffer(what, contents.len() as u64, usage | wgpu::BufferUsages::COPY_DST)?;
        self.queue.write_buffer(&buffer.buffer, 0, contents);
        self.check()?;
        Ok(buffer)
    }

    /// A buffer without contents.
    pub(super) fn buffer(&self, what: &str, bytes: u64, usage: wgpu::BufferUsages) -> Result<Buffer> {
        self.check_size(what, bytes, "use a smaller input, or another device")?;
        let size = bytes.max(SMALLEST).next_multiple_of(4);
        let descriptor = wgpu::BufferDescriptor { label: Some(what), size, usage, mapped_at_creation: false };
        Ok(Buffer { buffer: self.device.create_buffer(&descriptor), bytes })
    }
}
