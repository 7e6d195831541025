//! Rays of `trace` that are rounded, or aren't.

use super::{PLANE, answers, line};
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::random::Random;
use hitscope_lab::oracle;
use serde_json::Value;

fn rounding(answer: &Value) -> f64 {
    answer["ray_rounding"].as_f64().expect("a number")
}

#[test]
fn rays_of_f32_numbers_are_not_rounded_where_the_files_numbers_are_f32() {
    let mesh = "v 1000 0 0\nv 1000 1 0\nv 1000 0 1\nf 1 2 3\n";
    for kernel in ["watertight", "precise", "exact"] {
        let options = format!("--kernel {kernel}");
        // A billionth below the edge y = 0, and on it, and above it.
        let rays = "0 -1e-9 0.5 1 0 0\n0 0 0.5 1 0 0\n0 1e-9 0.5 1 0 0\n";
        let found = answers(mesh, &options, rays);
        let are_hits: Vec<_> = found.iter().map(|answer| answer["hit"].clone()).collect();
        assert_eq!(are_hits, [false, true, true], "{kernel}");
        // Half an ulp of 1e-9.
        let bound = 2f64.powi(-54);
        assert!(
            found.iter().all(|answer| rounding(answer) <= bound),
            "{found:?}"
        );
        assert_eq!(found[1]["t"], 1000.0);
    }
}

#[test]
fn hit_or_miss_of_f32_rays_about_a_far_f32_mesh_is_the_oracles() {
    let mut random = Random::new(11);
    let mut near = |middle: f32| Vec3::splat(middle) + 0.5 * random.in_cube_f32();
    let corners = [near(1000.0), near(1000.0), near(1000.0)];
    let rays: Vec<Ray> = (0..20_000)
        .map(|k| {
            // At an edge: which side is decided by what f32 leaves of the direction.
            let (from, to) = (corners[k % 3], corners[(k + 1) % 3]);
            let target = from + (to - from) * ((k as f32 + 0.5) / 20_000.0);
            let origin = near(0.0);
            Ray::new(origin, target - origin).expect("a ray")
        })
        .collect();
    let vertex = |p: &Vec3| "v ".to_owned() + &line(p.as_dvec3().to_array());
    let mesh: String = corners.iter().map(vertex).collect();
    let numbers = |ray: &Ray| ray.origin.to_array().into_iter().chain(ray.dir.to_array());
    let lines: String = rays
        .iter()
        .map(|ray| line(numbers(ray).map(f64::from)))
        .collect();
    let found = answers(&(mesh + "f 1 2 3\n"), "--kernel exact", lines);
    let mut hits = 0;
    for (answer, ray) in found.iter().zip(&rays) {
        let expected = oracle::intersect(ray, corners);
        assert_eq!(answer["hit"], expected.is_some(), "{ray:?}: {answer}");
        assert_eq!(rounding(answer), 0.0, "{ray:?}");
        hits += usize::from(expected.is_some());
    }
    // Some of both, or nothing was decided.
    assert!((2_000..18_000).contains(&hits), "{hits}");
}

#[test]
fn rays_from_far_away_hit_what_they_aim_at() {
    let mesh = "v 500000 4649776 0\nv 500001 4649776 0\nv 500000 4649777 0\nf 1 2 3\n";
    let found = &answers(mesh, "", "1000500032.1 4649776.25 1000000031.85 -1 0 -1\n")[0];
    assert_eq!(found["hit"], true);
    assert_eq!(found["t"], 1_000_000_031.85);
    // The origin's decimals are rounded to f64 by up to 2⁻²⁴ and 2⁻²⁴, an ulp of f32 at 0.25 is 2⁻²⁶.
    assert!(rounding(found) < 2f64.powi(-23), "{found}");

    let mut random = Random::new(3);
    let mut rays = String::new();
    let mut expected = Vec::new();
    for distance in [1.0, 1e3, 1e6, 1e9].map(|x: f64| 2f64.powi(x.log2() as i32)) {
        for _ in 0..200 {
            // Sums and products of so few bits are exact in f64, and near the mesh in f32.
            let target = [0; 2].map(|_| (random.signed() * 1024.0).round() / 1024.0);
            let slope = [0; 2].map(|_| (random.signed() * 64.0).round() / 64.0);
            let origin = [
                500_000.0 + target[0] - distance * slope[0],
                4_649_776.0 + target[1] - distance * slope[1],
                distance,
            ];
            rays += &line(origin.into_iter().chain([slope[0], slope[1], -1.0]));
            let [x, y] = target;
            expected.push((x >= 0.0 && y >= 0.0 && x + y <= 1.0, distance));
        }
    }
    for kernel in ["watertight", "precise", "exact"] {
        for end in ["", " --any"] {
            let found = answers(mesh, &format!("--kernel {kernel}{end}"), &rays);
            assert_eq!(found.len(), expected.len());
            for (answer, (is_hit, distance)) in found.iter().zip(&expected) {
                assert_eq!(answer["hit"], *is_hit, "{kernel}{end}: {answer}");
                assert_eq!(rounding(answer), 0.0, "{answer}");
                if *is_hit && end.is_empty() {
                    // From the start near the mesh, within its size: an ulp or two of f32 at up to 4.
                    let t = answer["t"].as_f64().expect("a number");
                    assert!((t - distance).abs() < 1e-6, "{distance}: {answer}");
                }
            }
        }
    }
}

#[test]
fn what_is_left_of_rounding_is_told() {
    // Decimals near the mesh: 0.1 alone is rounded.
    let found = &answers(PLANE, "", "0.1 0.5 1 0 0 -1\n")[0];
    assert_eq!(rounding(found), f64::from(0.1f32) - 0.1);
    // A direction that is rounded matters more at the far end of the mesh, 5 lengths away.
    let slope = 0.1f64;
    let long = "v 0 0 -5\nv 1 0 -5\nv 0 1 0\nf 1 2 3\n";
    let found = &answers(long, "", line([0.25, 0.25, 0.0, slope, 0.0, -1.0]))[0];
    let error = f64::from(0.1f32) - slope;
    assert!(
        (5.0 * error..8.0 * error).contains(&rounding(found)),
        "{found} {error}"
    );
    // --any and --all tell it, too.
    for options in ["--any", "--all"] {
        assert_eq!(
            rounding(&answers(PLANE, options, "0.1 0.5 1 0 0 -1\n")[0]),
            f64::from(0.1f32) - 0.1
        );
    }
}
