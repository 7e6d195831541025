//! Repairs of the shadow terminator on a coarse sphere under a distant light.

use super::lamps::{loaded, loaded_with, radiance};
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
use std::fmt::Write as _;
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

/// The edges of the facets. They are placed so that some facets face the light, which comes from 0°, where the curved
/// surface turns away, and others turn away where the curved surface faces it.
const EDGES: std::ops::Range<i32> = 0..12;

fn edge_degrees(edge: i32) -> f64 {
    f64::from(10 + 30 * edge)
}

/// The red of normal maps that tilt all normals by the arc tangent of 0.6/0.8, towards smaller and towards larger angles.
const TILTS: [(f64, f64); 2] = [(0.2, -0.75), (0.8, 0.75)];

/// A tube of 12 facets about the z axis, of radius 1, with vertex normals, and a normal map with this red.
fn embossed_tube(red: f64) -> Context {
    let mut mesh = String::new();
    for edge in EDGES.start..=EDGES.end {
        let (y, x) = edge_degrees(edge).to_radians().sin_cos();
        for z in [-1, 1] {
            let u = f64::from(edge) / 12.0;
            writeln!(mesh, "v {x} {y} {z}\nvn {x} {y} 0\nvt {u} {z}").expect("memory");
        }
    }
    for edge in EDGES {
        let corners = [1, 3, 4, 2].map(|k| 2 * edge + k);
        let corners = corners.map(|k| format!(" {k}/{k}/{k}"));
        writeln!(mesh, "f{}", corners.concat()).expect("memory");
    }
    let loaded = loaded_with(
        "tube.obj",
        &mesh,
        &format!(
            r#"<shape type="obj"><string name="filename" value="tube.obj"/>
                 <bsdf type="normalmap"><bsdf type="diffuse"/>
                   <texture name="normalmap" type="checkerboard">
                     <rgb name="color0" value="{red} 0.5 0.9"/><rgb name="color1" value="{red} 0.5 0.9"/>
                   </texture></bsdf></shape>
               <emitter type="directional"><vector name="direction" value="-1, 0, 0"/>
                 <spectrum name="irradiance" value="3.1415927"/></emitter>"#
        ),
    );
    let scene = Arc::into_inner(loaded.scene).expect("no other owner");
    let mut context = lit(scene, loaded.lights);
    context.shading = Shading::Smooth;
    context
}

/// A ray towards the axis, at an angle and a height.
fn inwards(degrees: f64, z: f64) -> Ray {
    let (y, x) = degrees.to_radians().sin_cos();
    let dir = glam::DVec3::new(-x, -y, 0.0);
    let from = glam::DVec3::Z * z - 3.0 * dir;
    Ray::new(from.as_vec3(), dir.as_vec3()).expect("a ray")
}

#[test]
fn no_light_reaches_a_relief_where_its_surface_turns_away() {
    let mut random = Random::new(11);
    let (mut seen_by_relief, mut seen_by_facet) = (0, 0);
    let mut contexts = TILTS.map(|(red, tangent)| (embossed_tube(red), f64::atan(tangent)));
    for k in 0..4000 {
        let (context, tilt) = &mut contexts[k % 2];
        let degrees = 360.0 * random.unit() - 180.0;
        let ray = inwards(degrees, random.unit() - 0.5);
        let hit = context.intersector.closest_hit(&ray).expect("a hit");
        let surface = SurfaceInteraction::new(&context.scene, &ray, hit, context.shading);
        let tilted = degrees.to_radians() + *tilt;
        let [by_geometry, by_shading] =
            [surface.geometric_normal.x, surface.shading_normal.x].map(f64::from);
        if by_shading < -1e-6 {
            assert_eq!(repaired(context, &ray), [0.0; 3], "{degrees}");
            let is_tilted_to_light = tilted.cos() > 0.05;
            seen_by_relief += u32::from(is_tilted_to_light);
            seen_by_facet += u32::from(is_tilted_to_light && by_geometry > 0.0);
        }
    }
    assert!(
        seen_by_relief > 50 && seen_by_facet > 20,
        "{seen_by_relief} {seen_by_facet}"
    );
}

#[test]
fn the_light_of_a_relief_on_shifted_origins_is_smooth_across_edges() {
    let mut largest = [0.0_f64; 3];
    let contexts = TILTS.map(|(red, _)| embossed_tube(red));
    for (mut context, edge) in contexts
        .into_iter()
        .flat_map(|context| EDGES.map(move |edge| (context.clone(), edge)))
    {
        for z in [-0.7, -0.2, 0.3, 0.9] {
            let at = |offset: f64| inwards(edge_degrees(edge) + offset, z);
            let sides = [at(-0.005), at(0.005)].map(|ray| repaired(&mut context, &ray));
            for (largest, (a, b)) in largest.iter_mut().zip(sides[0].into_iter().zip(sides[1])) {
                *largest = largest.max((a - b).abs());
            }
        }
    }
    let [none, _, hanika] = largest;
    // The reflectance 0.5, times the slope of cosine and relief, at most 10 near the light's edge, times 1.7·10⁻⁴ radians.
    assert!(none > 0.05 && hanika < 1e-3, "{none} {hanika}");
}
