//! The tree with its SIMD lanes against testing every triangle on its own: bit-identical results.
//!
//! Rays at edges, corners and flat boxes are checked only for watertight kernels. Other kernels' errors in t
//! may exceed the padding of boxes, so that the tree misses such a hit.

use glam::Vec3;
use hitscope_core::intersector::Crossing;
use hitscope_core::kernel::{Precision, TRIANGLE_KERNELS, TriangleKernel};
use hitscope_core::mesh::shapes::{Placement, flat_grid, in_torus, soup, sphere, torus};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::{Hit, Intersector, Ray, Scene};

/// A hit's bits, which distinguish −0 from 0 and compare NaN equal to itself.
fn bits(hit: Option<Hit>) -> Option<(u32, u32, u32, u32)> {
    hit.map(|h| (h.primitive, h.t.to_bits(), h.u.to_bits(), h.v.to_bits()))
}

/// Tests every triangle on its own in scalar arithmetic; sorted as `all_hits` promises.
fn one_by_one(kernel: &TriangleKernel, corners: &[[Vec3; 3]], ray: &Ray) -> Vec<Hit> {
    let asked = corners.iter().enumerate().filter_map(|(k, &corners)| {
        let hit = kernel.intersect(ray, corners)?;
        Some(Hit {
            primitive: k as u32,
            ..hit
        })
    });
    let mut hits: Vec<Hit> = asked.collect();
    hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.primitive.cmp(&b.primitive)));
    hits
}

/// Asserts that all queries agree with [`one_by_one`]. Returns whether the ray hits anything.
fn assert_same(
    kernel: &TriangleKernel,
    intersector: &dyn Intersector,
    corners: &[[Vec3; 3]],
    ray: &Ray,
) -> bool {
    let name = kernel.info.name;
    let mut expected = one_by_one(kernel, corners, ray);
    let all = intersector.all_hits(ray);
    let mut met: Vec<u32> = all.iter().flat_map(in_crossing).collect();
    if kernel.info.precision != Precision::F32 {
        // Sorted by a more accurate t than a hit's: hits of equal f32 t may be in either order.
        met.sort_unstable();
        expected.sort_by_key(|hit| hit.primitive);
        assert!(
            all.is_sorted_by_key(|crossing| crossing.hit.t),
            "{name} {ray:?}"
        );
    }
    let primitives: Vec<u32> = expected.iter().map(|hit| hit.primitive).collect();
    assert_eq!(met, primitives, "{name} {ray:?}");
    for crossing in &all {
        let alone = expected
            .iter()
            .find(|hit| hit.primitive == crossing.hit.primitive);
        assert_eq!(
            bits(Some(crossing.hit)),
            bits(alone.copied()),
            "{name} {ray:?}"
        );
    }

    let closest = intersector.closest_hit(ray);
    let first = all.first().map(|crossing| crossing.hit);
    assert_eq!(bits(closest), bits(first), "{name} {ray:?}");
    assert_eq!(
        intersector.any_hit(ray),
        closest.is_some(),
        "{name} {ray:?}"
    );
    closest.is_some()
}

/// The triangles of a crossing.
fn in_crossing(crossing: &Crossing) -> impl Iterator<Item = u32> {
    [crossing.hit.primitive]
        .into_iter()
        .chain(crossing.also.clone())
}

/// Kernels that a case applies to.
#[derive(Clone, Copy)]
enum Kernels {
    Every,
    Watertight,
}

impl Kernels {
    fn iter(self) -> impl Iterator<Item = &'static TriangleKernel> {
        let applies = move |kernel: &&TriangleKernel| match self {
            Self::Every => true,
            Self::Watertight => kernel.info.promises.is_watertight,
        };
        TRIANGLE_KERNELS.iter().filter(applies)
    }
}

/// Calls [`assert_same`] with many rays for each kernel, and asserts that enough of them hit.
fn assert_same_for_rays(
    kernels: Kernels,
    scene: &Scene,
    count: usize,
    mut next_ray: impl FnMut() -> Option<Ray>,
) {
    let corners = scene.mesh().corner_list();
    for kernel in kernels.iter() {
        let intersector = scene.intersector(kernel);
        let mut hits = 0;
        for _ in 0..count {
            if let Some(ray) = next_ray() {
                hits += usize::from(assert_same(kernel, &*intersector, &corners, &ray));
            }
        }
        assert!(
            hits > count / 20,
            "{}: only {hits} of {count} hit",
            kernel.info.name
        );
    }
}

fn assert_closest_is_the_first(intersector: &dyn Intersector, ray: &Ray) {
    let closest = intersector.closest_hit(ray).map(|hit| hit.primitive);
    assert_eq!(closest, Some(0), "{}", intersector.kernel().name);
}

