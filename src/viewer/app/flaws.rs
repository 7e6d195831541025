//! The flaws of the mesh that are marked.

use super::App;
use crate::flaw_place::FlawPlace;
use hitscope_core::mesh::Flaw;

/// Distance of the camera from a flaw, relative to the distance that frames the triangles there.
const FLAW_DISTANCE: f64 = 3.0;

/// A kind of flaw and the index of one of its flaws, counted from 0; or none.
pub type ShownFlaw = Option<(Flaw, usize)>;

impl App {
    /// Marks the flaws of a kind and frames the triangles around one of them; `None` clears the mark.
    pub(super) fn show_flaw(&mut self, shown: ShownFlaw) {
        let findings = self.open.document.known_findings();
        self.picked.flaw = shown.zip(findings).and_then(|((flaw, index), findings)| {
            let scene = &self.open.document.loaded.scene;
            FlawPlace::find(scene.mesh(), &findings.health, flaw, index)
        });
        if let Some(place) = &self.picked.flaw {
            // Shows some of the surface around it.
            self.frame_bounds(place.bounds, FLAW_DISTANCE);
        }
    }
}
