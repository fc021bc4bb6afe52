//! Thread pools for measurements: each thread is bound to a processor.

use crate::error::{Error, Result};

/// The largest number of threads of a pool.
pub const MAX_THREADS: usize = 1024;

fn refused(problem: String) -> Error {
    Error::argument("--threads", problem, format!("give 0 (all) to {MAX_THREADS}"))
}

/// Refuses more threads than a pool may have, before anything runs.
///
/// # Errors
/// [`Error::Input`] if there are more than [`MAX_THREADS`].
pub fn check(threads: usize) -> Result<()> {
    if threads > MAX_THREADS { Err(refused(format!("{threads} threads are too many"))) } else { Ok(()) }
}

/// A pool of `threads` threads (0: one per processor). All of them run when this returns, so that starting them is not
/// measured.
///
/// If there are as many threads as processors, each is bound to one processor. A scheduler that is free to choose may
/// wake a thread on the processor of the thread that waits for it although another processor is idle, and moves it only
/// at its next tick: on a virtual machine with two processors half of all joins waited more than 2.5 ms for the second
/// thread; with bound threads they waited 0.03 ms. A smaller pool is not bound, since only the scheduler knows which
/// processors share a core.
///
/// # Errors
/// Those of [`check`]; [`Error::Input`] if the system cannot start that many threads.
pub fn pool(threads: usize) -> Result<rayon::ThreadPool> {
    check(threads)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| refused(format!("cannot start {threads} threads: {e}")))?;
    let processors = core_affinity::get_core_ids().unwrap_or_default();
    pool.broadcast(|thread| {
        if thread.num_threads() == processors.len() && processors.len() > 1 {
            // If the system refuses, the thread stays unbound.
            core_affinity::set_for_current(processors[thread.index()]);
        }
    });
    Ok(pool)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The processors that each thread of a pool may run on.
    fn processors(threads: usize) -> Vec<Vec<usize>> {
        let own = |_: rayon::BroadcastContext| core_affinity::get_core_ids().unwrap().iter().map(|id| id.id).collect();
        pool(threads).unwrap().broadcast(own)
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_pool_of_all_processors_binds_each_thread_to_one() {
        let all: Vec<usize> = core_affinity::get_core_ids().unwrap().iter().map(|id| id.id).collect();
        let each: Vec<Vec<usize>> = all.iter().map(|&id| vec![id]).collect();
        assert_eq!(processors(all.len()), each);
        assert_eq!(
            processors(all.len() + 1),
            vec![all.clone(); all.len() + 1],
            "more threads than processors are not bound"
        );
    }

    #[test]
    fn a_pool_refuses_more_than_max_threads() {
        assert_eq!(pool(3).unwrap().current_num_threads(), 3);
        assert!(pool(MAX_THREADS + 1).unwrap_err().to_string().contains("too many"));
    }
}
