//! The flaws of the mesh that are marked.

use super::App;
use crate::flaw_place::FlawPlace;
use crate::task::{Pending, Task};
use hitscope_core::mesh::Flaw;
use std::sync::Arc;

/// Distance of the camera from a flaw, relative to the distance that frames the triangles there.
const FLAW_DISTANCE: f64 = 3.0;

/// A kind of flaw and the index of one of its flaws, counted from 0; or none.
pub type ShownFlaw = Option<(Flaw, usize)>;

impl App {
    /// Marks the flaws of a kind and frames the triangles around one of them, once they are found; `None` clears the
    /// mark.
    pub(super) fn show_flaw(&mut self, shown: ShownFlaw, ctx: &egui::Context) {
        let findings = self.open.document.known_findings();
        let Some(((flaw, index), findings)) = shown.zip(findings) else {
            self.picked.forget_flaw();
            return;
        };
        let scene = Arc::clone(&self.open.document.loaded.scene);
        // In the background: all triangles are searched for the adjacent ones.
        let find = move || FlawPlace::find(scene.mesh(), &findings.health, flaw, index);
        self.picked.flaw_search = Pending::Running(Task::spawn("flaw", ctx, find));
    }

    /// Marks a flaw and frames the triangles around it once they are found.
    pub(super) fn poll_flaw(&mut self) {
        let found = match self.picked.flaw_search.take() {
            Ok(None) => return,
            Ok(Some(found)) => found,
            Err(panicked) => {
                self.picked.forget_flaw();
                self.error(panicked);
                return;
            }
        };
        if let Some(place) = &found {
            // Shows some of the surface around it.
            self.frame_bounds(place.bounds, FLAW_DISTANCE);
        }
        self.picked.flaw = found;
    }
}

#[cfg(test)]
mod tests {
    use crate::harness::{app, wait};
    use crate::tab::Tab;
    use crate::task::sabotage;
    use hitscope_core::mesh::Flaw;

    #[test]
    fn a_flaw_is_searched_for_in_the_background() {
        let Some(mut window) = app(None) else { return };
        window.state_mut().preferences.tab = Tab::Mesh;
        wait(&mut window, "the check of the mesh", |app| {
            app.document().known_findings().is_some()
        });
        let findings = window.state().document().known_findings();
        let health = findings.expect("checked").health.clone();
        // The floor of the built-in scene has a border.
        assert!(
            health
                .places(Flaw::OpenEdge)
                .count()
                .is_some_and(|count| count > 1)
        );
        let hold = sabotage::hold("flaw");
        let ctx = window.ctx.clone();
        window
            .state_mut()
            .show_flaw(Some((Flaw::OpenEdge, 1)), &ctx);
        window.run_steps(3);
        assert_eq!(window.state().flaw(), None);
        drop(hold);
        wait(&mut window, "the flaw", |app| app.flaw().is_some());
        assert_eq!(window.state().flaw().map(|place| place.index), Some(1));
        window.state_mut().show_flaw(None, &ctx);
        assert_eq!(window.state().flaw(), None);
    }
}
