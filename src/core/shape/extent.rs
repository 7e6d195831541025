//! How far disks and ellipses reach along the axes, and planes of boxes rounded outwards.
//!
//! Everything is computed in the lane's numbers: f32 for trees and kernels, f64 for scene files. u is their unit roundoff.
//! Results are larger by the bound of their own error, so that boxes enclose the shapes in exact arithmetic.

use crate::aabb::Planes;
use crate::lane::{Lane, Number, dot};

/// How far the ellipse c + a·u + b·v with a² + b² ≤ 1 reaches from c along an axis, from the components of u and v along
/// it: √(u² + v²).
///
/// Exact if a component is 0. Else never too small, and too large by at most 12u of itself and the least normal number.
/// NaN if a component is.
#[inline(always)]
pub(crate) fn ellipse_reach<L: Lane>(u: L, v: L) -> L {
    let token = u.token();
    let (u, v) = (u.abs(), v.abs());
    let (shorter, longer) = (u.lesser(v), u.greater(v));
    // The square of the quotient errs by 3u. It is at most half of the sum, which makes that 1.5u + u. The root makes it
    // 1.25u + u, and the product adds u. Widening adds 2u: 5.25u.
    let slope = shorter / longer;
    let root = (L::of(token, 1.0) + slope * slope).sqrt();
    let least = L::splat(token, L::Number::LEAST_NORMAL);
    let reach = enlarged(longer * root, 6) + least;
    L::select(shorter.le(L::of(token, 0.0)), u + v, reach)
}

/// How far a disk about an axis through its centre reaches from there along x, y and z: r·√(1 − w_x²/|w|²) and so on for
/// the axis w, of any length. Components of w may have been rounded once.
///
/// Exact if w points along x, y or z. Else never too small, and too large by at most 36u of itself, and by three of the
/// least normal numbers or that part of the radius. At most the radius, and equal to it if w is 0 or infinite.
#[inline(always)]
pub(crate) fn disk_reach<L: Lane>(w: [L; 3], radius: L) -> [L; 3] {
    let token = radius.token();
    let (zero, one) = (L::of(token, 0.0), L::of(token, 1.0));
    let [x, y, z] = [w[0].abs(), w[1].abs(), w[2].abs()];
    let longest = x.greater(y).greater(z);
    // Of a length from 1 to √3, so that the sum of its squares neither over- nor underflows.
    let v = [x / longest, y / longest, z / longest];
    let per_length = radius / dot(&v, &v).sqrt();
    // 1 − w_x²/|w|² cancels for axes near x. It is the sum of the other components' squares, each over |w|²: the disk
    // reaches as far as an ellipse whose half axes have the components r·w_y/|w| and r·w_z/|w|. These err by 8.5u: w by u,
    // v by 2u, |v| by 4.5u; the quotient and the product add 2u. Enlarging adds 2u. Underflow takes half of the least
    // number at most, or that part of the radius.
    let lost = radius.greater(one) * L::splat(token, L::Number::LEAST_NORMAL);
    let component = |w: L, v: L| {
        let enlarged = enlarged(v * per_length, 12) + lost;
        L::select(w.le(zero), zero, enlarged)
    };
    let [x, y, z] = [component(x, v[0]), component(y, v[1]), component(z, v[2])];
    let has_length = zero.lt(longest) & longest.lt(L::of(token, f32::INFINITY));
    let reach = |a: L, b: L| {
        let reach = ellipse_reach(a, b);
        L::select(has_length & reach.lt(radius), reach, radius)
    };
    [reach(y, z), reach(x, z), reach(x, y)]
}

/// The planes of a box, for lower and upper bounds that are correctly rounded sums: each moved outwards by one or two
/// ulps. ε|x| is at least an ulp of x, and the sum errs by half of one; sums for which that product underflows are exact.
#[inline(always)]
pub(crate) fn rounded_outwards<L: Lane>(lower: [L; 3], upper: [L; 3]) -> Planes<L> {
    let [a, c, e] = lower;
    let [b, d, f] = upper;
    [below(a), above(b), below(c), above(d), below(e), above(f)]
}

