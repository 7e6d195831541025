//! The derivation for a plane in Hesse form.
//!
//! Source: the lecture, "Intersection Ray – Plane".

use super::Line;
use super::number::{operand, point, text};
use glam::DVec3;
use hitscope_core::shape::{Plane, PlaneForm, Shape};

pub(super) fn lines(line: &Line, plane: &Plane) -> Vec<String> {
    let mut lines: Vec<String> = Plane::INFO
        .equations
        .iter()
        .map(ToString::to_string)
        .collect();
    let form = PlaneForm::PointAndNormal {
        point: plane.point.as_dvec3(),
        normal: plane.normal.as_dvec3(),
    };
    let (normal, distance) = form.to_hesse().unwrap_or_default();
    lines.push(format!(
        "Hesse form, with n of length 1: n = {}",
        point(normal)
    ));
    lines.extend(hesse(line, normal, distance, "a").0);
    lines
}

/// t of a plane in Hesse form, which goes through a point of the given name.
pub(super) fn hesse(line: &Line, normal: DVec3, distance: f64, name: &str) -> (Vec<String>, f64) {
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
