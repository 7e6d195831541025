//! The derivation for a plane in Hesse form.
//!
//! Source: the lecture, "Intersection Ray – Plane".

use super::Line;
use super::number::{operand, point, text};
use glam::DVec3;
use hitscope_core::shape::{Plane, Shape};

pub(super) fn lines(line: &Line, plane: &Plane) -> Vec<String> {
    let mut lines: Vec<String> = Plane::INFO
        .equations
        .iter()
        .map(ToString::to_string)
        .collect();
    let normal = plane.normal.as_dvec3().normalize_or_zero();
    lines.push(format!(
        "Hesse form, with n of length 1: n = {}",
        point(normal)
    ));
    lines.extend(hesse(line, normal, plane.point.as_dvec3(), "a").0);
    lines
}

/// t of the plane through a point, which has a name, with a unit normal.
pub(super) fn hesse(line: &Line, normal: DVec3, through: DVec3, name: &str) -> (Vec<String>, f64) {
    let distance = through.dot(normal);
    let (on, dn) = (line.origin.dot(normal), line.dir.dot(normal));
    let t = (distance - on) / dn;
    let lines = vec![
        format!("0 = p·n − D, D = {name}·n = {}", text(distance)),
        format!(
            "t = (D − o·n) / (d·n) = ({} − {}) / {} = {}",
            text(distance),
            operand(on),
            operand(dn),
            text(t)
        ),
    ];
    (lines, t)
}
