//! Arguments that several commands share.

use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser as _;
use glam::{DVec3, UVec2};
use hitscope_core::camera::{CameraError, Projection, Turntable};
use hitscope_core::integrator::{INTEGRATORS, Integrator, integrator};
use hitscope_core::intersector::Packing;
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel, triangle_kernel};
use hitscope_core::scene::SceneOptions;
use hitscope_core::{Camera, Scene};

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

/// How triangles are kept for tracing.
#[derive(Args, Clone, Copy, Debug)]
pub struct PackingArg {
    /// Keep triangles and their tree in a third less memory; rays take longer
    #[arg(long)]
    pub compact: bool,
}

impl PackingArg {
    /// What a scene is made with.
    pub fn options(self) -> SceneOptions {
        SceneOptions {
            packing: if self.compact {
                Packing::Compact
            } else {
                Packing::Full
            },
            ..SceneOptions::default()
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
