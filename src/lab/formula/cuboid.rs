//! The derivation for a box: the nearer and the farther plane of each pair.
//!
//! Source: the lecture, "Intersection Ray – Box".

use super::number::text;
use hitscope_core::kernel::LineEquation;

/// The parts of the equations are the planes x = −1, x = 1, y = −1 and so on.
pub(super) fn lines(equations: &[LineEquation]) -> Vec<String> {
    let mut lines = vec![
        "p = c + x a1 + y a2 + z a3, with |x|, |y|, |z| ≤ 1".to_owned(),
        "Pairs of parallel planes, with p = r(t):".to_owned(),
    ];
    let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
    for (name, pair) in ["x", "y", "z"].into_iter().zip(equations.chunks_exact(2)) {
        let t = |equation: &LineEquation| equation.roots.first().map(|root| root.t);
        let Some((a, b)) = t(&pair[0]).zip(t(&pair[1])) else {
            lines.push(format!("{name} = ±1: parallel to the ray"));
            continue;
        };
        let (first, second) = (a.min(b), a.max(b));
        lines.push(format!(
            "{name} = ±1: t_near = {}, t_far = {}",
            text(first),
            text(second)
        ));
        (near, far) = (near.max(first), far.min(second));
    }
    lines.push(format!("t_near = max = {}", text(near)));
    lines.push(format!("t_far = min = {}", text(far)));
    lines.push("A hit if t_near ≤ t_far; at t_far if the ray starts inside.".to_owned());
    lines
}
