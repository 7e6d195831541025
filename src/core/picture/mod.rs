//! Pictures for other programs: linear, with what denoisers need.
//!
//! | part | file |
//! |---|---|
//! | what each pixel shows first: albedo, normal, depth, primitive | `guides` |
//! | the film and its guides as an OpenEXR file | `open_exr` |

mod guides;
mod open_exr;

pub use guides::{Guide, GuideError, Guides, guides};
pub use open_exr::{NO_PRIMITIVE, PictureError, write_exr};
