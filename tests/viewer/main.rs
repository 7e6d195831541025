//! Integration tests of the viewer.

// The real app, driven by label and key.
mod app;
// The built program's exit statuses, and what it does without a display.
mod cli;
// The built program beside others on a display.
mod desktop;
// The overlay in slices, and on a GPU with small buffers.
mod gpu;
// What is done about names in the environment that can't be used.
mod environment;
// The app in a harness, and the gate for tests that need a GPU.
mod harness;
// Standard input, warnings, and a machine that lacks memory or threads.
#[cfg(unix)]
mod machine;
// What is made of the file: flaws, changes, creases.
mod mesh;
// Before, while and after a file is opened.
mod opening;
// Files that the program writes.
#[cfg(unix)]
mod outputs;
// What the overlay draws.
mod overlay;
// The pointer on its picture.
mod pointer;
// The built program, run in a folder.
mod program;
// `render --wireframe` and `--normals`, pixel by pixel.
mod render_lines;
// Every shader parses and validates, without a GPU.
mod shaders;
// The built program's answers to rays that come through a pipe.
mod trace;
// What the rasterizer draws is what the rays hit, pixel by pixel.
mod triangle_ids;
// Faults of the command line.
mod usage;
// The built program in a real window.
mod window;
// Views that compare kernels, and the Trade tab.
mod trade;
