//! A diffuse surface with reflectance 1 under an emitter of radiance 1 reflects the radiance F, its form factor.
//!
//! Source: J. R. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors".

use super::{Estimate, lit, path_count};
use glam::{DVec3, Vec3};
use hitscope_core::integrator::integrator;
use hitscope_core::mesh::shapes::soup;
use hitscope_core::mesh::{Assigned, Attributes, Material, Runs};
use hitscope_core::progress::Progress;
use hitscope_core::scene::{SceneOptions, scene};
use hitscope_core::shape::{Rectangle, Span};
use hitscope_core::{Ray, Scene, TriangleMesh};

/// The corner at the origin and two edges of a square.
type Square = [Vec3; 3];

const FLOOR: Square = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// Above the floor, facing down.
const CEILING: Square = [Vec3::Z, Vec3::Y, Vec3::X];
/// At the floor's edge along y, facing it.
const WALL: Square = [Vec3::ZERO, Vec3::Y, Vec3::Z];

/// A white floor that emits nothing, and a black square that emits on its front.
fn materials() -> Attributes {
    let white = Material {
        diffuse: Some(Vec3::ONE),
        ..Material::default()
    };
    let lamp = Material {
        diffuse: Some(Vec3::ZERO),
        emission: Vec3::ONE,
        emits_on_back: false,
        ..Material::default()
    };
    let mut runs = Runs::default();
    runs.begin(2, 1);
    Attributes {
        materials: Assigned::new(vec![white, lamp], runs),
        ..Attributes::default()
    }
}

/// The floor and a lamp, of triangles or of rectangles.
fn scenes(lamp: Square) -> [Scene; 2] {
    let triangles = |[corner, a, b]: Square| {
        [
            [corner, corner + a, corner + a + b],
            [corner, corner + a + b, corner + b],
        ]
    };
    let corners = [triangles(FLOOR), triangles(lamp)].concat();
    let of_triangles = scene(soup(&corners).with_attributes(materials()));
    let rectangle = |[corner, a, b]: Square| {
        Rectangle(Span {
            centre: corner + 0.5 * (a + b),
            u: 0.5 * a,
            v: 0.5 * b,
        })
    };
    let mut of_rectangles = scene(TriangleMesh::default().with_attributes(materials()));
    let mut runs = Runs::default();
    runs.begin(1, 1);
    let both = vec![rectangle(FLOOR), rectangle(lamp)];
    let (options, progress) = (SceneOptions::default(), Progress::default());
    let added = of_rectangles.add_group(both, runs, options, &progress);
    added.expect("nobody cancels");
    [of_triangles, of_rectangles]
}

/// The mean radiance of the floor, over all its points or at its corner.
fn of_floor(context: &hitscope_core::integrator::Context, is_corner: bool) -> Estimate {
    let view = integrator("path").expect("a view");
    Estimate::of(path_count(), |sampler| {
        let at = sampler.next_2d();
        let target = if is_corner {
            Vec3::splat(1e-6)
        } else {
            at.extend(0.0)
        };
        let origin = target.as_dvec3() + DVec3::new(0.0, 0.0, 0.01);
        let ray = Ray::new(origin.as_vec3(), Vec3::NEG_Z).expect("a ray");
        let hit = context.intersector.closest_hit(&ray);
        view.radiance(context, &ray, hit, sampler).y.into()
    })
}

#[test]
fn a_square_under_a_parallel_one_receives_its_form_factor() {
    for scene in scenes(CEILING) {
        of_floor(&lit(scene, Vec::new()), false).require(0.199_824_90);
    }
}

#[test]
fn a_square_beside_a_perpendicular_one_receives_its_form_factor() {
    for scene in scenes(WALL) {
        of_floor(&lit(scene, Vec::new()), false).require(0.200_043_78);
    }
}

#[test]
fn a_point_under_the_corner_of_a_square_receives_its_form_factor() {
    for scene in scenes(CEILING) {
        of_floor(&lit(scene, Vec::new()), true).require(0.138_531_61);
    }
}
