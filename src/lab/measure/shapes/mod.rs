//! Errors of kernels of all shapes for single primitives.
//!
//! | module | content |
//! |---|---|
//! | `samples`, `flat`, `aligned` | random primitives |
//! | `solids` | random combined solids |
//! | `rays` | rays at them |
//! | `cases`, `special` | the cases of every shape, and those of one shape alone |
//! | `cells`, `solid_cells` | wrong decisions and errors of t for primitives and for solids |
//! | `spawning`, `solid_spawning` | self-hits of rays spawned on primitives and on solids |
//!
//! To measure another shape, implement its oracle and `Sampled`, and add a row to each table in `cases`.

mod aligned;
mod cases;
mod cells;
mod flat;
mod rays;
mod samples;
mod solid_cells;
mod solid_spawning;
mod solids;
mod spawning;
mod special;

pub use cases::{ShapeCase, shape_cases, shape_spawn_cases};
pub use cells::ShapeCell;
pub use rays::{Aim, aimed};
pub use samples::Sampled;
pub use solid_spawning::measure_solid_spawning;
pub use solids::SampledSolid;
pub use spawning::{ShapeSpawnCell, SpawnPlace, measure_spawning, spawn_places};
