//! Which pixel is traced when, and by which thread?
//!
//! A [`Job`] says what to render; [`Renderer`] has threads that take its tiles one after the other
//! and send them back over a bounded channel. Posting a job makes the one before stale: its threads
//! notice within a pixel, and what still arrives is dropped.

mod job;
pub mod plan;
mod worker;

pub use job::{Job, RenderPanic, TileResult, render};
pub use worker::{Message, Renderer};
