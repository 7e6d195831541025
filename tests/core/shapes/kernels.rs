//! Every kernel of every shape on easy cases, and its promises.

use super::{Sample, ray_near};
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::kernel::{KernelTable, Precision, Tier, equations_along, exact_answer};
use hitscope_core::random::Random;
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Sphere, Torus,
};

fn ray(origin: [f32; 3], dir: [f32; 3]) -> Ray {
    Ray::new(origin.into(), dir.into()).expect("a ray")
}

#[test]
fn a_sphere_is_hit_from_outside_from_inside_and_by_a_tangent() {
    let sphere = Sphere {
        centre: Vec3::new(1.0, 2.0, 3.0),
        radius: 2.0,
    };
    for kernel in Sphere::kernels() {
        let name = kernel.info.name;
        let t = |origin, dir| kernel.intersect(&ray(origin, dir), sphere).map(|hit| hit.t);
        assert_eq!(t([1.0, 2.0, -4.0], [0.0, 0.0, 1.0]), Some(5.0), "{name}");
        assert_eq!(t([1.0, 2.0, -4.0], [0.0, 0.0, 4.0]), Some(1.25), "{name}");
        assert_eq!(t([1.0, 2.0, 3.0], [0.0, 1.0, 0.0]), Some(2.0), "{name}");
        assert_eq!(t([1.0, 2.0, -4.0], [0.0, 0.0, -1.0]), None, "{name}");
        assert_eq!(t([3.5, 2.0, -4.0], [0.0, 0.0, 1.0]), None, "{name}");
        // All numbers are small integers, so every kernel sees the exact tangent.
        assert_eq!(t([3.0, 2.0, -4.0], [0.0, 0.0, 1.0]), Some(7.0), "{name}");
    }
}

#[test]
fn an_interval_selects_the_crossing_and_excludes_its_ends() {
    let sphere = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0,
    };
    for kernel in Sphere::kernels() {
        let t = |t_min, t_max| {
            let ray = Ray::with_interval(Vec3::NEG_Z * 3.0, Vec3::Z, t_min, t_max);
            let hit = kernel.intersect(&ray.expect("a ray"), sphere);
            hit.map(|hit| hit.t)
        };
        let name = kernel.info.name;
        assert_eq!(t(0.0, 10.0), Some(2.0), "{name}");
        assert_eq!(t(2.0, 10.0), Some(4.0), "{name}");
        assert_eq!(t(2.5, 4.0), None, "{name}");
        assert_eq!(t(0.0, 2.0), None, "{name}");
        assert_eq!(t(-9.0, 3.0), Some(2.0), "{name}");
    }
}

#[test]
fn spheres_without_a_radius_or_with_a_nan_are_missed() {
    let nan = f32::NAN;
    let bad = [
        (Vec3::ZERO, nan),
        (Vec3::new(nan, 0.0, 0.0), 1.0),
        (Vec3::ZERO, f32::INFINITY),
        (Vec3::new(0.0, f32::INFINITY, 0.0), 1.0),
    ];
    for (centre, radius) in bad {
        let sphere = Sphere { centre, radius };
        for kernel in Sphere::kernels() {
            let hit = kernel.intersect(&ray([0.1, 0.2, -4.0], [0.0, 0.0, 1.0]), sphere);
            assert_eq!(hit, None, "{} {sphere:?}", kernel.info.name);
        }
    }
}

/// Half an ulp of 1 in f32.
const U: f64 = f32::EPSILON as f64 / 2.0;

/// Compares each kernel with the exact one on rays that are neither grazing nor far away.
///
/// Only the exact kernels promise a bound; for the others the check is for wrong formulas. To first order, roundings act
/// like a move of the ray by some e. This moves a crossing by e / sin α along the ray, where α is the angle between ray
/// and surface. A ray that passes a silhouette at the distance g, inside a radius of curvature of at most 1, has
/// sin α ≥ √(2g): 0.014 for g = 1e-4.
fn kernels_agree_with_the_exact_one<S: Sample>(seed: u64) {
    let mut random = Random::new(seed);
    let mut hits = 0;
    for _ in 0..20_000 {
        let shape = S::sample(&mut random, Vec3::ZERO, 1.0);
        let ray = ray_near(&mut random, Vec3::ZERO, 1.0, 4.0);
        let exact = exact_answer(&ray, &shape);
        hits += u32::from(exact.is_some());
        for kernel in S::kernels() {
            let found = kernel.intersect(&ray, shape.clone());
            let name = kernel.info.name;
            match (exact, found) {
                (Some([t, ..]), Some(hit)) => {
                    let least = match kernel.info.precision {
                        // Ten roundings of coordinates up to 5: e = 50u = 3e-6, e / sin α = 2e-4. t is 0.3 or more.
                        Precision::F32 if kernel.info.tier == Some(Tier::Watertight) => 1e-3,
                        // The textbook quartic rounds |f|⁴ = 256. Over the gradient 8R²r = 0.1 of a tube with R = 0.4
                        // and r = 0.08 that is e = 2.4e-3 for 16u, or e / sin α = 3e-2 where sin α = 0.08. Thinner
                        // tubes and smaller angles may err more, but don't for this seed.
                        Precision::F32 => 3e-2,
                        // The same quartic in f64 errs by 5e-9 at sin α = 1e-3; t is then rounded to f32, by up to 6e-8.
                        Precision::F64 => 1e-6,
                        // Rounded correctly.
                        Precision::Adaptive => U,
                    };
                    let error = (f64::from(hit.t) - t).abs();
                    assert!(
                        error <= least * t || is_grazing(&shape, &ray, 1e-4),
                        "{name} {shape:?} {ray:?}: {error:e}"
                    );
                }
                (None, None) => {}
                // Only a grazing ray is decided wrongly: one that passes the silhouette within e.
                _ => {
                    assert_ne!(kernel.info.tier, Some(Tier::Exact), "{name}");
                    let is_textbook = kernel.info.precision == Precision::F32
                        && kernel.info.tier != Some(Tier::Watertight);
                    let beside = if is_textbook { 1e-2 } else { 1e-4 };
                    assert!(is_grazing(&shape, &ray, beside), "{name} {shape:?} {ray:?}");
                }
            }
        }
    }
    assert!(hits > 1500, "{hits}");
}

