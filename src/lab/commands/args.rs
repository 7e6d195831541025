//! Arguments that several commands share.

use super::load;
use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser as _;
use glam::{DVec3, UVec2};
use hitscope_core::camera::{CameraError, Projection, Turntable};
use hitscope_core::integrator::{INTEGRATORS, Integrator, integrator};
use hitscope_core::intersector::Packing;
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel, triangle_kernel};
use hitscope_core::mesh::Crease;
use hitscope_core::obj::{FaultPolicy, LoadError, LoadOptions, Recentre};
use hitscope_core::scene::{LoadedScene, SceneOptions};
use hitscope_core::{Camera, Scene};
use std::path::Path;
use std::sync::Arc;

/// From where a picture is taken. Positions are in the file's coordinates.
#[derive(Args, Clone, Debug)]
pub struct CameraArgs {
    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = parse_size)]
    pub size: UVec2,
    /// Where the camera stands; without it, the view that the viewer starts with
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_vector)]
    pub eye: Option<DVec3>,
    /// What it looks at [default: the middle of the mesh]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_vector, requires = "eye")]
    pub target: Option<DVec3>,
    /// Which way is up in the picture [default: 0,1,0]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_vector, requires = "eye")]
    pub up: Option<DVec3>,
    /// Vertical field of view [default: 40]
    #[arg(long, value_name = "DEGREES", conflicts_with = "ortho", value_parser = parse_fov)]
    pub fov: Option<f64>,
    /// Parallel rays, and the height of the picture in the file's units
    #[arg(long, value_name = "HEIGHT")]
    pub ortho: Option<f64>,
}

impl CameraArgs {
    /// The camera for a scene.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn camera(&self, scene: &Scene) -> Result<Camera, CameraError> {
        let mut start = Turntable::framing(scene.bounds(), self.size);
        if let Some(degrees) = self.fov {
            start.fov_y_radians = degrees.to_radians();
        }
        let projection = match self.ortho {
            Some(height) => Projection::Orthographic { height },
            None => Projection::Perspective {
                fov_y_radians: start.fov_y_radians,
            },
        };
        let Some(eye) = self.eye else {
            start.frame(scene.bounds(), self.size);
            let from = start.camera(self.size);
            let eye = start.pivot + start.distance * from.back();
            return Camera::look_at(eye, start.pivot, from.up(), projection, self.size);
        };
        let origin = scene.mesh().origin;
        let middle = scene.bounds().centre().as_dvec3();
        let target = self.target.map_or(middle, |target| target - origin);
        let up = self.up.unwrap_or(DVec3::Y);
        Camera::look_at(eye - origin, target, up, projection, self.size)
    }
}

/// Which kernel answers the rays.
#[derive(Args, Clone, Debug)]
pub struct KernelArg {
    /// Intersection kernel or tier
    #[arg(long, value_name = "KERNEL", default_value = "watertight", value_parser = kernel_names())]
    pub kernel: String,
}

impl KernelArg {
    /// The kernel's row in the table.
    pub fn kernel(&self) -> &'static TriangleKernel {
        triangle_kernel(&self.kernel).expect("clap takes names from the table only")
    }
}

/// How a mesh is loaded, and kept for tracing.
#[derive(Args, Clone, Copy, Debug)]
pub struct MeshArgs {
    /// Drop faces whose indices name nothing, and say how many, instead of refusing the file
    #[arg(long)]
    pub lenient: bool,
    /// How much memory that may take.
    #[command(flatten)]
    pub memory: MemoryArg,
    /// Keep triangles and their tree in a third less memory; rays take longer
    #[arg(long)]
    pub compact: bool,
}

impl MeshArgs {
    /// Loads a scene, with a line about it on a terminal's stderr.
    ///
    /// # Errors
    /// See [`LoadError`].
    pub fn load(self, path: &Path, recentre: Recentre) -> Result<LoadedScene, LoadError> {
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
        load(path, load_options, options)
    }
}

