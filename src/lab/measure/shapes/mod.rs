//! Errors of kernels of all shapes for single primitives.

mod rays;
mod samples;

pub use rays::{Aim, aimed};
pub use samples::Sampled;
