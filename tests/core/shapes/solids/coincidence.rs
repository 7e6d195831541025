//! Rays along coinciding and touching surfaces.

use super::{crossings, cube, intersector, scene_of};
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::group::{CsgOperation, Solid};
use hitscope_core::kernel::Tier;
use hitscope_core::shape::{Cone, Cuboid, Plane, Sphere, Torus};

#[test]
fn a_point_that_only_touches_an_operand_is_no_surface() {
    let ball = Sphere {
        centre: Vec3::Y,
        radius: 1.0,
    };
    let below = cube(Vec3::new(-2.0, -3.0, -2.0), Vec3::new(2.0, -1.0, 2.0));
    let tube = Torus {
        centre: Vec3::ZERO,
        axis: Vec3::Y,
        major: 4.0,
        minor: 1.0,
    };
    let both = vec![Solid::of(below), Solid::of(ball)];
    for (solid, y) in [
        (Solid::combined(CsgOperation::Union, both), 0.0),
        // The ray touches the tube along its top circle twice.
        (Solid::of(tube), 1.0),
    ] {
        let scene = scene_of(vec![solid]);
        let exact = intersector(&scene, Tier::Exact);
        let along_x = crossings(&*exact, [-8.0, y, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(along_x, [0.0; 0]);
    }
}

#[test]
fn coinciding_faces_are_decided_exactly() {
    let whole = cube(Vec3::ZERO, Vec3::ONE);
    let upper = cube(Vec3::new(0.0, 0.0, 0.5), Vec3::new(1.0, 1.0, 1.0));
    let next = cube(Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 1.0, 2.0));
    let along_z = |operation, solids| {
        let scene = scene_of(vec![Solid::combined(operation, solids)]);
        let exact = intersector(&scene, Tier::Exact);
        crossings(&*exact, [0.25, 0.75, -1.0], [0.0, 0.0, 1.0])
    };
    let two = |a: Cuboid, b: Cuboid| vec![Solid::of(a), Solid::of(b)];
    assert_eq!(
        along_z(CsgOperation::Difference, two(whole, upper)),
        [1.0, 1.5]
    );
    assert_eq!(
        along_z(CsgOperation::Difference, two(whole, whole)),
        [0.0; 0]
    );
    assert_eq!(along_z(CsgOperation::Union, two(whole, next)), [1.0, 3.0]);
    assert_eq!(
        along_z(CsgOperation::Intersection, two(whole, next)),
        [0.0; 0]
    );
    assert_eq!(
        along_z(CsgOperation::Intersection, two(whole, upper)),
        [1.5, 2.0]
    );
}

#[test]
fn a_ray_through_the_apex_of_a_cone_crosses_it() {
    let cone = Cone {
        p0: Vec3::ZERO,
        p1: Vec3::Z,
        radius: 1.0,
        is_capped: true,
    };
    let scene = scene_of(vec![Solid::of(cone)]);
    let exact = intersector(&scene, Tier::Exact);
    assert_eq!(
        crossings(&*exact, [0.0, 0.0, 3.0], [0.0, 0.0, -1.0]),
        [2.0, 3.0]
    );
}

#[test]
fn where_surfaces_coincide_the_one_that_faces_the_ray_counts() {
    // The ray goes down a hole that ends where another cube begins.
    let whole = cube(Vec3::new(-1.0, -1.0, 0.0), Vec3::ONE);
    let hole = cube(Vec3::new(-0.5, -0.5, -1.0), Vec3::new(0.5, 0.5, 2.0));
    let below = cube(Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 0.0));
    let [whole, hole, below] = [whole, hole, below].map(Solid::of);
    let drilled = Solid::combined(CsgOperation::Difference, vec![whole, hole]);
    let scene = scene_of(vec![Solid::combined(
        CsgOperation::Union,
        vec![drilled, below],
    )]);
    let ray = Ray::new(Vec3::new(0.0, 0.0, 3.0), Vec3::NEG_Z).expect("a ray");
    let hit = intersector(&scene, Tier::Exact)
        .closest_hit(&ray)
        .expect("the bottom");
    assert_eq!(hit.t, 3.0);
    assert_eq!(scene.surface(&ray, &hit).normal, DVec3::Z);
}

#[test]
fn a_coinciding_surface_that_bounds_nothing_is_not_hit() {
    // The ray enters both boxes at z = 1; the first one is cut away there.
    let cut = cube(Vec3::new(-1.0, -1.0, 0.0), Vec3::ONE);
    let left = Plane {
        point: Vec3::ZERO,
        normal: Vec3::X,
    };
    let ball = Sphere {
        centre: Vec3::new(0.5, 0.0, 0.5),
        radius: 0.5,
    };
    let half = vec![Solid::of(cut), Solid::of(left)];
    let half = Solid::combined(CsgOperation::Intersection, half);
    let scene = scene_of(vec![Solid::combined(
        CsgOperation::Union,
        vec![half, Solid::of(ball)],
    )]);
    let ray = Ray::new(Vec3::new(0.5, 0.0, 3.0), Vec3::NEG_Z).expect("a ray");
    let hit = intersector(&scene, Tier::Exact)
        .closest_hit(&ray)
        .expect("the ball");
    // The third operand.
    assert_eq!((hit.t, hit.v), (2.0, 2.0));
}
