//! What the user chose about parts, by their names, so that it outlives a reload and fits in a session.

use super::list::{Grouping, PartName};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Which parts are hidden, and their own colours.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PartsChoice {
    /// Whether a primitive is hidden if no rule is about one of its parts.
    hides_others: bool,
    /// Of the rules about a primitive's parts, the last one counts.
    rules: Vec<Rule>,
    /// Likewise.
    colours: Vec<OwnColour>,
}

/// Whether a part is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Rule {
    #[serde(flatten)]
    part: PartName,
    is_shown: bool,
}

/// The own colour of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct OwnColour {
    #[serde(flatten)]
    part: PartName,
    srgb: [u8; 3],
}

impl PartsChoice {
    /// Whether nothing is hidden.
    pub fn shows_all(&self) -> bool {
        !self.hides_others && self.rules.iter().all(|rule| rule.is_shown)
    }

    /// Whether primitives are shown about whose parts there is no rule.
    pub fn shows_others(&self) -> bool {
        !self.hides_others
    }

    /// Shows or hides a part.
    pub fn show(&mut self, part: &PartName, is_shown: bool) {
        self.rules.retain(|rule| rule.part != *part);
        self.rules.push(Rule {
            part: part.clone(),
            is_shown,
        });
    }

    /// Shows a part alone.
    pub fn show_only(&mut self, part: &PartName) {
        self.show_all();
        self.hides_others = true;
        self.show(part, true);
    }

    /// Shows everything.
    pub fn show_all(&mut self) {
        self.hides_others = false;
        self.rules.clear();
    }

    /// Shows what is hidden, and hides what is shown.
    pub fn invert(&mut self) {
        self.hides_others ^= true;
        for rule in &mut self.rules {
            rule.is_shown ^= true;
        }
    }

    /// The own colour of a part.
    pub fn colour_of(&self, part: &PartName) -> Option<[u8; 3]> {
        let own = self.colours.iter().find(|own| own.part == *part);
        own.map(|own| own.srgb)
    }

    /// Gives a part its own colour; `None` takes it away.
    pub fn colour(&mut self, part: &PartName, srgb: Option<[u8; 3]>) {
        let known = self.colours.iter_mut().find(|own| own.part == *part);
        match (srgb, known) {
            (Some(srgb), Some(own)) => own.srgb = srgb,
            (Some(srgb), None) => self.colours.push(OwnColour {
                part: part.clone(),
                srgb,
            }),
            (None, _) => self.colours.retain(|own| own.part != *part),
        }
    }

    /// The own colours, in the order in which they were given.
    pub fn colours(&self) -> impl Iterator<Item = [u8; 3]> {
        self.colours.iter().map(|own| own.srgb)
    }

    /// The rules about parts of a grouping: for each part the number of its rule, and whether the rule shows it.
    pub(super) fn rules_by(&self, grouping: Grouping) -> HashMap<&PartName, (usize, bool)> {
        let numbered = self.rules.iter().enumerate();
        numbered
            .filter(|(_, rule)| rule.part.grouping == grouping)
            .map(|(number, rule)| (&rule.part, (number, rule.is_shown)))
            .collect()
    }

    /// The numbers of the own colours of a grouping's parts, counted from 1.
    pub(super) fn colours_by(&self, grouping: Grouping) -> HashMap<&PartName, u32> {
        let numbered = (1..).zip(&self.colours);
        numbered
            .filter(|(_, own)| own.part.grouping == grouping)
            .map(|(number, own)| (&own.part, number))
            .collect()
    }

    /// The parts with own colours.
    pub(super) fn coloured(&self) -> Vec<PartName> {
        self.colours.iter().map(|own| own.part.clone()).collect()
    }
}
