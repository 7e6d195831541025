//! Kernels of disks and rectangles, and their tables.

mod plane_first;
mod triple_product;

use super::table::rows_of;
use super::{KernelList, KernelRow, KernelTable, KernelVisitor};
use crate::algebra::Pieces;
use crate::lane::Lane;
use crate::shape::{Disk, Rectangle, Shape};
use plane_first::PlaneFirst;
use std::sync::LazyLock;
use triple_product::TripleProduct;

/// All disk kernels, ordered by algorithm.
pub static DISK_KERNELS: LazyLock<Vec<KernelRow<Disk>>> = LazyLock::new(rows_of);
/// All rectangle kernels, ordered by algorithm.
pub static RECTANGLE_KERNELS: LazyLock<Vec<KernelRow<Rectangle>>> = LazyLock::new(rows_of);

/// A shape in a plane with the coordinates a and b.
trait Outline: Shape + Pieces {
    /// The names of its kernels.
    const NAMES: Names;

    /// Whether the shape contains the point (a/scale, b/scale), given a, b and scale ≥ 0. False for NaN.
    fn contains<L: Lane>(a: L, b: L, scale: L) -> L::Mask;
}

/// The names of a shape's kernels.
struct Names {
    plane_first: &'static str,
    plane_first_f64: &'static str,
    triple_product: &'static str,
    triple_product_f64: &'static str,
}

impl Outline for Disk {
    const NAMES: Names = Names {
        plane_first: "disk-plane-first",
        plane_first_f64: "disk-plane-first-f64",
        triple_product: "disk-triple-product",
        triple_product_f64: "disk-triple-product-f64",
    };

    #[inline(always)]
    fn contains<L: Lane>(a: L, b: L, scale: L) -> L::Mask {
        // Divided first: squares of the numerators over- or underflow sooner.
        let (a, b) = (a / scale, b / scale);
        (a * a + b * b).le(L::of(a.token(), 1.0))
    }
}

impl Outline for Rectangle {
    const NAMES: Names = Names {
        plane_first: "rectangle-plane-first",
        plane_first_f64: "rectangle-plane-first-f64",
        triple_product: "rectangle-triple-product",
        triple_product_f64: "rectangle-triple-product-f64",
    };

    #[inline(always)]
    fn contains<L: Lane>(a: L, b: L, scale: L) -> L::Mask {
        a.abs().le(scale) & b.abs().le(scale)
    }
}

impl KernelTable for Disk {
    fn kernels() -> &'static [KernelRow<Self>] {
        &DISK_KERNELS
    }
}

impl KernelTable for Rectangle {
    fn kernels() -> &'static [KernelRow<Self>] {
        &RECTANGLE_KERNELS
    }
}

impl KernelList for Disk {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visit(visitor);
    }
}

impl KernelList for Rectangle {
    fn visit_kernels<V: KernelVisitor<Self>>(visitor: &mut V) {
        visit(visitor);
    }
}

fn visit<S: Outline, V: KernelVisitor<S>>(visitor: &mut V) {
    visitor.visit::<PlaneFirst<S>, f32>();
    visitor.visit::<PlaneFirst<S>, f64>();
    visitor.visit_with_packets::<TripleProduct<S>>();
    visitor.visit::<TripleProduct<S>, f64>();
    visitor.visit_algebraic();
}
