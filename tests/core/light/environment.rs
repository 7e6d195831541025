//! Light from measured environments: the right side is lit, and all ways to sample it have the same mean.

use super::{Estimate, lit, path_count};
use glam::{DVec3, Quat, UVec2, Vec2, Vec3};
use hitscope_core::integrator::Context;
use hitscope_core::light::{Environment, EnvironmentMap, Light, MapPlacement, PlacedMap};
use hitscope_core::mesh::{Assigned, Attributes, Material, Runs};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::sampler::Sampler;
use hitscope_core::scene::{SceneOptions, scene};
use hitscope_core::shape::Sphere;
use hitscope_core::{Ray, TriangleMesh};
use std::f32::consts::FRAC_PI_2;
use std::f64::consts::{FRAC_1_PI, PI, TAU};
use std::sync::Arc;

const SIZE: UVec2 = UVec2::new(64, 33);

fn map(size: UVec2, texels: Vec<Vec3>) -> Arc<EnvironmentMap> {
    let map = EnvironmentMap::new(size, texels, &Progress::default());
    Arc::new(map.expect("texels"))
}

/// A map that is black but for one texel.
fn one_texel(column: u32, row: u32) -> Arc<EnvironmentMap> {
    let mut texels = vec![Vec3::ZERO; SIZE.element_product() as usize];
    texels[(row * SIZE.x + column) as usize] = Vec3::splat(1000.0);
    map(SIZE, texels)
}

/// A map of random texels, with a small and very bright one, and a black part.
fn varied(size: UVec2) -> Arc<EnvironmentMap> {
    let mut random = Random::new(7);
    let texel = |k: u32| {
        let (column, row) = (k % size.x, k / size.x);
        let brightness = match (column, row) {
            (3, 2) => 3000.0,
            (column, _) if column > size.x * 3 / 4 => 0.0,
            _ => 1.0,
        };
        brightness * random.unit() as f32 * Vec3::new(1.0, 1.0, 0.5)
    };
    map(size, (0..size.element_product()).map(texel).collect())
}

/// The direction of a texel in an unrotated map.
fn direction(size: UVec2, column: f64, row: f64) -> DVec3 {
    let (sin_phi, cos_phi) = (TAU * (column + 0.5) / f64::from(size.x)).sin_cos();
    let (sin, cos) = (PI * row / f64::from(size.y - 1)).sin_cos();
    DVec3::new(sin_phi * sin, cos, -cos_phi * sin)
}

/// A white unit ball in an environment.
fn ball(map: &Arc<EnvironmentMap>, placement: MapPlacement) -> Context {
    let white = Material {
        diffuse: Some(Vec3::ONE),
        ..Material::default()
    };
    let attributes = Attributes {
        materials: Assigned::new(vec![white], Runs::default()),
        ..Attributes::default()
    };
    let mut scene = scene(TriangleMesh::default().with_attributes(attributes));
    let ball = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0,
    };
    let (options, progress) = (SceneOptions::default(), Progress::default());
    let added = scene.add_group(vec![ball], Runs::default(), options, &progress);
    added.expect("nobody cancels");
    let environment = Environment::Map(PlacedMap::new(Arc::clone(map), placement));
    lit(scene, vec![Light::Environment(environment)])
}

/// The light that the ball's point with a normal reflects.
fn reflected(context: &Context, view: &str, n: u32, normal: Vec3) -> Estimate {
    let ray = Ray::new(3.0 * normal, -normal).expect("a ray");
    Estimate::of_ray(context, view, n, ray)
}

