//! Integration tests of the viewer.

// The real app, driven by labels and keys.
mod app;
// Tests in a process of their own.
mod alone;
// Names of all controls for assistive technology.
mod accessibility;
// The sides of a comparison: clicks, picks, rasterized sides.
mod compared_sides;
// Comparisons with another view, kernel, mesh or picture.
mod comparing;
// Comparisons that are incomplete.
mod comparison_states;
// The program's exit statuses and its behaviour without a display.
mod cli;
// Commands by key, tool bar, menu and palette; the help sheet.
mod commands;
// The program on a display: clipboard, closing, stored settings and fonts.
mod desktop;
// Frames that an unchanged window asks for.
mod idle;
// Random actions, and the memory after them.
mod monkey;
// Windows of all sizes and scales.
mod sizes;
// A device that is lost.
mod lost_device;
// The overlay in slices and on a GPU with small buffers.
mod gpu;
// Unusable graphics backends and display servers in the environment.
mod environment;
// Toasts, the log, pictures of the screen and the quality.
mod feedback;
// Recent files, and the files beside the open one.
mod files;
// Time of the window's thread per frame.
#[cfg(target_os = "linux")]
mod frames;
// The app in a test harness, and the gate for tests that need a GPU.
mod harness;
// Standard input, warnings, and machines that lack memory or threads.
#[cfg(unix)]
mod machine;
// Views that need lights: their options, noise and limits.
mod light;
// Man pages, shell completions and desktop files.
mod packaging;
// The path of a picked pixel's sample.
mod paths;
// The list of picks in undo and in sessions.
mod pick_list;
// Pictures of any size.
mod picture_dialog;
// Flaws, reloading and creases of the open mesh.
mod mesh;
// The window before, during and after opening a file.
mod opening;
// The files that the program writes.
#[cfg(unix)]
mod outputs;
// The overlay's lines, places and colours.
mod overlay;
// Every row of the overlay table, in the window and without one.
mod overlay_table;
// The list of picks, measuring, the read-out, going to elements.
mod inspecting;
// The pointer while the camera moves.
mod moving;
// The pointer on the picture.
mod pointer;
// The program, run in a folder.
mod program;
// The pixels of `render --overlay`.
mod render_lines;
// Scene files: views, crossings, saving, kernels by shape.
mod scene_files;
// Sessions; undo and redo.
mod sessions;
// Validation of the shaders without a GPU.
mod shaders;
mod shown;
// Sizes and places of the tool bar, the palette, the help sheet and dialogs.
mod sheets;
// `trace` on a pipe.
mod trace;
// Comparison of rasterized and traced triangles.
mod triangle_ids;
// Usage errors.
mod usage;
// The program in a real window.
mod window;
// Views that compare kernels, and the Trade tab.
mod trade;
// Navigation with the pointer, and animated views.
mod navigation;
// The magnified picture, and the values in its pixels.
mod magnifier;
// The list of parts.
mod parts;
// The view as text, copied and pasted.
mod view_text;
