//! Finds the entries of a file's lists that elements use, and removes the others.

use super::corner::List;
use super::elements::Elements;
use crate::mesh::NO_INDEX;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// The entries in use of each list.
pub(super) struct Used([UsedEntries; 3]);

/// The entries in use of a list.
struct UsedEntries {
    is_used: Vec<bool>,
    /// The new index of each entry, unless all are used.
    numbering: Option<Vec<u32>>,
}

impl Used {
    /// Finds the entries that elements use, in lists of `counts` entries.
    pub(super) fn in_elements(elements: &[Elements], counts: [usize; 3]) -> Self {
        Self(List::ALL.map(|list| {
            let flags: Vec<AtomicBool> = (0..counts[list as usize])
                .map(|_| AtomicBool::new(false))
                .collect();
            elements.par_iter().for_each(|elements| {
                let indices = elements.corners[list as usize].iter();
                for &index in indices.filter(|&&index| index != NO_INDEX) {
                    flags[index as usize].store(true, Relaxed);
                }
            });
            UsedEntries::of(flags.into_iter().map(AtomicBool::into_inner).collect())
        }))
    }

    /// Removes the entries of a list that aren't used.
    pub(super) fn keep<T>(&self, list: List, entries: &mut Vec<T>) {
        let UsedEntries { is_used, numbering } = &self.0[list as usize];
        if numbering.is_some() {
            let mut is_used = is_used.iter();
            entries.retain(|_| is_used.next() == Some(&true));
            entries.shrink_to_fit();
        }
    }

    /// Replaces indices by those after [`keep`](Self::keep).
    pub(super) fn renumber(&self, list: List, indices: &mut [u32]) {
        let Some(new) = &self.0[list as usize].numbering else {
            return;
        };
        for index in indices {
            if *index != NO_INDEX {
                *index = new[*index as usize];
            }
        }
    }
}

impl UsedEntries {
    fn of(is_used: Vec<bool>) -> Self {
        let next = |next: &mut u32, &is_used: &bool| {
            let index = *next;
            *next += u32::from(is_used);
            Some(index)
        };
        let has_unused = is_used.contains(&false);
        let numbering = has_unused.then(|| is_used.iter().scan(0, next).collect());
        Self { is_used, numbering }
    }
}
