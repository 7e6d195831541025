//! Descriptions of the kernels of combined solids: each tier uses the shapes' kernels of that tier.

use crate::kernel::{KernelInfo, Precision, Promises, Tier, algebraic};

/// All kernels of solids, the tiers in their order.
pub static CSG_KERNELS: [&KernelInfo; 4] = [&FAST, &WATERTIGHT, &PRECISE, &algebraic::INFO];

static FAST: KernelInfo = KernelInfo {
    name: "solid-fast",
    title: "Solids, fast",
    tier: Some(Tier::Fast),
    precision: Precision::F32,
    source: "Roth, Ray Casting for Modeling Solids, 1982",
    summary: "The shapes' fast kernels; crossings ordered as computed.",
    promises: Promises {
        is_watertight: false,
        is_accurate: false,
        is_exact: false,
        is_translation_invariant: true,
    },
};

static WATERTIGHT: KernelInfo = KernelInfo {
    name: "solid-watertight",
    title: "Solids, watertight",
    tier: Some(Tier::Watertight),
    summary: "The shapes' watertight kernels; crossings ordered as computed.",
    ..FAST
};

static PRECISE: KernelInfo = KernelInfo {
    name: "solid-precise",
    title: "Solids, precise",
    tier: Some(Tier::Precise),
    precision: Precision::F64,
    summary: "The shapes' precise kernels; crossings ordered as computed.",
    ..FAST
};

/// The kernel that serves a tier.
pub(super) fn kernel_of(tier: Tier) -> &'static KernelInfo {
    match tier {
        Tier::Fast => &FAST,
        Tier::Watertight => &WATERTIGHT,
        Tier::Precise => &PRECISE,
        Tier::Exact => &algebraic::INFO,
    }
}
