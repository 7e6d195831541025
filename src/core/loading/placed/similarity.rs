//! Similarities, and maps that keep circles about an axis round.

use glam::{DMat3, DVec3};

/// Relative deviation from a right angle or from equal lengths that is attributed to rounding: composing some rotations
/// in f64. A matrix typed with few digits scales unequally.
const ROUNDING: f64 = 1e-12;

/// The factor of a map that scales all directions equally; `None` for others.
pub(super) fn scale_of(linear: DMat3) -> Option<f64> {
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let squared = x.length_squared();
    let is_near = |a: f64, b: f64| (a - b).abs() <= ROUNDING * squared;
    let is_similar = is_near(y.length_squared(), squared)
        && is_near(z.length_squared(), squared)
        && [x.dot(y), y.dot(z), z.dot(x)]
            .iter()
            .all(|&product| is_near(product, 0.0));
    is_similar.then(|| squared.sqrt())
}

/// Why a map doesn't keep circles about an axis round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Distortion {
    /// It scales by these factors across the axis, at most and at least.
    Elliptic([f64; 2]),
    /// The circles' planes aren't perpendicular to the axis any more.
    Oblique,
}

/// The factor by which a map scales all directions across an axis, if it keeps them perpendicular to the axis.
///
/// # Errors
/// It doesn't.
pub(super) fn scale_across(linear: DMat3, axis: DVec3) -> Result<f64, Distortion> {
    let along = axis.normalize();
    let (u, v) = along.any_orthonormal_pair();
    let [w, u, v] = [linear * along, linear * u, linear * v];
    let squared = u.length_squared();
    let is_zero = |product: f64, size: f64| product.abs() <= ROUNDING * size;
    let is_across = |u: DVec3| is_zero(u.dot(w), u.length() * w.length());
    if !is_across(u) || !is_across(v) {
        return Err(Distortion::Oblique);
    }
    if is_zero(v.length_squared() - squared, squared) && is_zero(u.dot(v), squared) {
        return Ok(squared.sqrt());
    }
    // The half axes of the ellipse: roots of the eigenvalues of the products' matrix. Their product is the area.
    let half_difference = 0.5 * (squared - v.length_squared());
    let mean = 0.5 * (squared + v.length_squared());
    let most = (mean + half_difference.hypot(u.dot(v))).sqrt();
    Err(Distortion::Elliptic([most, u.cross(v).length() / most]))
}
