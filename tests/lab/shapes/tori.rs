//! Tori that are thin or far away.

use super::{ray_count, sum_over};
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::kernel::{KernelTable as _, Tier};
use hitscope_core::random::Random;
use hitscope_core::shape::Torus;
use hitscope_lab::oracle::{ExactT, Oracle as _};

/// A ray from a distance at the tube: at a point within 1.2 minor radii of the circle.
fn aimed(random: &mut Random, distance: f64, minor: f64) -> Ray {
    let around = DVec3::from((random.direction().truncate().normalize(), 0.0));
    let target = around + 1.2 * minor * random.in_cube();
    let origin = (target + distance * random.direction()).as_vec3();
    let dir = (target - origin.as_dvec3()).normalize().as_vec3();
    Ray::new(origin, dir).expect("a ray")
}

#[test]
fn thin_and_distant_tori_are_decided_rightly_by_the_exact_and_the_moved_quartic() {
    for (k, (minor, distance)) in [0.25f32, 0.01]
        .into_iter()
        .flat_map(|minor| [3.0, 30.0, 300.0, 3000.0].map(|distance| (minor, distance)))
        .enumerate()
    {
        let torus = Torus {
            centre: Vec3::ZERO,
            axis: Vec3::Z,
            major: 1.0,
            minor,
        };
        let n = ray_count();
        // Wrong decisions of each kernel.
        let wrong: Vec<std::sync::atomic::AtomicU64> =
            Torus::kernels().iter().map(|_| 0.into()).collect();
        let hits = sum_over(n, |number| {
            let mut random = Random::new(number << 8 | k as u64);
            let ray = aimed(&mut random, distance, minor.into());
            let t = torus.crossings(&ray).first_mut().map(ExactT::to_f32);
            for (kernel, wrong) in Torus::kernels().iter().zip(&wrong) {
                let found = kernel.intersect(&ray, torus).map(|hit| hit.t);
                if found.is_some() != t.is_some() {
                    wrong.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                }
                if kernel.info.tier == Some(Tier::Exact) {
                    assert_eq!(found, t, "{torus:?} {ray:?}");
                }
            }
            u64::from(t.is_some())
        });
        for (kernel, wrong) in Torus::kernels().iter().zip(wrong) {
            let (name, wrong) = (kernel.info.name, wrong.into_inner());
            eprintln!("r = {minor}, D = {distance}: {name} {wrong} wrong of {n}, {hits} hits");
            let is_right = matches!(kernel.info.tier, Some(Tier::Precise | Tier::Exact));
            assert!(
                wrong == 0 || !is_right,
                "{name} r = {minor}, D = {distance}: {wrong}"
            );
        }
        assert!(hits > n / 4, "{hits}");
    }
}
