//! Progressive rendering on several threads.
//!
//! A [`Job`] describes what to render. The threads of a [`Renderer`] trace its tiles in order and return
//! them through a bounded channel. Posting a job makes the previous one stale: threads notice between two
//! batches of rays, and results of the stale job are dropped.

mod job;
mod strips;
mod worker;

pub use job::{
    Job, RenderError, RenderPanic, TileResult, render, render_while, render_with_progress,
};
pub use strips::{STRIP_BYTES, Strip, Strips};
pub use worker::{Message, Renderer};
