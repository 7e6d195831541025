//! SIMD levels and cache prefetching.
//!
//! The best level of the CPU is chosen at run time, so a generic build is as fast as a native one. The level
//! changes the speed, never a bit of a result.

use fearless_simd::{Level, Simd};
use std::sync::OnceLock;

/// The environment variable that overrides the level.
pub const VARIABLE: &str = "HITSCOPE_SIMD";

/// A set of SIMD instructions that this machine supports.
#[derive(Clone, Copy, Debug)]
pub struct SimdLevel {
    name: &'static str,
    level: Level,
}

/// Error: the requested level doesn't exist on this machine.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{VARIABLE}={asked}: this machine has {}", available.join(", "))]
pub struct SimdError {
    asked: String,
    available: Vec<&'static str>,
}

impl SimdLevel {
    /// Every level of this machine, in ascending order. The first one is plain code for any CPU.
    pub fn available() -> Vec<Self> {
        let named = |(name, level): (_, Option<Level>)| {
            Some(Self {
                name,
                level: level?,
            })
        };
        levels(Level::new()).into_iter().filter_map(named).collect()
    }

    /// The level that [`VARIABLE`] names, or else the highest.
    ///
    /// # Errors
    /// [`SimdError`] if the variable names no level of this machine.
    pub fn chosen() -> Result<Self, SimdError> {
        static CHOSEN: OnceLock<Result<SimdLevel, SimdError>> = OnceLock::new();
        CHOSEN
            .get_or_init(|| match std::env::var(VARIABLE) {
                Ok(name) => Self::named(&name),
                Err(_) => Ok(Self::strongest()),
            })
            .clone()
    }

    /// The level of this name.
    ///
    /// # Errors
    /// [`SimdError`] if this machine doesn't support it.
    pub fn named(name: &str) -> Result<Self, SimdError> {
        let available = Self::available();
        let found = available.iter().find(|level| level.name == name);
        found.copied().ok_or_else(|| SimdError {
            asked: name.to_owned(),
            available: available.iter().map(|level| level.name).collect(),
        })
    }

    /// The name, as in [`VARIABLE`].
    pub fn name(self) -> &'static str {
        self.name
    }

    /// The default level of the process. An invalid [`VARIABLE`] is ignored here; programs report it at their
    /// start.
    pub fn current() -> Self {
        Self::chosen().unwrap_or_else(|_| Self::strongest())
    }

    pub(crate) fn level(self) -> Level {
        self.level
    }

    fn strongest() -> Self {
        let last = Self::available().pop();
        last.expect("every machine runs plain code")
    }
}

#[cfg(target_arch = "x86_64")]
fn levels(best: Level) -> Vec<(&'static str, Option<Level>)> {
    vec![
        ("fallback", Some(Level::baseline())),
        ("sse4.2", best.as_sse4_2().map(Level::Sse4_2)),
        ("avx2", best.as_avx2().map(Level::Avx2)),
        ("avx512", best.as_avx512().map(Level::Avx512)),
    ]
}

#[cfg(target_arch = "aarch64")]
fn levels(best: Level) -> Vec<(&'static str, Option<Level>)> {
    vec![
        ("fallback", Some(Level::baseline())),
        ("neon", best.as_neon().map(Level::Neon)),
    ]
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn levels(_: Level) -> Vec<(&'static str, Option<Level>)> {
    vec![("fallback", Some(Level::baseline()))]
}

/// The level that every machine of the target supports. Rare queries are compiled for it alone, because each
/// further level compiles every kernel once more.
#[cfg(target_arch = "x86_64")]
pub(crate) type Baseline = fearless_simd::Sse2;

/// The level that every machine of the target supports.
#[cfg(target_arch = "aarch64")]
pub(crate) type Baseline = fearless_simd::Neon;

/// The level that every machine of the target supports.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
pub(crate) type Baseline = fearless_simd::Fallback;

/// The token of [`Baseline`].
pub(crate) fn baseline() -> Baseline {
    #[cfg(target_arch = "x86_64")]
    return Level::baseline().as_sse2().expect("every x86-64 has SSE2");
    #[cfg(target_arch = "aarch64")]
    return Level::baseline().as_neon().expect("every AArch64 has NEON");
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    return fearless_simd::Fallback::new();
}

/// Prefetches `bytes` bytes from the element of this index on. Does nothing if the index is out of range.
#[inline(always)]
pub(crate) fn prefetch<S: Simd, T>(token: S, slice: &[T], index: usize, bytes: usize) {
    #[cfg(target_arch = "x86_64")]
    if let Some(token) = token.level().as_sse2() {
        let first = slice.as_ptr().wrapping_add(index).cast::<i8>();
        let mut offset = 0;
        while offset < bytes {
            line::prefetch(token, first.wrapping_add(offset));
            offset += 64;
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (token, slice, index, bytes);
}

#[cfg(target_arch = "x86_64")]
mod line {
    fearless_simd::kernel!(
        /// Prefetches the cache line at an address, without reading it.
        #[inline(always)]
        pub(super) fn prefetch(_token: Sse2, address: *const i8) {
            std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(address)
        }
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_machine_has_the_fallback_and_levels_are_found_by_name() {
        let available = SimdLevel::available();
        assert_eq!(available[0].name(), "fallback");
        for level in available {
            assert_eq!(
                SimdLevel::named(level.name()).map(|l| l.name),
                Ok(level.name)
            );
        }
        let error = SimdLevel::named("mmx")
            .expect_err("no such level")
            .to_string();
        assert!(
            error.starts_with("HITSCOPE_SIMD=mmx: this machine has fallback"),
            "{error}"
        );
    }
}
