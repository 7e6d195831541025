//! A side whose visible triangles are found by the GPU's rasterizer and shaded as in the traced picture.

use crate::gpu::GpuError;
use crate::gpu::rasterizer::{RasterMesh, RasterPixel, Rasterizer};
use crate::gpu::view::ViewUniform;
use crate::task::{Task, TaskPanicked, in_own_pool};
use crate::tracer::Request;
use glam::{DVec3, UVec2, Vec2};
use hitscope_core::counts::counted_as;
use hitscope_core::integrator::Integrator;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::sampler::Sampler;
use hitscope_core::tone::Display;
use hitscope_core::{Hit, Ray, Scene};
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// A rasterized picture: one sample at the centre of each pixel.
pub struct RasterizedPicture {
    /// Scene, camera and view.
    pub request: Request,
    /// The triangle of each pixel, counted from 1; 0 for none.
    pub triangles: Vec<u32>,
    /// sRGB with alpha 255, row by row from the top.
    pub pixels: Vec<[u8; 4]>,
}

impl RasterizedPicture {
    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.request.context.camera.resolution()
    }
}

/// The triangles of a scene on the GPU, and the scene.
type Uploaded = (Arc<Scene>, Arc<RasterMesh>);

/// Rasterizes requests in the background, always the newest one next.
pub struct Rasterized {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// Compiled when the first request is drawn.
    rasterizer: Arc<OnceLock<Rasterizer>>,
    mesh: Option<Uploaded>,
    running: Option<Task<Result<(Uploaded, RasterizedPicture), RasterizedError>>>,
    wanted: Option<Request>,
    /// The request that is being drawn, or was drawn last.
    begun: Option<Request>,
    picture: Option<Arc<RasterizedPicture>>,
    /// Whether a request couldn't be drawn. No further one is tried then.
    has_failed: bool,
}

/// Why there is no rasterized picture.
#[derive(Debug, thiserror::Error)]
enum RasterizedError {
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Whether a view can be rasterized: one that traces further rays from surfaces can't.
fn can_rasterize(view: &Integrator) -> bool {
    !view.needs.lights
}

impl Rasterized {
    /// A rasterizer on this device.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self {
            device: device.clone(),
            queue: queue.clone(),
            rasterizer: Arc::default(),
            mesh: None,
            running: None,
            wanted: None,
            begun: None,
            picture: None,
            has_failed: false,
        }
    }

    /// The views that can be rasterized.
    pub fn views() -> impl Iterator<Item = &'static Integrator> {
        let all = hitscope_core::integrator::INTEGRATORS.iter().copied();
        all.filter(|view| can_rasterize(view))
    }

    /// The shapes of a scene that aren't drawn; `None` if all are.
    pub fn not_drawn(scene: &Scene) -> Option<String> {
        let others = scene.other_groups().iter().map(|group| {
            let shape = group.shape();
            counted_as(group.count(), shape.name, shape.plural)
        });
        let others: Vec<String> = others.collect();
        (!others.is_empty()).then(|| others.join(", "))
    }

    /// Uses the triangles of this scene that another side has uploaded.
    pub fn share_mesh(&mut self, other: &Self, scene: &Scene) {
        let is_of = |mesh: &&Uploaded| mesh.0.has_shapes_of(scene);
        if self.mesh.as_ref().filter(is_of).is_none() {
            self.mesh = other
                .mesh
                .as_ref()
                .filter(is_of)
                .cloned()
                .or(self.mesh.take());
        }
    }

    /// Draws a request, now or after the one being drawn. A view that can't be rasterized is replaced by the first view
    /// of the table.
    pub fn request(&mut self, mut request: Request, ctx: &egui::Context) {
        if !can_rasterize(request.integrator) {
            request.integrator = hitscope_core::integrator::INTEGRATORS[0];
        }
        self.wanted = Some(request);
        self.start(ctx);
    }

    fn start(&mut self, ctx: &egui::Context) {
        if self.running.is_some() || self.begun == self.wanted || self.has_failed {
            return;
        }
        let Some(request) = self.wanted.clone() else {
            return;
        };
        self.begun = Some(request.clone());
        let shared = Arc::clone(&self.rasterizer);
        let (device, queue) = (self.device.clone(), self.queue.clone());
        let known = self
            .mesh
            .clone()
            .filter(|(scene, _)| scene.has_shapes_of(&request.context.scene));
        let draw = move |progress: &Progress| {
            let rasterizer = shared.get_or_init(|| Rasterizer::new(&device, &queue));
            let scene = &request.context.scene;
            let mesh = match known {
                Some((_, mesh)) => mesh,
                None => Arc::new(rasterizer.upload(scene)?),
            };
            let uploaded = (Arc::clone(scene), mesh);
            let picture = in_own_pool(|| draw(rasterizer, &uploaded.1, request, progress))?;
            Ok((uploaded, picture))
        };
        self.running = Some(Task::cancellable("rasterize", ctx, draw));
    }

    /// Collects a finished picture. Returns whether there is a new one.
    ///
    /// # Errors
    /// Why a request couldn't be drawn; no further one is tried.
    pub fn poll(&mut self, ctx: &egui::Context) -> Result<bool, String> {
        let result = match self.running.as_ref().map(Task::poll) {
            None | Some(Ok(None)) => return Ok(false),
            Some(Ok(Some(result))) => result.map_err(|error| error.to_string()),
            Some(Err(broken @ TaskPanicked)) => Err(broken.to_string()),
        };
        self.running = None;
        self.has_failed = result.is_err();
        let (mesh, picture) = result?;
        (self.mesh, self.picture) = (Some(mesh), Some(Arc::new(picture)));
        self.start(ctx);
        Ok(true)
    }

    /// The newest picture.
    pub fn picture(&self) -> Option<&Arc<RasterizedPicture>> {
        self.picture.as_ref()
    }

    /// The title of a view, or of the one that replaces it if it can't be rasterized.
    pub fn title_of(view: &Integrator) -> &'static str {
        let drawn = Self::views().find(|known| known.name == view.name);
        drawn
            .unwrap_or(hitscope_core::integrator::INTEGRATORS[0])
            .title
    }

    /// Whether nothing was requested.
    pub fn is_unused(&self) -> bool {
        self.wanted.is_none()
    }

    /// Whether the newest request is drawn.
    pub fn is_finished(&self) -> bool {
        self.running.is_none() && (self.begun == self.wanted || self.has_failed)
    }
}

