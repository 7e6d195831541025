//! The user's choices about parts by name, so that they survive reloads and can be stored in sessions.

use super::list::{Grouping, PartKey};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Hidden parts, and custom colours of parts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PartsChoice {
    /// Whether primitives are hidden that no rule applies to.
    hides_others: bool,
    /// The last rule about any of a primitive's parts applies.
    rules: Vec<Rule>,
    /// The last colour of any of a primitive's parts applies.
    colours: Vec<OwnColour>,
}

/// Whether a part is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Rule {
    #[serde(flatten)]
    part: PartKey,
    is_shown: bool,
}

/// The custom colour of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct OwnColour {
    #[serde(flatten)]
    part: PartKey,
    srgb: [u8; 3],
}

impl PartsChoice {
    /// Whether nothing is hidden.
    pub fn shows_all(&self) -> bool {
        !self.hides_others && self.rules.iter().all(|rule| rule.is_shown)
    }

    /// Whether primitives are shown that no rule applies to.
    pub fn shows_others(&self) -> bool {
        !self.hides_others
    }

    /// Shows or hides a part.
    pub fn show(&mut self, part: &PartKey, is_shown: bool) {
        self.rules.retain(|rule| rule.part != *part);
        self.rules.push(Rule {
            part: part.clone(),
            is_shown,
        });
    }

    /// Shows only this part.
    pub fn show_only(&mut self, part: &PartKey) {
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

    /// The custom colour of a part.
    pub fn colour_of(&self, part: &PartKey) -> Option<[u8; 3]> {
        let own = self.colours.iter().find(|own| own.part == *part);
        own.map(|own| own.srgb)
    }

    /// Sets the custom colour of a part; `None` removes it.
    pub fn colour(&mut self, part: &PartKey, srgb: Option<[u8; 3]>) {
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

    /// The custom colours, in the order in which they were first set.
    pub fn colours(&self) -> impl Iterator<Item = [u8; 3]> {
        self.colours.iter().map(|own| own.srgb)
    }

    /// The rules about parts of a grouping: the number of each part's rule, and whether the rule shows it.
    pub(super) fn rules_by(&self, grouping: Grouping) -> HashMap<&PartKey, (usize, bool)> {
        let numbered = self.rules.iter().enumerate();
        numbered
            .filter(|(_, rule)| rule.part.grouping == grouping)
            .map(|(number, rule)| (&rule.part, (number, rule.is_shown)))
            .collect()
    }

    /// The numbers of the custom colours of a grouping's parts, counted from 1.
    pub(super) fn colours_by(&self, grouping: Grouping) -> HashMap<&PartKey, u32> {
        let numbered = (1..).zip(&self.colours);
        numbered
            .filter(|(_, own)| own.part.grouping == grouping)
            .map(|(number, own)| (&own.part, number))
            .collect()
    }

    /// The same choice with black for each custom colour. It determines which primitives are shown and which have a
    /// colour.
    pub(super) fn without_colour_values(&self) -> Self {
        let mut plain = self.clone();
        plain.colours.iter_mut().for_each(|own| own.srgb = [0; 3]);
        plain
    }

    /// The parts with custom colours.
    pub(super) fn coloured(&self) -> Vec<PartKey> {
        self.colours.iter().map(|own| own.part.clone()).collect()
    }
}
