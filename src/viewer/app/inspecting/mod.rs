//! Inspecting beyond one pixel.
//!
//! | file | part |
//! |---|---|
//! | `pick_list` | the list of picks: its state |
//! | `picks` | the list of picks, the measurements between them, and the walk of the selected one |
//! | `hover` | the read-out under the pointer |
//! | `go_to` | going to an element that is named |

mod go_to;
mod hover;
mod pick_list;
mod picks;

use super::App;
use crate::go_to::GoToBox;

/// The state of inspecting beyond one pixel.
#[derive(Default)]
pub(crate) struct Inspecting {
    pub picks: pick_list::Picks,
    pub hover: hover::Hover,
    /// The box in which the user names an element.
    pub go_to: GoToBox,
    journey: Option<go_to::Journey>,
}

impl App {
    /// Collects results of background work.
    pub(super) fn poll_inspecting(&mut self, ctx: &egui::Context) {
        self.poll_picks(ctx);
        self.poll_journey(ctx);
    }
}
