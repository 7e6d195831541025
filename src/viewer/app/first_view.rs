//! The view in which a document opens: that of its sensor, or one that frames the scene.

use super::App;
use glam::UVec2;
use hitscope_core::Aabb;
use hitscope_core::camera::Turntable;

impl App {
    /// Shows the view of the file's sensor, or the scene from the default direction. Uses the integrator and the
    /// environment of the file, if it has them.
    pub(super) fn use_first_view(&mut self) {
        self.seen.settings.file_view = self.open.document.loaded.integrator().map(|view| view.name);
        self.use_environment_of_file();
        self.use_first_camera();
    }

    /// The camera of the first view. Before the first layout the picture has no size; the first layout then calls this
    /// again.
    pub(crate) fn use_first_camera(&mut self) {
        self.seen.settings.file_up_axis = None;
        let turntable = &mut self.seen.turntable;
        turntable.up_axis = self.seen.settings.up_axis();
        if let Some(own) = self.seen.own_projection.take() {
            (turntable.fov_y_radians, turntable.is_orthographic) = own;
        }
        let own = (turntable.fov_y_radians, turntable.is_orthographic);
        self.seen.is_unframed = self.shown.resolution == UVec2::ZERO;
        match self.view_of_file() {
            Some(view) => {
                self.seen.own_projection = Some(own);
                self.use_view(view);
            }
            None => self.use_default_view(),
        }
    }

    /// Shows the view of the file's sensor. If it is already shown or the file has none, frames the scene; from the
    /// default direction if the picture shows nothing.
    pub(crate) fn frame(&mut self) {
        match self.view_of_file() {
            Some(view) if view != self.seen.turntable => self.use_view(view),
            _ if self.shows_nothing() => self.use_default_view(),
            _ => self.seen.turntable = self.framed(self.bounds_of_sides()),
        }
    }

    /// Frames a part of the scene from a multiple of the distance that fits it. Zooming still reaches the whole scene.
    pub(super) fn frame_bounds(&mut self, bounds: Aabb, distances: f64) {
        let turntable = &mut self.seen.turntable;
        turntable.frame(bounds, self.shown.resolution);
        turntable.distance *= distances;
        turntable.set_scene(self.open.document.loaded.scene.bounds_with_elements());
    }

    /// Sets the picture's size. If the file's view is shown, it keeps the whole film in the picture. If the camera
    /// frames the scene, it frames it in the new size.
    pub(super) fn use_resolution(&mut self, resolution: UVec2) {
        if resolution == self.shown.resolution {
            return;
        }
        let is_files_view = self.view_of_file() == Some(self.seen.turntable);
        let of_scene = self.open.document.loaded.scene.bounds_with_elements();
        let framed = [of_scene, self.bounds_of_sides()]
            .into_iter()
            .find(|bounds| self.framed(*bounds) == self.seen.turntable);
        self.shown.resolution = resolution;
        if self.seen.is_unframed {
            self.use_first_camera();
        } else if let (true, Some(view)) = (is_files_view, self.view_of_file()) {
            self.use_view(view);
            self.history.absorb();
        } else if let Some(view) = framed.map(|bounds| self.framed(bounds))
            && view != self.seen.turntable
        {
            self.seen.turntable = view;
            self.history.absorb();
        }
    }

    /// The camera, moved so that it frames these bounds.
    fn framed(&self, bounds: Aabb) -> Turntable {
        let mut turntable = self.seen.turntable;
        turntable.frame(bounds, self.shown.resolution);
        turntable
    }

    /// The bounds of everything shown: the open scene and, in a comparison, another scene on side B.
    fn bounds_of_sides(&self) -> Aabb {
        let bounds = self.open.document.loaded.scene.bounds_with_elements();
        let other = self.bounds_of_other_scene();
        other.map_or(bounds, |other| bounds.union(other))
    }

    fn use_view(&mut self, view: Turntable) {
        self.seen.settings.file_up_axis = Some(view.up_axis);
        self.seen.turntable = view;
    }

    /// The view of the file's sensor, with the up axis for which it is more level.
    fn view_of_file(&self) -> Option<Turntable> {
        let loaded = &self.open.document.loaded;
        let view = loaded.view.as_ref()?;
        let bounds = loaded.scene.bounds_with_elements();
        let axes = [
            view.eye - loaded.scene.mesh().origin(),
            view.forward,
            view.up,
        ];
        let projection = view.projection_in(self.shown.resolution);
        let preferred = self.seen.settings.up_axis();
        Turntable::looking_level(axes, projection, preferred, bounds).ok()
    }

    /// Looks at the scene from the default direction. Keeps the settings that don't depend on the mesh: up
    /// axis, projection and field of view.
    pub(super) fn use_default_view(&mut self) {
        let bounds = self.bounds_of_sides();
        let mut turntable = Turntable::framing(bounds, self.shown.resolution);
        turntable.fov_y_radians = self.seen.turntable.fov_y_radians;
        turntable.is_orthographic = self.seen.turntable.is_orthographic;
        turntable.up_axis = self.seen.turntable.up_axis;
        turntable.frame(bounds, self.shown.resolution);
        self.seen.turntable = turntable;
    }
}
