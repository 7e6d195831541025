//! The numbers that `trace` prints.

use super::{PLANE, line, text};
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::random::Random;
use serde_json::Value;

#[test]
fn numbers_read_back_to_the_same_doubles() {
    // The distance is an f32: 1.0000029 for who reads f32, another number for who reads doubles.
    // The f32 next to it, in full: 1.00000286102294921875.
    let t = f64::from(1.000_002_9_f32);
    assert_eq!(f64::from(t as f32), t);
    let found = text(PLANE, "", line([0.25, 0.5, t, 0.0, 0.0, -1.0]));
    assert!(found.contains("\"t\":1.0000028610229492,"), "{found}");
    let answer: Value = serde_json::from_str(&found).expect("JSON");
    assert_eq!(answer["t"].as_f64(), Some(t));
    for weight in answer["barycentric"].as_array().expect("three") {
        let weight = weight.as_f64().expect("a number");
        assert_eq!(f64::from(weight as f32), weight, "the value of an f32");
    }
}

#[test]
fn no_weight_is_below_zero_and_no_zero_has_a_sign() {
    let corners = [[0.1, 0.2, 0.3], [0.9, -0.3, 0.1], [0.2, 0.7, -0.4]];
    let mesh: String = corners
        .iter()
        .map(|p| format!("v {} {} {}\n", p[0], p[1], p[2]))
        .collect();
    let mut random = Random::new(5);
    // At the edge BC, where 1 − u − v is 0 but for roundings.
    let rays: String = (0..2_000)
        .map(|_| {
            let along = random.unit();
            let origin = [random.signed(), random.signed(), 2.0];
            let dir = [0, 1, 2].map(|k| {
                let target = corners[1][k] + along * (corners[2][k] - corners[1][k]);
                target - origin[k]
            });
            line(origin.into_iter().chain(dir))
        })
        .collect();
    for kernel in TRIANGLE_KERNELS.iter() {
        let options = format!("--kernel {}", kernel.info.name);
        let printed = text(&(mesh.clone() + "f 1 2 3\n"), &options, &rays);
        let hits = printed.lines().filter(|line| line.contains("true")).count();
        assert!(hits > 100, "{options}: {hits} hits");
        for line in printed.lines() {
            let (_, weights) = line.split_once("barycentric\":[").unwrap_or_default();
            let (weights, _) = weights.split_once(']').unwrap_or_default();
            assert!(
                !weights.contains("[-") && !weights.contains(",-") && !weights.starts_with('-'),
                "{options}: {line}"
            );
        }
        // The plane z = 0 from above, at x = 0.
        let printed = text(PLANE, &options, "-0.0 -0.0 1 0 0 -1\n");
        assert!(!printed.contains("-0"), "{options}: {printed}");
    }
}
