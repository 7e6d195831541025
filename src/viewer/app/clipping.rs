//! The clip: its commands, and its use in the document.

use super::App;
use crate::clip_choice::{ClipShape, Extent};
use glam::DVec3;
use hitscope_core::Ray;

impl App {
    /// The box around the scene in the file's coordinates; the unit cube about the origin for a scene without bounds.
    pub(crate) fn extent(&self) -> Extent {
        let scene = &self.open.document.loaded.scene;
        let (bounds, origin) = (scene.bounds_with_elements(), scene.mesh().origin());
        let [min, max] = if bounds.is_empty() {
            [DVec3::NEG_ONE, DVec3::ONE]
        } else {
            [bounds.min, bounds.max].map(|corner| corner.as_dvec3())
        };
        Extent {
            min: min + origin,
            max: max + origin,
        }
    }

    /// Shows only what the chosen clip keeps. Returns whether that changed the scene.
    pub(super) fn use_clip(&mut self) -> bool {
        let clip = self.seen.settings.clip.clip();
        let used = clip.and_then(|clip| self.open.document.use_clip(clip.as_ref()));
        used.unwrap_or_else(|error| {
            self.seen.settings.clip.shape = ClipShape::None;
            self.error(format!("Clip: {error}"));
            true
        })
    }

    /// Turns the clip by a shape on or off.
    pub(crate) fn toggle_clip(&mut self, shape: ClipShape) {
        let extent = self.extent();
        self.seen.settings.clip.toggle(shape, &extent);
    }

    /// Turns the plane that clips the scene.
    pub(crate) fn turn_clip(&mut self, normal: DVec3) {
        let extent = self.extent();
        self.seen.settings.clip.turn(normal, &extent);
    }

    /// Turns the plane that clips the scene towards the camera.
    pub(crate) fn turn_clip_to_view(&mut self) {
        let back = self.seen.turntable.camera(self.shown.resolution).back();
        self.turn_clip(back);
    }

    /// Makes the box that clips the scene that of the scene.
    pub(crate) fn fit_clip_box(&mut self) {
        self.seen.settings.clip.cell = Some(self.extent());
    }

    /// Why the clip's plane can't be changed; `None` if it can.
    pub(crate) fn lacks_clip_plane(&self) -> Option<&'static str> {
        let is_plane = self.seen.settings.clip.shape == ClipShape::Plane;
        (!is_plane).then_some("No plane clips the scene")
    }

    /// Why the clip's box can't be changed; `None` if it can.
    pub(crate) fn lacks_clip_box(&self) -> Option<&'static str> {
        let is_box = self.seen.settings.clip.shape == ClipShape::Box;
        (!is_box).then_some("No box clips the scene")
    }

    /// Clips by the plane that touches the surface at the marked point, and removes the side of the camera.
    pub(crate) fn clip_at_pick(&mut self) {
        if let Some((point, normal)) = self.marked_surface() {
            self.seen.settings.clip.use_plane(normal, point);
        }
    }

    /// The marked point in the file's coordinates, and the geometric normal there, towards the picked ray's origin.
    fn marked_surface(&self) -> Option<(DVec3, DVec3)> {
        let (pick, scene) = (self.picked.pick.as_ref()?, &self.open.document.loaded.scene);
        let (ray, marked): (Ray, u32) = (pick.ray(), pick.marked_primitive()?);
        let crossings = self.open.document.intersector().all_hits(&ray);
        let mut hits = crossings.into_iter().map(|crossing| crossing.hit);
        let hit = hits.find(|hit| hit.primitive == marked)?;
        let normal = scene.surface(&ray, &hit).normal;
        let normal = if normal.dot(ray.dir.as_dvec3()) > 0.0 {
            -normal
        } else {
            normal
        };
        let is_usable = normal != DVec3::ZERO && normal.is_finite();
        let point = self.marked_point()? + scene.mesh().origin();
        is_usable.then_some((point, normal))
    }
}
