//! Rendering jobs, and the tracing of one tile.

use super::worker::{Message, Renderer};
use crate::camera::Projection;
use crate::film::{Film, SampleSum, TileSamples};
use crate::integrator::{Context, Integrator, Sample};
use crate::lane::PACKET;
use crate::picture::TraceError;
use crate::plan::{Plan, WorkUnit};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::{DVec3, UVec2};
use std::any::Any;
use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::slice::from_ref;
use std::time::{Duration, Instant};

/// A picture to render.
#[derive(Clone)]
pub struct Job {
    /// Scene, kernel and camera.
    pub context: Context,
    /// The view.
    pub integrator: &'static Integrator,
    /// The order of pixels and samples. Its size is the camera's resolution, unless it is a plan of some rows.
    pub plan: Plan,
}

/// A traced tile.
#[derive(Debug)]
pub struct TileResult {
    /// Its samples.
    pub samples: TileSamples,
    /// Number of samples whose colour wasn't finite; they count as black.
    pub non_finite: u32,
    /// Number of rays traced.
    pub rays: u32,
    /// Number of these rays that hit the scene.
    pub hits: u32,
    /// Time it took.
    pub busy: Duration,
}

/// A panic while a sample was traced. Its tile keeps its earlier samples.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "rendering failed at pixel {},{}, sample {sample}, kernel {kernel}: {message}; \
     to see that pixel's first ray: hitscope inspect FILE --pixel {},{} --kernel {kernel} {camera}",
    pixel.x, pixel.y, pixel.x, pixel.y
)]
pub struct RenderPanic {
    /// The pixel.
    pub pixel: UVec2,
    /// Index of the sample in the pixel.
    pub sample: u32,
    /// The kernel in use.
    pub kernel: &'static str,
    /// The message of the panic.
    pub message: String,
    /// The camera, as arguments of a command.
    pub camera: String,
}

impl Job {
    /// Traces a tile; `None` if `is_stale` became true between two batches of rays.
    pub(super) fn trace(
        &self,
        unit: WorkUnit,
        is_stale: impl Fn() -> bool,
    ) -> Result<Option<TileResult>, RenderPanic> {
        let at = Cell::new((UVec2::ZERO, 0));
        let traced = catch_unwind(AssertUnwindSafe(|| self.trace_at(unit, is_stale, &at)));
        traced.map_err(|panic| RenderPanic {
            pixel: at.get().0,
            sample: at.get().1,
            kernel: self.context.intersector.kernel().name,
            message: message_of(&*panic),
            camera: camera_arguments(&self.context),
        })
    }

    fn trace_at(
        &self,
        unit: WorkUnit,
        is_stale: impl Fn() -> bool,
        at: &Cell<(UVec2, u32)>,
    ) -> Option<TileResult> {
        let start = Instant::now();
        let pass = self.plan.pass(unit.pass);
        let samples = pass.samples();
        let blocks = self.plan.tile_rect(unit.tile).block_count(pass.step());
        let most_pixels = blocks.element_product() as usize;
        let mut batch = SampleBatch {
            job: self,
            at,
            places: Vec::with_capacity(SAMPLES_AT_ONCE),
            sums: Vec::with_capacity(most_pixels),
            non_finite: 0,
            hits: 0,
        };
        let mut rays = 0;
        for pixel in self.plan.pixels(unit) {
            let pixel = self.plan.in_whole(pixel);
            batch.sums.push(SampleSum::default());
            for sample in samples.clone() {
                batch.add(pixel, sample);
                rays += 1;
                if batch.places.len() == SAMPLES_AT_ONCE {
                    // A relaxed load is cheap compared with a ray, and rays may be slow.
                    if is_stale() {
                        return None;
                    }
                    batch.trace();
                }
            }
        }
        batch.trace();
        Some(TileResult {
            samples: TileSamples {
                unit,
                sums: batch.sums,
            },
            non_finite: batch.non_finite,
            rays,
            hits: batch.hits,
            busy: start.elapsed(),
        })
    }

    /// Traces the samples of a batch. Returns them with their colours, and the number of camera rays that hit the scene.
    fn traced(&self, places: &[Place]) -> (Vec<Sample>, u32) {
        let context = &self.context;
        let ray = |place: &Place| {
            let at = Plan::position(place.pixel, place.sample);
            context.camera.ray(place.pixel, at)
        };
        let rays: Vec<Ray> = places.iter().map(ray).collect();
        let mut hits = vec![None; rays.len()];
        context.intersector.coherent_hits(&rays, &mut hits);
        let all = places.iter().zip(rays).zip(hits);
        let sample = |((place, ray), hit): ((&Place, Ray), Option<Hit>)| {
            Sample::new(ray, hit, Sampler::new(place.pixel, place.sample))
        };
        let mut samples: Vec<Sample> = all.map(sample).collect();
        let hits = samples.iter().filter(|sample| sample.hit.is_some()).count();
        self.integrator.radiances(context, &mut samples);
        (samples, hits as u32)
    }
}

