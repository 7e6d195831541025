//! Work for the GPU, cut into slices that each take a bounded time.
//!
//! A queue runs its submissions one after the other. A frame of the window waits for whatever was submitted before
//! it, so what takes long is submitted in slices, and the next slice only when the one before is done.

use std::ops::Range;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

/// What a slice should take: short beside a frame of 33 ms, long beside the cost of a submission.
const SLICE: Range<Duration> = Duration::from_millis(8)..Duration::from_millis(25);
/// Slices of no more primitives than this take as long as a submission if they cover few pixels: lavapipe draws one or
/// two a µs (2 cores, 2026-11). On a busy machine shorter ones would only add submissions.
const SMALL: u32 = 1 << 14;
/// What a small slice may take. Only primitives that cover many pixels take longer.
const SMALL_SLICE: Range<Duration> = Duration::from_millis(100)..Duration::from_millis(250);
/// Primitives in the first slice, before anything is measured.
const FIRST: u32 = 1 << 15;
/// The smallest slice, which keeps the number of submissions in bounds.
const LEAST: u32 = 1 << 6;

/// How many primitives a slice has, adapted to what the slices before it took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pace(u32);

impl Default for Pace {
    fn default() -> Self {
        Self(FIRST)
    }
}

impl Pace {
    /// All at once: for a GPU that is quick, or where nobody waits for a frame.
    pub const UNLIMITED: Self = Self(u32::MAX);

    /// Primitives of the next slice.
    pub fn primitives(self) -> u32 {
        self.0
    }

    /// Takes into account what a slice took.
    pub fn adapt(&mut self, took: Duration) {
        if *self == Self::UNLIMITED {
            return;
        }
        let wanted = if self.0 > SMALL { SLICE } else { SMALL_SLICE };
        if took > wanted.end {
            self.0 = (self.0 / 2).max(LEAST);
        } else if took < wanted.start {
            self.0 = (self.0.saturating_add(self.0 / 2)).min(Self::UNLIMITED.0 - 1);
        }
    }
}

/// Parts of known sizes, handed out in slices.
#[derive(Clone, Debug)]
pub struct Slices {
    sizes: Vec<u32>,
    part: usize,
    start: u32,
}

impl Slices {
    /// Parts of these sizes.
    pub fn new(sizes: Vec<u32>) -> Self {
        Self {
            sizes,
            part: 0,
            start: 0,
        }
    }

    /// The next slice: ranges of parts, together `most` primitives or the rest. Empty once all are handed out.
    pub fn take(&mut self, most: u32) -> Vec<(usize, Range<u32>)> {
        let (mut ranges, mut left) = (Vec::new(), most);
        while let Some(&size) = self.sizes.get(self.part) {
            let end = self.start.saturating_add(left).min(size);
            if end > self.start {
                ranges.push((self.part, self.start..end));
                left -= end - self.start;
            }
            if end < size {
                self.start = end;
                break;
            }
            (self.part, self.start) = (self.part + 1, 0);
        }
        ranges
    }
}

/// Submits commands, and returns what they took once they are done. The wait is for the calling thread, which isn't
/// the window's; other threads may submit meanwhile.
pub fn submit_and_wait(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    commands: Option<wgpu::CommandBuffer>,
) -> Duration {
    // What others submitted before isn't measured.
    wait(device, queue);
    let start = Instant::now();
    queue.submit(commands);
    wait(device, queue);
    start.elapsed()
}

/// Waits for all that was submitted so far. wgpu's own wait with a timeout fails an assertion of wgpu-core 30 if
/// another thread's submission ends meanwhile, and one without keeps other threads from freeing what they made.
fn wait(device: &wgpu::Device, queue: &wgpu::Queue) {
    const STEP: Duration = Duration::from_millis(1);
    let (sender, done) = sync_channel(1);
    queue.on_submitted_work_done(move || _ = sender.send(()));
    // If the device is lost, of which its owner is told, the sender is dropped.
    while device.poll(wgpu::PollType::Poll).is_ok() {
        if done.recv_timeout(STEP) != Err(RecvTimeoutError::Timeout) {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_bounded_and_cover_each_part_once_and_in_order() {
        let sizes = vec![0, 5, 1, 0, 12, 3];
        for most in [1, 2, 4, 7, 21, u32::MAX] {
            let mut slices = Slices::new(sizes.clone());
            let mut done = vec![0; sizes.len()];
            let mut last_part = 0;
            loop {
                let slice = slices.take(most);
                let taken: u32 = slice.iter().map(|(_, range)| range.len() as u32).sum();
                assert!(taken <= most, "{taken} of {most}");
                if slice.is_empty() {
                    break;
                }
                for (part, range) in slice {
                    assert!(part >= last_part);
                    last_part = part;
                    assert_eq!(range.start, done[part]);
                    done[part] = range.end;
                }
            }
            assert_eq!(done, sizes, "{most}");
        }
    }

    #[test]
    fn slow_slices_shrink_quick_ones_grow_and_neither_ends_the_work() {
        let mut pace = Pace::default();
        for _ in 0..100 {
            pace.adapt(Duration::from_secs(1));
        }
        assert_eq!(pace.primitives(), LEAST);
        for _ in 0..100 {
            pace.adapt(Duration::ZERO);
        }
        // It stays a pace that adapts.
        assert!(pace != Pace::UNLIMITED && pace.primitives() > u32::MAX / 2);
        pace.adapt(Duration::from_secs(1));
        assert!(pace.primitives() < u32::MAX / 2 + 1);
        // Few primitives are given more time: nothing is won by even fewer.
        let mut few = Pace(SMALL);
        few.adapt(SMALL_SLICE.end);
        assert_eq!(few, Pace(SMALL));
        let mut steady = Pace::default();
        steady.adapt(SLICE.start);
        steady.adapt(SLICE.end);
        assert_eq!(steady, Pace::default());
        let mut unlimited = Pace::UNLIMITED;
        unlimited.adapt(Duration::from_secs(1));
        assert_eq!(unlimited, Pace::UNLIMITED);
    }
}
