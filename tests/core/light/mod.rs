//! Light transport against closed forms.
//!
//! `HITSCOPE_LIGHT_PATHS=1000000` follows that many paths for each figure. By default it is 2^16. With `--nocapture`, each
//! figure is printed with its deviation.

// Scenes of which a clip removes a part.
mod clipped;
// Measured environments: the side that they light, and how they are sampled.
mod environment;
// Files of measured environments.
mod environment_files;
// Surfaces lit by emitters: form factors.
mod form_factors;
// Textures in linear formats.
mod linear_textures;
// Closed rooms that emit light.
mod furnace;
// Integrators of scene files: Russian roulette, hidden emitters.
mod integrators;
// Planes under points and directions of light, from scene files; the studio.
mod lamps;
// How open surfaces are.
mod openness;
// Recorded paths against pictures.
mod recorded;
// Planes lit by spheres.
mod spheres;
// Repairs of the shadow terminator.
mod terminator;
// Mirrors and glass, and the trees of rays that follow them.
mod whitted;

use glam::{UVec2, Vec3};
use hitscope_core::camera::Projection;
use hitscope_core::group::kernel_named;
use hitscope_core::integrator::{Context, Lighting, ViewOptions, integrator};
use hitscope_core::kernel::Tier;
use hitscope_core::light::{Light, Lights};
use hitscope_core::sampler::Sampler;
use hitscope_core::scene::Shading;
use hitscope_core::{Camera, Intersector, Ray, Scene};
use rayon::prelude::*;
use std::sync::Arc;

fn path_count() -> u32 {
    let count = std::env::var("HITSCOPE_LIGHT_PATHS").ok();
    count
        .and_then(|count| count.parse().ok())
        .unwrap_or(1 << 16)
}

/// A scene with lights, without a camera that matters.
fn lit(scene: Scene, others: Vec<Light>) -> Context {
    let scene = Arc::new(scene);
    let kernel = kernel_named(Tier::Watertight.name()).expect("a tier");
    let intersector: Arc<dyn Intersector> = Arc::from(scene.intersector(kernel));
    let projection = Projection::Perspective { fov_y_radians: 1.0 };
    let (eye, target) = (glam::DVec3::ZERO, glam::DVec3::Z);
    let camera = Camera::look_at(eye, target, glam::DVec3::Y, projection, UVec2::ONE);
    Context {
        second: Arc::clone(&intersector),
        intersector,
        camera: camera.expect("a camera"),
        shading: Shading::Flat,
        background: Vec3::ZERO,
        lighting: Lighting {
            lights: Arc::new(Lights::new(&scene, others)),
            ..Lighting::default()
        },
        options: ViewOptions::default(),
        scene,
    }
}

/// A mean, its standard error, and the number of samples.
#[derive(Clone, Copy, Debug)]
struct Estimate {
    mean: f64,
    error: f64,
    n: u32,
}

impl Estimate {
    /// The mean of a function of independent random numbers. The samples of one pixel aren't independent, so each sample
    /// is of a pixel of its own.
    fn of(n: u32, sample: impl Fn(&mut Sampler) -> f64 + Sync) -> Self {
        /// Samples per chunk; a thread keeps the values of one chunk in memory.
        const CHUNK: u32 = 1 << 12;
        // The count and the sum of a chunk, and the squared deviations from its mean.
        let chunk = |k: u32| {
            let range = k * CHUNK..(k + 1).saturating_mul(CHUNK).min(n);
            let count = f64::from(range.end - range.start);
            let values: Vec<f64> = range
                .map(|k| sample(&mut Sampler::new(UVec2::new(k, 7), 3)))
                .collect();
            let sum: f64 = values.iter().sum();
            let squares: f64 = values.iter().map(|x| (x - sum / count).powi(2)).sum();
            [count, sum, squares]
        };
        let chunks: Vec<[f64; 3]> = (0..n.div_ceil(CHUNK)).into_par_iter().map(chunk).collect();
        let mean = chunks.iter().map(|[_, sum, _]| sum).sum::<f64>() / f64::from(n);
        let squares = chunks
            .iter()
            .map(|[count, sum, squares]| squares + count * (sum / count - mean).powi(2))
            .sum::<f64>();
        let error = (squares / f64::from(n - 1) / f64::from(n)).sqrt();
        Self { mean, error, n }
    }

    /// The mean of a view's green for a ray.
    fn of_ray(context: &Context, view: &str, n: u32, ray: Ray) -> Self {
        let view = integrator(view).expect("a view");
        let hit = context.intersector.closest_hit(&ray);
        Self::of(n, |sampler| {
            view.radiance(context, &ray, hit, sampler).y.into()
        })
    }

    /// Requires the mean within four standard errors, which one estimate in 16 000 exceeds by chance, and 10⁻⁶, relatively,
    /// for rounding.
    #[track_caller]
    fn require(&self, expected: f64) {
        let deviation = self.mean - expected;
        eprintln!(
            "{self:?} (n = {}), expected {expected}: {:+.2} standard errors, {:+.4} %",
            self.n,
            deviation / self.error,
            100.0 * deviation / expected
        );
        let most = 4.0 * self.error + 1e-6 * expected;
        assert!(deviation.abs() <= most, "{self:?}, expected {expected}");
    }
}
