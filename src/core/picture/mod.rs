//! Pictures for and from other programs: linear, with what denoisers need; distances, and numbers of surfaces.
//!
//! | part | file |
//! |---|---|
//! | what each pixel shows first: albedo, normal, depth, primitive | `guides` |
//! | the surface in the centre of each pixel | `surfaces` |
//! | the part of each pixel that surfaces cover | `alpha` |
//! | OpenEXR files | `open_exr` |
//! | parallel tracing | `rows` |
//! | pictures from files | `file` |

mod alpha;
mod file;
mod guides;
mod open_exr;
mod rows;
mod surfaces;

pub use alpha::{Alpha, shown_pixels};
pub use file::{PictureEncoding, PictureFile};
pub use guides::{Guide, Guides, guides};
pub use open_exr::{NO_PRIMITIVE, PictureError, write_depth, write_exr, write_ids};
pub use rows::TraceError;
pub use surfaces::{SurfaceIds, VisibleSurface, VisibleSurfaces};
