//! hitscope's laboratory: exact answers, inspection of single rays, and the commands that need no
//! window.
//!
//! | module | answers |
//! |---|---|
//! | [`oracle`] | what does exact arithmetic say of this ray and this triangle? |
//! | [`inspection`] | what happens to this ray: every kernel beside the exact answer |
//! | [`measure`] | what does speed cost in accuracy? |
//! | [`requirement`] | which tier does a scene require? |
//! | [`report`] | how is what was measured shown? |
//! | [`commands`] | what do `render`, `inspect`, `trace`, `info` and `lab` do? |

pub mod commands;
pub mod inspection;
pub mod measure;
pub mod oracle;
pub mod report;
pub mod requirement;
