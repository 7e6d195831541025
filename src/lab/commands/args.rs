//! Arguments that several commands share.

use super::CommandError;
use super::input::{load, print_warnings};
use super::picture::ShadingArg;
use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser as _;
use glam::{DVec3, UVec2};
use hitscope_core::camera::{CameraError, Projection, Turntable};
use hitscope_core::group::{all_kernels, kernel_named};
use hitscope_core::integrator::{INTEGRATORS, Integrator, integrator};
use hitscope_core::intersector::Packing;
use hitscope_core::kernel::KernelChoice;
use hitscope_core::loading::{LoadedScene, StartView};
use hitscope_core::mesh::Crease;
use hitscope_core::obj::{FaultPolicy, LoadOptions, Recentre};
use hitscope_core::scene::SceneOptions;
use hitscope_core::{Camera, Scene};
use std::path::Path;
use std::sync::Arc;

/// The camera. Positions are in the file's coordinates.
#[derive(Args, Clone, Debug)]
pub struct CameraArgs {
    /// Width and height of the picture in pixels, each at most 16384
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x720", value_parser = parse_size)]
    pub size: UVec2,
    /// Position of the camera [default: the sensor of a scene file, else the window's starting view of the whole mesh]
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
}

impl CameraArgs {
    /// Checks the arguments without a mesh. Call this before loading one.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(&self) -> Result<(), CommandError> {
        let (Some(eye), Some(target)) = (self.eye, self.target) else {
            return match self.up {
                Some(DVec3::ZERO) => Err(usage(CameraError::NoUp)),
                _ => Ok(()),
            };
        };
        // Checks directions only: whether positions fit in f32 depends on the mesh's origin.
        match self.look_at(DVec3::ZERO, target - eye) {
            Err(error) if error != CameraError::NotFinite => Err(usage(error)),
            _ => Ok(()),
        }
    }

    /// The camera for a scene whose file asks for a view, if it does.
    ///
    /// # Errors
    /// [`CommandError::Usage`] if the arguments don't fit the mesh, [`CommandError::Camera`] if no camera can show
    /// the mesh.
    pub fn camera(&self, scene: &Scene, view: Option<&StartView>) -> Result<Camera, CommandError> {
        let Some(eye) = self.eye else {
            return Ok(match view {
                Some(view) => self.given(scene, view)?,
                None => self.framing(scene)?,
            });
        };
        let origin = scene.mesh().origin();
        let centre = scene.bounds().centre().as_dvec3();
        let target = self.target.map_or(centre, |target| target - origin);
        self.look_at(eye - origin, target).map_err(usage)
    }

    /// The camera of the file's sensor, with this size and, if given, angle or height.
    fn given(&self, scene: &Scene, view: &StartView) -> Result<Camera, CameraError> {
        let eye = view.eye - scene.mesh().origin();
        let projection = match (self.fov, self.ortho, view.fov_y_radians) {
            (None, None, Some(fov_y_radians)) => Projection::Perspective { fov_y_radians },
            (None, None, None) => Projection::Orthographic {
                height: view.height,
            },
            _ => self.projection(),
        };
        Camera::look_at(eye, eye + view.forward, view.up, projection, self.size)
    }

    /// The camera that shows the whole mesh.
    fn framing(&self, scene: &Scene) -> Result<Camera, CameraError> {
        let mut start = Turntable::framing(scene.bounds(), self.size);
        if let Some(degrees) = self.fov {
            start.fov_y_radians = degrees.to_radians();
            start.frame(scene.bounds(), self.size);
        }
        let from = start.camera(self.size);
        let eye = start.pivot + start.distance * from.back();
        Camera::look_at(eye, start.pivot, from.up(), self.projection(), self.size)
    }

    fn look_at(&self, eye: DVec3, target: DVec3) -> Result<Camera, CameraError> {
        let up = self.up.unwrap_or(DVec3::Y);
        Camera::look_at(eye, target, up, self.projection(), self.size)
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

fn usage(error: CameraError) -> CommandError {
    CommandError::Usage(error.to_string())
}

/// The kernel that traces the rays.
#[derive(Args, Clone, Debug)]
pub struct KernelArg {
    /// Intersection kernel, by name or tier
    #[arg(long, value_name = "KERNEL", default_value = "watertight", value_parser = kernel_names())]
    pub kernel: String,
}

impl KernelArg {
    /// The kernel of each shape.
    pub fn kernel(&self) -> KernelChoice {
        kernel_named(&self.kernel).expect("clap accepts only names in the tables")
    }
}

/// How a mesh is loaded and stored for tracing.
#[derive(Args, Clone, Copy, Debug)]
pub struct MeshArgs {
    /// Drop faces with invalid indices, with a warning, instead of refusing the file
    #[arg(long)]
    pub lenient: bool,
    /// Memory limit.
    #[command(flatten)]
    pub memory: MemoryArg,
    /// Store triangles and tree in a third less memory; tracing is slower
    #[arg(long)]
    pub compact: bool,
}

impl MeshArgs {
    /// Loads a scene and prints the file's warnings.
    ///
    /// # Errors
    /// [`CommandError::Load`].
    pub fn load(self, path: &Path, recentre: Recentre) -> Result<LoadedScene, CommandError> {
        let load_options = LoadOptions {
            recentre,
            faults: if self.lenient {
                FaultPolicy::Lenient
            } else {
                FaultPolicy::Strict
            },
            max_memory: self.memory.bytes(),
        };
        let options = SceneOptions {
            packing: if self.compact {
                Packing::Compact
            } else {
                Packing::Full
            },
            ..SceneOptions::default()
        };
        let loaded = load(path, load_options, options)?;
        print_warnings(path, &loaded);
        Ok(loaded)
    }
}

/// Memory limit for a mesh, its textures and tree, and a picture of it.
#[derive(Args, Clone, Copy, Debug)]
pub struct MemoryArg {
    /// Refuse a file or a picture that needs more memory than this
    #[arg(long, value_name = "MB", allow_negative_numbers = true, default_value_t = LoadOptions::default().max_memory >> 20, value_parser = parse_megabytes)]
    pub max_memory: u64,
}

impl MemoryArg {
    /// The limit in bytes.
    pub fn bytes(self) -> u64 {
        self.max_memory << 20
    }

    /// Fails if `bytes` of work exceed the limit together with a scene whose packed triangles take `packed_bytes`.
    ///
    /// # Errors
    /// [`CommandError::Other`].
    pub(super) fn require(
        self,
        bytes: u64,
        scene: &Scene,
        packed_bytes: usize,
        what: std::fmt::Arguments,
    ) -> Result<(), CommandError> {
        let mesh: usize = scene.mesh().bytes().iter().map(|(_, bytes)| bytes).sum();
        let held = (mesh + scene.tree_bytes() + packed_bytes) as u64;
        if held.saturating_add(bytes) <= self.bytes() {
            return Ok(());
        }
        let [bytes, held] = [bytes, held].map(|bytes| bytes.div_ceil(1 << 20));
        let limit = self.max_memory;
        Err(CommandError::Other(format!(
            "{what} takes {bytes} MB in addition to the mesh's {held} MB; the limit is {limit} MB (--max-memory)"
        )))
    }
}

/// Crease angle of smooth shading.
#[derive(Args, Clone, Copy, Debug)]
pub struct CreaseArg {
    /// With smooth shading: keep edges sharp where triangles meet at a larger angle than this, and ignore the
    /// file's normals and smoothing groups
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = parse_crease)]
    pub crease: Option<f32>,
}

