//! The states of all overlays, which settings keep.

use super::spec::{OverlayOption, OverlaySpec, Trigger};
use super::{OVERLAYS, overlay};
use crate::storage::{merged, number};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// The widths that a control can set.
pub const WIDTHS_PX: RangeInclusive<f32> = 0.5..=10.0;
/// The opacities that a control can set.
pub const OPACITIES: RangeInclusive<f32> = 0.0..=1.0;

/// The state of an overlay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OverlayState {
    /// Whether it is drawn.
    pub is_on: bool,
    /// sRGB.
    pub colour: [u8; 3],
    /// Opacity from 0 to 1.
    pub opacity: f32,
    /// Width in pixels, on a screen with one pixel per point.
    pub width_px: f32,
    /// Values of its own options by their names.
    options: BTreeMap<String, f32>,
}

impl OverlayState {
    /// The state at first.
    fn of(overlay: &OverlaySpec) -> Self {
        let options = overlay.options.iter();
        Self {
            is_on: match overlay.trigger {
                Trigger::Switch { is_on } => is_on,
                Trigger::Mark => true,
            },
            colour: overlay.style.colour,
            opacity: overlay.style.opacity,
            width_px: overlay.style.width_px,
            options: options
                .map(|option| (option.name.to_owned(), option.default))
                .collect(),
        }
    }

    /// The value of an option.
    pub fn value(&self, option: &OverlayOption) -> f32 {
        let value = self.options.get(option.name);
        value.copied().unwrap_or(option.default)
    }

    /// Whether an option that is a switch is on.
    pub fn is_set(&self, option: &OverlayOption) -> bool {
        self.value(option) != 0.0
    }

    /// Sets the value of an option.
    pub fn set(&mut self, option: &OverlayOption, value: f32) {
        self.options.insert(option.name.to_owned(), value);
    }

    /// Replaces values that the window can't have set by those of `default`.
    fn usable(self, overlay: &OverlaySpec, default: &Self) -> Self {
        let value =
            |option: &&OverlayOption| (option.name.to_owned(), option.usable(self.value(option)));
        Self {
            is_on: self.is_on || !overlay.is_switch(),
            opacity: number(self.opacity, OPACITIES, default.opacity),
            width_px: number(self.width_px, WIDTHS_PX, default.width_px),
            options: overlay.options.iter().map(value).collect(),
            ..self
        }
    }
}

/// The state of each overlay.
///
/// It is stored by the overlays' names. What is missing, invalid or of another version is replaced by the default.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    from = "BTreeMap<String, Value>",
    into = "BTreeMap<String, OverlayState>"
)]
pub struct Overlays(
    /// In the order of [`OVERLAYS`].
    Vec<OverlayState>,
);

impl Default for Overlays {
    fn default() -> Self {
        Self(OVERLAYS.iter().copied().map(OverlayState::of).collect())
    }
}

impl Overlays {
    /// All overlays with their states.
    pub fn iter(&self) -> impl Iterator<Item = (&'static OverlaySpec, &OverlayState)> {
        OVERLAYS.iter().copied().zip(&self.0)
    }

    /// The state of an overlay.
    ///
    /// # Panics
    /// If the overlay isn't in [`OVERLAYS`].
    pub fn state(&self, overlay: &OverlaySpec) -> &OverlayState {
        &self.0[index(overlay)]
    }

    /// The state of an overlay, to change it.
    ///
    /// # Panics
    /// If the overlay isn't in [`OVERLAYS`].
    pub fn state_mut(&mut self, overlay: &OverlaySpec) -> &mut OverlayState {
        &mut self.0[index(overlay)]
    }

    /// Whether an overlay is on.
    pub fn is_on(&self, overlay: &OverlaySpec) -> bool {
        self.state(overlay).is_on
    }

    /// Turns an overlay on or off.
    pub fn set_on(&mut self, overlay: &OverlaySpec, is_on: bool) {
        self.state_mut(overlay).is_on = is_on;
    }

