//! The window's camera as plain data, for session files, undo, and `--session` on the command line.

use crate::json_error::explained;
use glam::{DVec3, UVec2};
use hitscope_core::camera::{Turntable, UpAxis};
use hitscope_core::{Camera, Scene};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The version of the format of session files. Files of later versions are refused.
pub const SESSION_FORMAT: u32 = 1;

/// The window's camera in the file's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Viewpoint {
    /// A point near the scene. It is stored beside the pivot because their sum would be rounded.
    origin: [f64; 3],
    /// Centre of rotation, relative to `origin`.
    pivot: [f64; 3],
    distance: f64,
    yaw_radians: f64,
    pitch_radians: f64,
    roll_radians: f64,
    fov_y_radians: f64,
    is_orthographic: bool,
    is_z_up: bool,
}

impl Viewpoint {
    /// A camera in a scene with this origin.
    pub fn of(turntable: &Turntable, origin: DVec3) -> Self {
        Self {
            origin: origin.to_array(),
            pivot: turntable.pivot.to_array(),
            distance: turntable.distance,
            yaw_radians: turntable.yaw_radians,
            pitch_radians: turntable.pitch_radians,
            roll_radians: turntable.roll_radians,
            fov_y_radians: turntable.fov_y_radians,
            is_orthographic: turntable.is_orthographic,
            is_z_up: turntable.up_axis == UpAxis::Z,
        }
    }

    /// The camera in a scene; the same, bit for bit, if the scene's origin is the same.
    pub fn turntable(&self, scene: &Scene) -> Turntable {
        let mut turntable = Turntable::framing(scene.bounds_with_elements(), UVec2::ONE);
        let shift = DVec3::from_array(self.origin) - scene.mesh().origin();
        turntable.pivot = DVec3::from_array(self.pivot) + shift;
        turntable.distance = self.distance;
        turntable.yaw_radians = self.yaw_radians;
        turntable.pitch_radians = self.pitch_radians;
        turntable.roll_radians = self.roll_radians;
        turntable.fov_y_radians = self.fov_y_radians;
        turntable.is_orthographic = self.is_orthographic;
        turntable.up_axis = self.up_axis();
        turntable
    }

    /// Refuses values that the window can't set.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), &'static str> {
        /// Below the least field of view of the command line, 10⁻⁶ degrees.
        const LEAST_FOV: f64 = 1e-8;
        let limit = f64::from(f32::MAX);
        let is_place = |v: [f64; 3]| v.iter().all(|x| x.abs() <= limit);
        if !is_place(self.origin) || !is_place(self.pivot) {
            return Err("the camera's origin or pivot is too far away");
        }
        if !(f64::from(f32::MIN_POSITIVE)..=limit).contains(&self.distance) {
            return Err("the camera's distance must be positive, and not too large");
        }
        if !(self.fov_y_radians >= LEAST_FOV && self.fov_y_radians < PI) {
            return Err("the camera's field of view must be between 0 and π");
        }
        Ok(())
    }

    /// The axis that points up.
    pub fn up_axis(&self) -> UpAxis {
        if self.is_z_up { UpAxis::Z } else { UpAxis::Y }
    }

    /// The camera for a picture of this size in a scene.
    pub fn camera(&self, scene: &Scene, size: UVec2) -> Camera {
        self.turntable(scene).camera(size)
    }

    /// Reads the camera of a session file.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn of_session(text: &str) -> Result<Self, String> {
        #[derive(Deserialize)]
        struct Session {
            sight: Sight,
        }
        #[derive(Deserialize)]
        struct Sight {
            camera: Viewpoint,
        }
        check_format(text)?;
        let session: Session =
            serde_json::from_str(text).map_err(|error| unreadable(text, &error))?;
        session.sight.camera.check()?;
        Ok(session.sight.camera)
    }
}

/// Refuses a text that isn't a session of this version or an earlier one.
///
/// # Errors
/// What is wrong with the text.
pub fn check_format(text: &str) -> Result<(), String> {
    /// The version alone: later versions may differ in all else.
    #[derive(Deserialize)]
    struct Version {
        hitscope: u32,
    }
    let version = serde_json::from_str(text).map_err(|error| unreadable(text, &error));
    let Version { hitscope } = version?;
    if hitscope > SESSION_FORMAT {
        return Err(format!(
            "written by a later version of hitscope: format {hitscope}, not {SESSION_FORMAT}"
        ));
    }
    Ok(())
}

/// The message about a text that isn't a readable session, with what the user can do.
pub fn unreadable(text: &str, error: &serde_json::Error) -> String {
    if text.trim().is_empty() {
        return "the session file is empty; save the session again".to_owned();
    }
    let reason = explained(error);
    format!(
        "not a readable session, line {}: {reason}; correct that line, or save the session again",
        error.line()
    )
}
