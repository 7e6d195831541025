//! Shared parts of the views that transport light: the surface that a ray hits, and the light that reaches it.

use super::Context;
use super::offset::offset_by;
use crate::appearance::Appearance;
use crate::bsdf::{Bsdf, Frame, Model, Scatter, Scattered, cosine_direction};
use crate::film::Seen;
use crate::interaction::SurfaceInteraction;
use crate::light::LightSample;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::shape::{SurfacePoint, on_sphere};
use crate::spawn::{Departure, RayStart, SpawnPolicy};
use crate::terminator::Offset;
use glam::{Vec2, Vec3};
use std::borrow::Cow;
use std::cell::Cell;

/// A point of a surface that a ray hits, with the way it scatters light.
pub(super) struct ShadingPoint<'a> {
    context: &'a Context,
    ray: &'a Ray,
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
    bsdf: Cow<'a, Bsdf>,
    model: &'static Model,
    /// Whether a texture tilts the shading normal.
    is_tilted: bool,
    /// The offset that the repair of the shadow terminator adds to the origins of rays that leave on the side that the
    /// ray comes from.
    offset: Vec3,
    has_offset: bool,
    /// Whether the ray comes from behind the surface, by its normal in f64.
    arrives_behind: bool,
    /// The start of rays that leave on the side that the ray comes from, computed on first use; unused with an offset.
    start: Cell<Option<RayStart>>,
    /// The light that the surface emits towards the ray's origin.
    pub emission: Vec3,
    /// The part of the surface that is there; light passes through the rest.
    pub opacity: f32,
}

impl<'a> ShadingPoint<'a> {
    #[inline(always)]
    pub fn new(context: &'a Context, ray: &'a Ray, hit: Hit) -> Self {
        Self::repaired(context, ray, hit, context.lighting.terminator.offset)
    }

    /// The same without offsets of rays by a repair of the shadow terminator.
    pub fn unrepaired(context: &'a Context, ray: &'a Ray, hit: Hit) -> Self {
        Self::repaired(context, ray, hit, None)
    }

    #[inline(always)]
    fn repaired(context: &'a Context, ray: &'a Ray, hit: Hit, offset: Option<Offset>) -> Self {
        let scene = &context.scene;
        let surface = scene.surface(ray, &hit);
        let interaction = SurfaceInteraction::of_surface(scene, &surface, hit, context.shading);
        let material = scene
            .mesh()
            .attributes()
            .materials
            .get(interaction.material);
        let is_front = interaction.geometric_normal.dot(ray.dir) <= 0.0;
        let appearance = Appearance::new(scene, material, surface.position, &hit);
        let bsdf = appearance.bsdf(is_front);
        let model = bsdf.model();
        let side = if is_front || model.transmits {
            1.0
        } else {
            -1.0
        };
        let (untilted, to_eye) = (side * interaction.shading_normal, -ray.dir.normalize());
        let tilt = appearance.tilt(interaction.shading_normal, is_front);
        let shading_normal = tilt.map_or(untilted, |tilt| tilt.applied_to(untilted, to_eye));
        let frame = Frame::about(shading_normal);
        let offset = offset.map_or(Vec3::ZERO, |f| offset_by(f, context, &hit, is_front));
        let emission = appearance.emission_of_side(is_front);
        let opacity = appearance.opacity();
        Self {
            context,
            ray,
            hit,
            arrives_behind: surface.is_behind(-ray.dir),
            surface,
            outgoing: frame.to_local(to_eye),
            frame,
            untilted,
            normal: side * interaction.geometric_normal,
            bsdf,
            model,
            is_tilted: tilt.is_some(),
            offset,
            has_offset: offset != Vec3::ZERO,
            start: Cell::new(None),
            emission,
            opacity,
        }
    }

    /// The point's position.
    pub fn position(&self) -> Vec3 {
        self.surface.position
    }

    /// The ray's hit.
    pub fn hit(&self) -> &Hit {
        &self.hit
    }