impl CreaseArg {
    /// Refuses a crease angle with flat shading, which has no use for it.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(self, shading: ShadingArg) -> Result<(), CommandError> {
        if self.crease.is_some() && shading == ShadingArg::Flat {
            let message =
                "--crease has no effect on flat shading: it needs --shading smooth or spherical";
            return Err(CommandError::Usage(message.to_owned()));
        }
        Ok(())
    }

    /// The scene with this crease angle.
    pub fn apply(self, scene: Arc<Scene>) -> Arc<Scene> {
        match self.crease {
            Some(degrees) => Arc::new(scene.with_crease(Crease::Above(degrees.to_radians()))),
            None => scene,
        }
    }
}

/// The view of a picture.
#[derive(Args, Clone, Debug)]
pub struct ViewArg {
    /// View: the meaning of the colours
    #[arg(long, value_name = "NAME", default_value = "shaded", value_parser = view_names())]
    pub view: String,
}

impl ViewArg {
    /// The view's row in the table.
    pub fn view(&self) -> &'static Integrator {
        integrator(&self.view).expect("clap accepts only names in the table")
    }
}

pub(super) fn kernel_names() -> impl clap::builder::TypedValueParser<Value = String> {
    let mut names: Vec<&'static str> = Vec::new();
    let kernels = all_kernels().into_iter().flat_map(|shape| shape.kernels);
    for kernel in kernels {
        let tier = kernel.tier.map(|tier| tier.name());
        for name in tier.into_iter().chain([kernel.name]) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    PossibleValuesParser::new(names).map(|name| name)
}

fn view_names() -> impl clap::builder::TypedValueParser<Value = String> {
    PossibleValuesParser::new(INTEGRATORS.iter().map(|view| view.name)).map(|name| name)
}

/// `1280x720`.
fn parse_size(text: &str) -> Result<UVec2, String> {
    /// Largest side of a picture, the usual limit of GPU textures.
    const LARGEST: u32 = 16384;
    let sides = text.split_once(['x', 'X', '×']);
    let [width, height] = sides
        .map(|(w, h)| [w.trim().parse::<u32>(), h.trim().parse::<u32>()])
        .ok_or("expected WIDTHxHEIGHT, as in 1280x720")?;
    match (width, height) {
        (Ok(width @ 1..=LARGEST), Ok(height @ 1..=LARGEST)) => Ok(UVec2::new(width, height)),
        _ => Err(format!(
            "width and height must be integers from 1 to {LARGEST}"
        )),
    }
}

/// `40`.
fn parse_fov(text: &str) -> Result<f64, String> {
    /// A camera that shows the whole mesh at this angle is about 1e8 times the mesh's size away.
    const LEAST_FOV: f64 = 1e-6;
    match text.parse() {
        Ok(degrees) if (LEAST_FOV..180.0).contains(&degrees) => Ok(degrees),
        _ => Err(format!(
            "expected an angle in degrees, at least {LEAST_FOV} and less than 180"
        )),
    }
}

/// `2.5`.
fn parse_height(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(height) if height > 0.0 && height <= f64::from(f32::MAX) => Ok(height),
        _ => Err(format!(
            "expected a height above 0, at most {:e}, in the file's units",
            f32::MAX
        )),
    }
}

