//! The program's name, version and licence, as the command line, the man pages and the window show them.

use std::env::consts::{ARCH, OS};
use std::sync::LazyLock;

/// The name.
pub const NAME: &str = "hitscope";
/// The version number.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// The program in a sentence.
pub const SUMMARY: &str = env!("CARGO_PKG_DESCRIPTION");
/// The licence as an SPDX expression.
pub const LICENCE: &str = env!("CARGO_PKG_LICENSE");

/// The version number with the system that the program was built for: `0.1.0 (x86_64-linux-gnu)`.
pub fn version_and_target() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(|| format!("{VERSION} ({ARCH}-{OS}{LIBC})"));
    &TEXT
}

/// The C library, where a system has several.
const LIBC: &str = if cfg!(target_env = "gnu") {
    "-gnu"
} else if cfg!(target_env = "musl") {
    "-musl"
} else if cfg!(target_env = "msvc") {
    "-msvc"
} else {
    ""
};
