//! Integration tests of the viewer.

// The real app, driven by label and key.
mod app;
// The built program's commands, and what it does without a display.
mod cli;
// The app in a harness, and the gate for tests that need a GPU.
mod harness;
// What is made of the file: flaws, changes, creases.
mod mesh;
// The pointer on its picture.
mod pointer;
// Every shader parses and validates, without a GPU.
mod shaders;
// What the rasterizer draws is what the rays hit, pixel by pixel.
mod triangle_ids;
// The built program in a real window.
mod window;
// Views that compare kernels, and the Trade tab.
mod trade;
