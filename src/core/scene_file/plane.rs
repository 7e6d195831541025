//! The parameters of a plane: one of its four descriptions.

use super::description::ShapeKind;
use super::parameters::Parameters;
use super::problem::Problem;
use crate::shape::PlaneForm;
use glam::DVec3;

/// A plane by a point and a normal, by a point and two vectors, by three points, or by an equation.
///
/// # Errors
/// The parameters define no plane.
pub(super) fn plane(parameters: &mut Parameters) -> Result<ShapeKind, Problem> {
    let form = form(parameters)?;
    let normal = form.normal();
    if is_degenerate(&form) {
        return Err(parameters.problem(match form {
            PlaneForm::PointAndVectors { .. } => "“v” and “w” are parallel",
            PlaneForm::ThreePoints(_) => "“p0”, “p1” and “p2” are collinear",
            PlaneForm::PointAndNormal { .. } => "“normal” is zero",
            PlaneForm::Equation { .. } => "“a”, “b” and “c” are zero",
        }));
    }
    Ok(ShapeKind::Plane {
        point: form.point(),
        normal,
    })
}

/// Whether a description describes no plane, up to rounding: each component of a cross product errs by 2u of two products
/// of components, which are at most |v||w|.
fn is_degenerate(form: &PlaneForm) -> bool {
    let size = match form.to_point_and_vectors() {
        PlaneForm::PointAndVectors {
            vectors: [v, w], ..
        } => v.length() * w.length(),
        _ => 0.0,
    };
    match form {
        PlaneForm::PointAndVectors { .. } | PlaneForm::ThreePoints(_) => {
            form.normal().length() <= 4.0 * f64::EPSILON * size
        }
        _ => form.normal() == DVec3::ZERO,
    }
}

fn form(parameters: &mut Parameters) -> Result<PlaneForm, Problem> {
    if parameters.has_any(&["p0", "p1", "p2"]) {
        return Ok(PlaneForm::ThreePoints([
            parameters.point("p0", DVec3::ZERO)?,
            parameters.point("p1", DVec3::X)?,
            parameters.point("p2", DVec3::Y)?,
        ]));
    }
    if parameters.has_any(&["a", "b", "c", "d"]) {
        let mut number = |name| {
            let found = parameters.float(name)?;
            Ok::<f64, Problem>(found.map_or(0.0, |(number, _)| number))
        };
        return Ok(PlaneForm::Equation {
            normal: DVec3::new(number("a")?, number("b")?, number("c")?),
            d: number("d")?,
        });
    }
    let has_vectors = parameters.has_any(&["v", "w"]);
    let point = parameters.point("point", DVec3::ZERO)?;
    if has_vectors {
        let vectors = [
            parameters.point("v", DVec3::X)?,
            parameters.point("w", DVec3::Y)?,
        ];
        return Ok(PlaneForm::PointAndVectors { point, vectors });
    }
    let normal = parameters.point("normal", DVec3::Z)?;
    Ok(PlaneForm::PointAndNormal { point, normal })
}