#[test]
fn a_bright_texel_lights_the_side_that_faces_it_in_every_rotation() {
    let (quarter, equator) = (SIZE.x / 4, SIZE.y / 2);
    let texels = [
        (0, 0, Vec3::Y),
        (0, SIZE.y - 1, Vec3::NEG_Y),
        (0, equator, Vec3::NEG_Z),
        (quarter, equator, Vec3::X),
        (2 * quarter, equator, Vec3::Z),
        (3 * quarter, equator, Vec3::NEG_X),
        (40, 10, direction(SIZE, 40.0, 10.0).as_vec3()),
    ];
    let axes = [
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        Vec3::NEG_X,
        Vec3::NEG_Y,
        Vec3::NEG_Z,
    ];
    for (column, row, towards) in texels {
        let map = one_texel(column, row);
        for turns in 0..4 {
            let rotation_radians = turns as f32 * FRAC_PI_2;
            let placement = MapPlacement {
                rotation_radians,
                ..MapPlacement::default()
            };
            let context = ball(&map, placement);
            let towards = Quat::from_rotation_y(rotation_radians) * towards;
            let facing = reflected(&context, "direct", 1024, towards.normalize()).mean;
            assert!(facing > 0.0, "{column}, {row}, {turns}");
            for normal in axes {
                let part = reflected(&context, "direct", 1024, normal).mean / facing;
                // A texel reaches 0.1 radians to all sides, and its centre lies at most 0.05 radians from the axis, so
                // that cosines are off by at most 0.15, and by at most 0.02 relative to 1.
                let cos = f64::from(normal.dot(towards)).max(0.0);
                assert!(
                    (part - cos).abs() < 0.17,
                    "{column}, {row}, {turns}, {normal}: {part}"
                );
            }
            let behind = reflected(&context, "path", 1024, -towards.normalize()).mean;
            assert_eq!(behind, 0.0);
        }
    }
}

#[test]
fn an_orientation_moves_the_up_axis() {
    // The first row is bright.
    let texel = |k: u32| {
        if k < SIZE.x {
            Vec3::splat(1000.0)
        } else {
            Vec3::ZERO
        }
    };
    let map = map(SIZE, (0..SIZE.element_product()).map(texel).collect());
    // As in files with z up.
    let orientation = glam::Mat3::from_rotation_x(FRAC_PI_2);
    let placement = MapPlacement {
        orientation,
        rotation_radians: 1.0,
        scale: 2.0,
    };
    let environment = Environment::Map(PlacedMap::new(map, placement));
    // The rotations are rounded to f32, and a row is 0.1 radians high.
    let above = environment.radiance(Vec3::Z);
    assert!((above - Vec3::splat(2000.0)).length() < 0.01, "{above}");
    assert_eq!(environment.radiance(Vec3::Y), Vec3::ZERO);
}

#[test]
fn every_way_to_sample_an_environment_has_the_same_mean() {
    for size in [SIZE, UVec2::new(5, 4), UVec2::new(1, 1)] {
        let map = varied(size);
        let placement = MapPlacement {
            rotation_radians: 0.7,
            scale: 3.0,
            ..MapPlacement::default()
        };
        let context = ball(&map, placement);
        let lights = &context.lighting.lights;
        let environment = lights.environment().expect("an environment");
        let normal = Vec3::new(0.3, 0.8, -0.4).normalize();
        let cos = |dir: Vec3| f64::from(dir.dot(normal).max(0.0));
        let by_light = Estimate::of(path_count(), |sampler: &mut Sampler| {
            let (at, choice) = (sampler.next_2d(), sampler.next_1d());
            let sample = lights.sample(&context.scene, context.lighting.spawn, normal, at, choice);
            sample.map_or(0.0, |sample| {
                FRAC_1_PI * cos(sample.dir) * f64::from(sample.weight.y)
            })
        });
        let uniformly = Estimate::of(path_count(), |sampler: &mut Sampler| {
            let at = sampler.next_2d();
            let y = 2.0 * at.x - 1.0;
            let (sin_phi, cos_phi) = (at.y * std::f32::consts::TAU).sin_cos();
            let across = (1.0 - y * y).sqrt();
            let dir = Vec3::new(across * cos_phi, y, across * sin_phi);
            let light = environment.radiance(dir);
            4.0 * cos(dir) * f64::from(light.y)
        });
        let direct = reflected(&context, "direct", path_count(), normal);
        let path = reflected(&context, "path", path_count(), normal);
        eprintln!("{size}: {by_light:?}, {uniformly:?}, {direct:?}, {path:?}");
        for other in [uniformly, direct, path] {
            // Four standard errors of the difference, and 10⁻⁵ for rounding.
            let error = by_light.error.hypot(other.error);
            let most = 4.0 * error + 1e-5 * by_light.mean;
            assert!((by_light.mean - other.mean).abs() < most);
        }
        // It knows the bright texel.
        assert!(size != SIZE || by_light.error < 0.5 * uniformly.error);
    }
}

