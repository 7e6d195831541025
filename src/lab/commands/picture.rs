//! Options of a traced picture, and its tracing.

use super::args::ViewArg;
use super::camera::{CameraArgs, parse_vector};
use super::kernel::parse_kernel;
use super::legend::Legend;
use super::light::no_effect;
use super::prepared::PreparedScene;
use super::scene::SceneArgs;
use super::{ClipArgs, ColourArgs, CommandError, DisplayArgs, LightArgs, ThreadsArg};
use crate::progress::{Meter, ProgressBar};
use clap::Args;
use glam::{DVec3, UVec2, Vec3};
use hitscope_core::camera::UpAxis;
use hitscope_core::colour::ColourScale;
use hitscope_core::film::{BYTES_PER_PIXEL, Noise, NoiseSum};
use hitscope_core::integrator::{Comparison, Integrator, Setting};
use hitscope_core::kernel::KernelChoice;
use hitscope_core::loading::LoadedScene;
use hitscope_core::picture::{Alpha, Guides, shown_pixels};
use hitscope_core::plan::PixelRect;
use hitscope_core::scene::{FirstTree, Shading};
use hitscope_core::{Camera, Film};
use std::ops::Range;
use std::sync::Arc;

/// Options of a traced picture
#[derive(Args, Clone, Debug)]
pub struct PictureArgs {
    /// Scene, shading and kernel.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Camera.
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Samples per pixel, 1 to 65536, rounded up to a power of two
    #[arg(long, value_name = "N", default_value_t = 16, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub samples: u32,
    /// View.
    #[command(flatten)]
    pub view: ViewArg,
    /// Colours of numbers and back faces.
    #[command(flatten)]
    pub colours: ColourArgs,
    /// Add an offset to the coordinates in which the scene is stored, and to the camera's: the larger they are, the more
    /// are 32-bit numbers rounded, which shows in the view “spawning”. Triangle meshes only
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_vector)]
    pub offset: Option<DVec3>,
    /// Clip.
    #[command(flatten)]
    pub clip: ClipArgs,
    /// Light.
    #[command(flatten)]
    pub light: LightArgs,
    /// Exposure and tone.
    #[command(flatten)]
    pub display: DisplayArgs,
    /// Kernel to compare with, for the view “disagreement”, by name or tier as for --kernel [default: exact, or fast if
    /// --kernel is exact]
    #[arg(long, value_name = "KERNEL", value_parser = parse_kernel)]
    pub against: Option<KernelChoice>,
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArg,
}

/// A traced picture or a strip of one, and the camera and scene for drawing over it.
pub struct Rendered {
    /// The view.
    pub view: &'static Integrator,
    /// The range of the rows in the whole picture.
    pub rows: Range<u32>,
    /// The film of these rows.
    pub film: Film,
    /// The scale of its colours, if it shows numbers.
    pub scale: Option<ColourScale>,
    /// The camera of the whole picture.
    pub camera: Camera,
    /// The scene.
    pub loaded: Arc<LoadedScene>,
    /// The axis that points up.
    pub up_axis: UpAxis,
    /// How normals vary over a triangle.
    pub shading: Shading,
    /// What each pixel shows first, if asked for.
    pub guides: Option<Arc<Guides>>,
    /// The part of each pixel that surfaces cover, if the background is transparent.
    pub alpha: Option<Alpha>,
}

impl Rendered {
    /// The pixels as they are displayed, in sRGB with straight alpha, row by row from the top.
    pub fn pixels(&self) -> Vec<[u8; 4]> {
        shown_pixels(&self.film, self.alpha.as_ref())
    }

    /// The noise of these rows; zero with one sample per pixel, where it isn't known.
    pub fn noise(&self) -> Noise {
        self.noise_sum().noise()
    }

    /// The sums over these rows from which the noise of the whole picture is computed.
    pub(super) fn noise_sum(&self) -> NoiseSum {
        let rows = PixelRect::whole(self.film.size());
        let sum = NoiseSum::of(&self.film, rows).unwrap_or_default();
        sum.moved_by(UVec2::new(0, self.rows.start))
    }

    /// The pixels with the legend of the numbers to their right, and the size of both together; `None` if the view shows no
    /// numbers.
    pub fn with_legend(&self, pixels: &[[u8; 4]]) -> Option<(UVec2, Vec<[u8; 4]>)> {
        let legend = Legend::new(self.camera.resolution(), self.scale.as_ref()?);
        let size = UVec2::new(legend.width_together(), self.film.size().y);
        Some((size, legend.beside(pixels, self.rows.start)))
    }
}

fn not_movable() -> CommandError {
    let message = "--offset moves scenes of triangle meshes alone, and not beyond 3.4e38";
    CommandError::Usage(message.to_owned())
}

/// The noise of a picture as a line of text.
pub(super) fn noise_text(noise: &Noise) -> String {
    let [mean, worst] = [noise.mean, noise.worst].map(|part| 100.0 * part);
    let UVec2 { x, y } = noise.worst_at;
    format!(
        "noise: standard error {mean:.3} % of the mean luminance on average, {worst:.3} % at most, at pixel {x},{y}; without pixels that show no surface"
    )
}

