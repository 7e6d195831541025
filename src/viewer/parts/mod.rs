//! The parts of a scene: groups, materials or shapes, each of which can be hidden and have a custom colour.
//!
//! | file | part |
//! |---|---|
//! | `list` | the parts that a scene has |
//! | `choice` | the user's choices about them, by name |
//! | this file | the choices applied to a scene: the shown primitives and their colours |

mod choice;
mod list;

pub use choice::PartsChoice;
pub use list::{Grouping, Part, PartKey, PartList};

use crate::document::ShownPrimitives;
use hitscope_core::Scene;
use hitscope_core::integrator::SurfaceColours;
use hitscope_core::srgb::from_texel;
use std::collections::HashMap;
use std::sync::Arc;

/// The parts of a scene, and which primitives are to be shown.
#[derive(Default)]
pub struct Parts {
    /// How primitives are grouped into parts.
    pub grouping: Grouping,
    /// The text that the names of listed parts contain.
    pub filter: String,
    choice: PartsChoice,
    /// Whether the choice has changed since [`refresh`](Self::refresh).
    is_stale: bool,
    /// The parts by each grouping, once they are listed.
    lists: [Option<Arc<PartList>>; Grouping::ALL.len()],
    shown: ShownPrimitives,
    /// The number of primitives of each part that are shown.
    shown_counts: Vec<usize>,
    /// The grouping whose parts were counted.
    counted: Option<Grouping>,
    colours: Option<SurfaceColours>,
    /// The parts with custom colours in `colours`.
    coloured: Vec<PartKey>,
    /// The choice that the picture shows, and its primitives.
    applied: (PartsChoice, ShownPrimitives),
}

impl Parts {
    /// The parts of a scene that isn't known yet, with these choices.
    pub fn by(grouping: Grouping, choice: PartsChoice) -> Self {
        Self {
            grouping,
            choice,
            is_stale: true,
            ..Self::default()
        }
    }

    /// The user's choices.
    pub fn choice(&self) -> &PartsChoice {
        &self.choice
    }

    /// Replaces the user's choices.
    pub fn choose(&mut self, choice: PartsChoice) {
        self.change(|old| *old = choice);
    }

    fn change(&mut self, change: impl FnOnce(&mut PartsChoice)) {
        change(&mut self.choice);
        self.is_stale = true;
    }

    fn listed_by(&mut self, grouping: Grouping, scene: &Scene) -> Arc<PartList> {
        let list = &mut self.lists[grouping as usize];
        let listed = || Arc::new(PartList::of(scene, grouping));
        Arc::clone(list.get_or_insert_with(listed))
    }

    /// The parts of a scene by the chosen grouping. The first call lists them.
    pub fn list(&mut self, scene: &Scene) -> Arc<PartList> {
        let list = self.listed_by(self.grouping, scene);
        if self.counted != Some(self.grouping) {
            self.count(&list);
        }
        list
    }

    /// Groups the parts in another way. What is hidden stays hidden.
    pub fn group_by(&mut self, grouping: Grouping) {
        self.grouping = grouping;
    }

    /// Whether [`refresh`](Self::refresh) has something to do.
    pub fn is_stale(&self) -> bool {
        self.is_stale
    }

    /// Updates the primitives to show and their colours, if the choice has changed.
    pub fn refresh(&mut self, scene: &Scene) {
        if !std::mem::take(&mut self.is_stale) {
            return;
        }
        let flags = self.flags(scene);
        if self.shown.0.as_deref() != flags.as_ref() {
            self.shown = ShownPrimitives(flags.map(Arc::new));
            self.counted = None;
        }
        self.refresh_colours(scene);
    }

