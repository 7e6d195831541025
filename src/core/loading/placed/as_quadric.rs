//! The quadrics that transformed cylinders and cones are, for messages.

use super::axial::{Axial, Tip, rounded};
use super::axis_of;
use super::quadric::coefficients;
use crate::scene_file::{number_text, vector_text};
use crate::shape::ellipse_reach;
use glam::{DMat3, DMat4, DVec3};

/// Part by which the box of a quadric is larger than it, so that rounding can't cut the surface where it touches the box.
const MARGIN: f64 = 1e-5;

/// The parameters of the quadric with the surface of a transformed cylinder or cone, as text. Coefficients that aren't
/// named are 0. The box ends the surface where the shape ends if there is an [`axis_along`].
pub(super) fn quadric_of(shape: &Axial, to_world: &DMat4) -> String {
    /// As many as f32 needs.
    const DIGITS: usize = 9;
    let short = |number: f64| rounded(number, DIGITS);
    let named = "abcdefghij".chars().zip(coefficients_of(shape, to_world));
    let coefficients = named
        .filter(|&(_, value)| value != 0.0)
        .map(|(name, value)| format!("{name} = {}", number_text(short(value))));
    let corner =
        |name: &str, corner: DVec3| format!("{name} = ({})", vector_text(corner.map(short)));
    let [min, max] = box_of(shape, to_world);
    let corners = [corner("min", min), corner("max", max)];
    coefficients.chain(corners).collect::<Vec<_>>().join(", ")
}

/// The coordinate axis along which the transformed axis points, if it does.
pub(super) fn axis_along(shape: &Axial, to_world: &DMat4) -> Option<usize> {
    let [p0, p1] = shape.ends;
    axis_of(DMat3::from_mat4(*to_world) * (p1 - p0))
}

/// The coefficients a to j.
///
/// A cylinder is |f|² − (f·w)² = r² and a cone |f|² − (1 + r²/h²)(f·w)² = 0, for the unit axis w and f from a point of
/// the axis, which is the apex of a cone.
fn coefficients_of(shape: &Axial, to_world: &DMat4) -> [f64; 10] {
    let [p0, p1] = shape.ends;
    let (axis, height) = ((p1 - p0).normalize(), (p1 - p0).length());
    let squared_radius = shape.radius * shape.radius;
    let (from, along, constant) = match shape.tip {
        Tip::Round => (p0, 1.0, -1.0),
        Tip::Pointed => (p1, 1.0 + (shape.radius / height).powi(2), 0.0),
    };
    let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    let local = (DMat3::IDENTITY - outer * along) * (1.0 / squared_radius);
    let inverse = DMat3::from_mat4(*to_world).inverse();
    let q = inverse.transpose() * local * inverse;
    let from = to_world.transform_point3(from);
    let slope = -(q * from);
    // What rounding leaves of a 0.
    let most = |numbers: &[f64]| numbers.iter().fold(0.0, |most, x| x.abs().max(most));
    let of_q = most(&q.to_cols_array());
    let without_residue = |x: f64, size: f64| if x.abs() <= 1e-14 * size { 0.0 } else { x };
    let size = of_q * from.length();
    coefficients(
        DMat3::from_cols_array(&q.to_cols_array().map(|x| without_residue(x, of_q))),
        slope.map(|x| without_residue(x, size)),
        constant - slope.dot(from),
    )
}

/// The lowest and the highest corner of the quadric's box.
fn box_of(shape: &Axial, to_world: &DMat4) -> [DVec3; 2] {
    let linear = DMat3::from_mat4(*to_world);
    let axis = shape.ends[1] - shape.ends[0];
    let (u, v) = axis.normalize().any_orthonormal_pair();
    let [u, v] = [u, v].map(|across| linear * (shape.radius * across));
    let reach = DVec3::from([0, 1, 2].map(|k| ellipse_reach(u[k], v[k])));
    let [p0, p1] = shape.ends.map(|end| to_world.transform_point3(end));
    let [min, max] = match shape.tip {
        Tip::Round => [p0.min(p1) - reach, p0.max(p1) + reach],
        Tip::Pointed => [(p0 - reach).min(p1), (p0 + reach).max(p1)],
    };
    let mut margin = MARGIN * 0.5 * (max - min);
    if let Some(k) = axis_along(shape, to_world) {
        // Here the box ends the surface.
        margin[k] = 0.0;
    }
    [min - margin, max + margin]
}
