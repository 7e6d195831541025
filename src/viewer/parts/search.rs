//! The search for parts by their names. A mesh may have as many parts as triangles, so a background task searches.

use super::list::PartList;
use crate::task::{KeyedTask, Task, TaskPanicked};
use std::sync::Arc;

/// The numbers of the parts that a search found, in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Matches {
    /// All parts, and their number.
    All(usize),
    /// These parts.
    Some(Arc<Vec<usize>>),
}

impl Matches {
    /// The number of parts.
    pub fn count(&self) -> usize {
        match self {
            Self::All(count) => *count,
            Self::Some(parts) => parts.len(),
        }
    }

    /// The number of the part in a row.
    pub fn part(&self, row: usize) -> usize {
        match self {
            Self::All(_) => row,
            Self::Some(parts) => parts[row],
        }
    }
}

/// A list of parts and a text. Lists are equal if they are the same object.
#[derive(Clone)]
struct SearchKey(Arc<PartList>, String);

impl PartialEq for SearchKey {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) && self.1 == other.1
    }
}

/// The last search and the running one.
#[derive(Default)]
pub(super) struct Search {
    found: Option<(SearchKey, Arc<Vec<usize>>)>,
    task: KeyedTask<SearchKey, Vec<usize>>,
}

impl Search {
    /// The parts whose names contain a text in any case. While they are being searched for, those of the last search in
    /// this list; all of them if there was none. A search that panics finds nothing.
    pub fn matches(&mut self, list: &Arc<PartList>, text: &str, ctx: &egui::Context) -> Matches {
        if text.is_empty() {
            self.task.cancel();
            self.found = None;
            return Matches::All(list.parts.len());
        }
        let key = SearchKey(Arc::clone(list), text.to_lowercase());
        if self.found.as_ref().is_none_or(|(known, _)| *known != key) {
            let wanted = key.clone();
            let start = || Task::spawn("search", ctx, move || wanted.find());
            let found = self.task.get(key.clone(), start);
            if let Some(parts) = found.unwrap_or_else(|TaskPanicked| Some(Vec::new())) {
                self.found = Some((key, Arc::new(parts)));
            }
        }
        let found = self.found.as_ref();
        let found = found.filter(|(known, _)| Arc::ptr_eq(&known.0, list));
        match found {
            Some((_, parts)) => Matches::Some(Arc::clone(parts)),
            None => Matches::All(list.parts.len()),
        }
    }
}

impl SearchKey {
    fn find(&self) -> Vec<usize> {
        let Self(list, text) = self;
        let is_found = |part: &usize| list.parts[*part].key.name.to_lowercase().contains(text);
        (0..list.parts.len()).filter(is_found).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::embedded_scene;
    use crate::parts::Grouping;
    use crate::task::sabotage;

    #[test]
    fn a_search_keeps_the_last_result_until_the_next_one_is_there() {
        let ctx = egui::Context::default();
        let list = Arc::new(PartList::of(&embedded_scene().scene, Grouping::Groups));
        let mut search = Search::default();
        let mut found = |text: &str| search.matches(&list, text, &ctx);
        assert_eq!(found(""), Matches::All(4));
        let hold = sabotage::hold("search");
        assert_eq!(found("E"), Matches::All(4), "not known yet");
        drop(hold);
        let wait = |found: &mut dyn FnMut() -> Matches, expected: &[usize]| {
            while found() != Matches::Some(Arc::new(expected.to_vec())) {
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
        };
        // Of floor, knot, gem and shell.
        wait(&mut || found("E"), &[2, 3]);
        let hold = sabotage::hold("search");
        assert_eq!(found("fl"), Matches::Some(Arc::new(vec![2, 3])));
        drop(hold);
        wait(&mut || found("fl"), &[0]);
        assert_eq!(found("fl").part(0), 0);
        assert_eq!(found(""), Matches::All(4));
    }
}
