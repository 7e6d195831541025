//! Integrators of scene files: where Russian roulette begins, and hidden emitters.

use super::lamps::{loaded, radiance};
use super::{Estimate, lit, path_count};
use glam::{DVec3, UVec2, Vec3};
use hitscope_core::Ray;
use hitscope_core::integrator::{Context, PathEnd, integrator};
use std::sync::Arc;

fn context(contents: &str) -> Context {
    let loaded = loaded(contents);
    let lighting = loaded.lighting();
    let scene = Arc::into_inner(loaded.scene).expect("no other owner");
    let mut context = lit(scene, loaded.lights);
    context.background = Vec3::new(0.1, 0.2, 0.3);
    context.lighting.roulette_depth = lighting.roulette_depth;
    context.lighting.hides_emitters = lighting.hides_emitters;
    context
}

/// A closed sphere that emits light 1 and reflects half of it, seen from inside, where L = 1/(1 − ρ) = 2.
fn furnace(rr_depth: u32) -> Context {
    context(&format!(
        "<integrator type='path'><integer name='rr_depth' value='{rr_depth}'/></integrator>
         <shape type='sphere'><bsdf type='twosided'><bsdf type='diffuse'/></bsdf>
           <boolean name='flip_normals' value='true'/><emitter type='area'/></shape>"
    ))
}

#[test]
fn roulette_begins_at_the_surface_that_the_file_names_and_does_not_change_the_mean() {
    let path = integrator("path").expect("a view");
    for rr_depth in [1, 3, 9] {
        let context = furnace(rr_depth);
        let surfaces: Vec<usize> = (0..200)
            .map(|k| {
                let record = path.record(&context, UVec2::ZERO, k).expect("a path");
                assert_eq!(record.end, PathEnd::RussianRoulette);
                for (surface, vertex) in (1..).zip(&record.vertices) {
                    assert_eq!(vertex.survival.is_some(), surface >= rr_depth);
                }
                record.vertices.len()
            })
            .collect();
        assert_eq!(surfaces.iter().min(), Some(&(rr_depth as usize)));
        let ray = Ray::new(Vec3::ZERO, Vec3::Z).expect("a ray");
        Estimate::of_ray(&context, "path", path_count(), ray).require(2.0);
    }
}

/// A hidden lamp under a sky, before a white wall if `has_wall`.
fn lamp(integrator: &str, has_wall: bool) -> Context {
    let wall = "<shape type='rectangle'><transform name='to_world'><scale value='9'/><translate z='-1'/></transform>
         <bsdf type='diffuse'><spectrum name='reflectance' value='1'/></bsdf></shape>";
    context(&format!(
        "<integrator type='{integrator}'><boolean name='hide_emitters' value='true'/></integrator>
         <shape type='sphere'><float name='radius' value='0.5'/><emitter type='area'/>
           <bsdf type='diffuse'><spectrum name='reflectance' value='0'/></bsdf></shape>
         <emitter type='constant'/>{}",
        if has_wall { wall } else { "" }
    ))
}

#[test]
fn hidden_emitters_light_the_scene_and_are_not_seen() {
    let down = Ray::new(Vec3::new(0.1, 0.2, 3.0), Vec3::NEG_Z).expect("a ray");
    for view in ["path", "direct", "whitted"] {
        let behind = radiance(&lamp(view, false), view, &down).expect("the lamp is hit");
        assert_eq!(behind, Vec3::new(0.1, 0.2, 0.3).as_dvec3(), "{view}");
        // The wall faces the sky and the lamp, both of radiance 1: the lamp replaces the sky that it covers.
        Estimate::of_ray(&lamp(view, true), view, path_count(), down).require(1.0);
    }
    let mut seen = lamp("path", false);
    seen.lighting.hides_emitters = false;
    assert_eq!(radiance(&seen, "path", &down), Some(DVec3::ONE));
}

#[test]
fn recorded_paths_pass_through_hidden_emitters() {
    let context = lamp("path", true);
    let path = integrator("path").expect("a view");
    // The camera of these tests looks along z from the lamp's centre, towards no wall.
    let record = path.record(&context, UVec2::ZERO, 0).expect("a path");
    let [lamp] = &record.vertices[..] else {
        panic!("the lamp alone: {record:?}");
    };
    assert!(lamp.is_passed && lamp.emission == Vec3::ZERO);
    assert_eq!(record.radiance, context.background);
}
