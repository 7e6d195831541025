//! The error of pictures against the CPU time that they take.

use crate::progress::Meter;
use cpu_time::ProcessTime;
use glam::UVec2;
use hitscope_core::integrator::{Context, Integrator, Lighting};
use hitscope_core::kernel::KernelChoice;
use hitscope_core::plan::Plan;
use hitscope_core::render::{Job, RenderError, render_with_progress};
use hitscope_core::spawn::SpawnPolicy;
use hitscope_core::srgb::luminance;
use hitscope_core::{Film, Intersector};
use serde::Serialize;
use std::sync::Arc;

/// How light is simulated.
#[derive(Clone)]
pub struct LightSetting {
    /// The text that names it.
    pub name: String,
    /// The view.
    pub view: &'static Integrator,
    /// The kernel.
    pub kernel: KernelChoice,
    /// How rays leave surfaces; `None` for the scene's choice.
    pub spawn: Option<&'static SpawnPolicy>,
    /// The most surfaces on a path; `None` for the scene's choice.
    pub depth: Option<u32>,
}

/// The picture that others are compared with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// The setting.
    pub setting: String,
    /// Samples per pixel.
    pub samples: u32,
    /// CPU time in seconds.
    pub cpu_s: f64,
    /// The root mean square of the pixels' standard errors of the luminance, relative to the mean luminance. Evenly spread
    /// samples err less.
    pub relative_error: f64,
    /// The mean luminance.
    pub mean: f64,
}

/// A picture of a setting.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConvergencePoint {
    /// The setting.
    pub setting: String,
    /// Samples per pixel.
    pub samples: u32,
    /// CPU time in seconds.
    pub cpu_s: f64,
    /// The root mean square over the pixels of the difference of luminance from the reference, relative to its mean.
    pub relative_rmse: f64,
}

/// The errors of pictures of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Convergence {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The reference.
    pub reference: Reference,
    /// The pictures, by setting, with increasing numbers of samples.
    pub points: Vec<ConvergencePoint>,
}

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct ConvergenceSizes {
    /// Samples per pixel of the reference, a power of two.
    pub reference_samples: u32,
    /// A setting ends with the picture that reaches this CPU time, in seconds.
    pub seconds: f64,
    /// Threads.
    pub threads: usize,
}

/// Pictures have at most this part of the reference's samples. The reference contains the samples of a picture, which
/// lowers the error of n of N samples by the part n/2N, here 3 %.
const MOST_OF_REFERENCE: u32 = 16;

/// Renders the reference and pictures of each setting with 1, 2, 4, … samples per pixel. `base` has the scene and the
/// camera; `meter` shows the picture that is being rendered. If the reference is black, relative errors are infinite or
/// NaN.
///
/// # Errors
/// See [`RenderError`].
pub fn measure(
    base: &Context,
    reference: &LightSetting,
    settings: &[LightSetting],
    sizes: ConvergenceSizes,
    meter: &Meter,
) -> Result<Convergence, RenderError> {
    let samples = sizes.reference_samples;
    meter.begin("Reference");
    let (exact, cpu_s) = picture(base, reference, samples, (sizes.threads, meter))?;
    let expected = luminances(&exact);
    let mean = expected.iter().sum::<f64>() / expected.len().max(1) as f64;
    let errors = pixels(&exact).map(|pixel| exact.standard_error(pixel).unwrap_or(0.0));
    let relative_error = root_mean_square(errors) / mean;
    let mut points = Vec::new();
    for setting in settings {
        let (mut samples, mut spent) = (1, 0.0);
        while samples <= (sizes.reference_samples / MOST_OF_REFERENCE).max(1) {
            meter.begin(format!("{}, {samples} spp", setting.name));
            let (film, cpu_s) = picture(base, setting, samples, (sizes.threads, meter))?;
            let found = luminances(&film);
            let errors = found.iter().zip(&expected).map(|(x, y)| x - y);
            points.push(ConvergencePoint {
                setting: setting.name.clone(),
                samples,
                cpu_s,
                relative_rmse: root_mean_square(errors) / mean,
            });
            spent += cpu_s;
            if spent >= sizes.seconds {
                break;
            }
            samples *= 2;
        }
    }
    Ok(Convergence {
        size: base.camera.resolution().to_array(),
        reference: Reference {
            setting: reference.name.clone(),
            samples,
            cpu_s,
            relative_error,
            mean,
        },
        points,
    })
}

/// Renders a picture, and returns the CPU time that it takes.
fn picture(
    base: &Context,
    setting: &LightSetting,
    samples: u32,
    (threads, meter): (usize, &Meter),
) -> Result<(Film, f64), RenderError> {
    let intersector: Arc<dyn Intersector> = Arc::from(base.scene.intersector(setting.kernel));
    let context = Context {
        second: Arc::clone(&intersector),
        intersector,
        lighting: Lighting {
            spawn: setting.spawn.unwrap_or(base.lighting.spawn),
            depth_limit: setting.depth.or(base.lighting.depth_limit),
            ..base.lighting.clone()
        },
        ..base.clone()
    };
    let job = Job {
        plan: Plan::new(context.camera.resolution(), 1, samples),
        context,
        integrator: setting.view,
    };
    let start = ProcessTime::now();
    let film = render_with_progress(job, threads, |part| meter.set(part))?;
    Ok((film, start.elapsed().as_secs_f64()))
}

fn pixels(film: &Film) -> impl Iterator<Item = UVec2> {
    let UVec2 { x, y } = film.size();
    (0..y).flat_map(move |row| (0..x).map(move |column| UVec2::new(column, row)))
}

fn luminances(film: &Film) -> Vec<f64> {
    let of = |pixel| film.radiance(pixel).map_or(0.0, luminance);
    pixels(film).map(|pixel| f64::from(of(pixel))).collect()
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0_u32), |(sum, n), x| (sum + x * x, n + 1));
    (sum / f64::from(n.max(1))).sqrt()
}
