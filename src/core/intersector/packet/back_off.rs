//! Back-off: decides when packets are abandoned and their rays traced one by one. A packet that searches for any hits is
//! split (see [`SubtreeLists`](crate::bvh::SubtreeLists)); the rays of others start at the root.
//!
//! Where rays lie farther apart than triangles are large, as in a view from far away or at silhouettes, a packet tests
//! more triangles than its rays do one by one. The interval that encloses the rays then meets most triangles of a block,
//! while coherent rays share a few. A packet is abandoned once it has tested too many triangles for its blocks. As its
//! neighbours rarely fare better, the next packets are abandoned at their first block, or split at once; their number
//! doubles with each failure.

use std::cell::Cell;

/// Triangles tested in excess of [`PER_BLOCK`] before a packet that searches for nearest hits is abandoned.
///
/// Measured with 8 to 64, and with 0 to 3.5 per block, on rays of a camera at 0.3, 1, 3 and 10 times the distance of the
/// starting view, 1.1 M triangles (AVX-512, AMD Zen 4, 2026-11).
pub(super) const EXCESS_OF_NEAREST: i32 = 48;

/// The same for packets that search for any hits, which cost single rays less.
///
/// On rays to a lamp in the starting view, 16 and 24 are a tenth slower, 48 as fast. Relative to single rays, packets run
/// at 4.3, 1.9, 1.1 and 1.0 in the four views; if every packet is split at once, at 1.7, 1.3, 1.1 and 1.1 (`hitscope bench
/// --kernel fast`, 1.1 M triangles, AVX2, AMD Zen 3, medians of 3, 2026-11).
pub(super) const EXCESS_OF_ANY: i32 = 32;

/// Triangles per block that coherent rays test.
const PER_BLOCK: i32 = 3;

/// The most blocks that a packet visits, even if it tests few triangles in each.
const MOST_BLOCKS: u32 = 96;

/// The most successive failures that count. After n failures, the next 2ⁿ − 1 packets that reach a block are abandoned
/// there, or split at once.
const MOST_FAILURES: u32 = 4;

/// The triangles and blocks that a packet may still test.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowance {
    excess: i32,
    blocks_left: u32,
}

impl Allowance {
    /// Whether the packet is to be abandoned at its next block.
    #[inline(always)]
    pub fn is_used_up(self) -> bool {
        self.excess <= 0
    }

    /// Takes a block, unless the packet is to be abandoned.
    #[inline(always)]
    pub fn takes_block(&mut self) -> bool {
        if self.is_used_up() || self.blocks_left == 0 {
            return false;
        }
        self.blocks_left -= 1;
        true
    }

    /// Notes the triangles that were tested in a block.
    #[inline(always)]
    pub fn tested(&mut self, triangles: u32) {
        self.excess += PER_BLOCK - triangles as i32;
    }
}

/// The state of the back-off: how coherent the last packets were.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct BackOff {
    /// Failures since the last packet that was worthwhile, at most [`MOST_FAILURES`].
    failures: u32,
    /// The number of packets that are still to be abandoned at their first block, or split at once.
    alone: u32,
}

thread_local! {
    // A caller passes few packets at a time, so the state outlives the call. The state changes the speed of later
    // packets, never their hits.
    static LAST: Cell<BackOff> = const { Cell::new(BackOff { failures: 0, alone: 0 }) };
}

impl BackOff {
    /// The state that the thread's last call kept.
    pub fn resumed() -> Self {
        LAST.get()
    }

    /// Keeps the state for the thread's next call.
    pub fn keep(self) {
        LAST.set(self);
    }

    /// The allowance of the next packet, which may test this many triangles in excess.
    #[inline(always)]
    pub fn allowance(self, excess: i32) -> Allowance {
        Allowance {
            excess: if self.alone > 0 { 0 } else { excess },
            blocks_left: MOST_BLOCKS,
        }
    }

    /// Notes how a packet ended, with what is left of its allowance.
    #[inline(always)]
    pub fn note(&mut self, left: Allowance, is_abandoned: bool) {
        if is_abandoned && self.alone > 0 {
            self.alone -= 1;
        } else if is_abandoned {
            self.failures = (self.failures + 1).min(MOST_FAILURES);
            self.alone = (1 << self.failures) - 1;
        } else if left.blocks_left < MOST_BLOCKS {
            self.failures = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXCESS: i32 = 32;

    /// Traces a packet that tests `triangles` in each of `blocks`; returns whether it was abandoned.
    fn trace(state: &mut BackOff, blocks: u32, triangles: u32) -> bool {
        let mut allowance = state.allowance(EXCESS);
        let mut is_abandoned = false;
        for _ in 0..blocks {
            if !allowance.takes_block() {
                is_abandoned = true;
                break;
            }
            allowance.tested(triangles);
        }
        state.note(allowance, is_abandoned);
        is_abandoned
    }

    #[test]
    fn coherent_packets_are_never_abandoned() {
        let mut state = BackOff::default();
        for (blocks, triangles) in [(0, 0), (90, 3), (6, 8), (30, 4)] {
            assert!(!trace(&mut state, blocks, triangles), "{blocks}");
            assert_eq!(state, BackOff::default());
        }
        assert!(trace(&mut state, 1000, 1), "too many blocks");
    }

    #[test]
    fn each_failure_doubles_the_packets_that_are_not_tried_and_a_success_ends_that() {
        let mut state = BackOff::default();
        for untried in [1, 3, 7, 15, 15] {
            assert!(trace(&mut state, 40, 6));
            for _ in 0..untried {
                // Packets that meet nothing are traced and don't change the state.
                assert!(!trace(&mut state, 0, 0));
                assert_eq!(state.allowance(EXCESS).excess, 0);
                assert!(trace(&mut state, 1, 2));
            }
            assert_eq!(state.allowance(EXCESS).excess, EXCESS);
        }
        assert!(!trace(&mut state, 4, 2));
        assert_eq!(state, BackOff::default());
    }
}
