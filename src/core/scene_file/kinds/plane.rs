//! Planes: the parameters are one of four descriptions.

use super::Kind;
use crate::scene_file::parameters::Parameters;
use crate::scene_file::problem::Problem;
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use crate::shape::PlaneForm;
use glam::DVec3;

/// An infinite plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of the plane.
    pub point: DVec3,
    /// Its normal, of any length except 0.
    pub normal: DVec3,
}

impl Kind for Plane {
    const NAME: &'static str = "plane";

    /// A plane by a point and a normal, by a point and two vectors, by three points, or by an equation.
    fn read(parts: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        let parameters = &mut parts.parameters;
        let form = form(parameters)?;
        if is_degenerate(&form) {
            return Err(parameters.problem(match form {
                PlaneForm::PointAndVectors { .. } => "“v” and “w” are parallel",
                PlaneForm::ThreePoints(_) => "“p0”, “p1” and “p2” are collinear",
                PlaneForm::PointAndNormal { .. } => "“normal” is zero",
                PlaneForm::Equation { .. } => "“a”, “b” and “c” are zero",
            }));
        }
        Ok(Self {
            point: form.point(),
            normal: form.normal(),
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        writer.point("point", self.point)?;
        writer.vector("normal", self.normal)
    }
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

/// The ways to describe a plane, each by its parameters besides `point`. A plane has one description.
const FORMS: [&[&str]; 4] = [
    &["p0", "p1", "p2"],
    &["a", "b", "c", "d"],
    &["v", "w"],
    &["normal"],
];

/// Checks that a plane has one description.
///
/// # Errors
/// Parameters of two descriptions are given.
fn require_one_form(parameters: &Parameters) -> Result<(), Problem> {
    let mut given = FORMS
        .iter()
        .filter_map(|form| Some((form[0], parameters.place_of(form)?)));
    match (given.next(), given.next()) {
        (Some((first, _)), Some((second, place))) => {
            let message = format!(
                "a plane is described by “p0”, “p1” and “p2”, by “a”, “b”, “c” and “d”, by “point”, “v” and “w”, or by “point” and “normal”, not by both “{first}” and “{second}”"
            );
            Err(Problem::at(place, message))
        }
        _ => Ok(()),
    }
}

fn form(parameters: &mut Parameters) -> Result<PlaneForm, Problem> {
    require_one_form(parameters)?;
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
