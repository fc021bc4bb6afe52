//! Pools of threads to measure with.

use crate::error::{Error, Result};

/// Most threads of a pool.
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

/// A pool of `threads` (0: one per processor), all of which run when this returns: starting them is no part of what is
/// measured.
///
/// If there is one for each processor, each is bound to its own. A scheduler that is free to choose may wake a thread on
/// the processor of the one that waits for it, though another is idle, and mend that at its next tick: on a virtual
/// machine of two processors half of all joins waited more than 2.5 ms for the second thread, bound ones 0.03 ms. Fewer
/// threads stay free: which processors share a core is for the scheduler to know.
///
/// # Errors
/// Those of [`check`], or the system does not give so many.
pub fn pool(threads: usize) -> Result<rayon::ThreadPool> {
    check(threads)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| refused(format!("cannot start {threads} threads: {e}")))?;
    let processors = core_affinity::get_core_ids().unwrap_or_default();
    pool.broadcast(|thread| {
        if thread.num_threads() == processors.len() && processors.len() > 1 {
            // Where the system refuses, the thread runs as any other.
            core_affinity::set_for_current(processors[thread.index()]);
        }
    });
    Ok(pool)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Processors that each thread of a pool may run on.
    fn processors(threads: usize) -> Vec<Vec<usize>> {
        let own = |_: rayon::BroadcastContext| core_affinity::get_core_ids().unwrap().iter().map(|id| id.id).collect();
        pool(threads).unwrap().broadcast(own)
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn as_many_threads_as_processors_have_one_each() {
        let all: Vec<usize> = core_affinity::get_core_ids().unwrap().iter().map(|id| id.id).collect();
        let each: Vec<Vec<usize>> = all.iter().map(|&id| vec![id]).collect();
        assert_eq!(processors(all.len()), each);
        assert_eq!(processors(all.len() + 1), vec![all.clone(); all.len() + 1], "there is no place for each");
    }

    #[test]
    fn a_pool_has_its_limits() {
        assert_eq!(pool(3).unwrap().current_num_threads(), 3);
        assert!(pool(MAX_THREADS + 1).unwrap_err().to_string().contains("too many"));
    }
}
