//! A ray spawned by the default policy starts above its surface and doesn't hit it again.

use glam::{DVec3, Vec3};
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel, exact_triangle_kernel};
use hitscope_core::mesh::shapes::soup;
use hitscope_core::mesh::unit_normal;
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::shape::{Shape as _, Triangle};
use hitscope_core::spawn::{Departure, default_spawn_policy};
use hitscope_core::{Hit, Ray};

/// Half an ulp of 1 in f32.
const U: f64 = 1.0 / (1 << 24) as f64;

fn watertight_kernels() -> impl Iterator<Item = &'static TriangleKernel> {
    TRIANGLE_KERNELS
        .iter()
        .filter(|kernel| kernel.info.promises.is_watertight)
}

/// The ray spawned where the exact kernel's ray from `origin` to `target` hits the triangle, and that hit.
fn leaving(corners: [Vec3; 3], origin: Vec3, target: Vec3, dir: Vec3) -> Option<(Ray, Hit)> {
    let arrived_by = Ray::new(origin, target - origin).ok()?;
    let hit = exact_triangle_kernel().intersect(&arrived_by, corners)?;
    let surface = Triangle(corners).surface(&arrived_by, &hit);
    let departure = Departure::of_triangle(&arrived_by, &hit, &surface, corners, dir);
    let ray = default_spawn_policy().spawn(&departure);
    Some((ray.expect("a finite place and direction"), hit))
}

#[test]
fn a_spawned_ray_misses_the_coplanar_neighbour_at_an_edge_with_zero_coordinates() {
    // Both lie in the plane x = y, and the spawned ray starts on their common edge, where x = y = 0.
    let left = [
        Vec3::splat(-1024.0),
        Vec3::ZERO,
        Vec3::new(0.0, 0.0, -1024.0),
    ];
    let neighbour = [
        Vec3::ZERO,
        Vec3::new(1024.0, 1024.0, 0.0),
        Vec3::new(0.0, 0.0, -1024.0),
    ];
    let target = Vec3::new(0.0, 0.0, -661.8242);
    let dir = Vec3::new(0.166_239_16, 0.166_241_72, 0.971_931_33);
    let (ray, hit) =
        leaving(left, Vec3::new(-8.0, 8.0, target.z), target, dir).expect("hit on the edge");
    assert_eq!(hit.barycentric()[0], 0.0);
    assert!(ray.origin.y > ray.origin.x, "not lifted: {}", ray.origin);
    let surface = scene(soup(&[left, neighbour]));
    for kernel in watertight_kernels() {
        let found = surface.intersector(kernel).closest_hit(&ray);
        assert_eq!(found, None, "{}", kernel.info.name);
    }
}

/// A triangle of integers times a power of two. Some coordinates are 0, often one in all three corners.
fn with_zeros(random: &mut Random) -> [Vec3; 3] {
    let zero_axis = random.index(4);
    let scale = 2f32.powi(random.index(41) as i32 - 20);
    [(); 3].map(|()| {
        Vec3::from_array(std::array::from_fn(|axis| {
            if axis == zero_axis || random.index(4) == 0 {
                0.0
            } else {
                (random.index(2049) as f32 - 1024.0) * scale
            }
        }))
    })
}

