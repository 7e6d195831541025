//! Primitives whose material emits light.

use super::LightSample;
use crate::appearance::Appearance;
use crate::mesh::{Material, Property};
use crate::ray::{Hit, Ray};
use crate::scene::Scene;
use crate::shape::{FlatPatch, SampledSurface};
use crate::spawn::SpawnPolicy;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// A primitive that emits the same light everywhere and to all directions on one side or both.
#[derive(Clone, Debug, PartialEq)]
pub struct AreaLight {
    primitive: u32,
    radiance: Vec3,
    /// In square units of the scene.
    area: f64,
    emits_on_back: bool,
    /// Whether a texture dims the light.
    is_textured: bool,
    /// The primitive prepared for sampling, if it is flat and not a triangle; of triangles, a scene may have too many.
    patch: Option<Box<FlatPatch>>,
}

/// The primitives of a scene that emit light.
pub(super) struct Emitters {
    /// Those with an area that can be sampled. Rays that hit the others find their light.
    pub lights: Vec<AreaLight>,
    /// Whether other primitives emit light.
    pub has_others: bool,
}

impl Emitters {
    pub fn of_scene(scene: &Scene) -> Self {
        let materials = &scene.mesh().attributes().materials;
        let any = scene.mesh().attributes().emits();
        let count = if any { scene.primitive_count() } else { 0 };
        let mut found = Self {
            lights: Vec::new(),
            has_others: false,
        };
        for primitive in 0..count as u32 {
            if let Some(material) = materials.get(scene.material(primitive))
                && material.emits()
                && scene.is_shown(primitive)
            {
                match AreaLight::new(scene, primitive, material) {
                    Some(light) => found.lights.push(light),
                    None => found.has_others = true,
                }
            }
        }
        found
    }

    /// Whether no primitive emits light.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty() && !self.has_others
    }
}

impl AreaLight {
    /// The light of a primitive; `None` if it has no area that can be sampled.
    fn new(scene: &Scene, primitive: u32, material: &Material) -> Option<Self> {
        let area = scene.area(primitive);
        (area > 0.0 && area.is_finite()).then(|| Self {
            primitive,
            radiance: material.emission,
            area,
            emits_on_back: material.emits_on_back,
            is_textured: material.further_map(Property::Emission).is_some(),
            patch: scene.flat_patch(primitive).map(Box::new),
        })
    }

    pub(super) fn primitive(&self) -> u32 {
        self.primitive
    }

    pub(super) fn power(&self) -> Vec3 {
        let sides = if self.emits_on_back { 2.0 } else { 1.0 };
        sides * PI * self.area as f32 * self.radiance
    }

    /// Light that reaches `from`; `None` if the sampled point doesn't emit towards it. `at` is uniform in the unit
    /// square.
    #[inline]
    pub(super) fn sample(
        &self,
        scene: &Scene,
        spawn: &SpawnPolicy,
        from: Vec3,
        at: Vec2,
    ) -> Option<LightSample> {
        let SampledSurface {
            surface,
            u,
            v,
            density,
        } = &self.sampled(scene, from, at)?;
        let hit = Hit {
            t: 1.0,
            u: *u,
            v: *v,
            primitive: self.primitive,
        };
        let way = surface.position.as_dvec3() - from.as_dvec3();
        let dir = way.try_normalize()?.as_vec3();
        let cos = surface.normal.as_vec3().dot(-dir);
        let density = self.density_at(*density, way.length_squared(), cos)?;
        let corners = || scene.corners(self.primitive);
        Some(LightSample {
            dir,
            weight: self.radiance_at(scene, surface.position, &hit) / density,
            density: Some(density),
            end: Some(spawn.end(from, &hit, surface, corners)),
        })
    }

    /// A point of the primitive that may light `from`.
    #[inline]
    fn sampled(&self, scene: &Scene, from: Vec3, at: Vec2) -> Option<SampledSurface> {
        let at = at.as_dvec2();
        match &self.patch {
            Some(patch) => {
                let sampled = patch.sampled(at);
                scene.keeps(sampled.surface.position).then_some(sampled)
            }
            None => scene.sampled(self.primitive, from, at),
        }
    }

    /// The light at a hit, which a texture may dim.
    fn radiance_at(&self, scene: &Scene, position: Vec3, hit: &Hit) -> Vec3 {
        if !self.is_textured {
            return self.radiance;
        }
        let materials = &scene.mesh().attributes().materials;
        let material = materials.get(scene.material(self.primitive));
        Appearance::new(scene, material, position, hit).emission()
    }

    /// The density of the point that a ray hits, as seen from a point on its line.
    pub(super) fn density(&self, scene: &Scene, from: Vec3, ray: &Ray, hit: &Hit) -> f32 {
        let surface = scene.surface(ray, hit);
        let way = surface.position.as_dvec3() - from.as_dvec3();
        let towards = -(ray.dir.normalize());
        let cos = surface.normal.as_vec3().dot(towards);
        let uniform = scene.density_from(self.primitive, from);
        let density = self.density_at(uniform, way.length_squared(), cos);
        density.unwrap_or(0.0)
    }

    /// The density of a point at a squared distance, with the cosine between its normal and the way back. `uniform` is the
    /// density if directions are uniform.
    fn density_at(&self, uniform: Option<f64>, distance2: f64, cos: f32) -> Option<f32> {
        let density = match uniform {
            // Only the front appears from there; a ray that has passed through it may hit the back.
            Some(density) => (cos > 0.0).then_some(density)?,
            None => {
                let cos = if self.emits_on_back { cos.abs() } else { cos };
                (cos > 0.0).then(|| distance2 / (f64::from(cos) * self.area))?
            }
        };
        let density = density as f32;
        (density > 0.0 && density.is_finite()).then_some(density)
    }
}
