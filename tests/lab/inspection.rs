//! Tests of inspections whose answers are known.

use glam::{DVec3, UVec2, Vec3};
use hitscope_core::camera::{Camera, Projection};
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::mesh::{Assigned, Attributes, Faces, Material, Runs};
use hitscope_core::progress::Progress;
use hitscope_core::scene::Shading;
use hitscope_core::{Scene, TriangleMesh};
use hitscope_lab::inspection::Inspection;

/// A square in the plane z = 0, of two triangles that share the diagonal from (0, 0) to (2, 2).
fn square() -> Scene {
    let corners = [[0, 0], [2, 0], [2, 2], [0, 2]].map(|[x, y]| Vec3::new(x as f32, y as f32, 0.0));
    let mesh = TriangleMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    let mut faces = Faces::default();
    faces.push(0, 0, 0b011);
    faces.push(1, 0, 0b110);
    let attributes = Attributes {
        faces,
        materials: Assigned::new(vec![Material::default()], Runs::default()),
        groups: Assigned::new(vec![String::new()], Runs::default()),
        ..Attributes::default()
    };
    Scene::new(mesh.with_attributes(attributes), &Progress::default()).expect("never cancelled")
}

fn inspect(at: DVec3) -> Inspection {
    let scene = square();
    let camera = Camera::look_at(
        at + 4.0 * DVec3::Z,
        at,
        DVec3::Y,
        Projection::Orthographic { height: 1.0 },
        UVec2::ONE,
    );
    let intersector = scene.intersector(&TRIANGLE_KERNELS[0]);
    Inspection::of_pixel(
        &scene,
        &*intersector,
        Shading::Flat,
        &camera.expect("good"),
        UVec2::ZERO,
    )
}

#[test]
fn barycentric_coordinates_are_in_the_order_of_the_corners() {
    let found = inspect(DVec3::new(1.5, 0.5, 0.0));
    let hit = found.hit.expect("inside");
    let triangle = hit.triangle.expect("a triangle");
    assert_eq!((triangle.index, hit.primitive, hit.t), (0, 0, 4.0));
    assert_eq!(triangle.barycentric, [0.25, 0.5, 0.25]);
    assert_eq!(hit.position, [1.5, 0.5, 0.0]);
    let exact = found.exact.expect("inside");
    assert!(exact.also.is_empty());
    let exact = exact.fractions.expect("a triangle");
    assert_eq!(exact.barycentric_fractions, ["1/4", "1/2", "1/4"]);
    assert!(!exact.is_on_boundary);
}

#[test]
fn the_formula_of_a_triangle_has_t_and_the_ratios_of_areas() {
    let found = inspect(DVec3::new(1.5, 0.5, 0.0));
    let lines = found.hit.expect("inside").formula;
    for line in [
        "n = (0, 0, 1)",
        "0 = p·n − D, D = A·n = 0",
        "t = (D − o·n) / (d·n) = (0 − 4) / (-1) = 4",
        "P = r(t) = (1.5, 0.5, 0)",
        "Δ(ABC) = 2",
        "λ1 = Δ(BCP) / Δ(ABC) = 0.5 / 2 = 0.25",
        "λ2 = Δ(CAP) / Δ(ABC) = 1 / 2 = 0.5",
        "λ3 = Δ(ABP) / Δ(ABC) = 0.5 / 2 = 0.25",
    ] {
        assert!(
            lines.iter().any(|found| found == line),
            "{line} in {lines:#?}"
        );
    }
    let crossing = &found.crossings[..];
    assert_eq!(
        (crossing.len(), crossing[0].primitive, crossing[0].t),
        (1, 0, 4.0)
    );
}

#[test]
fn a_hit_on_a_shared_edge_reports_the_lower_triangle_and_lists_the_other() {
    let found = inspect(DVec3::new(1.0, 1.0, 0.0));
    let exact = found.exact.expect("on the diagonal");
    assert_eq!((exact.primitive, exact.also), (0, vec![1]));
    assert!(exact.fractions.expect("a triangle").is_on_boundary);
    for kernel in found.kernels {
        assert_eq!(
            (kernel.triangle, kernel.t),
            (Some(0), Some(4.0)),
            "{}",
            kernel.name
        );
    }
}

#[test]
fn a_miss_has_a_row_for_every_kernel() {
    let found = inspect(DVec3::new(9.0, 9.0, 0.0));
    assert!(found.hit.is_none() && found.exact.is_none());
    assert_eq!(found.kernels.len(), TRIANGLE_KERNELS.len());
    assert!(found.kernels.iter().all(|row| !row.hit && row.t.is_none()));
}
