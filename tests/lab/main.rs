//! Integration tests of hitscope-lab.

// Outputs and errors of the commands.
mod commands;
// A temporary folder with a mesh, for tests of commands.
mod folder;
// `render`: several pictures, formats, and cameras that look at elements.
mod render;
// `compare`: distances between surfaces, differences of pictures.
mod compare;
// `trace`: lines, numbers and rounding.
mod trace;
// Loading meshes, and the output of `info`.
mod loading;
// Meshes compared with what tobj reads.
mod second_opinion;

// Shapes other than triangles.
mod shapes;
// Inspection of single rays against the exact answer.
mod inspection;

// The exact, accurate and watertight kernels against the oracle.
mod exact;

// The commands on scene files with other shapes than triangles.
mod scene_files;

// The commands on scenes that hold only a plane, only a solid, or nothing.
mod bare_scenes;

// Clipped rays, inspections and pictures.
mod clip;
// Pictures of several views, scales and legends.
mod pictures;
// Options of light, and the list of lights.
mod light;
// The error of pictures against time.
mod converge;
// The path of a sample.
mod paths;
// The commands on combined solids.
mod solids;

// The table in docs/accuracy.md matches a new measurement.
mod accuracy;

// The report of all measurements.
mod report;

// Errors in the lecture's programs.
mod lecture;

// The distance above which a scene requires more than `fast`.
mod requirement;

// Watertightness: closed meshes, boxes and spawned rays.
mod watertight;
