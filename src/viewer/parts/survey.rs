//! Applies the choices about parts to a scene. A background task does this, because it visits every primitive.

use super::choice::PartsChoice;
use super::list::{Grouping, Part, PartKey, PartList};
use crate::document::ShownPrimitives;
use hitscope_core::Scene;
use hitscope_core::integrator::SurfaceColours;
use std::collections::HashMap;
use std::sync::Arc;

/// The parts by each grouping, once they are listed.
pub(super) type Lists = [Option<Arc<PartList>>; Grouping::ALL.len()];

/// The inputs of a survey.
pub(super) struct Order {
    pub scene: Arc<Scene>,
    pub choice: PartsChoice,
    /// The grouping by which parts are listed and counted, if any.
    pub listed: Option<Grouping>,
    /// The lists that are known.
    pub lists: Lists,
    /// The primitives that the last survey shows. They stay the same object if they don't change.
    pub shown: ShownPrimitives,
    /// The numbers of the colours, if they are known.
    pub colours: Option<SurfaceColours>,
}

/// The parts of a scene, the primitives to be shown, and their colours.
pub(super) struct Survey {
    pub lists: Lists,
    pub shown: ShownPrimitives,
    /// The number of primitives of each listed part that are shown.
    pub shown_counts: Vec<usize>,
    /// Which primitives have custom colours. The colours themselves are those of the choice.
    pub colours: Option<SurfaceColours>,
}

impl Order {
    /// Applies the choices.
    pub fn carry_out(mut self) -> Survey {
        let flags = self.flags();
        let is_same = self.shown.0.as_deref() == flags.as_ref();
        let shown = if is_same {
            self.shown.clone()
        } else {
            ShownPrimitives(flags.map(Arc::new))
        };
        let colours = self.colours.take().or_else(|| self.numbers());
        let listed = self.listed.map(|grouping| self.list(grouping));
        Survey {
            shown_counts: listed.map_or_else(Vec::new, |list| counts(&list, &shown)),
            lists: self.lists,
            shown,
            colours,
        }
    }

    fn list(&mut self, grouping: Grouping) -> Arc<PartList> {
        let list = &mut self.lists[grouping as usize];
        let listed = || Arc::new(PartList::of(&self.scene, grouping));
        Arc::clone(list.get_or_insert_with(listed))
    }

    /// A flag for each primitive that tells whether it is to be shown; `None` if all are.
    fn flags(&mut self) -> Option<Vec<bool>> {
        if self.choice.shows_all() {
            return None;
        }
        // The number of the last rule about each primitive, and what it says.
        let mut last = vec![None; self.scene.primitive_count()];
        for grouping in Grouping::ALL {
            if self.choice.rules_by(grouping).is_empty() {
                continue;
            }
            let list = self.list(grouping);
            let of_parts = of_parts(&list, &self.choice.rules_by(grouping));
            for (last, part) in last.iter_mut().zip(list.all()) {
                *last = (*last).max(of_parts[part]);
            }
        }
        let others = self.choice.shows_others();
        let flag = |last: Option<(usize, bool)>| last.map_or(others, |(_, is_shown)| is_shown);
        let flags: Vec<bool> = last.into_iter().map(flag).collect();
        flags.contains(&false).then_some(flags)
    }

    /// The number of each primitive's custom colour; `None` if no part has one.
    fn numbers(&mut self) -> Option<SurfaceColours> {
        if self.choice.coloured().is_empty() {
            return None;
        }
        let mut numbers = vec![0; self.scene.primitive_count()];
        for grouping in Grouping::ALL {
            if self.choice.colours_by(grouping).is_empty() {
                continue;
            }
            let list = self.list(grouping);
            let of_parts = of_parts(&list, &self.choice.colours_by(grouping));
            for (number, part) in numbers.iter_mut().zip(list.all()) {
                *number = (*number).max(of_parts[part].unwrap_or(0));
            }
        }
        Some(SurfaceColours::new(numbers, Vec::new()))
    }
}

/// The number of primitives of each part that are shown.
fn counts(list: &PartList, shown: &ShownPrimitives) -> Vec<usize> {
    let Some(flags) = &shown.0 else {
        return list.parts.iter().map(|part| part.count).collect();
    };
    let mut counts = vec![0; list.parts.len()];
    for (part, &is_shown) in list.all().zip(&**flags) {
        counts[part] += usize::from(is_shown);
    }
    counts
}

/// The value of each part of a list that has one.
fn of_parts<T: Copy>(list: &PartList, of_keys: &HashMap<&PartKey, T>) -> Vec<Option<T>> {
    let value = |part: &Part| of_keys.get(&part.key).copied();
    list.parts.iter().map(value).collect()
}
