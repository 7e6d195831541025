//! Framing of the picked primitive and of its part, whose bounds are computed in the background.

use super::App;
use super::pick::Pick;
use crate::task::Task;
use hitscope_core::{Aabb, Scene};
use std::sync::Arc;

/// The search for the bounds of a part, while it runs.
pub(crate) struct PartBounds {
    scene: Arc<Scene>,
    task: Task<Aabb>,
}

impl App {
    /// Frames the marked primitive. One without bounds, such as a plane, is only centred.
    pub(crate) fn frame_pick(&mut self) {
        /// Distance of the camera, relative to the distance that frames the primitive: shows some of the surface
        /// around it.
        const DISTANCE: f64 = 3.0;
        let scene = &self.open.document.loaded.scene;
        let Some(primitive) = self.picked.pick.as_ref().and_then(Pick::marked_primitive) else {
            return;
        };
        let bounds = scene.subset(&[primitive]).bounds();
        if !bounds.is_empty() {
            self.frame_bounds(bounds, DISTANCE);
        } else if let Some(point) = self.marked_point() {
            self.seen.turntable.centre_on(point);
        }
    }

    /// Frames the group or object of the marked triangle; the whole scene if the triangle has none.
    pub(crate) fn frame_part(&mut self, ctx: &egui::Context) {
        let scene = &self.open.document.loaded.scene;
        let Some(primitive) = self.picked.pick.as_ref().and_then(Pick::marked_primitive) else {
            return;
        };
        let group = scene.mesh().attributes().groups.of(primitive);
        if group.is_none() || !scene.is_triangle(primitive) {
            return self.animated(ctx, Self::frame);
        }
        let (scene, shared) = (Arc::clone(scene), Arc::clone(scene));
        // In the background: each triangle's group is looked up.
        let find = move || bounds_of_part(&shared, primitive);
        let task = Task::spawn("part bounds", ctx, find);
        self.picked.part_bounds = Some(PartBounds { scene, task });
    }

    /// Frames a part once its bounds are known, unless another document has been opened.
    pub(super) fn poll_framing(&mut self, ctx: &egui::Context) {
        let Some(PartBounds { scene, task }) = &self.picked.part_bounds else {
            return;
        };
        let is_current = std::ptr::eq(scene.mesh(), self.open.document.loaded.scene.mesh());
        let result = match task.poll() {
            Ok(None) => return,
            Ok(Some(bounds)) => Ok(bounds),
            Err(panicked) => Err(panicked),
        };
        self.picked.part_bounds = None;
        match result {
            Ok(bounds) if is_current => self.animated(ctx, |app| app.frame_bounds(bounds, 1.0)),
            Ok(_) => {}
            Err(panicked) => self.error(panicked),
        }
    }
}

/// The box around all triangles of a triangle's group.
fn bounds_of_part(scene: &Scene, primitive: u32) -> Aabb {
    let groups = &scene.mesh().attributes().groups;
    let group = groups.index(primitive);
    let count = scene.mesh().triangles().len() as u32;
    let members = (0..count).filter(|other| groups.index(*other) == group);
    let corners = members.filter_map(|triangle| scene.corners(triangle));
    Aabb::around(corners.flatten())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::embedded_scene;

    #[test]
    fn the_bounds_of_a_part_are_those_of_its_triangles() {
        let scene = embedded_scene().scene;
        let groups = &scene.mesh().attributes().groups;
        let count = scene.mesh().triangles().len() as u32;
        let mut union = Aabb::EMPTY;
        for name in ["floor", "knot", "gem", "shell"] {
            let is_member = |triangle: &u32| groups.of(*triangle).is_some_and(|of| of == name);
            let members: Vec<u32> = (0..count).filter(is_member).collect();
            let bounds = bounds_of_part(&scene, members[members.len() / 2]);
            assert_eq!(bounds, scene.subset(&members).bounds(), "{name}");
            union = union.union(bounds);
        }
        assert_eq!(union, scene.bounds());
    }
}