/// The background of pictures without a window, in sRGB; the dark theme's.
pub const DARK_BACKGROUND: Vec3 = Vec3::new(0.13, 0.14, 0.16);

impl PictureArgs {
    /// Checks the arguments without a mesh. Call this before loading one.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(&self) -> Result<(), CommandError> {
        self.check_options()?;
        // The size of a scene file's picture may be known only later.
        match self.camera.known_size(&self.scene.file) {
            Some(size) => self.check_size(size),
            None => Ok(()),
        }
    }

    /// Checks all options but the size of the picture.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub(super) fn check_options(&self) -> Result<(), CommandError> {
        self.camera.check()?;
        if let Some(views) = self.view.known(&self.scene.file) {
            self.check_views(&views)?;
        }
        self.scene.check()
    }

    /// The first tree with which `shot_count` pictures of each view take the least time. It is the best tree unless all
    /// views show first hits, whose rays are coherent, and the number of rays is known before the scene is loaded.
    pub(super) fn first_tree(&self, shot_count: usize) -> FirstTree {
        let file = &self.scene.file;
        let known = self.view.known(file).zip(self.camera.known_size(file));
        let Some((views, size)) = known else {
            return FirstTree::Best;
        };
        let shows_more = |view: &&Integrator| {
            let needs = &view.needs;
            needs.final_tree || needs.lights || needs.uses(Setting::SecondSpawn)
        };
        if views.iter().any(shows_more) {
            return FirstTree::Best;
        }
        let pixels = u64::from(size.x) * u64::from(size.y);
        // Views that compare trace each ray twice.
        let traced = |view: &&Integrator| 1 + u64::from(view.needs.second != Comparison::Nothing);
        let pictures = shot_count as u64 * views.iter().map(traced).sum::<u64>();
        FirstTree::ForRays(pixels * u64::from(self.samples) * pictures)
    }

    /// Refuses a picture that exceeds the memory limit on its own.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub(super) fn check_size(&self, size: UVec2) -> Result<(), CommandError> {
        let fits = require_picture_memory(size, self.scene.mesh.memory.bytes());
        fits.map_err(CommandError::Usage)
    }

    /// Refuses options that don't change the picture of any of the views.
    fn check_views(&self, views: &[&Integrator]) -> Result<(), CommandError> {
        let compares = |view: &&Integrator| view.needs.second == Comparison::Second;
        if self.against.is_some() && !views.iter().any(compares) {
            return Err(no_effect("--against", views, "disagreement"));
        }
        self.light.check(views)?;
        self.colours.check(views)?;
        self.display.check(views)
    }

    /// Traces the picture of the first view of a scene, and the guides for denoisers if they are asked for.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn trace(&self, loaded: LoadedScene, has_guides: bool) -> Result<Rendered, CommandError> {
        let scene = self.prepare(loaded, has_guides)?;
        let camera = scene.camera(&self.camera)?;
        let meter = Meter::default();
        let _bar = ProgressBar::of(&meter);
        meter.begin("Rendering");
        scene.seen_by(camera).trace(scene.views()[0], &meter)
    }

    /// Prepares a scene for the pictures of its views.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn prepare(
        &self,
        mut loaded: LoadedScene,
        has_guides: bool,
    ) -> Result<PreparedScene<'_>, CommandError> {
        if let Some(offset) = self.offset {
            loaded = loaded.moved(offset).ok_or_else(not_movable)?;
        }
        loaded.scene = self.clip.apply(loaded.scene)?;
        let views = self.view.views(&loaded);
        self.check_views(&views)?;
        let need_light = views.iter().any(|view| view.needs.lights);
        let up_axis = self.camera.up_axis(loaded.view.as_ref());
        let max_memory = self.scene.mesh.memory.bytes();
        let light = || self.light.load(&loaded, up_axis, max_memory);
        Ok(PreparedScene {
            light: need_light.then(light).transpose()?,
            args: self,
            intersector: self.scene.intersector(&loaded.scene),
            loaded: Arc::new(loaded),
            views,
            has_guides,
            is_transparent: false,
        })
    }
}

/// Refuses a picture that isn't rendered in strips and exceeds a memory limit in bytes.
///
/// # Errors
/// A message for the user.
pub fn require_picture_memory(size: UVec2, max_memory: u64) -> Result<(), String> {
    let bytes = picture_bytes(size);
    if bytes <= max_memory {
        return Ok(());
    }
    let UVec2 { x, y } = size;
    let (megabytes, limit) = (bytes.div_ceil(1 << 20), max_memory >> 20);
    Err(format!(
        "a picture of {x}x{y} pixels takes {megabytes} MB; the limit is {limit} MB (--max-memory)"
    ))
}

/// The memory of a picture that isn't rendered in strips.
pub(super) fn picture_bytes(size: UVec2) -> u64 {
    let UVec2 { x, y } = size;
    u64::from(x) * u64::from(y) * BYTES_PER_PIXEL as u64
}
