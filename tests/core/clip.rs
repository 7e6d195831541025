//! Clipped scenes against crossings that are filtered one by one.

use crate::golden::{clipped, job};
use glam::{DQuat, DVec3, UVec2, Vec2, Vec3};
use hitscope_core::camera::Projection;
use hitscope_core::group::kernel_named;
use hitscope_core::intersector::Crossing;
use hitscope_core::kernel::{KernelChoice, Tier, exact_triangle_kernel};
use hitscope_core::mesh::Runs;
use hitscope_core::mesh::shapes::{Placement, soup, torus};
use hitscope_core::plan::Plan;
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::render::render;
use hitscope_core::scene::{SceneOptions, Shading, scene};
use hitscope_core::shape::Sphere;
use hitscope_core::{Camera, Clip, Intersector, Ray, Scene, TriangleMesh};
use std::sync::Arc;

/// A torus of triangles through two spheres.
fn mixed() -> Scene {
    let mut scene = scene(torus(24, 12, Placement::UNIT));
    let sphere = |x: f32| Sphere {
        centre: Vec3::new(x, 0.1, 0.0),
        radius: 0.4,
    };
    let (options, progress) = (SceneOptions::default(), Progress::default());
    let spheres = vec![sphere(-0.7), sphere(0.7)];
    let added = scene.add_group(spheres, Runs::default(), options, &progress);
    added.expect("nobody cancels");
    scene
}

fn tiers() -> [KernelChoice; 4] {
    let named = |tier: Tier| kernel_named(tier.name()).expect("a tier");
    [Tier::Fast, Tier::Watertight, Tier::Precise, Tier::Exact].map(named)
}

/// Both sides of random planes, and boxes.
fn clips(random: &mut Random) -> Vec<[Clip; 2]> {
    let mut clips = Vec::new();
    for _ in 0..12 {
        let (normal, offset) = (random.direction(), 0.6 * random.signed());
        let side = |sign: f64| Clip::plane(sign * normal, sign * offset).expect("a plane");
        clips.push([side(1.0), side(-1.0)]);
    }
    for _ in 0..4 {
        let corner = 0.5 * random.in_cube();
        let next_to = |x: f64| {
            let min = corner + DVec3::new(x, 0.0, 0.0);
            Clip::axis_box(min, min + 0.5).expect("a box")
        };
        clips.push([next_to(0.0), next_to(0.5)]);
    }
    clips
}

/// Rays through the scene from all sides; some start in it, some end there or start behind their origins.
fn rays(random: &mut Random, count: usize) -> Vec<Ray> {
    let ray = |k: usize| {
        let (target, from) = (0.8 * random.in_cube(), 3.0 * random.in_cube());
        let (origin, dir) = (from.as_vec3(), (target - from).as_vec3());
        let (t_min, t_max) = match k % 5 {
            0 => (0.3, 1.0),
            1 => (-2.0, 1.5),
            _ => (0.0, f32::INFINITY),
        };
        Ray::with_interval(origin, dir, t_min, t_max).expect("a ray")
    };
    (0..count).map(ray).collect()
}

/// The crossings without a clip of which the clip keeps t.
fn filtered(whole: &dyn Intersector, clip: &Clip, ray: &Ray) -> Vec<Crossing> {
    // The line without its interval, so that the cut is that of the clip alone.
    let line = Ray {
        t_min: f32::NEG_INFINITY,
        t_max: f32::INFINITY,
        ..*ray
    };
    let Some(cut) = clip.cut(&line) else {
        return Vec::new();
    };
    let mut all = whole.all_hits(ray);
    all.retain(|crossing| cut.kept.contains(crossing.hit.t));
    all
}

