//! Time per ray. `cargo test --release -p hitscope-core --lib algebra::tests::speed -- --ignored --nocapture`

use super::super::crossing::CrossingSolver;
use super::super::pieces::Pieces;
use super::shapes::{Cylinder, Sphere, Torus};
use crate::random::Random;
use crate::ray::Ray;
use cpu_time::ThreadTime;
use glam::Vec3;
use std::hint::black_box;

/// Prints the median over 11 rounds of the CPU time per ray, in intervals and in exact numbers.
fn measure(name: &str, shape: &impl Pieces, rays: &[Ray]) {
    let median = |rays: &[Ray], f: &dyn Fn(&Ray) -> usize| {
        let mut times = [0.0; 11].map(|_: f64| {
            let start = ThreadTime::now();
            black_box(rays.iter().map(f).sum::<usize>());
            start.elapsed().as_secs_f64() * 1e9 / rays.len() as f64
        });
        times.sort_by(f64::total_cmp);
        times[5]
    };
    let fast = median(rays, &|ray| CrossingSolver::new(ray).crossings(shape).len());
    let some = &rays[..rays.len() / 20];
    let exact = median(some, &|ray| {
        CrossingSolver::new(ray).exact_crossings(shape).len()
    });
    eprintln!("{name}: {fast:.0} ns with intervals, {exact:.0} ns exact, per ray");
}

#[test]
#[ignore = "prints times"]
fn time_per_ray() {
    let sphere = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0,
    };
    let torus = Torus {
        centre: Vec3::ZERO,
        axis: Vec3::new(0.1, 0.2, 1.0),
        major: 1.0,
        minor: 0.25,
    };
    let cylinder = Cylinder {
        base: Vec3::NEG_Z,
        axis: Vec3::new(0.1, 0.2, 2.0),
        radius: 0.5,
    };
    let mut random = Random::new(1);
    let all: Vec<Ray> = (0..40_000)
        .map(|_| {
            let origin = random.in_cube() * 4.0;
            let target = random.in_cube();
            Ray::new(origin.as_vec3(), (target - origin).as_vec3()).expect("a ray")
        })
        .collect();
    let split = |shape: &dyn Fn(&Ray) -> bool| -> [Vec<Ray>; 2] {
        let (hits, misses) = all
            .iter()
            .copied()
            .partition::<Vec<Ray>, _>(|ray| shape(ray));
        [hits, misses]
    };
    let [hits, misses] = split(&|ray| !CrossingSolver::new(ray).crossings(&sphere).is_empty());
    measure("sphere, hits", &sphere, &hits);
    measure("sphere, misses", &sphere, &misses);
    let [hits, misses] = split(&|ray| !CrossingSolver::new(ray).crossings(&cylinder).is_empty());
    measure("cylinder, hits", &cylinder, &hits);
    measure("cylinder, misses", &cylinder, &misses);
    let [hits, misses] = split(&|ray| !CrossingSolver::new(ray).crossings(&torus).is_empty());
    measure("torus, hits", &torus, &hits);
    measure("torus, misses", &torus, &misses);
}
