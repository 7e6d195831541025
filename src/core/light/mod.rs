//! Lights, one file per kind.
//!
//! Radiance is linear RGB, in any unit: twice the light gives twice the picture. A density is a probability per solid
//! angle as seen from the lit point.

mod alias;
mod area;
mod distant;
mod environment;
mod point;
pub(crate) mod studio;

pub use alias::AliasTable;
pub use area::AreaLight;
pub use distant::DirectionalLight;
pub use environment::{
    Environment, EnvironmentMap, LoadedMap, MapError, MapPlacement, MapSample, PlacedMap,
};
pub use point::PointLight;
pub use studio::studio;

use crate::mesh::Material;
use crate::ray::{Hit, Ray};
use crate::scene::Scene;
use crate::spawn::SpawnPolicy;
use crate::srgb::luminance;
use area::Emitters;
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;

/// A light that is sampled.
#[derive(Clone, Debug)]
pub enum Light {
    /// Light from infinitely far away, from all directions.
    Environment(Environment),
    /// Light from infinitely far away, from one direction.
    Directional(DirectionalLight),
    /// Light from a point.
    Point(PointLight),
    /// A primitive whose material emits light.
    Area(AreaLight),
}

/// Light that may reach a point from a direction, if nothing is in the way.
#[derive(Clone, Debug)]
pub struct LightSample {
    /// The unit direction to the light.
    pub dir: Vec3,
    /// The end of the way to the light, which the spawn policy moves off the light's surface; `None` if the light is
    /// infinitely far away.
    pub end: Option<Vec3>,
    /// The light that arrives, divided by the density.
    pub weight: Vec3,
    /// The density; `None` if the light comes from a single direction, so that no ray meets it by chance.
    pub density: Option<f32>,
}

/// The lights of a scene.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    lights: Vec<Light>,
    /// Chooses a light by its power.
    choice: AliasTable,
    /// The index of the environment.
    environment: Option<u32>,
    /// The light of each primitive that emits light.
    of_primitive: HashMap<u32, u32>,
    has_coverage: bool,
    has_extent: bool,
}

impl Lights {
    /// The primitives of a scene that emit light, and further lights. Of several environments the last one counts.
    pub fn new(scene: &Scene, others: Vec<Light>) -> Self {
        Self::with(scene, Emitters::of_scene(scene), others)
    }

    fn with(scene: &Scene, emitters: Emitters, others: Vec<Light>) -> Self {
        let has_emitters = !emitters.is_empty();
        let mut lights: Vec<Light> = emitters.lights.into_iter().map(Light::Area).collect();
        let of_primitive = lights
            .iter()
            .zip(0..)
            .filter_map(|(light, index)| match light {
                Light::Area(light) => Some((light.primitive(), index)),
                _ => None,
            });
        let of_primitive = of_primitive.collect();
        let is_environment = |light: &Light| matches!(light, Light::Environment(_));
        let last = others.iter().rposition(is_environment);
        let kept = others.into_iter().enumerate();
        let kept = kept.filter(|(k, light)| !is_environment(light) || Some(*k) == last);
        lights.extend(kept.map(|(_, light)| light));
        let attributes = scene.mesh().attributes();
        let mut materials = attributes.materials.entries().iter();
        let has_coverage = |material: &Material| material.has_coverage(&attributes.textures);
        let has_coverage = materials.any(has_coverage);
        let radius = radius_for_power(scene);
        let power = |light: &Light| f64::from(luminance(light.power(radius)));
        let environment = lights.iter().position(is_environment).map(|k| k as u32);
        Self {
            has_extent: environment.is_some() || has_emitters,
            choice: AliasTable::new(&lights.iter().map(power).collect::<Vec<_>>()),
            environment,
            of_primitive,
            has_coverage,
            lights,
        }
    }

    /// The same; if nothing emits light, white light of radiance 1 from all directions, so that pictures aren't black.
    pub fn or_white(scene: &Scene, others: Vec<Light>) -> Self {
        let emitters = Emitters::of_scene(scene);
        let others = if others.is_empty() && emitters.is_empty() {
            vec![Light::Environment(Environment::Constant(Vec3::ONE))]
        } else {
            others
        };
        Self::with(scene, emitters, others)
    }

    /// Whether light passes through parts of some surface.
    pub fn has_coverage(&self) -> bool {
        self.has_coverage
    }

