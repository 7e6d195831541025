//! The derivation for a box: the nearer and the farther plane of each pair.
//!
//! Source: the lecture, "Intersection Ray – Box".

use super::number::text;
use hitscope_core::kernel::LineEquation;

/// The texts of a box: its points, and the planes of a pair across an axis.
pub(super) struct BoxTexts {
    pub points: &'static str,
    pub planes: [&'static str; 3],
}

/// Of a box of any orientation.
pub(super) const CUBOID: BoxTexts = BoxTexts {
    points: "p = c + x a1 + y a2 + z a3, with |x|, |y|, |z| ≤ 1",
    planes: ["x = ±1", "y = ±1", "z = ±1"],
};

/// Of an axis-aligned box.
pub(super) const AXIS_BOX: BoxTexts = BoxTexts {
    points: "min ≤ p ≤ max, with p = (x, y, z)",
    planes: ["x = min.x, max.x", "y = min.y, max.y", "z = min.z, max.z"],
};

/// The parts of the equations are the lower and the upper plane across x, y and z.
pub(super) fn lines(texts: &BoxTexts, equations: &[LineEquation]) -> Vec<String> {
    let mut lines = vec![
        texts.points.to_owned(),
        "Pairs of parallel planes, with p = r(t):".to_owned(),
    ];
    let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut is_between = true;
    for (planes, pair) in texts.planes.into_iter().zip(equations.chunks_exact(2)) {
        let t = |equation: &LineEquation| equation.roots.first().map(|root| root.t);
        let Some((a, b)) = t(&pair[0]).zip(t(&pair[1])) else {
            // On the two sides of the planes the constants have equal signs.
            let constant = |equation: &LineEquation| equation.coefficients[0].signum();
            let is_inside = constant(&pair[0]) * constant(&pair[1]) <= 0.0;
            is_between &= is_inside;
            let place = if is_inside { "between" } else { "outside" };
            lines.push(format!("{planes}: parallel to the ray, which is {place}"));
            continue;
        };
        let (first, second) = (a.min(b), a.max(b));
        lines.push(format!(
            "{planes}: t_near = {}, t_far = {}",
            text(first),
            text(second)
        ));
        (near, far) = (near.max(first), far.min(second));
    }
    lines.push(format!("t_near = max = {}", text(near)));
    lines.push(format!("t_far = min = {}", text(far)));
    lines.push(if is_between {
        "A hit if t_near ≤ t_far and t_far > 0; at t_far if t_near < 0.".to_owned()
    } else {
        "A miss: the ray is outside a pair of planes.".to_owned()
    });
    lines
}
