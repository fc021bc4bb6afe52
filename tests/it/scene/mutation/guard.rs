//! What a variant may take: memory, and no more than a moment of time.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Bytes that reading may take beside sixteen times the file's.
const BASE: u64 = 64 << 20;

/// Processor time that reading may take.
const MOMENT: Duration = Duration::from_secs(2);

/// What counts as a hang by the clock, however busy the machine is.
const HANG: Duration = Duration::from_secs(20);

/// Fails if so many bytes of files may not lead to such a peak of memory (of this thread: readers allocate nowhere else).
fn hold_memory(what: &str, peak: u64, file_bytes: usize) {
    let limit = 16 * file_bytes as u64 + BASE;
    assert!(peak <= limit, "{what}: {peak} bytes allocated at once, {limit} are allowed for a file of {file_bytes}");
}

/// Runs something; returns the processor time that this thread spent on it.
fn processor_time(run: impl FnOnce()) -> Duration {
    #[cfg(unix)]
    let now = || {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
    };
    // Elsewhere the watchdog alone watches
    #[cfg(not(unix))]
    let now = || Duration::ZERO;
    let begun = now();
    run();
    now() - begun
}

/// Fails if reading took longer than it may.
fn hold_time(what: &str, time: Duration) {
    assert!(time <= MOMENT, "{what}: {time:?} of processor time, {MOMENT:?} are allowed");
}

/// Reads files of so many bytes, and fails if that takes more memory or more time than it may.
pub fn held<T>(what: &str, file_bytes: usize, read: impl FnOnce() -> T) -> T {
    let (mut result, mut peak) = (None, 0);
    let time = processor_time(|| peak = allocation_counter::measure(|| result = Some(read())).bytes_max);
    hold_time(what, time);
    hold_memory(what, peak, file_bytes);
    result.expect("measured things run")
}

/// Ends the whole test program if one piece of work takes for ever: a thread that hangs cannot be stopped otherwise.
pub struct Watchdog {
    running: Arc<Mutex<(Instant, String)>>,
    done: Arc<AtomicBool>,
}

impl Watchdog {
    /// Begins to watch.
    pub fn new() -> Watchdog {
        let running = Arc::new(Mutex::new((Instant::now(), String::new())));
        let done = Arc::new(AtomicBool::new(false));
        let (watched, ended) = (Arc::clone(&running), Arc::clone(&done));
        std::thread::spawn(move || {
            while !ended.load(Relaxed) {
                std::thread::sleep(Duration::from_millis(200));
                let (since, what) = watched.lock().unwrap().clone();
                if is_hang(since.elapsed()) && !ended.load(Relaxed) {
                    eprintln!("{what}: hangs, more than {} s", HANG.as_secs());
                    std::process::exit(101);
                }
            }
        });
        Watchdog { running, done }
    }

    /// Something else begins; `what` is what the user is told if it hangs.
    pub fn begin(&self, what: &str) {
        *self.running.lock().unwrap() = (Instant::now(), what.to_owned());
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
fn the_limits_can_be_overstepped() {
    hold_memory("as allowed", 16 * 100 + (64 << 20), 100);
    let caught = std::panic::catch_unwind(|| hold_memory("too much", 16 * 100 + (64 << 20) + 1, 100));
    assert!(caught.is_err());
    hold_time("as allowed", MOMENT);
    assert!(std::panic::catch_unwind(|| hold_time("too long", MOMENT + Duration::from_nanos(1))).is_err());
    // Waiting is not work; work is
    assert!(processor_time(|| std::thread::sleep(Duration::from_millis(100))) < Duration::from_millis(50));
    let work = || {
        (0..10_000_000_u64).for_each(|i| {
            std::hint::black_box(i);
        });
    };
    assert!(processor_time(work) > Duration::ZERO || cfg!(not(unix)));
    assert!(is_hang(Duration::from_secs(21)) && !is_hang(Duration::from_secs(19)));
    // What is counted is the peak, freed or not.
    let counted = allocation_counter::measure(|| drop(std::hint::black_box(vec![1u8; 1 << 20])));
    assert!(counted.bytes_max >= 1 << 20 && counted.bytes_current == 0, "{counted:?}");
}
