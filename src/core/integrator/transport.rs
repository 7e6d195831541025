//! What the views that transport light have in common: the surface that a ray hits, and the light that reaches it.

use super::Context;
use crate::appearance::Appearance;
use crate::bsdf::{Bsdf, Frame, Scatter, Scattered, cosine_direction};
use crate::interaction::SurfaceInteraction;
use crate::light::LightSample;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::shape::{SurfacePoint, on_sphere};
use crate::spawn::{Departure, SpawnPolicy};
use glam::Vec3;

/// A point of a surface that a ray hits, with the way it scatters light.
pub(super) struct ShadingPoint<'a> {
    context: &'a Context,
    ray: Ray,
    hit: Hit,
    surface: SurfacePoint,
    /// About the shading normal, on the side that the ray comes from unless light passes through the surface.
    frame: Frame,
    /// The shading normal before a texture tilts it, on the same side.
    untilted: Vec3,
    /// The geometric normal on the same side.
    normal: Vec3,
    /// The direction to where the ray comes from, in the frame.
    outgoing: Vec3,
    bsdf: Bsdf,
    /// The light that the surface emits towards the ray's origin.
    pub emission: Vec3,
    /// The part of the surface that is there; light passes through the rest.
    pub opacity: f32,
}

impl<'a> ShadingPoint<'a> {
    pub fn new(context: &'a Context, ray: &Ray, hit: Hit) -> Self {
        let scene = &context.scene;
        let interaction = SurfaceInteraction::new(scene, ray, hit, context.shading);
        let material = scene
            .mesh()
            .attributes()
            .materials
            .get(interaction.material);
        let is_front = interaction.geometric_normal.dot(ray.dir) <= 0.0;
        let appearance = Appearance::new(scene, material, ray, &hit);
        let bsdf = appearance.bsdf(is_front);
        let has_medium_behind = bsdf.model().transmits;
        let side = if is_front || has_medium_behind {
            1.0
        } else {
            -1.0
        };
        let (untilted, to_eye) = (side * interaction.shading_normal, -ray.dir.normalize());
        let tilt = appearance.tilt(interaction.shading_normal, is_front);
        let shading_normal = tilt.map_or(untilted, |tilt| tilt.applied_to(untilted, to_eye));
        let frame = Frame::about(shading_normal);
        let emission = appearance.emission_of_side(is_front);
        let opacity = appearance.opacity();
        Self {
            context,
            ray: *ray,
            hit,
            surface: scene.surface(ray, &hit),
            outgoing: frame.to_local(to_eye),
            frame,
            untilted,
            normal: side * interaction.geometric_normal,
            bsdf,
            emission,
            opacity,
        }
    }

    /// The point's position.
    pub fn position(&self) -> Vec3 {
        self.surface.position
    }

