//! The laboratory of hitscope: exact arithmetic, inspection of single rays, measurements, and the commands
//! that need no window.
//!
//! | module | contents |
//! |---|---|
//! | [`oracle`] | the exact answer for a ray and a triangle |
//! | [`inspection`] | one ray: every kernel and the exact answer |
//! | [`element`] | elements by which users name a place |
//! | [`formula`] | the derivation of a hit, in the notation of the lecture |
//! | [`surface_comparison`] | distances between surfaces |
//! | [`surface`] | the surface at a hit |
//! | [`frames`] | rays of f64 in the file's coordinates, as the f32 rays that kernels trace |
//! | [`json`] | JSON whose numbers read back as doubles |
//! | [`json_error`] | messages about invalid JSON for users |
//! | [`measure`] | measurements of speed and accuracy |
//! | [`picture_comparison`] | error figures of pictures |
//! | [`progress`] | progress of long work, and its bar on the terminal |
//! | [`requirement`] | the kernel tier that a scene requires |
//! | [`rounding`] | numbers rounded for text |
//! | [`second_opinion`] | what another reader finds in an OBJ file |
//! | [`report`] | measurements as JSON, HTML and text |
//! | [`viewpoint`] | the window's camera as plain data |
//! | [`commands`] | the commands `render`, `inspect`, `trace`, `info`, `compare`, `lab`, `bench` and `converge` |

pub mod commands;
pub mod element;
pub mod formula;
pub mod frames;
pub mod inspection;
pub mod json;
pub mod json_error;
pub mod measure;
pub mod oracle;
pub mod picture_comparison;
pub mod progress;
pub mod report;
pub mod requirement;
pub mod rounding;
pub mod second_opinion;
pub mod surface;
pub mod surface_comparison;
pub mod viewpoint;
