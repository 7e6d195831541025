//! Decisions and t of the exact kernel of each shape against the oracle.

use super::{ray_count, sum_over};
use hitscope_core::Ray;
use hitscope_core::kernel::{Tier, exact_answer};
use hitscope_core::random::Random;
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Sphere, Torus,
    Triangle,
};
use hitscope_lab::measure::shapes::{Aim, Sampled, aimed};
use hitscope_lab::oracle::ExactT;

/// Targets and distances of rays, in sizes.
const KINDS: [(Aim, f64); 11] = [
    (Aim::Around, 3.0),
    (Aim::Around, 1e3),
    (Aim::Around, 1e6),
    (Aim::Silhouette, 3.0),
    (Aim::Silhouette, 1e3),
    (Aim::Silhouette, 1e6),
    (Aim::Edges, 3.0),
    (Aim::Edges, 1e3),
    (Aim::Edges, 1e6),
    (Aim::Axes, 3.0),
    (Aim::FromInside, 0.0),
];

/// Whether hit or miss, t in f32 and t in f64 are those of the oracle, also for the second crossing.
fn check<S: Sampled>(ray: &Ray, shape: &S) -> bool {
    let exact = S::kernel_of(Tier::Exact);
    let mut expected = shape.crossings(ray);
    let Some(first) = expected.first_mut() else {
        let found = exact.intersect(ray, shape.clone());
        assert_eq!(found, None, "{shape:?} {ray:?}");
        return false;
    };
    let (t_f32, t_f64) = (first.to_f32(), first.to_f64());
    if t_f32 >= f32::MAX {
        return true;
    }
    let found = exact.intersect(ray, shape.clone()).map(|hit| hit.t);
    assert_eq!(found, Some(t_f32), "{shape:?} {ray:?} {t_f64:e}");
    let in_f64 = exact_answer(ray, shape).map(|answer| answer[0]);
    if S::INFO.name == "triangle" {
        let error = in_f64.map(|t| (t - t_f64).abs() / t_f64);
        assert!(error <= Some(2f64.powi(-32)), "{shape:?} {ray:?}");
    } else {
        assert_eq!(in_f64, Some(t_f64), "{shape:?} {ray:?}");
    }
    // A ray that begins between the first two crossings finds the second.
    if let Some(second) = expected.get_mut(1) {
        let (t_min, second) = ((0.5 * (t_f64 + second.to_f64())) as f32, second);
        if t_f64 < f64::from(t_min) && f64::from(t_min) < second.to_f64() {
            let later = Ray { t_min, ..*ray };
            let found = exact.intersect(&later, shape.clone()).map(|hit| hit.t);
            assert_eq!(found, Some(ExactT::to_f32(second)), "{shape:?} {later:?}");
        }
    }
    true
}

fn kernel_and_oracle_agree<S: Sampled>() {
    for (k, (aim, distance)) in KINDS.into_iter().enumerate() {
        if aim == Aim::Edges && !S::HAS_EDGES {
            continue;
        }
        let n = ray_count();
        let hits = sum_over(n, |number| {
            let mut random = Random::new(number << 8 | k as u64);
            let (ray, shape) = aimed::<S>(&mut random, aim, distance);
            u64::from(check(&ray, &shape))
        });
        eprintln!(
            "{} {aim:?} from {distance}: {hits} hits of {n} rays, 0 wrong",
            S::INFO.name
        );
        let is_in_plane = S::MOST_CROSSINGS == 1 && aim == Aim::Silhouette;
        assert!(hits > n / 20 || is_in_plane, "{aim:?} {distance}: {hits}");
    }
}

macro_rules! shapes_agree {
    ($($test:ident: $shape:ty),*) => {
        $(#[test]
        fn $test() {
            kernel_and_oracle_agree::<$shape>();
        })*
    };
}

shapes_agree!(
    the_exact_kernel_and_the_oracle_agree_about_triangles: Triangle,
    the_exact_kernel_and_the_oracle_agree_about_spheres: Sphere,
    the_exact_kernel_and_the_oracle_agree_about_planes: Plane,
    the_exact_kernel_and_the_oracle_agree_about_disks: Disk,
    the_exact_kernel_and_the_oracle_agree_about_rectangles: Rectangle,
    the_exact_kernel_and_the_oracle_agree_about_boxes: Cuboid,
    the_exact_kernel_and_the_oracle_agree_about_aligned_planes: AxisPlane,
    the_exact_kernel_and_the_oracle_agree_about_aligned_boxes: AxisBox,
    the_exact_kernel_and_the_oracle_agree_about_cylinders: Cylinder,
    the_exact_kernel_and_the_oracle_agree_about_cones: Cone,
    the_exact_kernel_and_the_oracle_agree_about_quadrics: Quadric,
    the_exact_kernel_and_the_oracle_agree_about_tori: Torus
);