/// Directions in the middles of the four quarters of every cell, and the solid angles of the quarters. The density is
/// linear in φ and in cos θ over a cell, so that its mean over a quarter is the density in the middle.
fn quarters(size: UVec2) -> Vec<(Vec3, f64)> {
    let cos = |row: f64| (PI * row / f64::from(size.y - 1)).cos();
    let mut quarters = Vec::new();
    for row in 0..size.y - 1 {
        let (upper, lower) = (cos(row.into()), cos(f64::from(row) + 1.0));
        for part in [0.25, 0.75] {
            let cos = upper + part * (lower - upper);
            let sin = (1.0 - cos * cos).sqrt();
            for half in 0..2 * size.x {
                let column = 0.5 * f64::from(half) + 0.25;
                let (sin_phi, cos_phi) = (TAU * (column + 0.5) / f64::from(size.x)).sin_cos();
                let dir = DVec3::new(sin_phi * sin, cos, -cos_phi * sin);
                let solid_angle = TAU * (upper - lower) / f64::from(4 * size.x);
                quarters.push((dir.as_vec3(), solid_angle));
            }
        }
    }
    quarters
}

/// The index of a direction in [`quarters`].
fn quarter_of(size: UVec2, dir: Vec3) -> usize {
    let cos = |row: f64| (PI * row / f64::from(size.y - 1)).cos();
    let dir = dir.as_dvec3().normalize();
    let theta = dir.x.hypot(dir.z).atan2(dir.y);
    let row = (theta / PI * f64::from(size.y - 1)).floor();
    let row = row.min(f64::from(size.y - 2));
    let is_lower = dir.y < 0.5 * (cos(row) + cos(row + 1.0));
    let column = dir.x.atan2(-dir.z) / TAU * f64::from(size.x) - 0.5;
    let half = (2.0 * column).floor().rem_euclid(f64::from(2 * size.x));
    (2 * row as usize + usize::from(is_lower)) * 2 * size.x as usize + half as usize
}

#[test]
fn the_density_integrates_to_one() {
    for size in [SIZE, UVec2::new(5, 4), UVec2::new(1, 2)] {
        for map in [varied(size), one_texel(40, 10), one_texel(63, 0)] {
            let density =
                |(dir, solid_angle): (Vec3, f64)| f64::from(map.density(dir)) * solid_angle;
            let integral: f64 = quarters(map.size()).into_iter().map(density).sum();
            // Directions and densities are rounded to f32.
            assert!((integral - 1.0).abs() < 1e-4, "{size}: {integral}");
        }
    }
}