/// Whether a parallel ray at this distance is decided otherwise.
fn is_grazing<S: Sample>(shape: &S, ray: &Ray, distance: f32) -> bool {
    let decision = |origin: Vec3| {
        let near = Ray::new(origin, ray.dir).expect("a ray");
        exact_answer(&near, shape).is_some()
    };
    let here = decision(ray.origin);
    let side = ray.dir.any_orthonormal_vector();
    let other = ray.dir.cross(side);
    (0..16).any(|k| {
        let (sin, cos) = (std::f32::consts::TAU * k as f32 / 16.0).sin_cos();
        decision(ray.origin + distance * (cos * side + sin * other)) != here
    })
}

#[test]
fn every_kernel_agrees_with_the_exact_one_of_its_shape() {
    kernels_agree_with_the_exact_one::<Sphere>(1);
    kernels_agree_with_the_exact_one::<Plane>(2);
    kernels_agree_with_the_exact_one::<Disk>(3);
    kernels_agree_with_the_exact_one::<Rectangle>(4);
    kernels_agree_with_the_exact_one::<Cuboid>(5);
    kernels_agree_with_the_exact_one::<Cylinder>(6);
    kernels_agree_with_the_exact_one::<Cone>(7);
    kernels_agree_with_the_exact_one::<Quadric>(8);
    kernels_agree_with_the_exact_one::<Torus>(9);
    kernels_agree_with_the_exact_one::<AxisBox>(10);
    kernels_agree_with_the_exact_one::<AxisPlane>(11);
}

/// The point of each hit lies on the ray, and its normal is a unit vector.
fn surfaces_are_on_the_ray<S: Sample>(seed: u64) {
    let mut random = Random::new(seed);
    let mut hits = 0;
    for _ in 0..2000 {
        let shape = S::sample(&mut random, Vec3::ZERO, 1.0);
        let ray = ray_near(&mut random, Vec3::ZERO, 1.0, 4.0);
        let Some(hit) = S::kernel_of(Tier::Exact).intersect(&ray, shape.clone()) else {
            continue;
        };
        hits += 1;
        let surface = shape.surface(&ray, &hit);
        // Normalisation rounds the length by at most 4.5 units of 2⁻⁵³, and computing it again by 2.5.
        let length = surface.normal.length();
        assert!((length - 1.0).abs() < 4.0 * f64::EPSILON, "{shape:?}");
        // t is rounded by up to ut. The point is projected onto the surface, for a cone across its axis, which makes that
        // √2·ut at most, and rounded by u|p| ≤ u(4 + t).
        let off = surface.position.as_dvec3().distance(ray.at(hit.t));
        let farthest = 1.0 + f64::from(hit.t);
        assert!(
            off < 4.0 * U * farthest,
            "{shape:?} {ray:?} {hit:?}: {off:e}"
        );
        // A thin torus has the largest bound, 350u; t is 1.4 or more there.
        let error = surface.error;
        assert!(
            error.min_element() >= 0.0 && f64::from(error.max_element()) < 168.0 * U * farthest
        );
    }
    assert!(hits > 150, "{hits}");
}

#[test]
fn the_surface_of_a_hit_is_on_the_ray_and_has_a_unit_normal() {
    surfaces_are_on_the_ray::<Sphere>(1);
    surfaces_are_on_the_ray::<Plane>(2);
    surfaces_are_on_the_ray::<Disk>(3);
    surfaces_are_on_the_ray::<Rectangle>(4);
    surfaces_are_on_the_ray::<Cuboid>(5);
    surfaces_are_on_the_ray::<Cylinder>(6);
    surfaces_are_on_the_ray::<Cone>(7);
    surfaces_are_on_the_ray::<Quadric>(8);
    surfaces_are_on_the_ray::<Torus>(9);
    surfaces_are_on_the_ray::<AxisBox>(10);
    surfaces_are_on_the_ray::<AxisPlane>(11);
}