/// `4096`.
fn parse_megabytes(text: &str) -> Result<u64, String> {
    /// More bytes than this don't fit in 64 bits.
    const MOST: u64 = u64::MAX >> 20;
    match text.parse() {
        Ok(megabytes @ 1..=MOST) => Ok(megabytes),
        _ => Err(format!("expected an integer from 1 to {MOST}")),
    }
}

/// `30`.
fn parse_crease(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(degrees) if (0.0..=180.0).contains(&degrees) => Ok(degrees),
        _ => Err("expected degrees from 0 to 180".to_owned()),
    }
}

/// `1,-2.5,3e4`.
fn parse_vector(text: &str) -> Result<DVec3, String> {
    let expected = || "expected three numbers separated by commas, as in 1,-2.5,3".to_owned();
    let numbers: Vec<f64> = text
        .split(',')
        .map(|word| word.trim().parse())
        .collect::<Result<_, _>>()
        .map_err(|_| expected())?;
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|x| x.is_finite()) => Ok(DVec3::new(x, y, z)),
        [_, _, _] => Err("the numbers must be finite".to_owned()),
        _ => Err(expected()),
    }
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
        assert_eq!(parse_megabytes("4096"), Ok(4096));
        for bad in ["0", "-5", "17592186044416", "x", ""] {
            assert!(parse_megabytes(bad).is_err(), "{bad}");
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
