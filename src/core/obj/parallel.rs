//! Reads a file: cuts it into chunks, parses them in parallel, and appends their contents in file order.
//!
//! The loading thread cuts and appends; rayon's threads parse. The result doesn't depend on the number of threads, because
//! chunks have the same bounds on every machine.

use super::LoadOptions;
use super::chunks::Chunks;
use super::contents::Contents;
use super::error::Problem;
use super::fence::fenced;
use super::reader::{self, ChunkOptions};
use super::steps::LoadSteps;
use crate::progress::Progress;
use std::collections::VecDeque;
use std::io::Read;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

/// Chunks per thread that are in memory at a time: one that is parsed, one that waits, and one that is appended.
const CHUNKS_PER_THREAD: usize = 3;
/// Memory for a byte of a chunk that is being parsed: the byte itself, and less than four bytes of contents. `f 1 1 1` has
/// 8 bytes and gives three indices of 4 bytes, which may be listed a second time as relative ones. Lines such as `g` give up
/// to 16 bytes each, but only a hundredth of the allowed memory is pending.
const BYTES_PER_PENDING_BYTE: u64 = 5;

/// Reads a file in chunks of `chunk_size` bytes, if `held` bytes of the allowed memory are in use.
///
/// # Errors
/// The first error in the file.
pub(super) fn read(
    bytes: impl Read,
    chunk_size: usize,
    (options, held): (&LoadOptions, u64),
    progress: &Progress,
    steps: &mut LoadSteps,
) -> Result<Contents, Problem> {
    let mut chunks = Chunks::new(bytes, chunk_size, progress)?;
    chunks.limit_statements(options.max_memory);
    chunks.require_obj()?;
    let mut contents = Contents::default();
    let chunk_options = ChunkOptions {
        faults: options.faults,
        counts: None,
        progress,
    };
    let most = CHUNKS_PER_THREAD * rayon::current_num_threads();
    // A small part of the allowed memory.
    let most_bytes = (options.max_memory / 100).min((most * chunk_size) as u64) as usize;
    rayon::in_place_scope(|scope| {
        let (mut pending, mut pending_bytes) = (VecDeque::new(), 0);
        let mut end = None;
        loop {
            while end.is_none() && pending.len() < most && pending_bytes <= most_bytes {
                match steps.time("cutting", || chunks.next()) {
                    Ok(Some(chunk)) => {
                        let (sender, receiver) = sync_channel(1);
                        pending_bytes += chunk.bytes.len();
                        pending.push_back((receiver, chunk.bytes.len()));
                        scope.spawn(move |_| {
                            let part = fenced("reading", || reader::read(&chunk, chunk_options));
                            // The receiver is gone after an error in an earlier chunk.
                            _ = sender.send((chunk, part));
                        });
                    }
                    Ok(None) => end = Some(Ok(())),
                    // An earlier chunk may have an error, which comes first.
                    Err(problem) => end = Some(Err(problem)),
                }
            }
            let memory = BYTES_PER_PENDING_BYTE * pending_bytes as u64;
            contents.check_size(options.max_memory, held + memory)?;
            let Some((first, bytes)) = pending.pop_front() else {
                return end.unwrap_or(Ok(()));
            };
            let (chunk, part) = steps.time("waiting for parsers", || wait(&first));
            let part = part.map_err(Problem::Content)?;
            steps.time("appending", || contents.append(&chunk, part, chunk_options))?;
            chunks.recycle(chunk);
            pending_bytes -= bytes;
        }
    })?;
    steps.time("joining", || {
        contents.finish(options.faults, chunks.has_garbage())
    })?;
    Ok(contents)
}

/// Waits for a task's result. On one of rayon's threads it runs other tasks meanwhile: that thread may be the only one.
fn wait<T>(result: &Receiver<T>) -> T {
    while rayon::current_thread_index().is_some() {
        match result.try_recv() {
            Ok(result) => return result,
            Err(TryRecvError::Empty) => _ = rayon::yield_now(),
            Err(TryRecvError::Disconnected) => break,
        }
    }
    result.recv().expect("each task sends")
}