/// How much memory loading may take.
#[derive(Args, Clone, Copy, Debug)]
pub struct MemoryArg {
    /// Refuse a file that takes more memory to load than this
    #[arg(long, value_name = "MB", default_value_t = LoadOptions::default().max_memory >> 20)]
    pub max_memory: u64,
}

impl MemoryArg {
    /// The same in bytes.
    pub fn bytes(self) -> u64 {
        self.max_memory.saturating_mul(1 << 20)
    }
}

/// Where smooth shading has edges.
#[derive(Args, Clone, Copy, Debug)]
pub struct CreaseArg {
    /// Smooth shading has an edge where triangles meet at a larger angle than this; the file's normals and
    /// smoothing groups don't count then
    #[arg(long, value_name = "DEGREES", value_parser = parse_crease)]
    pub crease: Option<f32>,
}

impl CreaseArg {
    /// The scene with its edges there.
    pub fn apply(self, scene: Arc<Scene>) -> Arc<Scene> {
        match self.crease {
            Some(degrees) => Arc::new(scene.with_crease(Crease::Above(degrees.to_radians()))),
            None => scene,
        }
    }
}

/// How a scene is seen.
#[derive(Args, Clone, Debug)]
pub struct ViewArg {
    /// What the colours show
    #[arg(long, value_name = "NAME", default_value = "shaded", value_parser = view_names())]
    pub view: String,
}

impl ViewArg {
    /// The view's row in the table.
    pub fn integrator(&self) -> &'static Integrator {
        integrator(&self.view).expect("clap takes names from the table only")
    }
}

pub(super) fn kernel_names() -> impl clap::builder::TypedValueParser<Value = String> {
    let mut names: Vec<&'static str> = Vec::new();
    for kernel in TRIANGLE_KERNELS {
        let tier = kernel.info.tier.map(|tier| tier.name());
        for name in tier.into_iter().chain([kernel.info.name]) {
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
    /// Largest side of a picture: what GPUs take, too.
    const LARGEST: u32 = 16384;
    let sides = text.split_once(['x', 'X', '×']);
    let [width, height] = sides
        .map(|(w, h)| [w.trim().parse::<u32>(), h.trim().parse::<u32>()])
        .ok_or("expected WIDTHxHEIGHT, as in 1280x720")?;
    match (width, height) {
        (Ok(width @ 1..=LARGEST), Ok(height @ 1..=LARGEST)) => Ok(UVec2::new(width, height)),
        _ => Err(format!("width and height are numbers from 1 to {LARGEST}")),
    }
}

/// `40`.
fn parse_fov(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(degrees) if degrees > 0.0 && degrees < 180.0 => Ok(degrees),
        _ => Err("expected degrees between 0 and 180".to_owned()),
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
    let numbers: Vec<f64> = text
        .split(',')
        .map(|word| word.trim().parse())
        .collect::<Result<_, _>>()
        .map_err(|_| "expected three numbers, as in 1,-2.5,3".to_owned())?;
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|x| x.is_finite()) => Ok(DVec3::new(x, y, z)),
        [_, _, _] => Err("the numbers must be finite".to_owned()),
        _ => Err(format!(
            "expected three numbers, here are {}",
            numbers.len()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_vectors_are_read_or_refused_with_a_reason() {
        assert_eq!(parse_size("640x480"), Ok(UVec2::new(640, 480)));
        for bad in ["640", "0x5", "5x99999", "ax5", ""] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_fov("40"), Ok(40.0));
        for bad in ["0", "180", "200", "nan", "-1", ""] {
            assert!(parse_fov(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_vector("1,-2.5,3e4"), Ok(DVec3::new(1.0, -2.5, 3e4)));
        for bad in ["1,2", "1,2,3,4", "1,2,x", "1,2,nan", ""] {
            assert!(parse_vector(bad).is_err(), "{bad}");
        }
    }
}