    /// Whether some light comes from more than single points and directions, so that random numbers sample it.
    pub fn has_extent(&self) -> bool {
        self.has_extent
    }

    /// All lights.
    pub fn all(&self) -> &[Light] {
        &self.lights
    }

    /// The environment.
    pub fn environment(&self) -> Option<&Environment> {
        match self.lights.get(self.environment? as usize)? {
            Light::Environment(environment) => Some(environment),
            _ => None,
        }
    }

    /// Whether there are lights to aim at. Light that is the same from everywhere has no direction to prefer.
    pub fn can_be_sampled(&self) -> bool {
        !self.choice.is_empty()
    }

    /// Whether there are several lights to choose from, so that [`sample`](Self::sample) uses its `choice`.
    pub fn are_several(&self) -> bool {
        self.lights.len() > 1
    }

    /// Light that reaches a point, from a light chosen by its power. Rays leave surfaces by the policy `spawn`. `at` and
    /// `choice` are uniform numbers in [0, 1).
    #[inline]
    pub fn sample(
        &self,
        scene: &Scene,
        spawn: &SpawnPolicy,
        from: Vec3,
        at: Vec2,
        choice: f32,
    ) -> Option<LightSample> {
        let (index, probability) = self.choice.sample(choice)?;
        let sample = match &self.lights[index] {
            Light::Area(light) => light.sample(scene, spawn, from, at),
            Light::Environment(light) => light.sample(at),
            Light::Directional(light) => Some(light.sample()),
            Light::Point(light) => light.sample(from),
        };
        if probability == 1.0 {
            return sample;
        }
        sample.map(|sample| LightSample {
            weight: sample.weight / probability,
            density: sample.density.map(|density| density * probability),
            ..sample
        })
    }

    /// The light that reaches a point from each single point and direction.
    pub fn without_extent(&self, from: Vec3) -> impl Iterator<Item = LightSample> {
        // The first lights are primitives.
        let others = &self.lights[self.of_primitive.len()..];
        others.iter().filter_map(move |light| match light {
            Light::Directional(light) => Some(light.sample()),
            Light::Point(light) => light.sample(from),
            Light::Environment(_) | Light::Area(_) => None,
        })
    }

    /// The density with which [`sample`](Self::sample) chooses the environment in a unit direction.
    pub fn density_of_environment(&self, dir: Vec3) -> f32 {
        let density = |light: &Environment| light.density(dir);
        self.environment().map_or(0.0, density) * self.probability(self.environment)
    }

    /// The density with which [`sample`](Self::sample) chooses the point that a ray hits, for the lit point `from` on the
    /// ray's line.
    pub fn density_of_hit(&self, scene: &Scene, from: Vec3, ray: &Ray, hit: &Hit) -> f32 {
        let index = self.of_primitive.get(&hit.primitive).copied();
        match index.map(|index| &self.lights[index as usize]) {
            Some(Light::Area(light)) => {
                light.density(scene, from, ray, hit) * self.probability(index)
            }
            _ => 0.0,
        }
    }

    fn probability(&self, light: Option<u32>) -> f32 {
        light.map_or(0.0, |index| self.choice.probability(index as usize))
    }
}

/// The radius of the scene for comparisons of lights' powers. Planes have no bounds, so a scene of planes alone counts as
/// one of radius 1. The powers of extreme radii would overflow or vanish in f32.
fn radius_for_power(scene: &Scene) -> f64 {
    let radius = scene.bounds().radius();
    if radius > 0.0 {
        radius.clamp(1e-12, 1e12)
    } else {
        1.0
    }
}

impl Light {
    /// The same light after an offset is added to the scene's coordinates. Primitives that emit light move with the
    /// scene.
    #[must_use]
    pub fn moved(self, offset: DVec3) -> Self {
        match self {
            Self::Point(light) => Self::Point(PointLight {
                position: (light.position.as_dvec3() + offset).as_vec3(),
                ..light
            }),
            other => other,
        }
    }

    /// About the power that lights a scene of this radius, up to a factor that all lights have in common.
    fn power(&self, radius: f64) -> Vec3 {
        match self {
            Self::Environment(light) => light.power(radius),
            Self::Directional(light) => light.power(radius),
            Self::Point(light) => light.power(),
            Self::Area(light) => light.power(),
        }
    }
}
