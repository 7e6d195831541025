//! The derivation for a triangle: its plane, then barycentric coordinates as ratios of signed areas.
//!
//! Source: the lecture, "Intersection Ray – Plane" and "Barycentric Coordinates – Definition".

use super::Line;
use super::number::{operand, point, text};
use super::plane::hesse;
use glam::DVec3;
use hitscope_core::barycentric::{signed_area, weights_by_areas};
use hitscope_core::shape::PlaneForm;

pub(super) fn lines(line: &Line, corners: [DVec3; 3]) -> Vec<String> {
    let [a, b, c] = corners;
    let plane = PlaneForm::ThreePoints(corners).to_hesse();
    let (normal, distance) = plane.unwrap_or_default();
    let mut lines: Vec<String> = ["A", "B", "C"]
        .into_iter()
        .zip(corners)
        .map(|(name, corner)| format!("{name} = {}", point(corner)))
        .collect();
    lines.push("n = (B − A) × (C − A) / |(B − A) × (C − A)|".to_owned());
    lines.push(format!("n = {}", point(normal)));
    let (of_plane, t) = hesse(line, normal, distance, "A");
    lines.extend(of_plane);
    let p = line.at(t);
    lines.push(format!("P = r(t) = {}", point(p)));
    lines.push("Signed areas: Δ(XYZ) = ((Y − X) × (Z − X))·n / 2".to_owned());
    let whole = signed_area(corners, normal);
    lines.push(format!("Δ(ABC) = {}", text(whole)));
    let parts = [("BCP", [b, c, p]), ("CAP", [c, a, p]), ("ABP", [a, b, p])];
    let weights = weights_by_areas(corners, p);
    for (k, ((name, part), weight)) in (1..).zip(parts.into_iter().zip(weights)) {
        lines.push(format!(
            "λ{k} = Δ({name}) / Δ(ABC) = {} / {} = {}",
            operand(signed_area(part, normal)),
            text(whole),
            text(weight)
        ));
    }
    lines.push("P = λ1 A + λ2 B + λ3 C, in the triangle if λ1, λ2, λ3 ≥ 0".to_owned());
    lines
}
