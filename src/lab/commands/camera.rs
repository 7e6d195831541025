//! The camera's arguments, which several commands share.

use super::numbers::numbers;
use super::{CommandError, file_error};
use crate::viewpoint::Viewpoint;
use clap::Args;
use glam::{DVec3, UVec2};
use hitscope_core::camera::{CameraError, MAX_SIDE, Projection, Turntable, UpAxis};
use hitscope_core::loading::{StartView, is_scene_file};
use hitscope_core::mesh::ElementPlace;
use hitscope_core::obj::shown;
use hitscope_core::{Aabb, Camera, Scene};
use std::fs;
use std::path::{Path, PathBuf};

/// The camera. Positions are in the file's coordinates.
#[derive(Args, Clone, Debug, Default)]
pub struct CameraArgs {
    /// Width and height of the picture in pixels, each at most 16384 [default: the film of a scene file's first sensor, else 1280x720]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    pub size: Option<UVec2>,
    /// Position of the camera [default: the first sensor of a scene file, else the window's starting view of the whole mesh]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_vector)]
    pub eye: Option<DVec3>,
    /// Point in the centre of the picture; requires --eye [default: the centre of the mesh]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_vector, requires = "eye")]
    pub target: Option<DVec3>,
    /// Direction that points up in the picture; requires --eye [default: 0,1,0]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_vector, requires = "eye")]
    pub up: Option<DVec3>,
    /// Vertical field of view, at least 0.000001 and less than 180 [default: 40]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, conflicts_with = "ortho", value_parser = parse_fov)]
    pub fov: Option<f64>,
    /// Orthographic projection; the picture is HEIGHT units of the file high
    #[arg(long, value_name = "HEIGHT", allow_negative_numbers = true, value_parser = parse_height)]
    pub ortho: Option<f64>,
    /// Camera of a session file that the window saved
    #[arg(long, value_name = "SESSION.hitscope", conflicts_with_all = ["eye", "target", "up", "fov", "ortho"])]
    pub session: Option<PathBuf>,
}

/// The size of pictures without `--size` and without a sensor.
const DEFAULT_SIZE: UVec2 = UVec2::new(1280, 720);

impl CameraArgs {
    /// The size of the picture if it is known before the file is loaded: a scene file may have a sensor.
    pub fn known_size(&self, file: &Path) -> Option<UVec2> {
        self.size
            .or_else(|| (!is_scene_file(file)).then_some(DEFAULT_SIZE))
    }

    /// Checks the arguments without a mesh. Call this before loading one.
    ///
    /// # Errors
    /// [`CommandError::Usage`]; [`CommandError::File`] and [`CommandError::Other`] about the session.
    pub fn check(&self) -> Result<(), CommandError> {
        self.viewpoint()?;
        let (Some(eye), Some(target)) = (self.eye, self.target) else {
            return match self.up {
                Some(DVec3::ZERO) => Err(usage(CameraError::NoUp)),
                _ => Ok(()),
            };
        };
        // Checks directions only: whether positions fit in f32 depends on the mesh's origin.
        match self.look_at(DVec3::ZERO, target - eye, UVec2::ONE) {
            Err(error) if error != CameraError::NotFinite => Err(usage(error)),
            _ => Ok(()),
        }
    }

    /// The camera of the session.
    fn viewpoint(&self) -> Result<Option<Viewpoint>, CommandError> {
        let Some(path) = &self.session else {
            return Ok(None);
        };
        let text = fs::read_to_string(path).map_err(|source| file_error(path, source))?;
        let viewpoint = Viewpoint::of_session(&text);
        let named = |error| CommandError::Other(format!("{}: {error}", shown(path)));
        viewpoint.map(Some).map_err(named)
    }

    /// The camera for a scene whose file asks for a view, if it does.
    ///
    /// # Errors
    /// [`CommandError::Usage`] if the arguments don't fit the mesh, [`CommandError::Camera`] if no camera can show
    /// the mesh; [`CommandError::File`] and [`CommandError::Other`] about the session.
    pub fn camera(&self, scene: &Scene, view: Option<&StartView>) -> Result<Camera, CommandError> {
        let of_file = view.map(|view| view.size);
        let size = self.size.or(of_file).unwrap_or(DEFAULT_SIZE);
        if let Some(viewpoint) = self.viewpoint()? {
            return Ok(viewpoint.camera(scene, size));
        }
        let Some(eye) = self.eye else {
            return Ok(match view {
                Some(view) => self.given(scene, view, size)?,
                None => self.framing(scene, size)?,
            });
        };
        let origin = scene.mesh().origin();
        let bounds = scene.bounds();
        // As in the default view of a scene without bounds.
        let centre = if bounds.is_empty() {
            DVec3::ZERO
        } else {
            bounds.centre().as_dvec3()
        };
        let target = self.target.map_or(centre, |target| target - origin);
        self.look_at(eye - origin, target, size).map_err(usage)
    }

