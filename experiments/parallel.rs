//! Cases measured side by side, each on a thread of its own.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::Result;

/// `work` on every case, on all cores; the results in the order of the cases, or the first error.
pub fn in_parallel<C: Sync, T: Send>(cases: &[C], work: impl Fn(&C) -> Result<T> + Sync) -> Result<Vec<T>> {
    on_threads(std::thread::available_parallelism().map_or(1, usize::from), cases, work)
}

/// [`in_parallel`] on this number of threads.
pub fn on_threads<C: Sync, T: Send>(
    threads: usize,
    cases: &[C],
    work: impl Fn(&C) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let next = AtomicUsize::new(0);
    let results: Mutex<Vec<(usize, Result<T>)>> = Mutex::new(Vec::new());
    let worker = || {
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(k) else { return };
            let result = work(case);
            if result.is_err() {
                next.store(cases.len(), Ordering::Relaxed);
            }
            if let Ok(mut results) = results.lock() {
                results.push((k, result));
            }
        }
    };
    std::thread::scope(|scope| (0..threads.min(cases.len())).for_each(|_| drop(scope.spawn(worker))));
    let mut results = results.into_inner().map_err(|_| "a thread ended early")?;
    results.sort_by_key(|(k, _)| *k);
    results.into_iter().map(|(_, result)| result).collect()
}
