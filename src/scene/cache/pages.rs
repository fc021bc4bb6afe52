//! Large pages for what is read at once.
//!
//! Most of the time of reading a cache went into page faults: 28 MB are 6,800 of them, at 3 to 4 microseconds each where this
//! was measured (a virtual machine). With pages of 2 MiB they are a few dozen. Linux gives those to who asks for them.

/// Memory below this is not worth the call, bytes.
const WORTH: usize = 4 << 20;

/// A multiple of every page size in use.
const ALIGNMENT: usize = 1 << 16;

/// Asks the system to back this memory with large pages where it has not been touched yet. Only advice: nothing depends on
/// whether it is followed.
pub fn prefer_large(memory: &mut [u8]) {
    let skipped = memory.as_ptr().align_offset(ALIGNMENT);
    let length = memory.len().saturating_sub(skipped) / ALIGNMENT * ALIGNMENT;
    if length >= WORTH {
        advise(&mut memory[skipped..][..length]);
    }
}

#[cfg(target_os = "linux")]
fn advise(memory: &mut [u8]) {
    // SAFETY: the range lies inside of a slice that is ours alone, and this advice changes how memory is backed, never
    // what is in it. A kernel without large pages says so in its answer; it works without.
    #[allow(unsafe_code)]
    let _ = unsafe { libc::madvise(memory.as_mut_ptr().cast(), memory.len(), libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn advise(_: &mut [u8]) {}
