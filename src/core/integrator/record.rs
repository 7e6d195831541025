//! The path of one sample of a picture, vertex by vertex.

use super::transport::{Connection, ShadingPoint};
use super::{Context, Integrator, Sample, direct, path};
use crate::plan::Plan;
use crate::ray::Ray;
use crate::sampler::Sampler;
use glam::{UVec2, Vec3};

/// A recorded path. Positions are in the scene's coordinates; light is what the vertex adds to the sample's colour.
#[derive(Clone, Debug, PartialEq)]
pub struct PathRecord {
    /// The origin of the camera's ray.
    pub origin: Vec3,
    /// The surfaces that the path meets, in order.
    pub vertices: Vec<PathVertex>,
    /// The direction of the last ray; its length is 1 up to rounding.
    pub last_dir: Vec3,
    /// The light of the environment along the last ray, or the background; black if the path ends on a surface.
    pub from_afar: Vec3,
    /// Why the path ends.
    pub end: PathEnd,
    /// The colour of the sample, bit for bit that of the picture: the sum in f32 of the vertices' light, in order, first
    /// `emission`, then `direct`, and of `from_afar`.
    pub radiance: Vec3,
}

/// A surface that a path meets.
#[derive(Clone, Debug, PartialEq)]
pub struct PathVertex {
    /// The point on the surface.
    pub position: Vec3,
    /// The primitive.
    pub primitive: u32,
    /// The distance, in lengths of the direction of the ray that arrives.
    pub t: f32,
    /// Whether the path passes through the surface, because the surface covers only a part. No light is added then.
    pub is_passed: bool,
    /// The light that the surface emits.
    pub emission: Vec3,
    /// The light that the surface scatters straight from a light.
    pub direct: Vec3,
    /// The ray to the light, if one was traced.
    pub shadow_ray: Option<ShadowRay>,
    /// The throughput of the path that continues; black if it ends here.
    pub throughput: Vec3,
    /// The probability with which Russian roulette let the path continue, if it was played here.
    pub survival: Option<f32>,
}

/// A ray from a vertex to a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowRay {
    /// The unit direction to the light.
    pub dir: Vec3,
    /// The end of the ray, slightly off the light's surface; `None` if the light is infinitely far away.
    pub target: Option<Vec3>,
    /// The part of the light that arrives: 0 if a surface is in the way.
    pub arriving: f32,
}

/// Why a path ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathEnd {
    /// The last ray hits nothing.
    Left,
    /// The last surface is the last one that the view's depth limit allows.
    DepthLimit,
    /// The last surface scatters nothing in the sampled direction.
    Absorbed,
    /// Russian roulette.
    RussianRoulette,
    /// Numbers overflow.
    Overflow,
}

impl PathEnd {
    /// A description in a few words.
    pub fn text(self) -> &'static str {
        match self {
            Self::Left => "hits nothing",
            Self::DepthLimit => "depth limit",
            Self::Absorbed => "absorbed",
            Self::RussianRoulette => "Russian roulette",
            Self::Overflow => "numbers overflow",
        }
    }
}

/// Observes a path while it is followed. `()` records nothing and costs nothing.
pub(super) trait Recorder {
    /// The path meets a surface.
    fn meet(&mut self, _point: &ShadingPoint<'_>) {}
    /// The path passes through the last surface.
    fn pass(&mut self) {}
    /// The last surface emits this light.
    fn emission(&mut self, _light: Vec3) {}
    /// A ray from the last surface to a light.
    fn shadow_ray(&mut self, _connection: &Connection) {}
    /// The part of the light that arrives along the shadow ray, and the light that the last surface scatters of it.
    fn direct(&mut self, _part: f32, _light: Vec3) {}
    /// Russian roulette lets the path continue with this probability.
    fn roulette(&mut self, _survival: f32) {}
    /// The path continues with this throughput.
    fn scatter(&mut self, _throughput: Vec3) {}
    /// The last ray brings this light from afar.
    fn escape(&mut self, _light: Vec3) {}
    /// The path ends with this ray.
    fn end(&mut self, _end: PathEnd, _ray: &Ray) {}
}

impl Recorder for () {}

impl Recorder for PathRecord {
    fn meet(&mut self, point: &ShadingPoint<'_>) {
        self.vertices.push(PathVertex {
            position: point.position(),
            primitive: point.hit().primitive,
            t: point.hit().t,
            is_passed: false,
            emission: Vec3::ZERO,
            direct: Vec3::ZERO,
            shadow_ray: None,
            throughput: Vec3::ZERO,
            survival: None,
        });
    }