    /// The axis that points up in the picture.
    pub fn up_axis(&self, view: Option<&StartView>) -> UpAxis {
        // A session that can't be read has no picture.
        if let Ok(Some(viewpoint)) = self.viewpoint() {
            return viewpoint.up_axis();
        }
        match (self.up, view) {
            (Some(up), _) => UpAxis::nearest(up),
            (None, Some(view)) if self.eye.is_none() => level_axis(view),
            _ => UpAxis::Y,
        }
    }

    /// The camera that looks at a place of the scene: from the given eye, or else along the usual direction and so that the
    /// place fills the picture. If the place faces away from there, it is seen along its normal.
    ///
    /// # Errors
    /// See [`camera`](Self::camera).
    pub fn camera_at(
        &self,
        scene: &Scene,
        view: Option<&StartView>,
        place: &ElementPlace,
    ) -> Result<Camera, CommandError> {
        let start = self.camera(scene, view)?;
        let size = start.resolution();
        if let Some(eye) = self.eye {
            let eye = eye - scene.mesh().origin();
            return self.look_at(eye, place.centre, size).map_err(usage);
        }
        Ok(framed(&start, scene, place, self.ortho.is_some())?)
    }

    /// The camera of the file's sensor, with this size and, if given, angle or height.
    fn given(&self, scene: &Scene, view: &StartView, size: UVec2) -> Result<Camera, CameraError> {
        let eye = view.eye - scene.mesh().origin();
        let projection = match (self.fov, self.ortho) {
            (None, None) => view.projection_in(size),
            _ => self.projection(),
        };
        Camera::look_at(eye, eye + view.forward, view.up, projection, size)
    }

    /// The camera that shows the whole mesh.
    fn framing(&self, scene: &Scene, size: UVec2) -> Result<Camera, CameraError> {
        let mut start = Turntable::framing(scene.bounds(), size);
        if let Some(degrees) = self.fov {
            start.fov_y_radians = degrees.to_radians();
            start.frame(scene.bounds(), size);
        }
        let from = start.camera(size);
        let eye = start.pivot + start.distance * from.back();
        Camera::look_at(eye, start.pivot, from.up(), self.projection(), size)
    }

    fn look_at(&self, eye: DVec3, target: DVec3, size: UVec2) -> Result<Camera, CameraError> {
        let up = self.up.unwrap_or(DVec3::Y);
        Camera::look_at(eye, target, up, self.projection(), size)
    }

    fn projection(&self) -> Projection {
        match self.ortho {
            Some(height) => Projection::Orthographic { height },
            None => Projection::Perspective {
                fov_y_radians: self.fov.map_or(Turntable::FOV_Y_RADIANS, f64::to_radians),
            },
        }
    }
}

/// The axis about which the window turns a file's view.
fn level_axis(view: &StartView) -> UpAxis {
    let axes = [DVec3::ZERO, view.forward, view.up];
    let projection = view.projection_in(view.size);
    let turntable = Turntable::looking_level(axes, projection, UpAxis::Y, Aabb::EMPTY);
    turntable.map_or(UpAxis::Y, |turntable| turntable.up_axis)
}

