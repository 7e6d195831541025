//! The primitives of a group that are shown.

use std::sync::Arc;

/// Which primitives of a group rays can hit; all of them by default. Hidden primitives keep their numbers.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// For each primitive of the scene, whether it is shown; `None` if all are.
    flags: Option<Arc<Vec<bool>>>,
    /// The number of the group's first primitive in the scene.
    first: usize,
}

impl Shown {
    /// The part of a scene's flags that belongs to the group whose first primitive has the number `first`.
    pub(crate) fn of_group(flags: &Arc<Vec<bool>>, first: usize) -> Self {
        Self {
            flags: Some(Arc::clone(flags)),
            first,
        }
    }

    /// Whether a primitive of the group is shown.
    pub(crate) fn contains(&self, index: u32) -> bool {
        let flags = self.flags.as_ref();
        flags.is_none_or(|flags| flags[self.first + index as usize])
    }

    /// The primitives of a group of `count` that are shown.
    pub(crate) fn indices(&self, count: usize) -> Vec<u32> {
        let all = 0..count as u32;
        all.filter(|&index| self.contains(index)).collect()
    }
}
