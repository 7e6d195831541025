//! Ray–cone test with a discriminant that doesn't cancel far from the apex.
//!
//! Source: Press et al., Numerical Recipes, 1986, for the roots; the discriminant is derived here.
//! Differs from it: nothing.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions about rays that pass close to the apex.
//!
//! With F = f×w, D = d×w, k = f·w, m = d·w and the length |w|, Lagrange's identity turns b² − ac into
//! |w|²·(r²·|m·F − k·D|² − |w|²·|F×D|²). All are divided by powers of |w|², as the discriminant would over- or underflow
//! at sizes of 10⁴ and 10⁻⁴ in f32. F×D is parallel to w and grows with the distance between ray and axis alone.
//!
//! A ray along a generator has a discriminant of 0 at any height above the surface, so that rounding decides. In f32, a
//! discriminant within its error is computed again in f64, and so is a small a. With p = |f|·|w| and q = |d|·|w|, k and F err by 4u·p, m and D
//! by 3u·q, m·F − k·D by 16u·p·q, and F×D by 9u·p·q.

use crate::kernel::crossings::{Nearest, Roots};
use crate::kernel::cylinder::{offer_cap, offer_side};
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, cross, dot, minus, times};
use crate::ray::Ray;
use crate::shape::{BASE, Cone, Shape as _};

/// See the [module](self).
pub(super) struct Stable;

impl Kernel for Stable {
    type Shape = Cone;
    const IN_F32: KernelInfo = KernelInfo {
        name: "cone-stable",
        title: "Lagrange, Press",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Press et al., Numerical Recipes, 1986",
        summary: "Accurate for thin and distant cones.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "cone-stable-f64",
        title: "Lagrange, Press, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "Correct to the last place of f32 but for grazing rays.",
        ..Self::IN_F32
    };
    const IS_ADAPTIVE: bool = true;
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = RayLanes<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        shapes: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        // From the apex towards the base.
        let (apex, base) = (shapes.three(3), shapes.three(0));
        let (w, f) = (minus(&base, &apex), minus(&ray.origin, &apex));
        let (from, step) = (cross(&f, &w), cross(&ray.dir, &w));
        let along = [dot(&f, &w), dot(&ray.dir, &w)];
        let (length_squared, r) = (dot(&w, &w), shapes.value(6));
        let r_squared = r * r;
        // a, b and c divided by |w|⁴, the discriminant by |w|⁸.
        let per_length = L::of(r.token(), 1.0) / length_squared;
        let slope = r_squared * per_length;
        let a = per_length * (dot(&step, &step) - slope * along[1] * along[1]);
        let b = per_length * (dot(&from, &step) - slope * along[0] * along[1]);
        let c = per_length * (dot(&from, &from) - slope * along[0] * along[0]);
        let turned = minus(&times(along[1], &from), &times(along[0], &step));
        let turned = times(per_length, &turned);
        let wound = times(per_length, &cross(&from, &step));
        let [of_turned, of_wound] = [dot(&turned, &turned), dot(&wound, &wound)];
        let discriminant = slope * of_turned - of_wound;
        let doubtful = if L::Number::HOLDS_PRODUCTS {
            t_max.lt(t_max)
        } else {
            let u = L::splat(r.token(), L::Number::U);
            let reach = u * (dot(&f, &f) * dot(&ray.dir, &ray.dir)).sqrt();
            let [two, four] = [2.0, 4.0].map(|x| L::of(r.token(), x));
            // The error of a square of which the root errs by some of `reach`.
            let of_square = |square: L, factor: f32| {
                let error = L::of(r.token(), factor) * reach;
                (two * square.sqrt() + error) * error + four * u * square
            };
            let error = slope * of_square(of_turned, 16.0) + of_square(of_wound, 9.0);
            // The far root is q/a, and a errs by 16u of its terms; it is trusted to 2⁻⁶.
            let terms = per_length * (dot(&step, &step) + slope * along[1] * along[1]);
            discriminant.abs().le(error) | a.abs().le(L::of(r.token(), 1024.0) * u * terms)
        };
        let roots = Roots::press(a, b, c, discriminant);
        let mut nearest = Nearest::new(t_min, t_max);
        offer_side(&mut nearest, &roots, along, length_squared);
        let (across, reach) = ([&from, &step], r_squared * length_squared);
        let base = (BASE, length_squared);
        offer_cap(&mut nearest, shapes.value(7), across, along, base, reach);
        nearest.hit_or_doubt(doubtful)
    }

    fn decide<N: Number>(ray: &Ray, cone: &impl Values<f32>) -> Option<[N; 3]> {
        let values: [f32; Cone::NUMBERS] = std::array::from_fn(|k| cone.value(k));
        let [start, end] = ray.finite_interval().map(f64::from);
        let rays = RayLanes::of((), ray);
        let hit = Self::intersect::<f64>(&rays, &&values[..], start, end)?;
        let [start, end] = ray.finite_interval().map(N::from);
        let [t, u, v] = [hit.t, hit.u, hit.v].map(N::of_f64);
        hit.mask
            .then(|| [t.greater(start.next_up()).lesser(end.next_down()), u, v])
    }
}