    /// A flag for each primitive that tells whether it is to be shown; `None` if all are.
    fn flags(&mut self, scene: &Scene) -> Option<Vec<bool>> {
        if self.choice.shows_all() {
            return None;
        }
        // The number of the last rule about each primitive, and what it says.
        let mut last = vec![None; scene.primitive_count()];
        for grouping in Grouping::ALL {
            if self.choice.rules_by(grouping).is_empty() {
                continue;
            }
            let list = self.listed_by(grouping, scene);
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

    fn refresh_colours(&mut self, scene: &Scene) {
        let coloured = self.choice.coloured();
        let colours: Vec<_> = self.choice.colours().map(from_texel).collect();
        if coloured.is_empty() {
            self.colours = None;
        } else if let Some(old) = self.colours.take_if(|_| self.coloured == coloured) {
            self.colours = Some(old.recoloured(colours));
        } else {
            let mut numbers = vec![0; scene.primitive_count()];
            for grouping in Grouping::ALL {
                if self.choice.colours_by(grouping).is_empty() {
                    continue;
                }
                let list = self.listed_by(grouping, scene);
                let of_parts = of_parts(&list, &self.choice.colours_by(grouping));
                for (number, part) in numbers.iter_mut().zip(list.all()) {
                    *number = (*number).max(of_parts[part].unwrap_or(0));
                }
            }
            self.colours = Some(SurfaceColours::new(numbers, colours));
        }
        self.coloured = coloured;
    }

    /// The primitives that are to be shown.
    pub fn shown(&self) -> &ShownPrimitives {
        &self.shown
    }

    /// Notes that the picture shows the choice.
    pub fn note_applied(&mut self) {
        if self.applied.0 != self.choice || self.applied.1 != self.shown {
            self.applied = (self.choice.clone(), self.shown.clone());
        }
    }

    /// Goes back to the choice that the picture shows.
    pub fn revert(&mut self) {
        let (choice, shown) = self.applied.clone();
        self.choose(choice);
        // The same flags, so that no new tree is built.
        self.shown = shown;
        self.counted = None;
    }

    /// The custom colours of parts; `None` if no part has one.
    pub fn colours(&self) -> Option<&SurfaceColours> {
        self.colours.as_ref()
    }

    fn listed(&self) -> Option<&PartList> {
        self.lists[self.grouping as usize].as_deref()
    }

    fn key(&self, part: usize) -> Option<PartKey> {
        Some(self.listed()?.parts.get(part)?.key.clone())
    }

    /// Whether a part is shown; `None` if some of its primitives are.
    pub fn is_shown(&self, part: usize) -> Option<bool> {
        let count = self.listed().map_or(0, |list| list.parts[part].count);
        match self.shown_counts.get(part).copied() {
            Some(0) => Some(false),
            Some(shown) if shown < count => None,
            _ => Some(true),
        }
    }

    /// Shows or hides a part.
    pub fn show(&mut self, part: usize, is_shown: bool) {
        if let Some(key) = self.key(part) {
            self.change(|choice| choice.show(&key, is_shown));
        }
    }

    /// Shows only this part.
    pub fn show_only(&mut self, part: usize) {
        if let Some(key) = self.key(part) {
            self.change(|choice| choice.show_only(&key));
        }
    }

    /// Shows everything.
    pub fn show_all(&mut self) {
        self.change(PartsChoice::show_all);
    }

    /// Shows what is hidden, and hides what is shown.
    pub fn invert(&mut self) {
        self.change(PartsChoice::invert);
    }

    /// The custom colour of a part, in sRGB.
    pub fn own_colour(&self, part: usize) -> Option<[u8; 3]> {
        self.choice.colour_of(&self.key(part)?)
    }

    /// Sets the custom colour of a part in sRGB; `None` removes it.
    pub fn colour(&mut self, part: usize, srgb: Option<[u8; 3]>) {
        if let Some(key) = self.key(part) {
            self.change(|choice| choice.colour(&key, srgb));
        }
    }

    fn count(&mut self, list: &PartList) {
        self.counted = Some(self.grouping);
        let Some(flags) = &self.shown.0 else {
            self.shown_counts = list.parts.iter().map(|part| part.count).collect();
            return;
        };
        self.shown_counts = vec![0; list.parts.len()];
        for (part, &is_shown) in list.all().zip(&**flags) {
            self.shown_counts[part] += usize::from(is_shown);
        }
    }
}

/// The value of each part of a list that has one.
fn of_parts<T: Copy>(list: &PartList, of_keys: &HashMap<&PartKey, T>) -> Vec<Option<T>> {
    let value = |part: &Part| of_keys.get(&part.key).copied();
    list.parts.iter().map(value).collect()
}

#[cfg(test)]
mod tests;