/// x moved up by one or two ulps.
#[inline(always)]
pub(crate) fn above<L: Lane>(x: L) -> L {
    x + x.abs() * epsilon(x.token())
}

/// x moved down by one or two ulps.
#[inline(always)]
fn below<L: Lane>(x: L) -> L {
    x - x.abs() * epsilon(x.token())
}

/// 2u.
#[inline(always)]
fn epsilon<L: Lane>(token: L::Token) -> L {
    let u = L::splat(token, L::Number::U);
    u + u
}

/// x·(1 + `roundings`·u), rounded.
#[inline(always)]
fn enlarged<L: Lane>(x: L, roundings: u8) -> L {
    let token = x.token();
    let slack = L::of(token, roundings.into()) * L::splat(token, L::Number::U);
    x * (L::of(token, 1.0) + slack)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::LANES;
    use crate::random::Random;
    use crate::simd::SimdLevel;
    use fearless_simd::{SimdBase as _, dispatch, f32x8};

    /// Any finite number, one in four times 0.
    fn any_number(random: &mut Random) -> f32 {
        if random.index(4) == 0 {
            return 0.0;
        }
        let exponent = random.index(254) as u32 + 1;
        let bits = random.bits() as u32;
        f32::from_bits(bits & 0x807f_ffff | exponent << 23)
    }

    #[test]
    fn lanes_give_the_reach_of_scalars_at_every_level() {
        let mut random = Random::new(1);
        for _ in 0..2000 {
            let mut rows = [(); 4].map(|()| [(); LANES].map(|()| any_number(&mut random)));
            rows[3] = rows[3].map(f32::abs);
            let [x, y, z, radius] = rows;
            for level in SimdLevel::available() {
                let found: [[f32; LANES]; 3] = dispatch!(level.level(), token => {
                    let [x, y, z, radius] = rows.map(|row| f32x8::load_array(token, row));
                    disk_reach([x, y, z], radius).map(|lanes| lanes.to_array())
                });
                for lane in 0..LANES {
                    let alone = disk_reach([x[lane], y[lane], z[lane]], radius[lane]);
                    let found = found.map(|lanes| lanes[lane].to_bits());
                    assert_eq!(found, alone.map(f32::to_bits), "{rows:?} {lane}");
                }
            }
        }
    }

    #[test]
    fn the_reach_is_a_number_for_any_axis() {
        let special = [0.0, -0.0, 1.0, 1e-45, 3e38, f32::INFINITY, f32::NAN];
        for x in special {
            for y in special {
                for z in special {
                    for reach in disk_reach([x, y, z], 2.0) {
                        assert!((0.0..=2.0).contains(&reach), "{x} {y} {z}: {reach}");
                    }
                }
            }
        }
        assert_eq!(disk_reach([0.0; 3], 2.0), [2.0; 3]);
        assert_eq!(disk_reach([0.0, f32::INFINITY, 1.0], 2.0), [2.0; 3]);
        assert_eq!(disk_reach([0.0, -1e-45, 0.0], 2.0), [2.0, 0.0, 2.0]);
    }

    #[test]
    fn the_reach_is_never_too_small_and_hardly_too_large() {
        let mut random = Random::new(2);
        let least = f64::from(f32::MIN_POSITIVE);
        let u = f64::from(f32::EPSILON) / 2.0;
        for _ in 0..200_000 {
            let w = [(); 3].map(|()| any_number(&mut random));
            let radius = any_number(&mut random).abs();
            let exact = w.map(f64::from);
            let length = exact[0].hypot(exact[1]).hypot(exact[2]);
            if length == 0.0 {
                continue;
            }
            for (axis, reach) in disk_reach(w, radius).into_iter().enumerate() {
                let others = exact[(axis + 1) % 3].hypot(exact[(axis + 2) % 3]);
                let expected = f64::from(radius) * (others / length);
                let excess = f64::from(reach) - expected;
                // Rounding of this test in f64.
                let in_test = 1e-14 * expected;
                let most = 36.0 * u * expected + 3.0 * least * f64::from(radius).max(1.0);
                assert!(
                    -in_test <= excess && excess <= most + in_test,
                    "{w:?} {radius} {axis}: {reach:e} {expected:e}"
                );
            }
        }
    }
}
