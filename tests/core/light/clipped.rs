//! Light in clipped scenes: what is removed neither blocks light, nor scatters or emits any.

use super::lit;
use glam::{DVec3, UVec2, Vec3};
use hitscope_core::integrator::{Context, integrator};
use hitscope_core::light::{Environment, Light};
use hitscope_core::mesh::shapes::soup;
use hitscope_core::mesh::{Assigned, Attributes, Material, Runs};
use hitscope_core::sampler::Sampler;
use hitscope_core::scene::scene;
use hitscope_core::{Clip, Ray, Scene};

/// Two triangles of a square about the z axis with this half side and height, facing up.
fn square(half: f32, z: f32) -> [[Vec3; 3]; 2] {
    let [a, b, c, d] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y): (f32, f32)| Vec3::new(half * x, half * y, z));
    [[a, b, c], [a, c, d]]
}

/// A floor at z = 0 and, if it is there, a roof over it at z = 1, which may emit light.
fn floor(roof_emits: bool, has_roof: bool) -> Scene {
    let white = Material {
        diffuse: Some(Vec3::splat(0.5)),
        ..Material::default()
    };
    let roof = Material {
        emission: if roof_emits { Vec3::ONE } else { Vec3::ZERO },
        ..white.clone()
    };
    let mut runs = Runs::default();
    runs.begin(2, 1);
    let mut corners = square(2.0, 0.0).to_vec();
    if has_roof {
        corners.extend(square(1.0, 1.0));
    }
    scene(soup(&corners).with_attributes(Attributes {
        materials: Assigned::new(vec![white, roof], runs),
        ..Attributes::default()
    }))
}

/// The radiance of some samples of rays that come down to the floor from aside, below the roof.
fn samples(context: &Context, view: &str) -> Vec<Vec3> {
    let view = integrator(view).expect("a view");
    let sample = |k: u16| {
        let origin = Vec3::new(-1.5 + 0.05 * f32::from(k), 0.3, 0.5);
        let ray = Ray::new(origin, Vec3::new(0.2, 0.1, -0.5)).expect("a ray");
        let hit = context.intersector.closest_hit(&ray);
        assert!(hit.is_some_and(|hit| hit.primitive < 2), "the floor");
        let mut sampler = Sampler::new(UVec2::new(u32::from(k), 0), 1);
        view.radiance(context, &ray, hit, &mut sampler)
    };
    (0..60).map(sample).collect()
}

fn without_roof(scene: &Scene) -> Scene {
    scene.with_clip(Some(Clip::plane(DVec3::Z, 0.75).expect("a plane")))
}

fn under_sky(scene: Scene) -> Context {
    let sky = Environment::Constant(Vec3::ONE);
    lit(scene, vec![Light::Environment(sky)])
}

#[test]
fn a_removed_roof_neither_shadows_the_floor_nor_reflects_light_to_it() {
    for view in ["direct", "path", "whitted", "ao"] {
        let [with, without, clipped] = [
            floor(false, true),
            floor(false, false),
            without_roof(&floor(false, true)),
        ]
        .map(|scene| {
            let mut context = under_sky(scene);
            // Otherwise it depends on the scene's size.
            context.lighting.ao_distance = f32::INFINITY;
            samples(&context, view)
        });
        assert_ne!(with, without, "{view}: the roof matters");
        assert_eq!(clipped, without, "{view}");
    }
}

#[test]
fn a_removed_lamp_gives_no_light() {
    for view in ["direct", "path", "whitted"] {
        let lamp = floor(true, true);
        let light = samples(&lit(lamp.with_clip(None), Vec::new()), view);
        assert!(
            light.iter().any(|light| light.max_element() > 0.0),
            "{view}"
        );
        let dark = samples(&lit(without_roof(&lamp), Vec::new()), view);
        assert!(dark.iter().all(|light| *light == Vec3::ZERO), "{view}");
    }
}
