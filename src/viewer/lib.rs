//! hitscope's viewer: a progressively ray-traced picture with an overlay of lines, and inspection of clicked
//! pixels.
//!
//! | module | contents |
//! |---|---|
//! | [`cli`], [`about`] | the command line; the program's name and version |
//! | [`man`], [`completions`] | man pages and shell completions of the command line |
//! | [`app`] | the app: its state and the order of work in a frame |
//! | [`bindings`] | what drags and the wheel do on the picture |
//! | [`command`] | the commands of keys, buttons and menus, as one table |
//! | [`launch`], [`display`] | opening the window, again if the device is lost; the choice of the display server |
//! | [`document`], [`opening`], [`watch`] | the open file, opening it, and watching it for changes |
//! | [`recent`], [`folder`] | the files that were opened last; the files beside the open one |
//! | [`saving`], [`dialog`] | saving it as a scene file; file dialogs |
//! | [`session`], [`history`] | sessions as plain data; undo and redo |
//! | [`tracer`], [`look`] | tracing of the window's picture; what is shown of it |
//! | [`clip_choice`], [`parts`], [`colour_choice`] | the part of the scene that is shown; the colours of the picture |
//! | [`comparison`] | comparisons with another picture |
//! | [`trade`] | speed and accuracy of each kernel in this scene |
//! | [`task`], [`retired`] | background tasks; large data that they free |
//! | [`toasts`], [`log`], [`log_links`] | short messages about results; all messages, and the links in them |
//! | [`overlay`], [`gpu`] | drawing the picture and its overlay |
//! | [`picks`], [`measuring`], [`go_to`] | the list of picks; measurements between them; going to an element |
//! | [`face_lookup`], [`flaw_place`] | the picked face in its file; the place of a flaw |
//! | [`numbers`], [`theme`] | number formatting; colours |
//! | [`number_field`], [`text_field`] | fields for numbers and for text |
//! | [`panels`], [`tab`] | the contents and names of the side panel's tabs |
//! | [`settings`], [`preferences`] | how the scene is shown; preferences of the window |
//! | [`quality`] | sets of settings from a draft to exact |
//! | [`storage`], [`window`] | storage of settings and preferences; the window's size and end |
//! | [`about_sheet`] | the version, the graphics adapter and the machine, for the window |
//! | [`render`], [`offscreen`], [`screenshot`] | the command `render`; the overlay without a window; `--screenshot` |
//! | [`first_picture`] | the time to the first traced picture |

pub mod about;
pub mod about_sheet;
pub mod app;
pub mod bindings;
pub mod cli;
pub mod clip_choice;
pub mod colour_choice;
pub mod command;
pub mod comparison;
pub mod completions;
pub mod dialog;
pub mod display;
pub mod document;
pub mod face_lookup;
pub mod first_picture;
pub mod flaw_place;
pub mod folder;
pub mod go_to;
pub mod gpu;
pub mod history;
pub mod launch;
pub mod log;
pub mod log_links;
pub mod look;
pub mod man;
pub mod measuring;
pub mod number_field;
pub mod numbers;
pub mod offscreen;
pub mod opening;
pub mod overlay;
pub mod panels;
pub mod parts;
pub mod picks;
pub mod preferences;
pub mod quality;
pub mod recent;
pub mod render;
pub mod retired;
pub mod saving;
pub mod screenshot;
pub mod session;
pub mod settings;
pub mod storage;
mod subcommand;
pub mod tab;
pub mod task;
pub mod text_field;
pub mod theme;
mod times;
pub mod toasts;
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
    reason = "its other functions are used by the integration tests"
)]
mod harness;

// glibc keeps much of the memory of closed files; see Cargo.toml.
#[cfg(target_os = "linux")]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;
