//! Comparisons of the window's picture, side A, with another picture for the same camera, side B.
//!
//! | file | contents |
//! |---|---|
//! | `choice` | the choices about a comparison, as plain data |
//! | `traced` | a side B that is traced |
//! | `rasterized` | a side B whose visible triangles are found by the GPU's rasterizer |
//! | `reference` | a side B that is a picture in a file |
//! | `difference` | the picture of the differences |
//! | `figures` | the figures of the differences |
//! | `distances` | distances between the surfaces of both sides |

mod choice;
mod difference;
mod distances;
mod figures;
mod rasterized;
mod reference;
mod traced;

pub use choice::{Comparison, GAINS, Mode, Side, Source};
pub use difference::difference_picture;
pub use distances::{DistanceMap, MapKey, MeshDistances, SurfacePair};
pub use figures::{ComparedPictures, Figures, Pixels, Visibility, VisibilityDifference};
pub use rasterized::{Rasterized, RasterizedPicture};
pub use reference::Reference;
pub use traced::TracedSide;
