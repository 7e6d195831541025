//! Workloads for measuring speed: camera rays, bounce rays, random rays, and rays to a lamp.

use glam::{DVec3, UVec2, Vec2};
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::mesh::unit_normal;
use hitscope_core::random::Random;
use hitscope_core::{Camera, Intersector, Ray, Scene};

/// The rays of each workload, in the order of [`WORKLOADS`].
pub type Workloads = [Vec<Ray>; 3];

/// Names of the workloads.
pub const WORKLOADS: [&str; 3] = ["primary", "bounce", "random"];

/// Side length in pixels of the blocks of camera rays; a power of two.
const BLOCK_PX: u32 = 8;

/// Height of the origins of bounce rays above the surface, relative to the diagonal of the scene's box. It
/// exceeds every kernel's error, so that all kernels trace the same rays.
const LIFT: f64 = 1e-5;

/// The workloads of a scene: at most `count` camera rays, a bounce ray from each of their hits, and `count` random
/// rays.
pub fn workloads(scene: &Scene, camera: &Camera, count: usize, seed: u64) -> Workloads {
    let mut random = Random::new(seed);
    let intersector = scene.intersector(default_triangle_kernel());
    let primary = primary_rays(camera, count);
    let bounce = bounce_rays(scene, &*intersector, &primary, &mut random);
    let random = random_rays(scene, count, &mut random);
    [primary, bounce, random]
}

/// Camera rays through the centres of pixels, in rows of blocks and in Morton order within a block. If there are
/// more pixels than `count`, every k-th pixel in both directions.
fn primary_rays(camera: &Camera, count: usize) -> Vec<Ray> {
    let size = camera.resolution();
    let pixels = u64::from(size.x) * u64::from(size.y);
    let step = (pixels as f64 / count.max(1) as f64).sqrt().ceil().max(1.0) as u32;
    let size = (size / step).max(UVec2::ONE);
    let blocks = (size + (BLOCK_PX - 1)) / BLOCK_PX;
    let in_block = |block: u32| {
        let corner = UVec2::new(block % blocks.x, block / blocks.x) * BLOCK_PX;
        (0..BLOCK_PX * BLOCK_PX)
            .map(move |k| corner + UVec2::new(every_second(k), every_second(k >> 1)))
    };
    let pixels = (0..blocks.x * blocks.y).flat_map(in_block);
    let inside = pixels.filter(|p| p.x < size.x && p.y < size.y);
    inside
        .map(|p| camera.ray(p * step + step / 2, Vec2::splat(0.5)))
        .take(count)
        .collect()
}

/// Moves bits 0, 2, 4 … to bits 0, 1, 2 …: decodes one coordinate of a Morton code.
fn every_second(k: u32) -> u32 {
    k & 1 | (k >> 2 & 1) << 1 | (k >> 4 & 1) << 2
}

/// A ray from each hit, cosine-distributed about the normal that faces the camera ray.
fn bounce_rays(
    scene: &Scene,
    intersector: &dyn Intersector,
    arriving: &[Ray],
    random: &mut Random,
) -> Vec<Ray> {
    let lit = lit_points(scene, intersector, arriving).into_iter();
    let bounce = lit.filter_map(|(origin, facing)| {
        let dir = (facing + random.direction()).normalize_or(facing);
        Ray::new(origin.as_vec3(), dir.as_vec3()).ok()
    });
    bounce.collect()
}

/// The rays to a distant lamp behind the camera at its upper left, from the hits of camera rays that face the lamp, in
/// the order of the camera rays.
pub fn lamp_rays(scene: &Scene, camera: &Camera, arriving: &[Ray]) -> Vec<Ray> {
    let intersector = scene.intersector(default_triangle_kernel());
    let to_lamp = (camera.back() + camera.up() - camera.right()).normalize();
    let lit = lit_points(scene, &*intersector, arriving).into_iter();
    let rays = lit
        .filter(|(_, facing)| facing.dot(to_lamp) > 0.0)
        .filter_map(|(origin, _)| Ray::new(origin.as_vec3(), to_lamp.as_vec3()).ok());
    rays.collect()
}

