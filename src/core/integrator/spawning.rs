//! The view *Spawn policies*: where two policies disagree about what a ray that leaves the surface meets.

use super::palette::{FALSE_HIT, MISSED, decision, named};
use super::transport::ShadingPoint;
use super::{Context, Integrator, Legend, Needs, Setting, Source};
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::spawn::SpawnPolicy;
use glam::Vec3;

/// The row of the view.
pub(super) static SPAWNING: Integrator = Integrator {
    name: "spawning",
    title: "Spawn policies",
    about: "Where rays that leave the surface by the chosen policy are blocked and those by the second one aren't, or the other way round.",
    needs: Needs {
        settings: &[Setting::Spawn, Setting::SecondSpawn],
        ..Needs::LIGHTS
    },
    legend,
    source: Source::Colour(radiance),
};

fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, sampler: &mut Sampler) -> Vec3 {
    let Some(hit) = hit else {
        return context.background;
    };
    let point = ShadingPoint::unrepaired(context, ray, hit);
    let Some(dir) = point.open_direction(sampler) else {
        return Vec3::splat(0.02);
    };
    let is_blocked = |policy: &SpawnPolicy| {
        let ray = point.spawn_by(policy, dir);
        ray.is_some_and(|ray| context.intersector.any_hit(&ray))
    };
    let lighting = &context.lighting;
    let first = is_blocked(lighting.spawn);
    let second = is_blocked(lighting.second_spawn);
    decision(first, second, !first)
}

fn legend() -> Legend {
    vec![vec![
        named(FALSE_HIT, "only the chosen one is blocked"),
        named(MISSED, "only the second one is blocked"),
    ]]
}
