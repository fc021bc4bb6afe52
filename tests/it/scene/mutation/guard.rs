//! Limits of memory and time for a variant.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Memory in bytes that reading may take in addition to sixteen times the file's size.
const BASE: u64 = 64 << 20;

/// The largest processor time of reading.
const TIME_LIMIT: Duration = Duration::from_secs(2);

/// Wall time after which reading counts as a hang, even on a busy machine.
const HANG: Duration = Duration::from_secs(20);

/// Asserts that a peak of memory is within the limit for files of this size. The peak is that of the calling thread, on
/// which readers allocate.
fn check_memory(name: &str, peak: u64, file_bytes: usize) {
    let limit = 16 * file_bytes as u64 + BASE;
    assert!(peak <= limit, "{name}: {peak} bytes allocated at once, {limit} are allowed for a file of {file_bytes}");
}

/// Returns the processor time of this thread for `run`.
fn processor_time(run: impl FnOnce()) -> Duration {
    #[cfg(unix)]
    let now = || {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
    };
    // On other systems only the watchdog limits the time.
    #[cfg(not(unix))]
    let now = || Duration::ZERO;
    let begun = now();
    run();
    now() - begun
}

/// Asserts that the processor time is within the limit.
fn check_time(name: &str, time: Duration) {
    assert!(time <= TIME_LIMIT, "{name}: {time:?} of processor time, {TIME_LIMIT:?} are allowed");
}

/// Runs a reader of files of this size, and asserts that it stays within the limits of memory and time.
pub fn within_limits<T>(name: &str, file_bytes: usize, read: impl FnOnce() -> T) -> T {
    let (mut result, mut peak) = (None, 0);
    let time = processor_time(|| peak = allocation_counter::measure(|| result = Some(read())).bytes_max);
    check_time(name, time);
    check_memory(name, peak, file_bytes);
    result.expect("the closure was run")
}

/// Ends the test program if a step hangs: a hanging thread cannot be stopped otherwise.
pub struct Watchdog {
    running: Arc<Mutex<(Instant, String)>>,
    done: Arc<AtomicBool>,
}

impl Watchdog {
    /// Starts the thread that watches.
    pub fn new() -> Watchdog {
        let running = Arc::new(Mutex::new((Instant::now(), String::new())));
        let done = Arc::new(AtomicBool::new(false));
        let (watched, ended) = (Arc::clone(&running), Arc::clone(&done));
        std::thread::spawn(move || {
            while !ended.load(Relaxed) {
                std::thread::sleep(Duration::from_millis(200));
                let (since, name) = watched.lock().unwrap().clone();
                if is_hang(since.elapsed()) && !ended.load(Relaxed) {
                    eprintln!("{name}: hangs, more than {} s", HANG.as_secs());
                    std::process::exit(101);
                }
            }
        });
        Watchdog { running, done }
    }

    /// Starts a new step; `name` is its name for the message if it hangs.
    pub fn begin(&self, name: &str) {
        *self.running.lock().unwrap() = (Instant::now(), name.to_owned());
    }
}

fn is_hang(time: Duration) -> bool {
    time > HANG
}

impl Drop for Watchdog {
    fn drop(&mut self) {
        self.done.store(true, Relaxed);
    }
}

#[test]
fn exceeding_a_limit_is_detected() {
    check_memory("as allowed", 16 * 100 + (64 << 20), 100);
    let caught = std::panic::catch_unwind(|| check_memory("too much", 16 * 100 + (64 << 20) + 1, 100));
    assert!(caught.is_err());
    check_time("as allowed", TIME_LIMIT);
    assert!(std::panic::catch_unwind(|| check_time("too long", TIME_LIMIT + Duration::from_nanos(1))).is_err());
    // Waiting takes no processor time; work does.
    assert!(processor_time(|| std::thread::sleep(Duration::from_millis(100))) < Duration::from_millis(50));
    let work = || {
        (0..10_000_000_u64).for_each(|i| {
            std::hint::black_box(i);
        });
    };
    assert!(processor_time(work) > Duration::ZERO || cfg!(not(unix)));
    assert!(is_hang(Duration::from_secs(21)) && !is_hang(Duration::from_secs(19)));
    // The peak is counted, even if the memory was freed.
    let counted = allocation_counter::measure(|| drop(std::hint::black_box(vec![1u8; 1 << 20])));
    assert!(counted.bytes_max >= 1 << 20 && counted.bytes_current == 0, "{counted:?}");
}
