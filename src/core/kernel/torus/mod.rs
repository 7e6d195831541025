//! Ray–torus kernels and their table.

mod quartic;
mod shifted;
mod unshifted;

use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor, LaneHit};
use crate::lane::{Lane, Values, dot};
use crate::shape::Torus;
use shifted::Shifted;
use std::sync::LazyLock;
use unshifted::Unshifted;

/// All torus kernels, ordered by algorithm.
pub static TORUS_KERNELS: LazyLock<Vec<KernelRow<Torus>>> = LazyLock::new(rows_of);

impl KernelTable for Torus {
    fn kernels() -> &'static [KernelRow<Self>] {
        &TORUS_KERNELS
    }
}

impl KernelList for Torus {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Unshifted, f32>();
        visitor.visit::<Unshifted, f64>();
        visitor.visit::<Shifted, f32>();
        visitor.visit::<Shifted, f64>();
        visitor.visit_algebraic();
    }
}

/// The nearest hit of the points f + s·d with t = s + shift.
///
/// With p·p = αs² + 2βs + |f|², γ = |f|² + R² − r², and the unit axis w: (αs² + 2βs + γ)² = 4R²·|p×w|².
#[inline(always)]
fn nearest_root<L: Lane>(
    tori: &impl Values<L>,
    f: &[L; 3],
    d: &[L; 3],
    shift: L,
    [t_min, t_max]: [L; 2],
) -> Option<LaneHit<L>> {
    let constant = |x: f32| L::of(t_min.token(), x);
    let (axis, major, minor) = (tori.three(3), tori.value(6), tori.value(7));
    let (alpha, beta, squared) = (dot(d, d), dot(f, d), dot(f, f));
    let gamma = squared + major * major - minor * minor;
    let axis_squared = dot(&axis, &axis);
    let (m, k) = (dot(d, &axis), dot(f, &axis));
    let across = [
        squared - k * k / axis_squared,
        beta - m * k / axis_squared,
        alpha - m * m / axis_squared,
    ];
    let four = constant(4.0);
    let four_major = four * major * major;
    let coefficients = [
        gamma * gamma - four_major * across[0],
        four * beta * gamma - (four_major + four_major) * across[1],
        constant(2.0) * alpha * gamma + four * beta * beta - four_major * across[2],
        four * alpha * beta,
        alpha * alpha,
    ];
    // The ray is within the bounding sphere for at most this long about the point nearest to the centre.
    let reach = (major + minor) * constant(1.0 + 8.0 * f32::EPSILON) / alpha.sqrt();
    let nearest = -beta / alpha;
    let [c0, c1, c2, c3, c4] = coefficients;
    let inputs = [
        c0,
        c1,
        c2,
        c3,
        c4,
        nearest - reach,
        nearest + reach,
        shift,
        t_min,
    ];
    let t = L::map(inputs, |[c0, c1, c2, c3, c4, start, end, shift, t_min]| {
        let roots = quartic::roots(&[c0, c1, c2, c3, c4], [start, end]);
        let after = roots.iter().map(|root| root + shift).find(|t| t_min < *t);
        after.unwrap_or(L::Number::from(f32::NAN))
    });
    let zero = constant(0.0);
    LaneHit::certain(t_min.lt(t) & t.le(t_max), t, zero, zero)
}
