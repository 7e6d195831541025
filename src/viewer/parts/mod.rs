//! The parts of a scene: groups, materials or shapes, each of which can be hidden and have a custom colour.
//!
//! | file | part |
//! |---|---|
//! | `list` | the parts that a scene has |
//! | `choice` | the user's choices about them, by name |
//! | `survey` | the choices applied to a scene: the shown primitives and their colours |
//! | `search` | the listed parts whose names contain a text |
//! | this file | the state of the parts, and the background task that surveys them |

mod choice;
mod list;
mod search;
mod survey;

pub use choice::PartsChoice;
pub use list::{Grouping, Part, PartKey, PartList};

use crate::document::ShownPrimitives;
use crate::task::{KeyedTask, Task, TaskPanicked};
use hitscope_core::Scene;
use hitscope_core::integrator::SurfaceColours;
use hitscope_core::srgb::from_texel;
use search::{Matches, Search};
use std::sync::Arc;
use survey::{Lists, Order, Survey};

/// A change to the part of a primitive. The part's number is known once the parts are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartChange {
    /// Hides the part.
    Hide,
    /// Shows only the part.
    ShowOnly,
}

/// The inputs that determine a survey: the choice without the values of the colours, and the grouping that is listed.
type SurveyKey = (PartsChoice, Option<Grouping>);

/// The parts of a scene, and which primitives are to be shown.
#[derive(Default)]
pub struct Parts {
    /// How primitives are grouped into parts.
    pub grouping: Grouping,
    /// The text that the names of listed parts contain.
    pub filter: String,
    search: Search,
    choice: PartsChoice,
    /// Whether the choice has changed since the last survey.
    is_stale: bool,
    /// Whether the parts by the chosen grouping are to be listed.
    wants_list: bool,
    survey: KeyedTask<SurveyKey, Survey>,
    /// Whether the last survey panicked.
    has_failed: bool,
    /// The parts by each grouping, once they are listed.
    lists: Lists,
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
    /// The change to make once the parts are listed, and the primitive whose part it changes.
    change: Option<(PartChange, u32)>,
}

impl Parts {
    /// The parts of a scene that isn't known yet, with these choices.
    pub fn by(grouping: Grouping, choice: PartsChoice) -> Self {
        Self {
            grouping,
            is_stale: choice != PartsChoice::default(),
            choice,
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
        let before = self.choice.without_colour_values();
        change(&mut self.choice);
        self.is_stale |= self.choice.without_colour_values() != before;
        self.has_failed = false;
        self.recolour();
    }

    /// Gives the coloured primitives the colours of the choice, unless other parts are coloured now.
    fn recolour(&mut self) {
        if self.coloured == self.choice.coloured() {
            let colours = self.choice.colours().map(from_texel).collect();
            let old = self.colours.take();
            self.colours = old.map(|old| old.recoloured(colours));
        }
    }

    /// The parts by the chosen grouping; `None` until [`update`](Self::update) has listed them, which this call
    /// requests.
    pub fn list(&mut self) -> Option<Arc<PartList>> {
        self.wants_list = true;
        self.listed().map(Arc::clone)
    }

    /// Groups the parts in another way. What is hidden stays hidden.
    pub fn group_by(&mut self, grouping: Grouping) {
        self.grouping = grouping;
        self.has_failed = false;
    }

    /// Whether [`update`](Self::update) has something to do.
    pub fn is_stale(&self) -> bool {
        let lacks_list = self.wants_list && self.counted != Some(self.grouping);
        !self.has_failed && (self.is_stale || lacks_list)
    }

    /// Whether the last survey panicked, so that there is no list.
    pub fn has_failed(&self) -> bool {
        self.has_failed
    }

    /// Applies the choice to the scene in the background, if it has changed, and lists the parts, if they were asked
    /// for. Collects the result.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if the task panicked; the choice is then the one that the picture shows.
    pub fn update(&mut self, scene: &Arc<Scene>, ctx: &egui::Context) -> Result<(), TaskPanicked> {
        if !self.is_stale() {
            self.survey.cancel();
            return Ok(());
        }
        let listed = self.wants_list.then_some(self.grouping);
        let key = (self.choice.without_colour_values(), listed);
        let has_numbers = self.coloured == self.choice.coloured();
        let start = || {
            let order = Order {
                scene: Arc::clone(scene),
                choice: self.choice.clone(),
                listed,
                lists: self.lists.clone(),
                shown: self.shown.clone(),
                colours: self.colours.clone().filter(|_| has_numbers),
            };
            Task::spawn("survey of parts", ctx, move || order.carry_out())
        };
        match self.survey.get(key, start) {
            Ok(None) => {}
            Ok(Some(survey)) => self.use_survey(survey, listed),
            Err(panicked) => {
                self.revert();
                (self.is_stale, self.wants_list, self.change) = (false, false, None);
                self.has_failed = true;
                return Err(panicked);
            }
        }
        Ok(())
    }

    fn use_survey(&mut self, survey: Survey, listed: Option<Grouping>) {
        self.lists = survey.lists;
        self.shown = survey.shown;
        (self.shown_counts, self.counted) = (survey.shown_counts, listed);
        (self.colours, self.coloured) = (survey.colours, self.choice.coloured());
        self.is_stale = false;
        self.recolour();
        self.make_change();
    }

    /// The primitives that are to be shown.
    pub fn shown(&self) -> &ShownPrimitives {
        &self.shown
    }

    /// Notes that the picture shows the choice.
    pub fn note_applied(&mut self) {
        let is_news = self.applied.0 != self.choice || self.applied.1 != self.shown;
        if is_news && !self.is_stale {
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

    fn listed(&self) -> Option<&Arc<PartList>> {
        self.lists[self.grouping as usize].as_ref()
    }

    fn key(&self, part: usize) -> Option<PartKey> {
        Some(self.listed()?.parts.get(part)?.key.clone())
    }

    /// Whether a part is shown; `None` if some of its primitives are.
    pub fn is_shown(&self, part: usize) -> Option<bool> {
        let count = self.listed().map_or(0, |list| list.parts[part].count);
        let counted = self.counted == Some(self.grouping);
        match self.shown_counts.get(part).filter(|_| counted) {
            Some(0) => Some(false),
            Some(&shown) if shown < count => None,
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

    /// Changes the part of a primitive, once the parts are listed.
    pub fn change_part_of(&mut self, primitive: u32, change: PartChange) {
        (self.change, self.wants_list) = (Some((change, primitive)), true);
        self.make_change();
    }

    fn make_change(&mut self) {
        let Some(list) = self.listed().map(Arc::clone) else {
            return;
        };
        if let Some((change, primitive)) = self.change.take() {
            let part = list.part_of(primitive);
            match change {
                PartChange::Hide => self.show(part, false),
                PartChange::ShowOnly => self.show_only(part),
            }
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

    /// The numbers of the listed parts whose names contain the filter's text, as far as they are known.
    pub fn matching(&mut self, ctx: &egui::Context) -> Matches {
        let Some(list) = self.listed().map(Arc::clone) else {
            return Matches::All(0);
        };
        self.search.matches(&list, &self.filter, ctx)
    }
}

#[cfg(test)]
mod tests;