#[test]
fn the_spawned_origin_lies_above_the_computed_point_by_the_policys_derived_bound() {
    let mut random = Random::new(7);
    let mut count = 0;
    while count < 20_000 {
        let corners = if count % 2 == 0 {
            with_zeros(&mut random)
        } else {
            [(); 3].map(|()| random.in_cube_f32() + random.in_cube_f32() * 100.0)
        };
        let normal = unit_normal(corners);
        // In the interior, on an edge, or at a corner.
        let mut weights = [random.unit(), random.unit(), random.unit()];
        weights[random.index(3)] *= random.index(2) as f64;
        weights[random.index(3)] *= random.index(2) as f64;
        let sum: f64 = weights.iter().sum();
        if sum == 0.0 || normal == DVec3::ZERO {
            continue;
        }
        let [a, b, c] = corners;
        let hit = Hit {
            t: 1.0,
            u: (weights[1] / sum) as f32,
            v: (weights[2] / sum) as f32,
            primitive: 0,
        };
        let dir = random.direction().as_vec3();
        let side = if normal.dot(dir.as_dvec3()) < 0.0 {
            -normal
        } else {
            normal
        };
        let arrived_by = Ray::new(a + dir, -dir).expect("a ray");
        let surface = Triangle(corners).surface(&arrived_by, &hit);
        let departure = Departure::of_triangle(&arrived_by, &hit, &surface, corners, dir);
        let ray = default_spawn_policy().spawn(&departure).expect("a ray");
        let [l1, l2, l3] = hit.barycentric();
        let [a, b, c] = [l1 * a, l2 * b, l3 * c];
        let p = a + b + c;
        let size = a.abs() + b.abs() + c.abs();
        let extent = corners.map(|corner| (corner.as_dvec3() - p.as_dvec3()).abs());
        let extent = extent
            .map(DVec3::max_element)
            .into_iter()
            .fold(0.0, f64::max);
        let height = side.dot(ray.origin.as_dvec3() - p.as_dvec3());
        // Computing the lift takes about ten f32 operations, which change it by at most 10u of itself.
        let lift = 7.0 * U * (size.as_dvec3() + extent).dot(normal.abs());
        let least = lift * (1.0 - 10.0 * U);
        assert!(
            height >= least && least > 0.0,
            "{height:e} {least:e} {corners:?} {hit:?} {dir}"
        );
        // Each coordinate is then rounded and moved by three half-ulps in all.
        let ulps = ray.origin.as_dvec3().abs().max(p.as_dvec3().abs());
        let most = lift * (1.0 + 20.0 * U) + 3.0 * U * ulps.dot(normal.abs());
        assert!(
            height <= most,
            "{height:e} {most:e} {corners:?} {hit:?} {dir}"
        );
        count += 1;
    }
}

/// Two triangles in one plane, on either side of an edge that lies on a coordinate axis. In the plane two
/// coordinates are equal, or one is 0.
struct AroundAxis {
    axes: [usize; 3],
    /// The plane is y = slope·x, where z is the axis of the edge.
    slope: f32,
    triangles: [[Vec3; 3]; 2],
}

impl AroundAxis {
    fn new(random: &mut Random) -> Self {
        let axes = [[0, 1, 2], [1, 2, 0], [2, 0, 1]][random.index(3)];
        let slope = random.index(2) as f32;
        let step = 2f32.powi(random.index(21) as i32 - 20);
        let mut whole = || (1 + random.index(1024)) as f32 * step;
        let at = |x: f32, z: f32| turned(axes, [x, slope * x, z]);
        let (start, end) = (at(0.0, -whole()), at(0.0, whole()));
        let (right, left) = (at(whole(), whole()), at(-whole(), -whole()));
        Self {
            axes,
            slope,
            triangles: [[start, right, end], [end, left, start]],
        }
    }

    /// A direction in the plane plus `across` perpendicular to it.
    fn dir(&self, x: f32, z: f32, across: f32) -> Vec3 {
        let y = self.slope * x + across;
        turned(self.axes, [x - self.slope * across, y, z])
    }
}

/// The point with these coordinates along these axes.
fn turned(axes: [usize; 3], coordinates: [f32; 3]) -> Vec3 {
    let mut p = Vec3::ZERO;
    for (axis, coordinate) in axes.into_iter().zip(coordinates) {
        p[axis] = coordinate;
    }
    p
}

#[test]
fn nearly_coplanar_rays_spawned_at_an_edge_on_an_axis_do_not_hit_the_plane_again() {
    let mut random = Random::new(3);
    let mut count = 0;
    while count < 4000 {
        let plane = AroundAxis::new(&mut random);
        let surface = scene(soup(&plane.triangles));
        let intersectors: Vec<_> = watertight_kernels()
            .map(|kernel| surface.intersector(kernel))
            .collect();
        for _ in 0..20 {
            let [start, _, end] = plane.triangles[0];
            let target = start + (random.unit() as f32) * (end - start);
            let (along, x) = (random.signed() as f32, random.signed() as f32);
            let dir = plane.dir(x, along, 2f32.powi(-(random.index(25) as i32)));
            let from = target + plane.dir(0.0, 0.0, 64.0);
            let Some((ray, _)) = leaving(plane.triangles[0], from, target, dir) else {
                continue;
            };
            for intersector in &intersectors {
                let is_hit = intersector.any_hit(&ray);
                assert!(
                    !is_hit,
                    "{} {ray:?} {:?}",
                    intersector.kernel().name,
                    plane.triangles
                );
            }
            count += 1;
        }
    }
}