    fn pass(&mut self) {
        // The throughput of the path so far.
        let before = self.vertices.iter().rev().nth(1);
        let throughput = before.map_or(Vec3::ONE, |vertex| vertex.throughput);
        self.change(|vertex| (vertex.is_passed, vertex.throughput) = (true, throughput));
    }

    fn emission(&mut self, light: Vec3) {
        self.change(|vertex| vertex.emission = light);
    }

    fn shadow_ray(&mut self, connection: &Connection) {
        let ray = ShadowRay {
            dir: connection.ray.dir.normalize(),
            target: connection.end,
            arriving: 0.0,
        };
        self.change(|vertex| vertex.shadow_ray = Some(ray));
    }

    fn direct(&mut self, part: f32, light: Vec3) {
        self.change(|vertex| {
            vertex.direct = light;
            if let Some(ray) = &mut vertex.shadow_ray {
                ray.arriving = part;
            }
        });
    }

    fn roulette(&mut self, survival: f32) {
        self.change(|vertex| vertex.survival = Some(survival));
    }

    fn scatter(&mut self, throughput: Vec3) {
        self.change(|vertex| vertex.throughput = throughput);
    }

    fn escape(&mut self, light: Vec3) {
        self.from_afar = light;
    }

    fn end(&mut self, end: PathEnd, ray: &Ray) {
        self.last_dir = ray.dir.normalize();
        self.end = end;
    }
}

impl PathRecord {
    /// Changes the last vertex.
    fn change(&mut self, change: impl FnOnce(&mut PathVertex)) {
        if let Some(vertex) = self.vertices.last_mut() {
            change(vertex);
        }
    }
}

/// The most surfaces on a path of a picture; `None` for no limit.
type DepthLimit = fn(&Context) -> Option<u32>;

/// The views that follow paths, with the most surfaces on one.
static PATH_VIEWS: [(&Integrator, DepthLimit); 2] =
    [(&direct::DIRECT, direct::limit), (&path::PATH, path::limit)];

impl Integrator {
    /// Whether the view follows paths, which [`record`](Self::record) records.
    pub fn follows_paths(&self) -> bool {
        self.path_limit().is_some()
    }

    fn path_limit(&self) -> Option<DepthLimit> {
        let mut views = PATH_VIEWS.iter();
        let (_, limit) = views.find(|(view, _)| view.name == self.name)?;
        Some(*limit)
    }

    /// The path of a sample of a pixel, with the random numbers that a picture has there; `None` if the view doesn't
    /// follow paths.
    pub fn record(&self, context: &Context, pixel: UVec2, sample: u32) -> Option<PathRecord> {
        let limit = self.path_limit()?;
        let place = Plan::position(pixel, sample);
        let ray = context.camera.ray(pixel, place);
        let hit = context.intersector.closest_hit(&ray);
        let mut record = PathRecord {
            origin: ray.origin,
            vertices: Vec::new(),
            last_dir: ray.dir,
            from_afar: Vec3::ZERO,
            end: PathEnd::Left,
            radiance: Vec3::ZERO,
        };
        let mut sample = Sample::new(ray, hit, Sampler::new(pixel, sample));
        path::follow_recorded(context, &mut sample, limit(context), &mut record);
        record.radiance = sample.radiance;
        Some(record)
    }
}
