//! Traces the rows of a picture in parallel.

use crate::obj::fenced;
use crate::progress::{Cancelled, Progress};
use glam::UVec2;
use rayon::prelude::*;

/// Why pixels weren't traced.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// There isn't enough memory.
    #[error("there isn't enough memory for what each pixel shows")]
    NoMemory,
    /// No thread could be started.
    #[error("the system grants no thread to trace with: {0}")]
    NoThread(#[from] rayon::ThreadPoolBuildError),
    /// Tracing panicked.
    #[error("{0}")]
    Panic(String),
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for TraceError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// The pixels of a picture, row by row from the top, on `threads` threads; 0 takes one for each processor core. `trace`
/// receives the number of a row and its pixels, which are `nothing` before.
///
/// # Errors
/// See [`TraceError`].
pub(super) fn rows<T: Copy + Send + Sync>(
    size: UVec2,
    threads: usize,
    progress: &Progress,
    nothing: T,
    trace: impl Fn(u32, &mut [T]) + Sync,
) -> Result<Vec<T>, TraceError> {
    let count = size.element_product() as usize;
    let mut pixels = Vec::new();
    let reserved = pixels.try_reserve_exact(count);
    reserved.map_err(|_| TraceError::NoMemory)?;
    pixels.resize(count, nothing);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build()?;
    let trace_all = || {
        let rows = pixels.par_chunks_mut(size.x as usize).zip(0..size.y);
        rows.try_for_each(|(row, y)| {
            progress.check()?;
            trace(y, row);
            Ok::<(), Cancelled>(())
        })
    };
    fenced("tracing", || pool.install(trace_all)).map_err(TraceError::Panic)??;
    Ok(pixels)
}
