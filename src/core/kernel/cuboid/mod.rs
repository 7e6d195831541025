//! Ray–box kernels and their table.

mod faces;
mod slabs;

use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::aabb::Planes;
use crate::lane::{Lane, Number, Values};
use crate::shape::Cuboid;
use faces::Faces;
use slabs::Slabs;
use std::sync::LazyLock;

/// All box kernels, ordered by algorithm.
pub static CUBOID_KERNELS: LazyLock<Vec<KernelRow<Cuboid>>> = LazyLock::new(rows_of);

impl KernelTable for Cuboid {
    fn kernels() -> &'static [KernelRow<Self>] {
        &CUBOID_KERNELS
    }
}

impl KernelList for Cuboid {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visitor.visit::<Slabs, f32>();
        visitor.visit::<Slabs, f64>();
        visitor.visit::<Faces, f32>();
        visitor.visit::<Faces, f64>();
        visitor.visit_algebraic();
    }
}

/// The number of packed values: the centre, three rows that map a point relative to it to coordinates from −1 to 1, and
/// half the edges of the bounding box.
const VALUES: usize = 15;

fn pack<N: Number>(cuboid: &Cuboid, values: &mut [N]) {
    let (rows, det) = cuboid.cofactors();
    let half = cuboid.half_extent();
    let rows = rows.map(|row| row / det);
    let vectors = [
        cuboid.centre.as_dvec3(),
        rows[0],
        rows[1],
        rows[2],
        half.as_dvec3(),
    ];
    for (vector, kept) in vectors.iter().zip(values.chunks_exact_mut(3)) {
        kept.copy_from_slice(&vector.to_array().map(N::of_f64));
    }
}

#[inline(always)]
fn bounds<L: Lane>(cuboids: &impl Values<L>) -> Planes<L> {
    Cuboid::around(cuboids.three(0), cuboids.three(12))
}