    /// Turns an overlay off if it is on, else on.
    pub fn toggle(&mut self, overlay: &OverlaySpec) {
        let state = self.state_mut(overlay);
        state.is_on = !state.is_on;
    }

    /// Turns off all overlays except those that are on at first.
    pub fn turn_off_added(&mut self) {
        for (state, overlay) in self.0.iter_mut().zip(OVERLAYS) {
            state.is_on &= OverlayState::of(overlay).is_on;
        }
    }
}

fn index(overlay: &OverlaySpec) -> usize {
    let mut overlays = OVERLAYS.iter();
    let index = overlays.position(|other| other.name == overlay.name);
    index.expect("overlays are rows of the table")
}

impl From<BTreeMap<String, Value>> for Overlays {
    fn from(stored: BTreeMap<String, Value>) -> Self {
        let mut overlays = Self::default();
        for (name, value) in stored {
            if let (Some(overlay), Value::Object(fields)) = (overlay(&name), value) {
                let default = OverlayState::of(overlay);
                let state = merged(&default, fields);
                *overlays.state_mut(overlay) = state.usable(overlay, &default);
            }
        }
        overlays
    }
}

impl From<Overlays> for BTreeMap<String, OverlayState> {
    fn from(overlays: Overlays) -> Self {
        let names = OVERLAYS.iter().map(|overlay| overlay.name.to_owned());
        names.zip(overlays.0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overlay::elements::ELEMENTS;
    use crate::overlay::normals::LENGTH;
    use crate::overlay::vertex_normals::VERTEX_NORMALS;
    use crate::overlay::wireframe::WIREFRAME;

    fn read(text: &str) -> Overlays {
        serde_json::from_str(text).expect("JSON")
    }

    #[test]
    fn states_are_read_back() {
        let mut overlays = Overlays::default();
        let state = overlays.state_mut(&VERTEX_NORMALS);
        (state.is_on, state.colour, state.width_px) = (true, [1, 2, 3], 4.0);
        state.set(&LENGTH, 0.2);
        overlays.set_on(&ELEMENTS, false);
        let text = serde_json::to_string(&overlays).expect("JSON");
        assert_eq!(read(&text), overlays);
    }

    #[test]
    fn a_bad_value_becomes_the_default_and_affects_no_other() {
        let default = Overlays::default();
        for bad in [
            "\"opacity\": 2",
            "\"opacity\": null",
            "\"width_px\": 0",
            "\"width_px\": 1e39",
            "\"colour\": [1, 2]",
            "\"colour\": [1, 2, 300]",
            "\"of another version\": 3",
            "\"options\": {\"diagonals\": null}",
            "\"options\": {\"of another version\": 3}",
            "\"options\": 3",
        ] {
            let text = format!("{{\"wireframe\": {{\"is_on\": true, {bad}}}}}");
            let mut expected = default.clone();
            expected.set_on(&WIREFRAME, true);
            assert_eq!(read(&text), expected, "{bad}");
        }
        for text in [
            "{}",
            "{\"of another version\": {\"is_on\": true}}",
            "{\"wireframe\": 3}",
        ] {
            assert_eq!(read(text), default, "{text}");
        }
        let text = "{\"vertex-normals\": {\"options\": {\"length\": 2}}}";
        assert_eq!(read(text), default, "longer than the control allows");
    }

    #[test]
    fn marks_cannot_be_turned_off_by_a_file() {
        let text = "{\"picked\": {\"is_on\": false}, \"path\": {\"is_on\": false}}";
        assert_eq!(read(text), Overlays::default());
    }

    #[test]
    fn what_was_added_is_turned_off_and_what_was_removed_stays_off() {
        let mut overlays = Overlays::default();
        overlays.toggle(&WIREFRAME);
        overlays.toggle(&ELEMENTS);
        assert!(overlays.is_on(&WIREFRAME) && !overlays.is_on(&ELEMENTS));
        overlays.turn_off_added();
        assert!(!overlays.is_on(&WIREFRAME) && !overlays.is_on(&ELEMENTS));
    }
}
