//! Colours of numbers: colour maps, and scales with ticks for legends.
//!
//! | part | file |
//! |---|---|
//! | a colour map, and the table of them | `map` |
//! | the colours of the maps | `stops` |
//! | a map over a range of a quantity | `scale` |
//! | round numbers in a range | `ticks` |

mod map;
mod scale;
mod stops;
mod ticks;

pub use map::{COLOUR_MAPS, ColourMap, MapKind, NO_NUMBER, colour_map};
pub(crate) use map::{DUSK, GREY, VIRIDIS};
pub use scale::{ColourScale, ScaleError};
pub use ticks::{Tick, decimal, exponent_of};
