//! Integration tests of hitscope-lab.

// What the commands print, and what they refuse.
mod commands;
// A folder with a mesh, for tests of commands.
mod folder;
// Lines, numbers and rounding of `trace`.
mod trace;
// How the commands load a mesh, and what `info` tells of it.
mod loading;
// Inspection of single rays against the exact answer.
mod inspection;

// The exact kernel against the oracle; the accurate ones where f64 suffices.
mod exact;

// The table in docs/accuracy.md is what the laboratory measures.
mod accuracy;

// The lecture's slips.
mod lecture;

// From which distance on a scene requires more than `fast`.
mod requirement;

// Closed meshes, boxes, leaving rays.
mod watertight;
