//! Undo and redo: the steps of how a document was seen.

use crate::session::Sight;

/// The most steps that are kept.
const MAX_STEPS: usize = 100;
/// Turns of the wheel with a shorter pause are one step.
const WHEEL_PAUSE_SECS: f64 = 0.5;

/// A movement whose changes are one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// A button of the pointer is down, or the camera rotates by itself.
    Motion,
    /// The camera moves to a view.
    Transition,
    /// The wheel turns.
    Wheel,
    /// A text field has the focus.
    Typing,
}

/// Steps that can be undone and redone.
#[derive(Default)]
pub struct History {
    past: Vec<Sight>,
    future: Vec<Sight>,
    /// The newest state; `None` before the first one.
    now: Option<Sight>,
    /// The movement that the last step belongs to, while it lasts.
    open: Option<Gesture>,
    changed_at_secs: f64,
    /// Whether the next change is no step.
    absorbs: bool,
}

impl History {
    /// The newest state that is known.
    pub fn now(&self) -> Option<&Sight> {
        self.now.as_ref()
    }

    /// Notes the state of a frame, and the movement that goes on in this frame.
    pub fn note(&mut self, sight: Sight, gesture: Option<Gesture>, secs: f64) {
        let is_same = self.now.as_ref() == Some(&sight);
        if let (false, false, Some(last)) = (is_same, self.absorbs, &self.now) {
            let is_continued = gesture.is_some() && gesture == self.open;
            if !is_continued {
                self.past.push(last.clone());
                if self.past.len() > MAX_STEPS {
                    self.past.remove(0);
                }
            }
            self.future.clear();
            (self.open, self.changed_at_secs) = (gesture, secs);
        }
        self.absorbs = false;
        self.now = Some(sight);
        self.rest(gesture, secs);
    }

    /// Ends the last step if its movement has ended. Called for frames without a change, too.
    pub fn rest(&mut self, gesture: Option<Gesture>, secs: f64) {
        self.absorbs = false;
        let has_ended = match self.open {
            Some(Gesture::Wheel) => secs - self.changed_at_secs > WHEEL_PAUSE_SECS,
            open => gesture != open,
        };
        if has_ended {
            self.open = None;
        }
    }

    /// Makes the next change part of the last step: one that the user didn't make.
    pub fn absorb(&mut self) {
        self.absorbs = true;
    }

    /// Forgets all steps.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Whether a step can be undone.
    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether a step can be redone.
    pub fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }

    /// Undoes a step. Returns the state before it.
    pub fn undo(&mut self) -> Option<Sight> {
        let sight = self.past.pop()?;
        self.future.extend(self.now.replace(sight.clone()));
        self.open = None;
        Some(sight)
    }

    /// Redoes a step. Returns the state after it.
    pub fn redo(&mut self) -> Option<Sight> {
        let sight = self.future.pop()?;
        self.past.extend(self.now.replace(sight.clone()));
        self.open = None;
        Some(sight)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::PartsChoice;
    use crate::picks::Snapping;
    use crate::session::Viewpoint;
    use crate::settings::Settings;
    use glam::{DVec3, UVec2};
    use hitscope_core::Aabb;
    use hitscope_core::camera::Turntable;

    /// A state that differs from those of other numbers.
    fn sight(number: u32) -> Sight {
        let turntable = Turntable::framing(Aabb::EMPTY, UVec2::ONE);
        Sight {
            camera: Viewpoint::of(&turntable, DVec3::ZERO),
            settings: Settings {
                samples: number,
                ..Settings::default()
            },
            comparison: crate::comparison::Comparison::default(),
            parts: PartsChoice::default(),
            picks: Vec::new(),
            snapping: Snapping::default(),
        }
    }

    fn undone(history: &mut History) -> Option<u32> {
        history.undo().map(|sight| sight.settings.samples)
    }

    #[test]
    fn a_drag_is_one_step_and_so_are_quick_turns_of_the_wheel() {
        use Gesture::{Motion, Wheel};
        let mut history = History::default();
        let frames = [
            (0, None, 0.0),
            (1, Some(Motion), 1.0),
            (2, Some(Motion), 1.1),
            (2, None, 1.2),
            (3, Some(Motion), 1.3),
            (3, None, 1.4),
            (4, Some(Wheel), 2.0),
            (4, None, 2.2),
            (5, Some(Wheel), 2.4),
            // A key between two turns.
            (6, None, 2.5),
            (7, Some(Wheel), 2.6),
            (7, None, 3.2),
            (8, Some(Wheel), 3.3),
        ];
        for (number, gesture, secs) in frames {
            history.note(sight(number), gesture, secs);
        }
        for expected in [7, 6, 5, 3, 2, 0] {
            assert_eq!(undone(&mut history), Some(expected));
        }
        assert_eq!(undone(&mut history), None);
        assert!(!history.can_undo() && history.can_redo());
        let redone = history.redo().expect("a step");
        assert_eq!(redone.settings.samples, 2);
        // A new change ends what could be redone.
        history.note(sight(9), None, 9.0);
        assert!(!history.can_redo());
        assert_eq!(undone(&mut history), Some(2));
    }

    #[test]
    fn a_hundred_steps_are_kept_and_changes_by_the_program_are_none() {
        let mut history = History::default();
        for number in 0..300 {
            history.note(sight(number), None, number.into());
        }
        history.absorb();
        history.note(sight(1000), None, 300.0);
        let mut count = 0;
        while history.undo().is_some() {
            count += 1;
        }
        assert_eq!(count, MAX_STEPS);
        history.clear();
        assert!(!history.can_undo() && !history.can_redo());
    }
}