fn draw(
    rasterizer: &Rasterizer,
    mesh: &RasterMesh,
    request: Request,
    progress: &Progress,
) -> Result<RasterizedPicture, RasterizedError> {
    let context = &request.context;
    let (scene, camera) = (&context.scene, &context.camera);
    let view = ViewUniform::new(camera, &scene.bounds()).clipped(scene.clip());
    progress.check()?;
    let drawn = rasterizer.draw(mesh, &view)?;
    let size = camera.resolution();
    let shade = |(index, pixel): (usize, &RasterPixel)| {
        progress.check()?;
        let at = UVec2::new(index as u32 % size.x, index as u32 / size.x);
        let ray = camera.ray(at, Vec2::splat(0.5));
        let mut sampler = Sampler::new(at, 0);
        let hit = hit_of(scene, &ray, pixel);
        let colour = request
            .integrator
            .radiance(context, &ray, hit, &mut sampler);
        Ok(Display::default().encode(colour))
    };
    let pixels: Result<_, Cancelled> = drawn.par_iter().enumerate().map(shade).collect();
    Ok(RasterizedPicture {
        pixels: pixels?,
        triangles: drawn.iter().map(|pixel| pixel.triangle).collect(),
        request,
    })
}

/// The hit that a rasterized pixel stands for; `t` is that of the interpolated position.
fn hit_of(scene: &Scene, ray: &Ray, pixel: &RasterPixel) -> Option<Hit> {
    let primitive = pixel.triangle.checked_sub(1)?;
    let [a, b, c] = scene.corners(primitive)?.map(|corner| corner.as_dvec3());
    let position = a + f64::from(pixel.u) * (b - a) + f64::from(pixel.v) * (c - a);
    let dir: DVec3 = ray.dir.as_dvec3();
    let t = (position - ray.origin.as_dvec3()).dot(dir) / dir.length_squared();
    Some(Hit {
        t: t as f32,
        u: pixel.u,
        v: pixel.v,
        primitive,
    })
}
