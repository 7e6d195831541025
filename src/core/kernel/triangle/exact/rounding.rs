//! t, u and v of several hits, one per lane, to little more than half an ulp of f32.

use super::{VALUES, filter};
use crate::kernel::{RayLanes, ShearedRay, axes_of};
use crate::lane::{LANES, Lane, LaneMask, Number, Values};
use crate::ray::Ray;
use fearless_simd::{Simd, f64x8};
use glam::Vec3;

/// Rays and the triangles that they hit, one pair per lane. Each ray's coordinates are permuted so that its
/// dominant axis comes third in every lane.
#[derive(Clone, Copy)]
pub(crate) struct HitLanes {
    origin: [[f32; LANES]; 3],
    dir: [[f32; LANES]; 3],
    corners: [[f32; LANES]; VALUES],
}

/// The values computed from [`HitLanes`].
pub(crate) struct RoundedLanes {
    t: [f64; LANES],
    u: [f64; LANES],
    v: [f64; LANES],
    accurate: u32,
}

impl RoundedLanes {
    /// t, u and v of a lane, if they are [accurate](super::Filtered::is_accurate).
    pub fn of(&self, lane: usize) -> Option<[f64; 3]> {
        let is_accurate = self.accurate >> lane & 1 == 1;
        is_accurate.then(|| [self.t[lane], self.u[lane], self.v[lane]])
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
    };

    /// Stores a ray and the triangle that it hits in a lane.
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
        let rays = RayLanes {
            origin: [
                row(&self.origin, 0),
                row(&self.origin, 1),
                row(&self.origin, 2),
            ],
            dir: [row(&self.dir, 0), row(&self.dir, 1), row(&self.dir, 2)],
            interval: [f64x8::splat(token, 0.0), f64x8::splat(token, f64::INFINITY)],
            axes: [0, 1, 2],
        };
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
        RoundedLanes {
            t: f64::store(t),
            u: f64::store(u),
            v: f64::store(v),
            accurate: is_accurate.bits(),
        }
    }
}
