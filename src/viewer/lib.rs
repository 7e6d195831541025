//! hitscope's window: a progressive ray tracer's picture, the mesh's lines over it, and what a click
//! on a pixel tells.
//!
//! | module | answers |
//! |---|---|
//! | [`cli`] | what was asked for on the command line? |
//! | [`app`] | what is in the window, and what does a frame do? |
//! | [`bindings`] | which key does what? |
//! | [`document`], [`opening`], [`watch`] | what is open, how does a file get there, and when again? |
//! | [`tracer`] | what is being traced? |
//! | [`trade`] | what does speed cost in accuracy in this scene? |
//! | [`task`] | what runs in the background? |
//! | [`overlay`], [`gpu`] | how does the picture get on the screen, and what is drawn over it? |
//! | [`panels`], [`settings`] | what can be read and chosen at the side? |
//! | [`storage`], [`window`] | what is kept between runs, and how large is the window? |
//! | [`offscreen`], [`screenshot`] | how do pictures get into files? |

pub mod app;
pub mod bindings;
pub mod cli;
pub mod document;
pub mod gpu;
pub mod offscreen;
pub mod opening;
pub mod overlay;
pub mod panels;
pub mod screenshot;
pub mod settings;
pub mod storage;
pub mod task;
mod times;
pub mod tracer;
pub mod trade;
pub mod watch;
pub mod window;