#[test]
fn simd_lanes_give_the_scalar_kernels_bits() {
    // One triangle per scene: the tree is a single box, and the block has one lane in use.
    let mut random = Random::new(2);
    for kernel in TRIANGLE_KERNELS.iter() {
        let mut hits = 0;
        for _ in 0..10_000 {
            let corners = [(); 3].map(|()| random.in_cube_f32());
            let intersector = scene(soup(&[corners])).intersector(kernel);
            for _ in 0..2 {
                let origin = random.in_cube_f32() * 3.0;
                let [a, b, c] = corners;
                let target = (a + b + c) / 3.0 + 0.4 * random.in_cube_f32();
                let ray = Ray::new(origin, target - origin).expect("a ray");
                let (lane, scalar) = (
                    intersector.closest_hit(&ray),
                    kernel.intersect(&ray, corners),
                );
                assert_eq!(
                    bits(lane),
                    bits(scalar),
                    "{} {ray:?} {corners:?}",
                    kernel.info.name
                );
                hits += usize::from(scalar.is_some());
            }
        }
        assert!(hits > 3000, "{hits}");
    }
}

#[test]
fn the_tree_finds_the_same_hits_as_testing_every_triangle() {
    let mut random = Random::new(3);
    for place in [
        Placement::UNIT,
        Placement::new(1e-6, 10.0),
        Placement::new(1e6, 1000.0),
    ] {
        for mesh in [torus(24, 12, place), sphere(7, place)] {
            let scene = scene(mesh);
            assert_same_for_rays(Kernels::Every, &scene, 2500, || {
                let origin = place.of(2.0 * random.in_cube());
                let target = place.of(0.8 * random.in_cube());
                Ray::new(origin, target - origin).ok()
            });
        }
    }
}

#[test]
fn the_tree_finds_the_same_hits_as_testing_every_triangle_at_edges_and_corners() {
    let mut random = Random::new(4);
    let place = Placement::new(1.0, 3.0);
    let scene = scene(torus(16, 8, place));
    let corners = scene.mesh().corner_list();
    assert_same_for_rays(Kernels::Watertight, &scene, 8000, || {
        let [a, b, _] = corners[random.index(corners.len())];
        let target = a + (b - a) * [0.0, 0.25, random.unit() as f32][random.index(3)];
        let origin = place.of(3.0 * random.in_cube());
        Ray::new(origin, target - origin).ok()
    });
}

#[test]
fn the_tree_finds_the_same_hits_as_testing_every_triangle_within_an_interval() {
    let mut random = Random::new(5);
    let scene = scene(torus(24, 12, Placement::UNIT));
    assert_same_for_rays(Kernels::Every, &scene, 4000, || {
        let origin = in_torus(random.unit(), random.unit(), 0.3).as_vec3();
        let dir = random.in_cube_f32();
        let [a, b] = [random.signed() as f32, 2.0 * random.signed() as f32];
        Ray::with_interval(origin, dir, a, b).ok()
    });
}

#[test]
fn an_interval_that_ends_at_a_hit_excludes_it() {
    let mut random = Random::new(12);
    let scene = scene(sphere(6, Placement::UNIT));
    // Kernels that decide with more digits than they report compare t before rounding it.
    let as_reported = |kernel: &&TriangleKernel| {
        kernel.info.precision == Precision::F32 && !kernel.info.promises.is_watertight
    };
    for kernel in TRIANGLE_KERNELS.iter().filter(as_reported) {
        let intersector = scene.intersector(kernel);
        for _ in 0..500 {
            let (origin, dir) = (0.3 * random.in_cube_f32(), random.in_cube_f32());
            let whole = Ray::new(origin, dir).expect("a ray");
            let t = intersector.closest_hit(&whole).expect("from inside").t;
            let hit_in = |t_min, t_max| {
                let ray = Ray::with_interval(origin, dir, t_min, t_max).expect("a ray");
                let closest = intersector.closest_hit(&ray).map(|hit| hit.t);
                assert_eq!(intersector.any_hit(&ray), closest.is_some());
                assert_eq!(intersector.all_hits(&ray).first().map(|c| c.hit.t), closest);
                closest
            };
            assert_eq!(hit_in(0.0, t), None);
            assert_eq!(hit_in(0.0, t.next_up()), Some(t));
            assert_eq!(hit_in(t.next_down(), t.next_up()), Some(t));
        }
    }
}

#[test]
fn a_flat_grid_behind_the_origin_is_hit_within_an_interval_of_negative_t() {
    // Flat boxes: only their padding keeps rays that are aimed at their border.
    let mut random = Random::new(6);
    let grid = flat_grid(8, Placement::new(0.25, 0.1));
    let scene = scene(grid);
    let corners = scene.mesh().corner_list();
    assert_same_for_rays(Kernels::Watertight, &scene, 8000, || {
        let target = corners[random.index(corners.len())][random.index(3)];
        let dir = random.in_cube_f32();
        Ray::with_interval(target + dir, dir, -10.0, 10.0).ok()
    });
}

