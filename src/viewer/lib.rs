//! hitscope's viewer: a progressively ray-traced picture, the mesh's lines over it, and the inspection of
//! clicked pixels.
//!
//! | module | contents |
//! |---|---|
//! | [`cli`] | the command line |
//! | [`app`] | the app: its state and the order of a frame |
//! | [`bindings`] | keys and pointer |
//! | [`display`] | the display server of the window |
//! | [`document`], [`opening`], [`watch`] | the open file, opening it, and watching it for changes |
//! | [`tracer`] | the picture in progress |
//! | [`trade`] | speed and accuracy of each kernel in this scene |
//! | [`task`] | background work |
//! | [`overlay`], [`gpu`] | drawing the picture, and lines over it |
//! | [`face_lookup`], [`flaw_place`] | the picked face in its file, and the place of a flaw |
//! | [`numbers`], [`theme`] | numbers as text, and colours |
//! | [`panels`], [`settings`] | the side panel and the settings |
//! | [`storage`], [`window`] | settings kept between runs, and the window itself |
//! | [`offscreen`], [`screenshot`] | pictures in files |

pub mod app;
pub mod bindings;
pub mod cli;
pub mod display;
pub mod document;
pub mod face_lookup;
pub mod flaw_place;
pub mod gpu;
pub mod numbers;
pub mod offscreen;
pub mod opening;
pub mod overlay;
pub mod panels;
pub mod screenshot;
pub mod settings;
pub mod storage;
pub mod task;
pub mod theme;
mod times;
pub mod tracer;
pub mod trade;
pub mod watch;
pub mod window;

// The library's own tests use the harness of the integration tests.
#[cfg(test)]
extern crate self as hitscope;
#[cfg(test)]
#[path = "../../tests/viewer/harness.rs"]
#[expect(
    dead_code,
    reason = "its other functions are for the integration tests"
)]
mod harness;
