//! Repairs of the shadow terminator on a coarse sphere under a distant light.

use super::lamps::{loaded, radiance};
use super::lit;
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::integrator::Context;
use hitscope_core::interaction::SurfaceInteraction;
use hitscope_core::light::{DirectionalLight, Light};
use hitscope_core::mesh::shapes::{Placement, sphere};
use hitscope_core::random::Random;
use hitscope_core::scene::{Shading, scene};
use hitscope_core::terminator::terminator_repair;
use std::sync::Arc;

/// Along no edge of the mesh, whose terminators would coincide with the light's.
const TO_LIGHT: Vec3 = Vec3::new(0.36, 0.48, 0.8);

fn coarse_sphere(shading: Shading) -> Context {
    let lamp = DirectionalLight {
        to_light: TO_LIGHT,
        irradiance: Vec3::ONE,
    };
    let context = lit(
        scene(sphere(2, Placement::UNIT)),
        vec![Light::Directional(lamp)],
    );
    Context { shading, ..context }
}

/// The light of a ray without a repair, with that of Chiang et al., and with that of Hanika.
fn repaired(context: &mut Context, ray: &Ray) -> [f64; 3] {
    ["none", "chiang", "hanika"].map(|name| {
        context.lighting.terminator = terminator_repair(name).expect("a repair");
        radiance(context, "direct", ray).expect("a hit").y
    })
}

/// Rays to the centre from random directions.
fn rays() -> impl Iterator<Item = Ray> {
    let mut random = Random::new(7);
    (0..4000).map(move |_| {
        let from = random.direction().as_vec3();
        Ray::new(3.0 * from, -from).expect("a ray")
    })
}

#[test]
fn repairs_darken_the_lit_side_or_light_what_the_shading_normal_sees() {
    let mut context = coarse_sphere(Shading::Smooth);
    let (mut turned_away, mut lit_by_hanika, mut darkened) = (0, 0, 0);
    for ray in rays() {
        let hit = context.intersector.closest_hit(&ray).expect("a hit");
        let surface = SurfaceInteraction::new(&context.scene, &ray, hit, context.shading);
        let [none, chiang, hanika] = repaired(&mut context, &ray);
        assert!(chiang <= none, "{ray:?}: {chiang} {none}");
        darkened += u32::from(chiang < none);
        let by_geometry = surface.geometric_normal.dot(TO_LIGHT);
        let by_shading = surface.shading_normal.dot(TO_LIGHT);
        if by_geometry < 0.0 && by_shading > 0.05 {
            assert_eq!((none, chiang), (0.0, 0.0), "{ray:?}");
            turned_away += 1;
            lit_by_hanika += u32::from(hanika > 0.0);
        }
    }
    eprintln!("{lit_by_hanika} of {turned_away} are lit, {darkened} darkened");
    assert!(
        turned_away > 50 && darkened > 100,
        "{turned_away} {darkened}"
    );
    // On the sphere itself, which the mesh approximates, all would be.
    assert!(
        10 * lit_by_hanika > 9 * turned_away,
        "{lit_by_hanika} of {turned_away}"
    );
}

#[test]
fn flat_shading_has_no_terminator_to_repair() {
    let mut context = coarse_sphere(Shading::Flat);
    for ray in rays() {
        let [none, chiang, hanika] = repaired(&mut context, &ray);
        // The ratio of equal cosines over the square of a unit normal's length.
        assert!((chiang - none).abs() <= 1e-6 * none, "{ray:?}");
        assert_eq!(none, hanika, "{ray:?}");
    }
}

#[test]
fn repairs_change_nothing_where_only_a_texture_tilts_the_normal() {
    let loaded = loaded(
        r#"<shape type="rectangle"><bsdf type="normalmap"><bsdf type="diffuse"/>
             <texture name="normalmap" type="checkerboard">
               <rgb name="color0" value="0.8 0.5 0.9"/><rgb name="color1" value="0.8 0.5 0.9"/>
             </texture></bsdf></shape>
           <emitter type="directional"><vector name="direction" value="-2, 0, -1"/></emitter>"#,
    );
    let scene = Arc::into_inner(loaded.scene).expect("no other owner");
    let mut context = lit(scene, loaded.lights);
    context.shading = Shading::Smooth;
    let ray = Ray::new(Vec3::new(0.1, 0.2, 1.0), Vec3::NEG_Z).expect("a ray");
    let [none, chiang, hanika] = repaired(&mut context, &ray);
    assert!(none > 0.1, "{none}");
    // The ratio of equal cosines over the square of a unit normal's length.
    assert!((chiang - none).abs() <= 1e-6 * none, "{chiang} {none}");
    assert_eq!(none, hanika);
}