#[test]
fn sampled_directions_are_distributed_by_their_density() {
    const N: u32 = 1 << 18;
    for size in [SIZE, UVec2::new(5, 4)] {
        let map = varied(size);
        let expected = quarters(size);
        let mut counts = vec![0u32; expected.len()];
        let mut random = Random::new(3);
        for _ in 0..N {
            let at = Vec2::new(random.unit() as f32, random.unit() as f32);
            let sample = map.sample(at.min(Vec2::splat(1.0 - f32::EPSILON)));
            let sample = sample.expect("light");
            counts[quarter_of(size, sample.dir)] += 1;
        }
        // Quarters that expect fewer than ten are counted together.
        let (mut statistic, mut freedoms) = (0.0, -1.0);
        let mut rest = (0.0, 0.0);
        for ((dir, solid_angle), count) in expected.into_iter().zip(counts) {
            let expected = f64::from(N) * f64::from(map.density(dir)) * solid_angle;
            let count = f64::from(count);
            if expected < 10.0 {
                rest = (rest.0 + expected, rest.1 + count);
                continue;
            }
            statistic += (count - expected).powi(2) / expected;
            freedoms += 1.0;
        }
        if rest.0 >= 10.0 {
            statistic += (rest.1 - rest.0).powi(2) / rest.0;
            freedoms += 1.0;
        }
        // Four standard deviations of χ², which is normal for so many degrees of freedom.
        let most = freedoms + 4.0 * f64::sqrt(2.0 * freedoms);
        eprintln!("{size}: χ² = {statistic}, {freedoms} degrees of freedom, n = {N}");
        assert!(statistic < most);
    }
}

#[test]
fn a_sample_agrees_with_lookups_in_its_direction() {
    let map = varied(SIZE);
    let mut random = Random::new(5);
    let samples: Vec<_> = (0..10_000)
        .filter_map(|_| map.sample(Vec2::new(random.unit() as f32, random.unit() as f32)))
        .collect();
    let densest = samples.iter().map(|s| s.density).fold(0.0, f32::max);
    for sample in &samples {
        assert!((sample.dir.length() - 1.0).abs() < 1e-6);
        // A direction is rounded by 10⁻⁷, a cell is 0.1 wide.
        let error = (map.density(sample.dir) - sample.density).abs();
        assert!(error < 1e-5 * densest, "{sample:?}");
        let error = (map.radiance(sample.dir) - sample.radiance).length();
        assert!(error < 1e-5 * 3000.0, "{sample:?}");
    }
}

#[test]
fn every_direction_with_light_has_a_density() {
    let mut random = Random::new(9);
    for map in [
        varied(SIZE),
        one_texel(5, 0),
        one_texel(0, 1),
        one_texel(63, 32),
    ] {
        for _ in 0..20_000 {
            let dir = random.direction().as_vec3();
            // Dimmer light may be due to rounding.
            let is_lit = map.radiance(dir).y > 1e-3;
            assert!(!is_lit || map.density(dir) > 0.0, "{dir}");
        }
    }
    let black = map(SIZE, vec![Vec3::ZERO; SIZE.element_product() as usize]);
    assert_eq!(black.sample(Vec2::splat(0.5)), None);
    assert_eq!(black.density(Vec3::X), 0.0);
}

#[test]
fn lookups_equal_mitsubas() {
    let size = UVec2::new(8, 5);
    let texel = |k: u32| {
        let (column, row) = (k % 8, k / 8);
        UVec2::new(column, row)
            .as_vec2()
            .extend((column * row % 5) as f32)
            + Vec3::new(1.0, 1.0, 0.0)
    };
    let map = map(size, (0..40).map(texel).collect());
    // Mitsuba 3.9.1, scalar_rgb, emitter `envmap` with the same picture.
    for (dir, expected) in [
        ([1.0, 0.0, 0.0], [2.5, 3.0, 3.0]),
        ([-1.0, 0.0, 0.0], [6.5, 3.0, 1.0]),
        ([0.0, 0.0, 1.0], [4.5, 3.0, 2.0]),
        ([0.0, 0.0, -1.0], [4.5, 3.0, 2.0]),
        ([0.0, -1.0, 0.0], [4.5, 5.0, 1.5]),
        ([1.0, 2.0, 3.0], [4.090_335, 2.281_966, 2.551_875]),
        ([-1.0, 0.5, 0.2], [6.248_667, 2.419_594, 0.353_007]),
        ([0.3, -0.9, -0.4], [1.319_331, 4.354_342, 1.071_144]),
    ] {
        let found = map.radiance(Vec3::from(dir).normalize());
        assert!((found - Vec3::from(expected)).length() < 1e-5, "{found}");
    }
}