/// The normal of a closed shape faces a ray that comes from outside.
#[test]
fn normals_of_closed_shapes_face_outwards() {
    fn check<S: Sample>(is_closed: fn(&S) -> bool) {
        let mut random = Random::new(3);
        for _ in 0..2000 {
            let shape = S::sample(&mut random, Vec3::ZERO, 1.0);
            let ray = ray_near(&mut random, Vec3::ZERO, 1.0, 8.0);
            let hit = S::kernel_of(Tier::Exact).intersect(&ray, shape.clone());
            if let Some(hit) = hit.filter(|_| is_closed(&shape)) {
                let surface = shape.surface(&ray, &hit);
                // t is at most 12 and rounded by up to 12u, which turns the normal of the thinnest tube, of radius 0.03,
                // by 12u/0.03. Close to a cone's apex it may turn more, but no ray of this seed comes so close.
                let towards = surface.normal.dot(ray.dir.as_dvec3());
                assert!(
                    towards < 12.0 * U / 0.03,
                    "{shape:?} {ray:?} {hit:?}: {towards}"
                );
            }
        }
    }
    check::<Sphere>(|_| true);
    check::<Torus>(|_| true);
    check::<Cuboid>(|_| true);
    check::<AxisBox>(|_| true);
    check::<Cylinder>(|cylinder| cylinder.is_capped);
    check::<Cone>(|cone| cone.is_capped);
}

/// The parameters have names, and the equations along a ray have the crossings as their roots.
fn describes_itself<S: Sample>(seed: u64) {
    let name = S::INFO.name;
    let width: usize = S::INFO.parameters.iter().map(|p| p.width()).sum();
    assert_eq!(width, S::NUMBERS, "{name}");
    let mut random = Random::new(seed);
    let mut hits = 0;
    for _ in 0..200 {
        let shape = S::sample(&mut random, Vec3::ZERO, 1.0);
        let ray = ray_near(&mut random, Vec3::ZERO, 1.0, 3.0);
        let equations = equations_along(&ray, &shape);
        assert!(!equations.is_empty(), "{name}");
        for equation in &equations {
            assert!(
                usize::from(equation.part) < S::INFO.equations.len(),
                "{name}"
            );
        }
        let roots = equations.iter().flat_map(|equation| &equation.roots);
        let ahead = roots.filter(|root| root.is_on_shape && root.t > 0.0);
        let first = ahead.map(|root| root.t).reduce(f64::min);
        let exact = exact_answer(&ray, &shape).map(|[t, ..]| t);
        assert_eq!(first, exact, "{name} {shape:?} {ray:?}");
        hits += u32::from(exact.is_some());
    }
    assert!(hits > 10, "{name}: {hits}");
}

#[test]
fn every_shape_has_named_parameters_and_equations_whose_roots_are_its_crossings() {
    describes_itself::<Sphere>(1);
    describes_itself::<Plane>(2);
    describes_itself::<Disk>(3);
    describes_itself::<Rectangle>(4);
    describes_itself::<Cuboid>(5);
    describes_itself::<Cylinder>(6);
    describes_itself::<Cone>(7);
    describes_itself::<Torus>(8);
    describes_itself::<Quadric>(9);
    describes_itself::<AxisBox>(10);
    describes_itself::<AxisPlane>(11);
}

#[test]
fn the_equation_of_a_sphere_has_the_textbooks_coefficients() {
    let sphere = Sphere {
        centre: Vec3::new(1.0, 2.0, 3.0),
        radius: 2.0,
    };
    let equations = equations_along(&ray([1.0, 2.0, -4.0], [0.0, 0.0, 1.0]), &sphere);
    let [equation] = &equations[..] else {
        panic!("{equations:?}")
    };
    // f = (0, 0, −7): f·f − r², 2 f·d, d·d.
    assert_eq!(equation.coefficients, [45.0, -14.0, 1.0]);
    let roots: Vec<f64> = equation.roots.iter().map(|root| root.t).collect();
    assert_eq!(roots, [5.0, 9.0]);
}

/// A ray in the plane of a face meets the faces beside it, whichever face it is and whatever the sign of its zero.
#[test]
fn slabs_hit_a_box_along_each_of_its_faces() {
    let aligned = AxisBox {
        min: Vec3::NEG_ONE,
        max: Vec3::ONE,
    };
    let cuboid = Cuboid {
        centre: Vec3::ZERO,
        axes: [Vec3::X, Vec3::Y, Vec3::Z],
    };
    for side in [-1.0, 1.0] {
        for zero in [0.0, -0.0] {
            let (origin, dir) = (Vec3::new(-3.0, side, 0.25), Vec3::new(1.0, zero, zero));
            let ray = Ray::new(origin, dir).expect("a ray");
            for row in AxisBox::kernels() {
                let hit = row.intersect(&ray, aligned).map(|hit| hit.t);
                assert_eq!(hit, Some(2.0), "{} {side} {zero}", row.info.name);
            }
            for row in Cuboid::kernels() {
                let hit = row.intersect(&ray, cuboid).map(|hit| hit.t);
                assert_eq!(hit, Some(2.0), "{} {side} {zero}", row.info.name);
            }
        }
    }
}
