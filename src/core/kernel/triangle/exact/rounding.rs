//! t, u and v of several hits, one per lane, to little more than half an ulp of f32.

use super::{VALUES, filter};
use crate::kernel::{RayLanes, ShearedRay, axes_of};
use crate::lane::{LANES, Lane, LaneMask, Number, Values};
use crate::ray::{Hit, Ray};
use fearless_simd::{Simd, f64x8};
use glam::Vec3;

/// Rays and the triangles that they hit, one pair per lane.
#[derive(Clone, Copy)]
pub(crate) struct HitLanes {
    pub origin: [[f32; LANES]; 3],
    pub dir: [[f32; LANES]; 3],
    pub corners: [[f32; LANES]; VALUES],
    /// The axes of all the rays; see [`RayLanes::axes`].
    pub axes: [usize; 3],
}

/// The values computed from [`HitLanes`], rounded as by [`Candidate::hit`](super::Candidate::hit).
pub(crate) struct RoundedLanes {
    t: [f32; LANES],
    u: [f32; LANES],
    v: [f32; LANES],
    accurate: u32,
}

impl RoundedLanes {
    /// The hit of a lane, if t and the weights are [accurate](super::Filtered::is_accurate).
    #[inline(always)]
    pub fn of(&self, lane: usize, primitive: u32) -> Option<Hit> {
        let is_accurate = self.accurate >> lane & 1 == 1;
        is_accurate.then(|| Hit {
            t: self.t[lane],
            u: self.u[lane],
            v: self.v[lane],
            primitive,
        })
    }
}

/// The corners' coordinates widened to f64.
struct Widened<'a, S> {
    token: S,
    rows: &'a [[f32; LANES]; VALUES],
}

impl<S: Simd> Values<f64x8<S>> for Widened<'_, S> {
    #[inline(always)]
    fn value(&self, index: usize) -> f64x8<S> {
        f64::load(self.token, &self.rows[index])
    }
}

impl HitLanes {
    /// No hits.
    pub const EMPTY: Self = Self {
        origin: [[0.0; LANES]; 3],
        dir: [[0.0; LANES]; 3],
        corners: [[0.0; LANES]; VALUES],
        axes: [0, 1, 2],
    };

    /// Stores a ray and the triangle that it hits in a lane. The coordinates are permuted so that the ray's axes are
    /// [`Self::EMPTY`]'s.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, ray: &Ray, corners: [Vec3; 3]) {
        let lane = lane % LANES;
        let [x, y, z] = axes_of(ray.dir.to_array());
        let permuted = |p: Vec3| [p[x], p[y], p[z]];
        let put = |rows: &mut [[f32; LANES]], p: Vec3| {
            for (row, x) in rows.iter_mut().zip(permuted(p)) {
                row[lane] = x;
            }
        };
        put(&mut self.origin, ray.origin);
        put(&mut self.dir, ray.dir);
        let [a, b, c] = corners;
        put(&mut self.corners[..3], a);
        put(&mut self.corners[3..6], b);
        put(&mut self.corners[6..], c);
    }

    /// Computes t, u and v in each lane.
    #[inline(always)]
    pub fn values<S: Simd>(&self, token: S) -> RoundedLanes {
        let row = |rows: &[[f32; LANES]; 3], k: usize| f64::load(token, &rows[k]);
        let three = |rows| [row(rows, 0), row(rows, 1), row(rows, 2)];
        let (origin, dir) = (three(&self.origin), three(&self.dir));
        let interval = [f64x8::splat(token, 0.0), f64x8::splat(token, f64::INFINITY)];
        let rays = RayLanes::with_axes(origin, dir, interval, self.axes);
        let sheared = ShearedRay::<f64x8<S>>::new(&rays);
        let corners = Widened {
            token,
            rows: &self.corners,
        };
        let Some(filtered) = filter(&sheared, &corners) else {
            return RoundedLanes {
                t: [0.0; LANES],
                u: [0.0; LANES],
                v: [0.0; LANES],
                accurate: 0,
            };
        };
        let is_accurate = filtered.certain & filtered.is_accurate();
        let t = filtered.depth / sheared.dir_z().abs();
        let [u, v] = filtered.weights;
        let mut rounded = RoundedLanes {
            t: [0.0; LANES],
            u: [0.0; LANES],
            v: [0.0; LANES],
            accurate: is_accurate.bits(),
        };
        let (t, u, v) = (f64::store(t), f64::store(u), f64::store(v));
        let mut lane = 0;
        while lane < LANES {
            rounded.t[lane] = rounded_t(t[lane]);
            rounded.u[lane] = u[lane] as f32;
            rounded.v[lane] = v[lane] as f32;
            lane += 1;
        }
        rounded
    }
}

/// t in f32.
#[inline(always)]
pub(super) fn rounded_t(t: f64) -> f32 {
    // Slightly below the largest f32, t may round to infinity.
    (t as f32).min(f32::MAX)
}