#[test]
fn at_equal_t_the_lowest_triangle_is_hit() {
    let mut random = Random::new(7);
    let corners = [
        Vec3::new(-1.0, -1.0, 0.0),
        Vec3::new(1.0, -0.875, 0.0),
        Vec3::new(0.125, 1.0, 0.0),
    ];
    // Copies of one triangle: every leaf contains hits at the same t.
    let copies = scene(soup(&[corners; 40]));
    assert_eq!(copies.mesh().triangles().len(), 40);
    assert_same_for_rays(Kernels::Every, &copies, 8000, || {
        let target = 0.4 * random.in_cube_f32() * Vec3::new(1.0, 1.0, 0.0);
        let origin = 3.0 * random.in_cube_f32();
        Ray::new(origin, target - origin).ok()
    });
    for kernel in TRIANGLE_KERNELS.iter() {
        let ray = Ray::new(Vec3::new(0.0, 0.0, 3.0), Vec3::NEG_Z).expect("a ray");
        assert_closest_is_the_first(&*copies.intersector(kernel), &ray);
    }
}

#[test]
fn at_equal_t_the_lowest_of_overlapping_coplanar_triangles_is_hit() {
    let mut random = Random::new(8);
    // Coplanar, of different sizes and positions, so that they are in different leaves.
    let on_plane = |p: Vec3| Vec3::new(p.x, p.y, 0.375);
    let triangles: Vec<[Vec3; 3]> = (0..60)
        .map(|_| [(); 3].map(|()| on_plane(random.in_cube_f32())))
        .collect();
    let scene = scene(soup(&triangles));
    assert_same_for_rays(Kernels::Watertight, &scene, 20_000, || {
        let target = on_plane(0.5 * random.in_cube_f32());
        let origin = 3.0 * random.in_cube_f32();
        Ray::new(origin, target - origin).ok()
    });
}

#[test]
fn at_equal_negative_t_the_lowest_triangle_is_hit() {
    let corners = [
        Vec3::new(-1.0, -1.0, 0.0),
        Vec3::new(1.0, -1.0, 0.0),
        Vec3::new(0.0, 1.0, 0.0),
    ];
    let copies = scene(soup(&[corners; 40]));
    for kernel in TRIANGLE_KERNELS.iter() {
        let (origin, dir) = (Vec3::new(0.0, 0.0, 3.0), Vec3::Z);
        let ray = Ray::with_interval(origin, dir, -10.0, 10.0).expect("a ray");
        let intersector = copies.intersector(kernel);
        let all = intersector.all_hits(&ray);
        assert_eq!(all.len(), 1, "{}", kernel.info.name);
        assert_eq!(all[0].also.len(), 39, "{}", kernel.info.name);
        assert_closest_is_the_first(&*intersector, &ray);
    }
}

#[test]
fn a_hit_whose_t_rounds_to_before_its_box_is_found() {
    // A plane perpendicular to an axis: the kernel's t errs by more half-ulps than the box's.
    let mut random = Random::new(9);
    let mut corner = || random.in_cube_f32().with_z(0.375);
    let triangles: Vec<[Vec3; 3]> = (0..60).map(|_| [(); 3].map(|()| corner())).collect();
    let scene = scene(soup(&triangles));
    let origin = Vec3::new(-0.274_436_77, 0.293_592_54, 0.288_934_6);
    let dir = Vec3::new(0.088_818_06, -0.016_551_644, 0.086_065_41);
    assert_same_for_rays(Kernels::Watertight, &scene, 1, || {
        Ray::new(origin, dir).ok()
    });
}

#[test]
fn candidates_include_every_triangle_that_is_hit() {
    let mut random = Random::new(9);
    let scene = scene(torus(24, 12, Placement::UNIT));
    let corners = scene.mesh().corner_list();
    for kernel in TRIANGLE_KERNELS.iter() {
        let intersector = scene.intersector(kernel);
        let (mut hits, mut candidates) = (0, 0);
        for _ in 0..3000 {
            let origin = 2.0 * random.in_cube_f32();
            let ray = Ray::new(origin, random.in_cube_f32() - origin).expect("a ray");
            let found = intersector.candidates(&ray);
            for hit in one_by_one(kernel, &corners, &ray) {
                assert!(
                    found.contains(&hit.primitive),
                    "{} {ray:?}",
                    kernel.info.name
                );
                hits += 1;
            }
            candidates += found.len();
        }
        // Fewer than all triangles: the tree excluded most.
        assert!(
            hits > 1000 && candidates < 3000 * corners.len() / 4,
            "{hits} {candidates}"
        );
    }
}

#[test]
fn counting_the_cost_does_not_change_hits() {
    let mut random = Random::new(10);
    let scene = scene(sphere(8, Placement::UNIT));
    for kernel in TRIANGLE_KERNELS.iter() {
        let intersector = scene.intersector(kernel);
        for _ in 0..3000 {
            let origin = 2.0 * random.in_cube_f32();
            let ray = Ray::new(origin, random.in_cube_f32() - origin).expect("a ray");
            let (hit, cost) = intersector.closest_hit_with_cost(&ray);
            assert_eq!(bits(hit), bits(intersector.closest_hit(&ray)));
            assert!(
                cost.boxes > 0 && (hit.is_none() || cost.primitives > 0),
                "{cost:?}"
            );
        }
    }
}
