//! GPU work in slices of bounded time.
//!
//! A queue runs its submissions in order, so a frame of the window waits for all earlier submissions. Long work is
//! therefore submitted in slices, each when the previous one is done.

use std::ops::Range;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

/// Target time of a slice: less than a frame of 33 ms, and much more than a submission takes.
const SLICE: Range<Duration> = Duration::from_millis(8)..Duration::from_millis(25);
/// Slices of up to this many primitives take as long as a submission if they cover few pixels: lavapipe draws one or
/// two per µs (2 cores, 2026-11). On a busy machine shorter slices would only add submissions.
const SMALL: u32 = 1 << 14;
/// Target time of a small slice. Only primitives that cover many pixels take longer.
const SMALL_SLICE: Range<Duration> = Duration::from_millis(100)..Duration::from_millis(250);
/// Primitives in the first slice, before any measurement.
const FIRST: u32 = 1 << 15;
/// Primitives in the smallest slice, which bounds the number of submissions.
const LEAST: u32 = 1 << 6;

/// The number of primitives per slice, adapted to the times of earlier slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pace(u32);

impl Default for Pace {
    fn default() -> Self {
        Self(FIRST)
    }
}

impl Pace {
    /// One slice for everything, for a fast GPU or without a window.
    pub const UNLIMITED: Self = Self(u32::MAX);

    /// Primitives of the next slice.
    pub fn primitives(self) -> u32 {
        self.0
    }

    /// Adapts to the time that a slice took.
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
    /// Slices of parts with these sizes.
    pub fn new(sizes: Vec<u32>) -> Self {
        Self {
            sizes,
            part: 0,
            start: 0,
        }
    }

    /// The next slice: ranges of parts with `most` primitives in total, or the remaining ones. Empty at the end.
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

/// Submits commands, waits until they are done, and returns the time that they took. Must not be called on the
/// window's thread; other threads may submit meanwhile.
pub fn submit_and_wait(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    commands: Option<wgpu::CommandBuffer>,
) -> Duration {
    // Exclude earlier submissions from the measurement.
    wait(device, queue);
    let start = Instant::now();
    queue.submit(commands);
    wait(device, queue);
    start.elapsed()
}

/// Waits for all submissions so far. wgpu's own wait with a timeout fails an assertion in wgpu-core 30 if another
/// thread's submission ends meanwhile, and its wait without a timeout keeps other threads from freeing resources.
fn wait(device: &wgpu::Device, queue: &wgpu::Queue) {
    const STEP: Duration = Duration::from_millis(1);
    let (sender, done) = sync_channel(1);
    queue.on_submitted_work_done(move || _ = sender.send(()));
    // If the device is lost, which is reported elsewhere, the sender is dropped.
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
    fn slow_slices_shrink_and_fast_ones_grow_within_bounds() {
        let mut pace = Pace::default();
        for _ in 0..100 {
            pace.adapt(Duration::from_secs(1));
        }
        assert_eq!(pace.primitives(), LEAST);
        for _ in 0..100 {
            pace.adapt(Duration::ZERO);
        }
        // It remains adaptive.
        assert!(pace != Pace::UNLIMITED && pace.primitives() > u32::MAX / 2);
        pace.adapt(Duration::from_secs(1));
        assert!(pace.primitives() < u32::MAX / 2 + 1);
        // Small slices get more time, as smaller ones would gain nothing.
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
