//! Microbenchmarks of the core: `cargo bench -p hitscope-core`; `-- NAME` runs those whose name contains
//! NAME.
//!
//! For judging a change of one part on one machine. `hitscope bench` compares kernels on whole scenes.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::Vec3;
use hitscope_core::bvh::Bvh;
use hitscope_core::intersector::Intersector;
use hitscope_core::kernel::{TriangleKernel, triangle_kernel};
use hitscope_core::mesh::TriangleMesh;
use hitscope_core::mesh::shapes::{Placement, soup, torus};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::shape::bounds_in;
use hitscope_core::{Hit, Ray, Scene};
use std::sync::LazyLock;

/// The tiers, and the lecture's methods with Baldwin–Weber.
const KERNELS: [&str; 8] = [
    "fast",
    "watertight",
    "precise",
    "exact",
    "plane-projection",
    "parametric",
    "edge-planes",
    "baldwin-weber",
];

/// Rays per batch: together with the data they touch, more than the caches hold.
const RAYS: usize = 16 * 1024;

/// 2·400·250 triangles.
static TORUS: LazyLock<Scene> = LazyLock::new(|| scene(torus(400, 250, Placement::UNIT)));

fn main() {
    divan::main();
}

fn kernel(name: &str) -> &'static TriangleKernel {
    triangle_kernel(name).expect("in the table")
}

/// Rays from one point, in squares of 4 × 4, like a camera's.
fn coherent() -> Vec<Ray> {
    let eye = Vec3::new(0.3, 1.2, 2.8);
    let ray = |i: usize| {
        let (square, within) = (i / 16, i % 16);
        let x = 4 * (square % 32) + within % 4;
        let y = 4 * (square / 32) + within / 4;
        let target = Vec3::new(x as f32 / 64.0 - 1.0, y as f32 / 64.0 - 1.0, 0.0);
        Ray::new(eye, target - eye).expect("a ray")
    };
    (0..RAYS).map(ray).collect()
}

/// Rays between random points around the mesh.
fn random() -> Vec<Ray> {
    let mut random = Random::new(1);
    let mut point = || 1.5 * random.direction().as_vec3();
    let rays = std::iter::repeat_with(|| {
        let (from, to) = (point(), point());
        Ray::new(from, to - from).ok()
    });
    rays.flatten().take(RAYS).collect()
}

fn trace(
    bencher: Bencher<'_, '_>,
    name: &str,
    rays: &[Ray],
    ask: impl Fn(&dyn Intersector, &[Ray], &mut [Option<Hit>]) + Sync,
) {
    let intersector = TORUS.intersector(kernel(name));
    let mut hits = vec![None; rays.len()];
    bencher
        .counter(ItemsCount::new(rays.len()))
        .bench_local(|| {
            ask(&*intersector, black_box(rays), &mut hits);
            black_box(hits[0])
        });
}

/// Closest hits of camera rays, in packets.
#[divan::bench(args = KERNELS)]
fn trace_coherent(bencher: Bencher<'_, '_>, name: &str) {
    trace(bencher, name, &coherent(), |x, rays, hits| {
        x.coherent_hits(rays, hits);
    });
}

/// The same, ray by ray.
#[divan::bench(args = KERNELS)]
fn trace_coherent_singly(bencher: Bencher<'_, '_>, name: &str) {
    trace(bencher, name, &coherent(), |x, rays, hits| {
        x.closest_hits(rays, hits);
    });
}

/// Closest hits of incoherent rays.
#[divan::bench(args = KERNELS)]
fn trace_random(bencher: Bencher<'_, '_>, name: &str) {
    trace(bencher, name, &random(), |x, rays, hits| {
        x.closest_hits(rays, hits);
    });
}

/// Any-hit queries.
#[divan::bench(args = KERNELS)]
fn trace_any(bencher: Bencher<'_, '_>, name: &str) {
    any(bencher, name, &random(), |x, rays, are_hits| {
        x.any_hits(rays, are_hits);
    });
}

/// Any-hit queries of camera rays, in packets.
#[divan::bench(args = KERNELS)]
fn trace_any_coherent(bencher: Bencher<'_, '_>, name: &str) {
    any(bencher, name, &coherent(), |x, rays, are_hits| {
        x.coherent_any_hits(rays, are_hits);
    });
}

fn any(
    bencher: Bencher<'_, '_>,
    name: &str,
    rays: &[Ray],
    ask: impl Fn(&dyn Intersector, &[Ray], &mut [bool]) + Sync,
) {
    let intersector = TORUS.intersector(kernel(name));
    let mut are_hits = vec![false; rays.len()];
    bencher
        .counter(ItemsCount::new(rays.len()))
        .bench_local(|| {
            ask(&*intersector, black_box(rays), &mut are_hits);
            black_box(are_hits[0])
        });
}

/// A kernel's triangle test without a tree: triangles per second.
#[divan::bench(args = KERNELS)]
fn test_triangles(bencher: Bencher<'_, '_>, name: &str) {
    let mut random = Random::new(2);
    let mut corner = || random.in_cube_f32();
    let corners: Vec<[Vec3; 3]> = (0..1024).map(|_| [corner(), corner(), corner()]).collect();
    let intersector = scene(soup(&corners)).intersector(kernel(name));
    let ray = Ray::new(Vec3::new(0.1, 0.2, 3.0), -Vec3::Z).expect("a ray");
    bencher
        .counter(ItemsCount::new(corners.len()))
        .bench_local(|| intersector.count_hits(black_box(&ray)));
}

/// High-quality tree construction on all cores: triangles per second.
#[divan::bench]
fn build(bencher: Bencher<'_, '_>) {
    build_with(bencher, |mesh| {
        Bvh::build(mesh.triangles().len(), &bounds_in(mesh), &|| Ok(()))
    });
}

/// Fast tree construction.
#[divan::bench]
fn build_quickly(bencher: Bencher<'_, '_>) {
    build_with(bencher, |mesh| {
        Bvh::build_quickly(mesh.triangles().len(), &bounds_in(mesh), &|| Ok(()))
    });
}

fn build_with<E>(bencher: Bencher<'_, '_>, build: impl Fn(&TriangleMesh) -> Result<Bvh, E>) {
    let mesh = TORUS.mesh();
    bencher
        .counter(ItemsCount::new(mesh.triangles().len()))
        .bench_local(|| build(black_box(mesh)).is_ok());
}

/// Packing a mesh's triangles into a kernel's blocks.
#[divan::bench(args = KERNELS)]
fn pack(bencher: Bencher<'_, '_>, name: &str) {
    bencher
        .counter(ItemsCount::new(TORUS.mesh().triangles().len()))
        .bench_local(|| TORUS.intersector(kernel(name)));
}
