//! Views of scene files' sensors, and sensors of views.

use crate::camera::{Camera, Projection};
use crate::scene_file::{FieldOfView, Film, FovAxis, Place, Sensor, SensorKind};
use glam::{DMat4, DVec3, UVec2};

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

    /// The view of a camera in a scene with this origin.
    pub fn of_camera(camera: &Camera, origin: DVec3) -> Self {
        let (fov_y_radians, height) = match camera.projection() {
            Projection::Perspective { fov_y_radians } => (Some(fov_y_radians), 0.0),
            Projection::Orthographic { height } => (None, height),
        };
        Self {
            eye: camera.exact_eye() + origin,
            forward: -camera.back(),
            up: camera.up(),
            fov_y_radians,
            height,
            size: camera.resolution(),
        }
    }

    /// The projection for a picture of this size, which shows the whole film: in a narrower picture the height grows, in a
    /// wider one more is seen at the sides. A picture without a size counts as one of the film's shape.
    pub fn projection_in(&self, picture: UVec2) -> Projection {
        let aspect = |size: UVec2| f64::from(size.x) / f64::from(size.y);
        let growth = match picture {
            UVec2 { x: 0, .. } | UVec2 { y: 0, .. } => 1.0,
            _ => (aspect(self.size) / aspect(picture)).max(1.0),
        };
        match self.fov_y_radians {
            // Exact where nothing grows.
            Some(fov_y_radians) if growth == 1.0 => Projection::Perspective { fov_y_radians },
            Some(fov_y_radians) => Projection::Perspective {
                fov_y_radians: 2.0 * (growth * (0.5 * fov_y_radians).tan()).atan(),
            },
            None => Projection::Orthographic {
                height: growth * self.height,
            },
        }
    }

    /// A sensor with this view.
    pub fn sensor(&self) -> Sensor {
        let [width, height] = self.size.to_array();
        let (kind, scale) = match self.fov_y_radians {
            Some(fov_y_radians) => {
                let degrees = fov_y_radians.to_degrees();
                let axis = FovAxis::Y;
                (SensorKind::Perspective(FieldOfView { degrees, axis }), 1.0)
            }
            None => {
                let width = self.height * f64::from(width) / f64::from(height);
                (SensorKind::Orthographic, 0.5 * width)
            }
        };
        let left = self.up.cross(self.forward);
        Sensor {
            place: Place::default(),
            id: None,
            kind,
            to_world: DMat4::from_cols(
                (scale * left).extend(0.0),
                (scale * self.up).extend(0.0),
                self.forward.extend(0.0),
                self.eye.extend(1.0),
            ),
            film: Film {
                width,
                height,
                crop: None,
            },
            sample_count: DEFAULT_SAMPLE_COUNT,
        }
    }
}

/// Mitsuba's default.
const DEFAULT_SAMPLE_COUNT: u32 = 4;

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
    fn the_sensor_of_a_view_has_this_view() {
        for fov_y_radians in [Some(0.7), None] {
            let view = StartView {
                eye: DVec3::new(1.0, -2.0, 1e6),
                forward: DVec3::new(0.6, 0.0, -0.8),
                up: DVec3::Y,
                fov_y_radians,
                height: if fov_y_radians.is_some() { 0.0 } else { 2.5 },
                size: UVec2::new(640, 360),
            };
            let again = StartView::new(&view.sensor());
            assert_eq!((again.eye, again.size), (view.eye, view.size));
            assert!((again.forward - view.forward).length() < 1e-15);
            assert!((again.up - view.up).length() < 1e-15);
            assert!((again.height - view.height).abs() < 1e-15);
            let angle = |view: StartView| view.fov_y_radians.unwrap_or(0.0);
            assert!((angle(again) - angle(view)).abs() < 1e-15);
        }
    }

    #[test]
    fn a_picture_shows_the_whole_film() {
        let film = UVec2::new(200, 100);
        let view = |fov_y_radians| StartView {
            eye: DVec3::ZERO,
            forward: DVec3::Z,
            up: DVec3::Y,
            fov_y_radians,
            height: 3.0,
            size: film,
        };
        for (picture, growth) in [
            (film, 1.0),
            (UVec2::new(400, 100), 1.0),
            (UVec2::new(1, 1), 2.0),
            (UVec2::new(50, 100), 4.0),
            (UVec2::ZERO, 1.0),
        ] {
            let Projection::Orthographic { height } = view(None).projection_in(picture) else {
                panic!("the view is orthographic");
            };
            assert_eq!(height, growth * 3.0, "{picture}");
            let Projection::Perspective { fov_y_radians } = view(Some(0.7)).projection_in(picture)
            else {
                panic!("the view is a perspective");
            };
            let tangent = (0.5 * fov_y_radians).tan();
            assert!(
                (tangent - growth * 0.35_f64.tan()).abs() < 1e-12,
                "{picture}"
            );
        }
    }

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
