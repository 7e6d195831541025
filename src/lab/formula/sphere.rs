//! The derivation for a sphere: the roots of a quadratic.
//!
//! Source: the lecture, "Intersection Ray – Sphere".

use super::Line;
use super::number::{operand, point, polynomial, text};
use super::roots;
use hitscope_core::kernel::LineEquation;
use hitscope_core::shape::{Shape, Sphere};

pub(super) fn lines(line: &Line, sphere: &Sphere, equations: &[LineEquation]) -> Vec<String> {
    let mut lines: Vec<String> = Sphere::INFO
        .equations
        .iter()
        .map(ToString::to_string)
        .collect();
    for equation in equations {
        let f = line.origin - sphere.centre.as_dvec3();
        lines.push(format!("f = o − c = {}", point(f)));
        lines.push("p = r(t): 0 = (d·d) t² + 2 (f·d) t + f·f − r²".to_owned());
        lines.push(format!("0 = {}", polynomial(&equation.coefficients)));
        if let &[c, b, a] = &equation.coefficients[..] {
            let product = format!("4·{}·{}", operand(a), operand(c));
            let square = operand(b);
            let discriminant = text(b * b - 4.0 * a * c);
            lines.push(format!(
                "discriminant: {square}² − {product} = {discriminant}"
            ));
        }
        lines.push(roots(equation));
    }
    lines
}
