//! Tables of kernels: one per shape.

use super::{Kernel, KernelInfo, MAX_VALUES, RayLanes, Tier};
use crate::algebra::{LineEquation, Pieces, line_equations};
use crate::lane::Number;
use crate::ray::{Hit, Ray};
use crate::shape::{Shape, Triangle};

/// A row of a shape's table: a kernel in one precision.
pub struct KernelRow<S> {
    /// The kernel's description.
    pub info: &'static KernelInfo,
    one: fn(&Ray, &S) -> Option<Hit>,
    /// t, u and v before they are rounded to f32, if the kernel is exact.
    answer: fn(&Ray, &S) -> Option<[f64; 3]>,
    /// The shape's equations along the ray, if the kernel is exact and solves them.
    equations: fn(&Ray, &S) -> Vec<LineEquation>,
}

impl<S: Shape> KernelRow<S> {
    /// Tests one primitive in scalar arithmetic, bit for bit as the SIMD lanes do.
    ///
    /// The hit's `primitive` is 0. The ray's `exclude` and the primitive's box are ignored.
    pub fn intersect(&self, ray: &Ray, shape: impl Into<S>) -> Option<Hit> {
        (self.one)(ray, &shape.into())
    }
}

/// A shape with a table of kernels.
pub trait KernelTable: KernelList {
    /// The rows, ordered by algorithm, the tiers last. Each tier has one row.
    fn kernels() -> &'static [KernelRow<Self>];

    /// The kernel with this name, or the one that serves the tier with this name.
    fn kernel(name: &str) -> Option<&'static KernelRow<Self>> {
        Self::kernels().iter().find(|row| row.info.answers_to(name))
    }

    /// The kernel that serves a tier.
    fn kernel_of(tier: Tier) -> &'static KernelRow<Self> {
        Self::kernel(tier.name()).expect("every table serves every tier")
    }
}

/// The list of a shape's kernels, from which its table is made.
pub trait KernelList: Shape {
    /// Passes each kernel to a visitor, in the order of the table.
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V);
}

/// Visitor of a shape's kernels, with their types.
pub trait KernelVisitor<S: Shape> {
    /// A kernel that computes in `N`, with code for the baseline of the CPU's SIMD levels alone.
    fn visit<K: Kernel<Shape = S>, N: Number>(&mut self);

    /// As [`visit`](Self::visit), with code for every SIMD level of the CPU. Only for some kernels, as each level
    /// compiles the tree's walk once more.
    fn visit_with_levels<K: Kernel<Shape = S>, N: Number>(&mut self) {
        self.visit::<K, N>();
    }

    /// As [`visit_with_levels`](Self::visit_with_levels) in f32, and traces coherent rays as packets.
    fn visit_with_packets<K: Kernel<Shape = S>>(&mut self) {
        self.visit::<K, f32>();
    }

    /// The exact kernel of triangles.
    fn visit_exact_triangle(&mut self)
    where
        S: From<Triangle> + Into<Triangle>;

    /// The exact kernel of shapes that state their crossings as polynomials.
    fn visit_algebraic(&mut self)
    where
        S: Pieces;

    /// As [`visit_algebraic`](Self::visit_algebraic), with code for every SIMD level of the CPU.
    fn visit_algebraic_with_levels(&mut self)
    where
        S: Pieces,
    {
        self.visit_algebraic();
    }
}

/// The rows of a shape's table.
pub(super) fn rows_of<S: KernelList>() -> Vec<KernelRow<S>> {
    let mut rows = Vec::new();
    S::visit_kernels(&mut rows);
    rows
}

impl<S: Shape> KernelVisitor<S> for Vec<KernelRow<S>> {
    fn visit<K: Kernel<Shape = S>, N: Number>(&mut self) {
        self.push(KernelRow {
            info: K::info::<N>(),
            one: intersect_one::<K, N>,
            answer: |ray, shape| intersect_one::<K, N>(ray, shape).map(widened),
            equations: |_, _| Vec::new(),
        });
    }

    fn visit_exact_triangle(&mut self)
    where
        S: From<Triangle> + Into<Triangle>,
    {
        self.push(KernelRow {
            info: &super::exact::INFO,
            one: |ray, triangle| super::exact::intersect_one(ray, triangle.clone().into().0),
            answer: |ray, triangle| super::exact::answer_for::<f64>(ray, triangle.clone().into().0),
            equations: |_, _| Vec::new(),
        });
    }

    fn visit_algebraic(&mut self)
    where
        S: Pieces,
    {
        self.push(KernelRow {
            info: &super::algebraic::INFO,
            one: super::algebraic::intersect_one,
            answer: super::algebraic::answer,
            equations: line_equations,
        });
    }
}

/// t, u and v of a ray's first hit of a primitive, or `None` for a miss. For views and tables that show a kernel's
/// errors.
///
/// t errs by at most 2⁻³² relatively, the weights of a triangle by at most 2⁻³¹. A NaN or an infinity in the primitive
/// is a miss.
pub fn exact_answer<S: KernelTable>(ray: &Ray, shape: &S) -> Option<[f64; 3]> {
    (S::kernel_of(Tier::Exact).answer)(ray, shape)
}

/// The equations of a shape with a ray's line substituted, part by part; none for a triangle.
pub fn equations_along<S: KernelTable>(ray: &Ray, shape: &S) -> Vec<LineEquation> {
    (S::kernel_of(Tier::Exact).equations)(ray, shape)
}

/// t, u and v of a hit.
fn widened(hit: Hit) -> [f64; 3] {
    [hit.t, hit.u, hit.v].map(f64::from)
}

fn intersect_one<K: Kernel, N: Number>(ray: &Ray, shape: &K::Shape) -> Option<Hit> {
    let mut values = [K::Stored::<N>::default(); MAX_VALUES];
    let values = &mut values[..K::VALUES];
    K::pack::<N>(shape, values);
    let prepared = K::Prepared::<N>::from(RayLanes::of((), ray));
    let [t_min, t_max] = [ray.t_min, ray.t_max].map(N::from);
    let hit = K::intersect(&prepared, &&*values, t_min, t_max)?;
    let [t, u, v] = if hit.doubtful {
        K::decide(ray, &&*values)?
    } else {
        [hit.t, hit.u, hit.v]
    };
    let is_hit = (hit.mask || hit.doubtful) && t < t_max && t.to_f32().is_finite();
    is_hit.then_some(Hit {
        t: t.to_f32(),
        u: u.to_f32(),
        v: v.to_f32(),
        primitive: 0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_are_found_by_name_and_tier_and_both_are_unique() {
        fn check<S: KernelTable>() {
            for kernel in S::kernels() {
                let tier = kernel.info.tier.map(Tier::name);
                for name in [Some(kernel.info.name), tier].into_iter().flatten() {
                    let found = S::kernel(name).expect("in the table");
                    assert!(std::ptr::eq(found, kernel), "{name}");
                    let answers = S::kernels().iter().filter(|row| row.info.answers_to(name));
                    assert_eq!(answers.count(), 1, "{name}");
                }
            }
            assert!(S::kernel("no such kernel").is_none());
            let tiers = [Tier::Fast, Tier::Watertight, Tier::Precise, Tier::Exact];
            for tier in tiers {
                assert_eq!(S::kernel_of(tier).info.tier, Some(tier));
            }
        }
        check::<Triangle>();
    }
}
