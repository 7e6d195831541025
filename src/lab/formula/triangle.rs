//! The derivation for a triangle: its plane, then barycentric coordinates as ratios of signed areas.
//!
//! Source: the lecture, "Intersection Ray – Plane" and "Barycentric Coordinates – Definition".

use super::Line;
use super::number::{operand, point, text};
use super::plane::hesse;
use glam::DVec3;

pub(super) fn lines(line: &Line, corners: [DVec3; 3]) -> Vec<String> {
    let [a, b, c] = corners;
    let cross = (b - a).cross(c - a);
    let normal = cross.normalize_or_zero();
    let mut lines: Vec<String> = ["A", "B", "C"]
        .into_iter()
        .zip(corners)
        .map(|(name, corner)| format!("{name} = {}", point(corner)))
        .collect();
    lines.push("n = (B − A) × (C − A) / |(B − A) × (C − A)|".to_owned());
    lines.push(format!("n = {}", point(normal)));
    let (of_plane, t) = hesse(line, normal, a, "A");
    lines.extend(of_plane);
    let p = line.at(t);
    lines.push(format!("P = r(t) = {}", point(p)));
    lines.push("Signed areas: Δ(XYZ) = ((Y − X) × (Z − X))·n / 2".to_owned());
    let area = |[x, y, z]: [DVec3; 3]| 0.5 * (y - x).cross(z - x).dot(normal);
    let whole = area(corners);
    lines.push(format!("Δ(ABC) = {}", text(whole)));
    for (k, name, part) in [
        (1, "BCP", [b, c, p]),
        (2, "CAP", [c, a, p]),
        (3, "ABP", [a, b, p]),
    ] {
        let part = area(part);
        lines.push(format!(
            "λ{k} = Δ({name}) / Δ(ABC) = {} / {} = {}",
            operand(part),
            text(whole),
            text(part / whole)
        ));
    }
    lines.push("P = λ1 A + λ2 B + λ3 C, in the triangle if λ1, λ2, λ3 ≥ 0".to_owned());
    lines
}
