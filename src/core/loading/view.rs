//! The view of a scene file's sensor.

use crate::scene_file::{FieldOfView, Film, FovAxis, Sensor, SensorKind};
use glam::{DVec3, UVec2};

/// The view that a scene file asks for, in the world's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartView {
    /// The eye.
    pub eye: DVec3,
    /// Unit vector along the view.
    pub forward: DVec3,
    /// The direction that is up in the picture.
    pub up: DVec3,
    /// The angle between the upper and the lower edge; `None` for an orthographic view.
    pub fov_y_radians: Option<f64>,
    /// The height of an orthographic picture in the world's units; 0 for a perspective.
    pub height: f64,
    /// The size of the picture in pixels.
    pub size: UVec2,
}

impl StartView {
    /// The view of a sensor. Clip planes and the lens are left out.
    pub fn new(sensor: &Sensor) -> Self {
        let axis = |v: DVec3| sensor.to_world.transform_vector3(v);
        let Film { width, height, .. } = sensor.film;
        let (fov_y_radians, picture_height) = match sensor.kind {
            SensorKind::Perspective(fov) | SensorKind::ThinLens { fov, .. } => {
                (Some(fov_y(fov, sensor.film)), 0.0)
            }
            SensorKind::Orthographic => {
                let aspect = f64::from(height) / f64::from(width);
                (None, 2.0 * axis(DVec3::X).length() * aspect)
            }
        };
        Self {
            eye: sensor.to_world.transform_point3(DVec3::ZERO),
            forward: axis(DVec3::Z).normalize_or(DVec3::NEG_Z),
            up: axis(DVec3::Y).normalize_or(DVec3::Y),
            fov_y_radians,
            height: picture_height,
            size: UVec2::new(width, height),
        }
    }
}

/// The angle between the upper and the lower edge.
fn fov_y(fov: FieldOfView, film: Film) -> f64 {
    let [width, height] = [film.width, film.height].map(f64::from);
    // The length that the angle spans, in units in which the picture has its size in pixels.
    let spanned = match fov.axis {
        FovAxis::X => width,
        FovAxis::Y => height,
        FovAxis::Diagonal => width.hypot(height),
        FovAxis::Smaller => width.min(height),
        FovAxis::Larger => width.max(height),
    };
    let half = 0.5 * fov.degrees.to_radians();
    2.0 * (half.tan() * height / spanned).atan()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vertical_angle_follows_from_the_axis_and_the_shape_of_the_film() {
        let film = Film {
            width: 400,
            height: 300,
            crop: None,
        };
        let fov = |axis| {
            fov_y(
                FieldOfView {
                    degrees: 90.0,
                    axis,
                },
                film,
            )
        };
        for (axis, tangent) in [
            (FovAxis::X, 0.75),
            (FovAxis::Larger, 0.75),
            (FovAxis::Y, 1.0),
            (FovAxis::Smaller, 1.0),
            (FovAxis::Diagonal, 0.6),
        ] {
            assert!(
                ((0.5 * fov(axis)).tan() - tangent).abs() < 1e-12,
                "{axis:?}"
            );
        }
    }
}
