//! The boxes of solids.

use super::bounds::is_exact;
use glam::Vec3;
use hitscope_core::Aabb;
use hitscope_core::group::{CsgOperation, Solid};
use hitscope_core::shape::{AxisPlane, Plane, Sphere};

/// The half-space of lower coordinates along z, or of higher ones.
fn half_space(z: f32, is_below: bool) -> Solid {
    Solid::of(AxisPlane {
        axis: 2,
        coordinate: z,
        is_along_axis: is_below,
    })
}

#[test]
fn boxes_of_solids_are_those_of_the_combined_points() {
    use CsgOperation::{Difference, Intersection, Union};
    let ball = |x: f32| {
        Solid::of(Sphere {
            centre: Vec3::new(x, 0.0, 0.0),
            radius: 1.0,
        })
    };
    let of = |operation, solids: Vec<Solid>| Solid::combined(operation, solids);
    let box_of = |operation, solids| of(operation, solids).bounds().expect("bounded");
    let (low, high) = ([-1.0; 3], [1.0; 3]);
    is_exact(
        box_of(Union, vec![ball(0.0), ball(1.0)]),
        low,
        [2.0, 1.0, 1.0],
    );
    is_exact(
        box_of(Intersection, vec![ball(0.0), ball(1.0)]),
        [0.0, -1.0, -1.0],
        high,
    );
    is_exact(box_of(Difference, vec![ball(0.0), ball(1.0)]), low, high);
    // Planes cut the box.
    let lower_half = half_space(0.25, true);
    is_exact(
        box_of(Intersection, vec![ball(0.0), lower_half.clone()]),
        low,
        [1.0, 1.0, 0.25],
    );
    let cap = of(Difference, vec![ball(0.0), lower_half.clone()]);
    is_exact(cap.bounds().expect("bounded"), [-1.0, -1.0, 0.25], high);
    // What isn't in the union of half-spaces lies between them.
    let outside = of(Union, vec![half_space(-0.5, true), half_space(0.5, false)]);
    is_exact(
        box_of(Difference, vec![ball(0.0), outside.clone()]),
        [-1.0, -1.0, -0.5],
        [1.0, 1.0, 0.5],
    );
    // A difference of a difference.
    let slab = of(
        Difference,
        vec![half_space(0.5, true), half_space(-0.5, true)],
    );
    is_exact(
        box_of(Intersection, vec![ball(0.0), slab.clone()]),
        [-1.0, -1.0, -0.5],
        [1.0, 1.0, 0.5],
    );
    // Infinite ones.
    let tilted = Solid::of(Plane {
        point: Vec3::ZERO,
        normal: Vec3::ONE,
    });
    for infinite in [
        slab.clone(),
        outside,
        tilted.clone(),
        of(Union, vec![ball(0.0), tilted.clone()]),
        of(Difference, vec![lower_half.clone(), ball(0.0)]),
    ] {
        assert_eq!(infinite.bounds(), None, "{infinite:?}");
    }
    is_exact(box_of(Difference, vec![ball(0.0), tilted]), low, high);
    // Empty ones.
    for empty in [
        of(Union, Vec::new()),
        of(Intersection, Vec::new()),
        of(Difference, Vec::new()),
        of(Intersection, vec![ball(0.0), ball(3.0)]),
        of(
            Intersection,
            vec![half_space(0.0, true), half_space(1.0, false)],
        ),
    ] {
        assert_eq!(empty.bounds(), Some(Aabb::EMPTY), "{empty:?}");
    }
}
