//! Measurements between picked points of a scene.
//!
//! | measurement | file |
//! |---|---|
//! | the vertex, edge or face that a click means | `snapping` |
//! | distance of two points | `separation` |
//! | angle of three points, or of two normals | `angle` |
//! | circle through three points | `circle` |
//! | thickness of a wall, and clearance in front of it | `thickness` |
//!
//! All are computed in f64 in the coordinates of the points, without absolute tolerances.

mod angle;
mod circle;
mod separation;
mod snapping;
mod thickness;

pub use angle::{angle_at, angle_between};
pub use circle::Circle;
pub use separation::Separation;
pub use snapping::{SnapReach, SnapTarget, Snapped, snap};
pub use thickness::{Thickness, WallPoint, thickness};