    fn departure(&self, dir: Vec3) -> Departure<'_> {
        Departure {
            arrived_by: &self.ray,
            hit: &self.hit,
            surface: self.surface,
            corners: self.context.scene.corners(self.hit.primitive),
            dir,
        }
    }

    /// The ray that leaves in a direction; `None` if numbers overflow.
    pub fn spawn(&self, dir: Vec3) -> Option<Ray> {
        self.spawn_by(self.context.lighting.spawn, dir)
    }

    /// The same by another policy.
    pub fn spawn_by(&self, policy: &SpawnPolicy, dir: Vec3) -> Option<Ray> {
        policy.spawn(&self.departure(dir)).ok()
    }

    /// The ray that continues behind the surface.
    pub fn onward(&self) -> Option<Ray> {
        self.spawn(self.ray.dir)
    }

    /// A direction that light comes from, in the world. One that the shading normal puts on the other side of the surface
    /// carries no light.
    pub fn scatter(&self, sampler: &mut Sampler) -> Option<Scattered> {
        let (at, choice) = (sampler.next_2d(), sampler.next_1d());
        let scattered = self.bsdf.sample(self.outgoing, at, choice)?;
        let incoming = self.frame.to_world(scattered.incoming);
        self.is_consistent(scattered.incoming, incoming)
            .then_some(Scattered {
                incoming,
                weight: self.unshadowed(incoming) * scattered.weight,
                ..scattered
            })
    }

    /// A direction on the side that the ray comes from, with a density of cos θ / π.
    pub fn open_direction(&self, sampler: &mut Sampler) -> Option<Vec3> {
        let local = cosine_direction(sampler.next_2d());
        let side = self.outgoing.z.signum();
        let dir = side * self.frame.to_world(local);
        self.is_consistent(side * local, dir).then_some(dir)
    }

    /// A direction to a light; without a light to aim at, a uniform direction.
    pub fn light_direction(&self, sampler: &mut Sampler) -> Vec3 {
        let (at, choice) = (sampler.next_2d(), sampler.next_1d());
        let lights = &self.context.lighting.lights;
        let sample = lights.sample(&self.context.scene, self.position(), at, choice);
        sample.map_or_else(|| on_sphere(at.as_dvec2()).as_vec3(), |sample| sample.dir)
    }

    /// Whether a direction is on the ray's side of the shading and of the geometric normal.
    pub fn sides(&self, dir: Vec3) -> [bool; 2] {
        [self.frame.z.dot(dir) > 0.0, self.normal.dot(dir) > 0.0]
    }

    /// Whether a direction lies on the same side of the shading and the geometric normal, in the frame and in the world.
    fn is_consistent(&self, local: Vec3, dir: Vec3) -> bool {
        local.z * self.normal.dot(dir) > 0.0
    }

    /// The part of light from a direction that the relief of a texture lets through: if it tilts the normal, the surface
    /// consists of facets that are tilted as much. Without it, light would end at a hard border.
    ///
    /// Source: Conty Estevez, Lecocq, Stein, "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem",
    /// Ray Tracing Gems, 2019; with Mitsuba's factor.
    fn unshadowed(&self, dir: Vec3) -> f32 {
        if self.untilted == self.frame.z {
            return 1.0;
        }
        let squared_tangent = |dir: Vec3| {
            let squared_cosine = self.untilted.dot(dir).powi(2);
            (1.0 - squared_cosine).max(0.0) / squared_cosine
        };
        let squared_roughness = (0.125 * squared_tangent(self.frame.z)).min(1.0);
        2.0 / (1.0 + (1.0 + squared_roughness * squared_tangent(dir)).sqrt())
    }

    /// The light from one of the lights that is scattered towards the ray's origin, weighted against the density of
    /// [`scatter`](Self::scatter) by the balance heuristic.
    ///
    /// Source: Veach, Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995.
    pub fn direct_light(&self, sampler: &mut Sampler) -> Vec3 {
        let (at, choice) = (sampler.next_2d(), sampler.next_1d());
        let Context {
            scene, lighting, ..
        } = self.context;
        let Some(sample) = lighting.lights.sample(scene, self.position(), at, choice) else {
            return Vec3::ZERO;
        };
        let incoming = self.frame.to_local(sample.dir);
        if !self.is_consistent(incoming, sample.dir) {
            return Vec3::ZERO;
        }
        let mut light = sample.weight * self.bsdf.evaluate(self.outgoing, incoming);
        if let Some(density) = sample.density {
            light *= balance(density, self.bsdf.density(self.outgoing, incoming));
        }
        light *= self.unshadowed(sample.dir);
        if light == Vec3::ZERO {
            return light;
        }
        light * self.visibility(&sample)
    }

    /// The part of a light sample that arrives: surfaces with coverage let some of it pass.
    fn visibility(&self, sample: &LightSample) -> f32 {
        let policy = self.context.lighting.spawn;
        let departure = self.departure(sample.dir);
        let ray = match &sample.end {
            None => policy.spawn(&departure),
            Some(end) => policy.connect(&departure, end),
        };
        ray.map_or(0.0, |ray| transmittance(self.context, ray))
    }
}

/// The part of light that passes along a ray.
pub(super) fn transmittance(context: &Context, mut ray: Ray) -> f32 {
    if !context.lighting.lights.has_coverage() {
        return if context.intersector.any_hit(&ray) {
            0.0
        } else {
            1.0
        };
    }
    let mut passed = 1.0;
    while let Some(hit) = context.intersector.closest_hit(&ray) {
        let point = ShadingPoint::new(context, &ray, hit);
        passed *= 1.0 - point.opacity;
        if passed <= 0.0 {
            return 0.0;
        }
        let Some(onward) = point.onward() else {
            return 0.0;
        };
        // The rest of the way.
        let t_max = ray.t_max - hit.t;
        if t_max <= onward.t_min {
            break;
        }
        ray = Ray { t_max, ..onward };
    }
    passed
}

/// The weight of a sample of one density where another technique has the second density.
pub(super) fn balance(own: f32, other: f32) -> f32 {
    own / (own + other)
}

/// The light of a ray that hits nothing. `scattered_with` is the density of its direction, `None` for single directions
/// and rays of the camera.
pub(super) fn from_afar(context: &Context, ray: &Ray, scattered_with: Option<f32>) -> Vec3 {
    let lights = &context.lighting.lights;
    let dir = ray.dir.normalize();
    let Some(light) = lights.from_afar(dir) else {
        return Vec3::ZERO;
    };
    let weight = scattered_with.map_or(1.0, |own| balance(own, lights.density_of_environment(dir)));
    weight * light
}

/// The light that a surface emits towards a ray's origin; `scattered_with` as in [`from_afar`]. `from` is the point where
/// the ray left a surface, which differs from its origin behind surfaces with coverage.
pub(super) fn emitted(point: &ShadingPoint<'_>, from: Vec3, scattered_with: Option<f32>) -> Vec3 {
    if point.emission == Vec3::ZERO {
        return Vec3::ZERO;
    }
    let Context {
        scene, lighting, ..
    } = point.context;
    let lights = &lighting.lights;
    let weight = scattered_with.map_or(1.0, |own| {
        balance(
            own,
            lights.density_of_hit(scene, from, &point.ray, &point.hit),
        )
    });
    weight * point.emission
}