/// The camera that frames a place as seen by another camera, whose height it keeps if that is given.
fn framed(
    start: &Camera,
    scene: &Scene,
    place: &ElementPlace,
    has_height: bool,
) -> Result<Camera, CameraError> {
    /// Between the place and the edge of the picture.
    const MARGIN: f64 = 1.3;
    /// The sine of the angle, about 6°, below which a surface is seen too much from its side, and up isn't well defined.
    const SLANT: f64 = 0.1;
    /// As near as the window's camera comes, in radii of the scene: f32 still resolves a hundredth of it.
    const NEAREST: f64 = 1e-5;
    let size = start.resolution();
    let is_seen = place.normal == DVec3::ZERO || place.normal.dot(start.back()) > SLANT;
    let back = if is_seen { start.back() } else { place.normal };
    let up = if back.cross(start.up()).length() > SLANT {
        start.up()
    } else {
        start.back()
    };
    let scene_radius = scene.bounds().radius();
    let below = place.centre - place.bounds.min.as_dvec3();
    let above = place.bounds.max.as_dvec3() - place.centre;
    let radius = match MARGIN * below.max(above).length() {
        0.0 if scene_radius > 0.0 => scene_radius,
        0.0 => 1.0,
        radius => radius,
    };
    let aspect = f64::from(size.x) / f64::from(size.y);
    let narrow = aspect.min(1.0);
    let (projection, distance) = match start.projection() {
        Projection::Perspective { fov_y_radians } => {
            let half_angle = ((0.5 * fov_y_radians).tan() * narrow).atan();
            (start.projection(), radius / half_angle.sin())
        }
        // Outside of the scene, so that nothing is cut off.
        Projection::Orthographic { height } => {
            let own = if has_height {
                height
            } else {
                2.0 * radius / narrow
            };
            let bounds = scene.bounds().union(place.bounds);
            let projection = Projection::Orthographic { height: own };
            (projection, 2.0 * bounds.radius() + radius)
        }
    };
    let eye = place.centre + distance.max(NEAREST * scene_radius) * back;
    Camera::look_at(eye, place.centre, up, projection, size)
}

fn usage(error: CameraError) -> CommandError {
    CommandError::Usage(error.to_string())
}

/// Whether a picture can have this size.
pub(super) fn is_size(size: UVec2) -> bool {
    size.min_element() >= 1 && size.max_element() <= MAX_SIDE
}

/// A camera that shows the whole mesh at this angle is about 1e8 times the mesh's size away.
const LEAST_FOV: f64 = 1e-6;

/// Whether a camera can have this vertical field of view in degrees.
pub(super) fn is_fov(degrees: f64) -> bool {
    (LEAST_FOV..180.0).contains(&degrees)
}

/// Whether an orthographic picture can have this height.
pub(super) fn is_height(height: f64) -> bool {
    height > 0.0 && height <= f64::from(f32::MAX)
}

/// `1280x720`.
fn parse_size(text: &str) -> Result<UVec2, String> {
    let sides = text.split_once(['x', 'X', '×']);
    let [width, height] = sides
        .map(|(w, h)| [w.trim().parse::<u32>(), h.trim().parse::<u32>()])
        .ok_or("expected WIDTHxHEIGHT, as in 1280x720")?;
    match (width, height) {
        (Ok(width), Ok(height)) if is_size(UVec2::new(width, height)) => {
            Ok(UVec2::new(width, height))
        }
        _ => Err(format!(
            "width and height must be integers from 1 to {MAX_SIDE}"
        )),
    }
}

/// `40`.
fn parse_fov(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(degrees) if is_fov(degrees) => Ok(degrees),
        _ => Err(format!(
            "expected an angle in degrees, at least {LEAST_FOV} and less than 180"
        )),
    }
}

/// `2.5`.
fn parse_height(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(height) if is_height(height) => Ok(height),
        _ => Err(format!(
            "expected a height above 0, at most {:e}, in the file's units",
            f32::MAX
        )),
    }
}

/// `1,-2.5,3e4`.
pub(super) fn parse_vector(text: &str) -> Result<DVec3, String> {
    let expected = "expected three numbers separated by commas, as in 1,-2.5,3";
    numbers(text, expected).map(DVec3::from_array)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_angles_and_vectors_are_read_or_refused_with_a_reason() {
        assert_eq!(parse_size("640x480"), Ok(UVec2::new(640, 480)));
        for bad in ["640", "0x5", "5x99999", "ax5", ""] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_fov("40"), Ok(40.0));
        for bad in ["0", "1e-7", "180", "200", "nan", "-1", ""] {
            assert!(parse_fov(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_height("1e-9"), Ok(1e-9));
        for bad in ["0", "-1", "inf", "nan", "1e39", ""] {
            assert!(parse_height(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_vector("1,-2.5,3e4"), Ok(DVec3::new(1.0, -2.5, 3e4)));
        for bad in ["1,2", "1,2,3,4", "1,2,x", "1,2,nan", ""] {
            assert!(parse_vector(bad).is_err(), "{bad}");
        }
    }
}
