//! Ray–sphere test that avoids both cancellations of the quadratic equation.
//!
//! Sources: Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems,
//!   2019, which combines the discriminant of Hearn, Baker, Computer Graphics with OpenGL, 2004, with the roots of
//!   Press et al., Numerical Recipes, 1986.
//! Differs from them: nothing.
//! Promises: nothing beyond the measured figures. In f32 the decision errs by a few ulps of the distance from origin
//!   to centre, measured at the sphere.
//! Doesn't promise: right decisions about rays that pass the surface more closely than that.
//!
//! With f = o − c, a = d·d and b = −f·d, the point of the ray nearest to the centre is l = f + (b/a)·d away from it.
//! The discriminant r² − l·l is a difference of numbers of the sphere's size, however far away the origin is. With
//! q = b + sign(b)·√(aΔ), which adds numbers of equal sign, the roots are (f·f − r²)/q and q/a.

use crate::kernel::crossings::Roots;
use crate::kernel::ray_lanes::SquaredRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, Tier};
use crate::lane::{Lane, Number, Values, minus};
use crate::shape::Sphere;

/// See the [module](self).
pub(super) struct HearnBaker;

impl Kernel for HearnBaker {
    type Shape = Sphere;
    const IN_F32: KernelInfo = KernelInfo {
        name: "sphere-hearn-baker",
        title: "Hearn–Baker, Press",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Haines, Günther, Akenine-Möller, Precision Improvements for Ray/Sphere Intersection, 2019",
        summary: "No cancellation: accurate for small, distant and huge spheres.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "sphere-hearn-baker-f64",
        title: "Hearn–Baker, Press, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "No cancellation; t correct to the last place of f32 but for grazing rays.",
        ..Self::IN_F32
    };
    // In f64 the distance of line and centre errs by at most 2⁴u·|f|: `algebra::quick_line` derives it for the same
    // formula.
    const IS_FILTERED: bool = true;
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = SquaredRay<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &SquaredRay<L>,
        spheres: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let r = spheres.value(3);
        let f = minus(&ray.origin, &spheres.three(0));
        let roots = Roots::at_distance(&f, &ray.dir, ray.dir_squared, r * r);
        roots.nearest(t_min, t_max)
    }
}

#[cfg(test)]
mod tests {
    use crate::algebra::{Dyadic, Ring, cross, difference, squared_length, vector};
    use crate::kernel::KernelTable;
    use crate::random::Random;
    use crate::ray::Ray;
    use crate::shape::{Shape, Sphere, numbers_of};
    use std::cmp::Ordering;

    /// Whether the ray's line misses the sphere in exact arithmetic: |f×d|² > r²·|d|².
    fn misses(ray: &Ray, sphere: &Sphere) -> bool {
        let f = difference(&vector::<Dyadic>(ray.origin), &vector(sphere.centre));
        let dir = vector(ray.dir);
        let reach = Dyadic::from(sphere.radius)
            .square()
            .times(&squared_length(&dir));
        squared_length(&cross(&f, &dir)).minus(&reach).sign() == Ordering::Greater
    }

    #[test]
    fn filtered_spheres_are_missed_exactly_and_in_f64() {
        let mut random = Random::new(50);
        let kernel = Sphere::kernel("sphere-hearn-baker-f64").expect("in the table");
        let (mut missed_count, mut filtered_count) = (0, 0);
        for _ in 0..100_000 {
            // Spheres of any size at any distance, and rays that pass their surface closely.
            let scale = 2f64.powi(random.index(81) as i32 - 40);
            let radius = scale * (0.1 + random.unit());
            let sphere = Sphere {
                centre: (scale * random.in_cube()).as_vec3(),
                radius: radius as f32,
            };
            let across = random.direction();
            let along = random.direction().cross(across);
            let gap = 10f64.powi(-(random.index(9) as i32)) * (random.unit() - 0.2);
            let away = radius * 10f64.powi(random.index(6) as i32) * random.unit();
            let origin = sphere.centre.as_dvec3() + radius * (1.0 + gap) * across - away * along;
            let dir = along * 2f64.powi(random.index(41) as i32 - 20);
            let Ok(ray) = Ray::new(origin.as_vec3(), dir.as_vec3()) else {
                continue;
            };
            let line = [&ray.origin.to_array(), &ray.dir.to_array()];
            let may_meet = Sphere::may_meet(line, &numbers_of(&sphere)).expect("a filter");
            missed_count += usize::from(misses(&ray, &sphere));
            if !may_meet {
                filtered_count += 1;
                assert!(misses(&ray, &sphere), "{ray:?} {sphere:?}");
                assert_eq!(kernel.intersect(&ray, sphere), None, "{ray:?} {sphere:?}");
            }
        }
        // Gaps below some 10⁻⁶·|f| aren't filtered.
        assert!(
            3 * filtered_count > missed_count,
            "{filtered_count} of {missed_count}"
        );
    }
}
