//! The view as text: the arguments of `hitscope render`, copied to the clipboard and pasted from it.

use super::App;
use hitscope_core::Camera;
use hitscope_core::camera::{Projection, Turntable};
use hitscope_lab::commands::CameraArgs;

impl App {
    /// The camera as command-line arguments.
    pub fn view_text(&self) -> String {
        let camera = self.seen.turntable.camera(self.shown.resolution);
        let origin = self.open.document.loaded.scene.mesh().origin();
        let distance = (camera.exact_eye() - self.seen.turntable.pivot).length();
        CameraArgs::of_camera(&camera, origin, distance).to_string()
    }

    /// Moves the camera to a place that command-line arguments describe, or says what is wrong with them.
    pub(super) fn paste_view(&mut self, text: &str) {
        match self.view_of_text(text) {
            Ok(view) => {
                self.seen.turntable = view;
                self.seen.is_unframed = false;
                self.feedback.notice = None;
                self.tell("Moved the camera to the pasted view");
            }
            Err(reason) => self.error(format!(
                "The clipboard holds no view, such as --eye 1,2,3 --target 0,0,0 --fov 40: {reason}"
            )),
        }
    }

    /// The view of command-line arguments. It turns about their target.
    fn view_of_text(&self, text: &str) -> Result<Turntable, String> {
        let args = CameraArgs::from_text(text)?;
        if args.eye.is_none() {
            return Err("--eye is missing".to_owned());
        }
        let scene = &self.open.document.loaded.scene;
        args.check().map_err(|error| error.to_string())?;
        let camera = args.camera(scene, None);
        let camera = camera.map_err(|error| error.to_string())?;
        let eye = camera.exact_eye();
        let axes = [eye, -camera.back(), camera.up()];
        let bounds = scene.bounds_with_elements();
        let (projection, up_axis) = (camera.projection(), self.seen.settings.up_axis());
        // The camera is valid, but it may be so far away that rounding leaves no direction.
        let too_far = || "the camera would be too far away".to_owned();
        let mut view =
            Turntable::looking(axes, projection, up_axis, bounds).map_err(|_| too_far())?;
        if let Some(target) = args.target {
            view.pivot = target - scene.mesh().origin();
        }
        match projection {
            Projection::Perspective { .. } => view.distance = (eye - view.pivot).length(),
            // The angle stays for the next perspective view.
            Projection::Orthographic { height } => {
                view.fov_y_radians = self.seen.turntable.fov_y_radians;
                view.distance = 0.5 * height / (0.5 * view.fov_y_radians).tan();
            }
        }
        if is_of(&view, &camera) {
            Ok(view)
        } else {
            Err(too_far())
        }
    }
}

/// Whether a turntable has the view of a camera. It may not, because a turntable limits distances and heights.
fn is_of(view: &Turntable, camera: &Camera) -> bool {
    /// Far more than the rounding of the turntable's angles, and far less than a limit changes.
    const ROUNDING: f64 = 1e-6;
    let shown = view.camera(camera.resolution());
    match (shown.projection(), camera.projection()) {
        (Projection::Orthographic { height }, Projection::Orthographic { height: wanted }) => {
            (height - wanted).abs() <= ROUNDING * wanted
        }
        _ => {
            let size = camera.exact_eye().length().max(view.distance);
            (shown.exact_eye() - camera.exact_eye()).length() <= ROUNDING * size
        }
    }
}