/// A point a little above each hit, and the normal that faces the arriving ray.
fn lit_points(
    scene: &Scene,
    intersector: &dyn Intersector,
    arriving: &[Ray],
) -> Vec<(DVec3, DVec3)> {
    let mut hits = vec![None; arriving.len()];
    intersector.coherent_hits(arriving, &mut hits);
    let lift = LIFT * 2.0 * scene.bounds().radius();
    let lit = |(ray, hit): (&Ray, Option<hitscope_core::Hit>)| {
        let hit = hit?;
        if !scene.is_triangle(hit.primitive) {
            let surface = scene.surface(ray, &hit);
            let facing = -surface.facing_normal(ray.dir).as_dvec3();
            return Some((surface.position.as_dvec3() + lift * facing, facing));
        }
        let corners = scene.mesh().corners(hit.primitive);
        let normal = unit_normal(corners);
        let facing = if normal.dot(ray.dir.as_dvec3()) > 0.0 {
            -normal
        } else {
            normal
        };
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let (u, v) = (f64::from(hit.u), f64::from(hit.v));
        Some((a + u * (b - a) + v * (c - a) + lift * facing, facing))
    };
    arriving.iter().zip(hits).filter_map(lit).collect()
}

/// A ray from a sphere around the scene, whose radius is the diagonal of its box, through a point of the box.
fn random_rays(scene: &Scene, count: usize, random: &mut Random) -> Vec<Ray> {
    let bounds = scene.bounds();
    let centre = bounds.centre().as_dvec3();
    let (lower, extent) = (bounds.min.as_dvec3(), bounds.extent());
    (0..count)
        .filter_map(|_| {
            let origin = centre + 2.0 * bounds.radius() * random.direction();
            let part = 0.5 * (random.in_cube() + DVec3::ONE);
            let dir = (lower + part * extent - origin).normalize_or_zero();
            Ray::new(origin.as_vec3(), dir.as_vec3()).ok()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::camera::Projection;
    use hitscope_core::mesh::shapes::{Placement, sphere};
    use hitscope_core::scene::scene;

    #[test]
    fn the_workloads_match_their_names() {
        let scene = scene(sphere(8, Placement::UNIT));
        let projection = Projection::Perspective { fov_y_radians: 0.7 };
        let size = UVec2::new(32, 16);
        let eye = DVec3::Z * 4.0;
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size);
        let camera = camera.expect("a camera");
        let [primary, bounce, random] = workloads(&scene, &camera, 512, 1);
        assert_eq!(primary.len(), 512);
        let intersector = scene.intersector(default_triangle_kernel());
        let is_hit = |ray: &&Ray| intersector.any_hit(ray);
        assert_eq!(primary.iter().filter(is_hit).count(), bounce.len());
        // A sphere is convex: rays that leave it never hit it again.
        assert_eq!(bounce.iter().filter(is_hit).count(), 0);
        assert!(random.iter().filter(is_hit).count() > 100);
        let lamp = lamp_rays(&scene, &camera, &primary);
        assert!(lamp.len() > bounce.len() / 2 && lamp.len() < bounce.len());
        assert_eq!(lamp.iter().filter(is_hit).count(), 0);
        assert!(lamp.iter().all(|ray| ray.dir == lamp[0].dir));
    }

    #[test]
    fn camera_rays_cover_every_pixel_once_or_an_even_subset() {
        let projection = Projection::Orthographic { height: 2.0 };
        for (size, count, expected) in [
            (UVec2::new(21, 10), 1000, 210),
            (UVec2::new(64, 64), 1024, 1024),
            (UVec2::new(1, 1), 5, 1),
        ] {
            let camera = Camera::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y, projection, size);
            let rays = primary_rays(&camera.expect("a camera"), count);
            let mut origins: Vec<_> = rays
                .iter()
                .map(|ray| ray.origin.to_array().map(f32::to_bits))
                .collect();
            origins.sort_unstable();
            origins.dedup();
            assert_eq!(origins.len(), expected, "{size}");
        }
    }
}