    /// A departure by a policy.
    #[inline]
    fn departure(&self, policy: &SpawnPolicy, dir: Vec3) -> Departure<'_> {
        let moves = self.has_offset && self.goes_back(dir);
        let corners = || self.context.scene.corners(self.hit.primitive);
        Departure {
            arrived_by: self.ray,
            hit: &self.hit,
            surface: &self.surface,
            corners: if policy.uses_corners { corners() } else { None },
            dir,
            offset: if moves { self.offset } else { Vec3::ZERO },
        }
    }

    /// Whether a direction leads to the side that the ray comes from, by the shading normal before a texture tilts it:
    /// the repairs of the shadow terminator know the surface without relief.
    #[inline]
    fn goes_back(&self, dir: Vec3) -> bool {
        self.untilted.dot(dir) * self.untilted.dot(self.ray.dir) < 0.0
    }

    /// The start of a ray that leaves in a direction. It is kept for the side that the ray comes from, where the ray to
    /// a light and the ray that continues the path usually share it.
    #[inline(always)]
    fn start(&self, dir: Vec3) -> RayStart {
        let policy = self.context.lighting.spawn;
        if self.has_offset || self.surface.is_behind(dir) != self.arrives_behind {
            return policy.start(&self.departure(policy, dir));
        }
        self.start.get().unwrap_or_else(|| {
            let start = policy.start(&self.departure(policy, dir));
            self.start.set(Some(start));
            start
        })
    }

    /// The ray that leaves in a direction; `None` if numbers overflow.
    #[inline(always)]
    pub fn spawn(&self, dir: Vec3) -> Option<Ray> {
        self.start(dir).towards(dir).ok()
    }

    /// The ray that continues behind the surface.
    pub fn onward(&self) -> Option<Ray> {
        self.spawn(self.ray.dir)
    }

    /// A direction that light comes from, in the world. One that the shading normal puts on the other side of the surface
    /// carries no light.
    #[inline]
    pub fn scatter(&self, sampler: &mut Sampler) -> Option<Scattered> {
        // Numbers that the model doesn't use aren't drawn: those that are drawn together are spread together.
        let at = sampler.next_2d_if(self.model.uses_point);
        let choice = sampler.next_1d_if(self.model.uses_choice);
        self.in_world(self.bsdf.sample(self.outgoing, at, choice)?)
    }

    /// The part of light from a direction that the repair of the shadow terminator leaves. Single directions keep all.
    fn remaining_part(&self, dir: Vec3) -> f32 {
        let part = self.context.lighting.terminator.part;
        part.map_or(1.0, |part| part(self.normal, self.untilted, dir))
    }

    /// The single directions that light comes from, in the world, each with the part of light that it scatters.
    pub fn single_directions(&self) -> impl Iterator<Item = Scattered> {
        let singles = self.bsdf.single_directions(self.outgoing);
        let singles = singles.into_iter().flatten();
        singles.filter_map(|scattered| self.in_world(scattered))
    }

    /// A scattered direction of the frame in the world; `None` if the shading normal puts it on the other side of the
    /// surface.
    #[inline]
    fn in_world(&self, scattered: Scattered) -> Option<Scattered> {
        let incoming = self.frame.to_world(scattered.incoming);
        if !self.is_consistent(scattered.incoming, incoming) {
            return None;
        }
        let repaired = match scattered.density {
            Some(_) => self.remaining_part(incoming),
            None => 1.0,
        };
        let part = repaired * self.unshadowed(incoming);
        Some(Scattered {
            incoming,
            weight: part * scattered.weight,
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
        let at = sampler.next_2d();
        let sample = self.light_at(at, sampler);
        sample.map_or_else(|| on_sphere(at.as_dvec2()).as_vec3(), |sample| sample.dir)
    }

    /// Whether a direction is on the ray's side of the shading and of the geometric normal.
    pub fn sides(&self, dir: Vec3) -> [bool; 2] {
        [self.frame.z.dot(dir) > 0.0, self.normal.dot(dir) > 0.0]
    }

    /// Whether a direction, in the frame and in the world, lies on the same side of the shading and the geometric normal,
    /// and of the shading normal before a texture tilts it: no light reaches a relief from behind its surface.
    /// Rays that start above the surface may point through it.
    #[inline]
    fn is_consistent(&self, local: Vec3, dir: Vec3) -> bool {
        if self.is_tilted && local.z * self.untilted.dot(dir) <= 0.0 {
            return false;
        }
        let is_reflected = local.z * self.outgoing.z > 0.0;
        let starts_above = self.has_offset && is_reflected && self.goes_back(dir);
        starts_above || local.z * self.normal.dot(dir) > 0.0
    }

    /// The part of light from a direction that the relief of a texture lets through: if it tilts the normal, the surface
    /// consists of facets that are tilted as much. Without it, light would end at a hard border.
    ///
    /// Source: Conty Estevez, Lecocq, Stein, "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem",
    /// Ray Tracing Gems, 2019; with Mitsuba's factor.
    fn unshadowed(&self, dir: Vec3) -> f32 {
        if !self.is_tilted {
            return 1.0;
        }
        let squared_tangent = |dir: Vec3| {
            // At least the smallest normal number, so that the quotient is finite.
            let squared_cosine = self.untilted.dot(dir).powi(2).max(f32::MIN_POSITIVE);
            (1.0 - squared_cosine).max(0.0) / squared_cosine
        };
        let squared_roughness = (0.125 * squared_tangent(self.frame.z)).min(1.0);
        2.0 / (1.0 + (1.0 + squared_roughness * squared_tangent(dir)).sqrt())
    }

    /// A connection to one of the lights, weighted against the density of [`scatter`](Self::scatter) by the balance
    /// heuristic; `None` if no light is scattered towards the ray's origin.
    ///
    /// Source: Veach, Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995.
    #[inline(always)]
    pub fn direct_light(&self, sampler: &mut Sampler) -> Option<Connection> {
        self.connection(&self.light_sample(sampler)?)
    }

    /// The same without the lights that are single points or directions.
    pub fn light_with_extent(&self, sampler: &mut Sampler) -> Option<Connection> {
        let sample = self.light_sample(sampler);
        self.connection(&sample.filter(|sample| sample.density.is_some())?)
    }

    /// The connections to all lights that are single points or directions.
    pub fn light_without_extent(&self) -> impl Iterator<Item = Connection> {
        let samples = self.context.lighting.lights.without_extent(self.position());
        samples.filter_map(|sample| self.connection(&sample))
    }

    /// `None`, and no number is drawn, if there is no light to aim at or the surface scatters none of it.
    #[inline(always)]
    fn light_sample(&self, sampler: &mut Sampler) -> Option<LightSample> {
        let lights = &self.context.lighting.lights;
        if self.model.is_specular || !lights.can_be_sampled() {
            return None;
        }
        let at = sampler.next_2d();
        self.light_at(at, sampler)
    }

    /// The sample of a light for a point of the unit square. The number that chooses among several lights is drawn.
    #[inline(always)]
    fn light_at(&self, at: Vec2, sampler: &mut Sampler) -> Option<LightSample> {
        let Context {
            scene, lighting, ..
        } = self.context;
        let lights = &lighting.lights;
        let choice = sampler.next_1d_if(lights.are_several());
        lights.sample(scene, lighting.spawn, self.position(), at, choice)
    }

    /// The connection to a sample of a light, weighted by the balance heuristic; `None` if its light is black, or if
    /// numbers overflow.
    #[inline(always)]
    fn connection(&self, sample: &LightSample) -> Option<Connection> {
        let incoming = self.frame.to_local(sample.dir);
        if !self.is_consistent(incoming, sample.dir) {
            return None;
        }
        let part = self.remaining_part(sample.dir) * self.unshadowed(sample.dir);
        let (value, own) = self.bsdf.evaluate_with_density(self.outgoing, incoming);
        let mut light = part * sample.weight * value;
        if let Some(density) = sample.density {
            light *= balance(density, own);
        }
        if light == Vec3::ZERO {
            return None;
        }
        let start = self.start(sample.dir);
        let ray = match sample.end {
            None => start.towards(sample.dir),
            Some(end) => start.connect(end),
        };
        Some(Connection {
            light,
            ray: ray.ok()?,
            end: sample.end,
        })
    }
}

/// A surface connected to a light.
pub(super) struct Connection {
    /// The light that the surface scatters towards a ray's origin, unless something blocks the shadow ray.
    pub light: Vec3,
    /// The shadow ray to the light.
    pub ray: Ray,
    /// The end of the shadow ray; `None` if the light is infinitely far away.
    pub end: Option<Vec3>,
}

/// The weight of a sample of one density where another technique has the second density.
pub(super) fn balance(own: f32, other: f32) -> f32 {
    own / (own + other)
}

/// The part of light below which a ray isn't followed: half a step of 8 bits.
pub(super) const INVISIBLE: f32 = 1.0 / 512.0;

/// The source of the colour of a camera's ray with this first hit: the background if there is neither a hit nor a
/// visible environment.
pub(super) fn seen(context: &Context, hit: Option<Hit>) -> Seen {
    let lighting = &context.lighting;
    if hit.is_some() {
        Seen::Surface
    } else if lighting.hides_emitters || lighting.lights.environment().is_none() {
        Seen::Background
    } else {
        Seen::Environment
    }
}

/// The light of a ray that hits nothing. `scattered_with` is the density of its direction, `None` for single directions
/// and rays of the camera.
pub(super) fn from_afar(context: &Context, ray: &Ray, scattered_with: Option<f32>) -> Vec3 {
    let lights = &context.lighting.lights;
    let Some(environment) = lights.environment() else {
        return Vec3::ZERO;
    };
    let dir = ray.dir.normalize();
    let light = environment.radiance(dir);
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
            lights.density_of_hit(scene, from, point.ray, &point.hit),
        )
    });
    weight * point.emission
}