#[test]
fn a_clipped_scene_has_the_crossings_that_its_clip_keeps_for_every_kernel() {
    let (mut random, scene) = (Random::new(1), mixed());
    let clips = clips(&mut random);
    let rays = rays(&mut random, 150);
    let kernels = scene.kernels().into_iter().flat_map(|shape| shape.kernels);
    let (mut kept, mut removed) = (0, 0);
    for info in kernels {
        let kernel = KernelChoice { info };
        let whole: Arc<dyn Intersector> = scene.intersector(kernel).into();
        for clip in clips.iter().flatten() {
            let clipped = scene
                .with_clip(Some(clip.clone()))
                .clipped(Arc::clone(&whole));
            for ray in &rays {
                let expected = filtered(&*whole, clip, ray);
                let found = clipped.all_hits(ray);
                assert_eq!(found, expected, "{} {clip:?} {ray:?}", info.name);
                kept += found.len();
                removed += whole.all_hits(ray).len() - found.len();
            }
        }
    }
    assert!(kept > 1000 && removed > 1000, "{kept} {removed}");
}

#[test]
fn the_nearest_hit_is_the_first_kept_crossing_alone_in_packets_and_as_occlusion() {
    let (mut random, scene) = (Random::new(2), mixed());
    let clips = clips(&mut random);
    let size = UVec2::splat(32);
    let projection = Projection::Perspective { fov_y_radians: 0.7 };
    let eye = DVec3::new(1.0, -2.0, 2.25);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Z, projection, size).expect("good");
    let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
    let mut rays: Vec<Ray> = pixels.map(|p| camera.ray(p, Vec2::splat(0.5))).collect();
    rays.extend(self::rays(&mut random, 200));
    for kernel in tiers() {
        let whole: Arc<dyn Intersector> = scene.intersector(kernel).into();
        for clip in clips.iter().step_by(3).flatten() {
            let clipped = scene
                .with_clip(Some(clip.clone()))
                .clipped(Arc::clone(&whole));
            let mut found = vec![None; rays.len()];
            clipped.closest_hits(&rays, &mut found);
            let mut together = found.clone();
            clipped.coherent_hits(&rays, &mut together);
            assert_eq!(found, together, "{}", kernel.info.name);
            let mut are_hits = vec![true; rays.len()];
            clipped.any_hits(&rays, &mut are_hits);
            for ((ray, hit), is_hit) in rays.iter().zip(&found).zip(are_hits) {
                let expected = filtered(&*whole, clip, ray);
                let expected = expected.first().map(|crossing| crossing.hit);
                let name = kernel.info.name;
                assert_eq!(*hit, expected, "{name} {clip:?} {ray:?}");
                assert_eq!(clipped.closest_hit(ray), expected, "{name}");
                assert_eq!(clipped.closest_hit_with_cost(ray).0, expected, "{name}");
                assert_eq!(is_hit, expected.is_some(), "{name} {clip:?} {ray:?}");
            }
        }
    }
}

#[test]
fn each_crossing_is_on_a_side_of_a_plane() {
    let (mut random, scene) = (Random::new(3), mixed());
    let rays = rays(&mut random, 300);
    for kernel in tiers() {
        let whole: Arc<dyn Intersector> = scene.intersector(kernel).into();
        // The boxes leave a rest.
        for sides in clips(&mut random).iter().take(12) {
            let [a, b] = [0, 1].map(|k| {
                let scene = scene.with_clip(Some(sides[k].clone()));
                scene.clipped(Arc::clone(&whole))
            });
            for ray in &rays {
                let (mut both, all) = (a.all_hits(ray), whole.all_hits(ray));
                both.extend(b.all_hits(ray));
                both.sort_by(|a, b| a.hit.t.total_cmp(&b.hit.t));
                both.dedup();
                assert_eq!(both, all, "{} {sides:?} {ray:?}", kernel.info.name);
            }
        }
    }
}

/// A vector of integers from −`most` to `most`.
fn integers(random: &mut Random, most: i64) -> [i64; 3] {
    [0; 3].map(|_| random.index(2 * most as usize + 1) as i64 - most)
}

fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn minus(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn cross(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

fn vector(a: [i64; 3]) -> Vec3 {
    Vec3::from_array(a.map(|x| x as f32))
}

/// Whether a ray crosses the plane of a triangle beyond another plane, on it or before it, as a negative number, zero or a
/// positive one: the sign of `offset − normal·p` in integers.
fn exact_side(
    (origin, dir): ([i64; 3], [i64; 3]),
    [a, b, c]: [[i64; 3]; 3],
    (normal, offset): ([i64; 3], i64),
) -> i64 {
    let of_triangle = cross(minus(b, a), minus(c, a));
    // t = numerator / det.
    let (numerator, det) = (dot(minus(a, origin), of_triangle), dot(dir, of_triangle));
    let side = (offset - dot(normal, origin)) * det - numerator * dot(normal, dir);
    side.signum() * det.signum()
}

#[test]
fn crossings_are_kept_by_their_exact_side() {
    let mut random = Random::new(4);
    let (mut off_plane, mut on_plane) = (0, 0);
    for _ in 0..300 {
        // With coordinates up to 4, t of a crossing and t of the plane are equal, or differ by more than
        // 1/(1536·24), many ulps of f32 at 16.
        let corners: Vec<[Vec3; 3]> = (0..8)
            .map(|_| [0; 3].map(|_| vector(integers(&mut random, 4))))
            .collect();
        let scene = scene(soup(&corners));
        let whole: Arc<dyn Intersector> = scene.intersector(exact_triangle_kernel()).into();
        let (normal, offset) = (integers(&mut random, 2), random.index(9) as i64 - 4);
        let in_f64 = vector(normal).as_dvec3();
        let sides = [1.0, -1.0].map(|sign| Clip::plane(sign * in_f64, sign * offset as f64));
        let [Ok(first), Ok(second)] = sides else {
            continue;
        };
        let [first, second] = [first, second].map(|clip| {
            let scene = scene.with_clip(Some(clip));
            scene.clipped(Arc::clone(&whole))
        });
        for _ in 0..40 {
            let line = (integers(&mut random, 4), integers(&mut random, 4));
            let Ok(ray) = Ray::new(vector(line.0), vector(line.1)) else {
                continue;
            };
            let [first, second] = [&first, &second].map(|clipped| clipped.all_hits(&ray));
            for crossing in whole.all_hits(&ray) {
                // Triangles with equal corners aren't in the scene, so the numbers of its primitives differ.
                let corners = scene.corners(crossing.hit.primitive);
                let triangle = corners
                    .expect("a triangle")
                    .map(|p| p.to_array().map(|x| x as i64));
                let side = exact_side(line, triangle, (normal, offset));
                let kept = [first.contains(&crossing), second.contains(&crossing)];
                match side {
                    1 => assert_eq!(kept, [true, false], "{ray:?} {crossing:?}"),
                    -1 => assert_eq!(kept, [false, true], "{ray:?} {crossing:?}"),
                    _ => assert_eq!(kept, [true, true], "{ray:?} {crossing:?}"),
                }
                off_plane += i64::from(side != 0);
                on_plane += i64::from(side == 0);
            }
        }
    }
    assert!(off_plane > 300 && on_plane > 10, "{off_plane} {on_plane}");
}

#[test]
fn a_clipped_picture_is_the_same_on_any_number_of_threads() {
    let projection = Projection::Perspective {
        fov_y_radians: 0.75,
    };
    let picture = |view: &str, threads: usize| {
        let plan = Plan::new(UVec2::new(101, 67), 4, 4);
        let job = clipped(job(view, Shading::Smooth, projection, plan));
        render(job, threads).expect("no panic").pixels().to_vec()
    };
    for view in ["shaded", "path", "depth", "error-t"] {
        let alone = picture(view, 1);
        assert!(
            alone == picture(view, 2) && alone == picture(view, 5),
            "{view}"
        );
    }
}

#[test]
fn a_clip_changes_neither_bounds_nor_kept_hits_and_can_be_removed() {
    let scene = mixed();
    let clip = Clip::plane(DVec3::X, 0.0).expect("a plane");
    let clipped = scene.with_clip(Some(clip.clone()));
    assert_eq!(clipped.clip(), Some(&clip));
    assert_eq!(clipped.bounds(), scene.bounds());
    let ray = Ray::new(Vec3::new(3.0, 0.1, 0.0), Vec3::NEG_X).expect("a ray");
    let hits = |scene: &Scene| scene.intersector(exact_triangle_kernel()).all_hits(&ray);
    let (all, kept) = (hits(&scene), hits(&clipped));
    // A sphere inside the tube of a torus, on either side.
    assert!(all.len() >= 6 && kept.len() < all.len() && !kept.is_empty());
    assert!(all.ends_with(&kept));
    assert_eq!(hits(&clipped.with_clip(None)), all);
    // Exact answers are those of the part that is shown: the ray leaves the second sphere where it isn't removed.
    for crossing in &all {
        let shown = clipped.exact_answer(&ray, crossing.hit.primitive).is_some();
        let primitive = crossing.hit.primitive;
        let is_kept = kept.iter().any(|kept| kept.hit.primitive == primitive);
        assert_eq!(shown, is_kept, "{crossing:?}");
    }
}

/// A triangle in a plane, and the plane's normal and offset. Its coordinates are rounded to f32.
fn triangle_in_plane(normal: DVec3, middle: DVec3, radius: f64) -> (Scene, [Vec3; 3]) {
    let across = radius * normal.any_orthonormal_vector();
    let third = std::f64::consts::TAU / 3.0;
    let corner = |k: f64| middle + DQuat::from_axis_angle(normal, k * third) * across;
    let corners = [0.0, 1.0, 2.0].map(|k| corner(k).as_vec3());
    let mesh = TriangleMesh::new(corners.to_vec(), vec![[0, 1, 2]]);
    (scene(mesh), corners)
}

#[test]
fn a_face_in_the_plane_of_a_clip_is_shown_completely() {
    let mut random = Random::new(3);
    for k in 0..60 {
        let normal = if k % 2 == 0 {
            DVec3::Y
        } else {
            random.direction()
        };
        let radius = [1e-3, 1.0, 1e4][k % 3];
        // Near the origin, or far along the plane, where only the ray's reach tells how far.
        let far = if k % 4 < 2 { 1.0 } else { 300.0 };
        let middle = if k % 5 == 0 {
            far * radius * normal.any_orthonormal_vector()
        } else {
            radius * random.in_cube()
        };
        let (scene, corners) = triangle_in_plane(normal, middle, radius);
        let eye = if k % 5 == 0 {
            0.5 * far * radius * normal
        } else {
            middle + radius * (normal + 2.0 * random.in_cube())
        };
        let ray = |_| {
            let weights = [random.unit(), random.unit(), random.unit()];
            let sum: f64 = weights.iter().sum();
            let of_corner = |(corner, weight): (&Vec3, f64)| corner.as_dvec3() * (weight / sum);
            let target: DVec3 = corners.iter().zip(weights).map(of_corner).sum();
            Ray::new(eye.as_vec3(), (target - eye).as_vec3()).expect("a ray")
        };
        let rays: Vec<Ray> = (0..200).map(ray).collect();
        for kernel in tiers() {
            let whole: Arc<dyn Intersector> = scene.intersector(kernel).into();
            let hit_count = |scene: &Scene| {
                let clipped = scene.clipped(Arc::clone(&whole));
                let hits = rays.iter().filter_map(|ray| clipped.closest_hit(ray));
                hits.count()
            };
            let all = hit_count(&scene);
            // Rays at the edges may miss.
            assert!(all > rays.len() / 2, "{all}");
            let of_side = |sign: f64| {
                let clip = Clip::plane(sign * normal, sign * normal.dot(middle));
                hit_count(&scene.with_clip(Some(clip.expect("a plane"))))
            };
            let name = kernel.info.name;
            assert_eq!([of_side(1.0), of_side(-1.0)], [all; 2], "{name} {k}");
        }
    }
}