/// Samples traced together. A larger number delays cancellation; with half of it, pictures of the view `path` take 3 to
/// 5 % longer (bunny on a plane, 2026-11).
const SAMPLES_AT_ONCE: usize = 16 * PACKET;

/// Samples collected to be traced together, and the sums of their tile's pixels.
struct SampleBatch<'a> {
    job: &'a Job,
    /// The sample being traced, for the message if it panics.
    at: &'a Cell<(UVec2, u32)>,
    places: Vec<Place>,
    sums: Vec<SampleSum>,
    non_finite: u32,
    hits: u32,
}

/// A sample: the index of its pixel's sum, the pixel in the whole picture, and its index among the pixel's samples.
#[derive(Clone, Copy)]
struct Place {
    sum: usize,
    pixel: UVec2,
    sample: u32,
}

impl SampleBatch<'_> {
    /// Adds a sample to the last pixel.
    fn add(&mut self, pixel: UVec2, sample: u32) {
        self.places.push(Place {
            sum: self.sums.len() - 1,
            pixel,
            sample,
        });
    }

    fn trace(&mut self) {
        let together = || self.job.traced(&self.places);
        let (samples, hits) = catch_unwind(AssertUnwindSafe(together)).unwrap_or_else(|panic| {
            // Trace the samples one by one to find the one that panics.
            for place in &self.places {
                self.at.set((place.pixel, place.sample));
                self.job.traced(from_ref(place));
            }
            resume_unwind(panic)
        });
        self.hits += hits;
        for (place, sample) in self.places.drain(..).zip(samples) {
            self.non_finite +=
                u32::from(!self.sums[place.sum].add_seen(sample.radiance, sample.seen));
        }
    }
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// A sample panicked.
    #[error(transparent)]
    Panic(#[from] RenderPanic),
    /// There isn't enough memory for the film.
    #[error("there isn't enough memory for a picture of {}x{} pixels", size.x, size.y)]
    NoMemory {
        /// Width and height in pixels.
        size: UVec2,
    },
    /// The caller has cancelled it.
    #[error("cancelled")]
    Cancelled,
    /// The alpha of a transparent background couldn't be traced.
    #[error(transparent)]
    Alpha(TraceError),
    /// No thread could be started.
    #[error("the system grants no thread to render with: {0}")]
    NoThread(io::Error),
}

/// Renders a whole job on `threads` threads and waits for it.
///
/// # Errors
/// See [`RenderError`]; of panics the first.
pub fn render(job: Job, threads: usize) -> Result<Film, RenderError> {
    render_with_progress(job, threads, |_| ())
}

/// The same as [`render`]; after each tile, `advanced` receives the part of all samples that is traced, from 0 to 1.
///
/// # Errors
/// See [`RenderError`]; of panics the first.
pub fn render_with_progress(
    job: Job,
    threads: usize,
    mut advanced: impl FnMut(f64),
) -> Result<Film, RenderError> {
    render_while(job, threads, |part| {
        advanced(part);
        true
    })
}

/// The same as [`render_with_progress`], until `goes_on` returns false.
///
/// # Errors
/// See [`RenderError`]; of panics the first.
pub fn render_while(
    job: Job,
    threads: usize,
    mut goes_on: impl FnMut(f64) -> bool,
) -> Result<Film, RenderError> {
    let size = job.plan.size();
    let samples = job.plan.samples_after(job.plan.pass_count());
    let all = f64::from(size.x) * f64::from(size.y) * f64::from(samples);
    let mut traced = 0.0;
    let film = Film::try_new(job.plan.clone(), job.context.background);
    let mut film = film.map_err(|_| RenderError::NoMemory {
        size: job.context.camera.resolution(),
    })?;
    let mut renderer = Renderer::try_new(threads, || ()).map_err(RenderError::NoThread)?;
    renderer.post(job);
    while !film.is_complete() {
        match renderer.wait_next() {
            Message::Tile(tile) => {
                film.add(tile.samples);
                traced += f64::from(tile.rays);
                if !goes_on(traced / all) {
                    return Err(RenderError::Cancelled);
                }
            }
            Message::Panicked(_, panic) => return Err(panic.into()),
        }
    }
    Ok(film)
}

/// The camera as arguments of a command, in the file's coordinates.
fn camera_arguments(context: &Context) -> String {
    let camera = &context.camera;
    let list = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
    let eye = context.scene.mesh().in_file(camera.eye().as_dvec3());
    let size = camera.resolution();
    let projection = match camera.projection() {
        Projection::Perspective { fov_y_radians } => {
            format!("--fov {}", fov_y_radians.to_degrees())
        }
        Projection::Orthographic { height } => format!("--ortho {height}"),
    };
    format!(
        "--size {}x{} --eye {} --target {} --up {} {projection}",
        size.x,
        size.y,
        list(eye),
        list(eye - camera.back()),
        list(camera.up())
    )
}

fn message_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "no message".to_owned())
}
