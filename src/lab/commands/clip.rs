//! Options of the part of the scene that is shown.

use super::CommandError;
use super::numbers::numbers;
use clap::Args;
use glam::DVec3;
use hitscope_core::{Clip, Scene};
use std::sync::Arc;

/// The most planes of a clip that overlays obey; a box is six of them.
pub const MAX_OVERLAY_PLANES: usize = 16;

/// The part of the scene that is shown
#[derive(Args, Clone, Debug)]
pub struct ClipArgs {
    /// Show only the side of a plane on which NX*x + NY*y + NZ*z <= D, in the file's coordinates; may be given more than
    /// once. Surfaces aren't changed: rays end at the plane
    #[arg(long, value_name = "NX,NY,NZ,D", allow_hyphen_values = true, value_parser = parse_plane)]
    pub clip_plane: Vec<Clip>,
    /// Show only the inside of a box between two corners, in the file's coordinates
    #[arg(long, value_name = "X0,Y0,Z0,X1,Y1,Z1", allow_hyphen_values = true, value_parser = parse_box)]
    pub clip_box: Option<Clip>,
}

impl ClipArgs {
    /// The clip in the file's coordinates: what all planes and the box keep.
    pub fn clip(&self) -> Option<Clip> {
        let parts = self.clip_plane.iter().chain(&self.clip_box);
        parts.cloned().reduce(Clip::and)
    }

    /// Whether the clip has more planes than overlays obey.
    pub(super) fn has_too_many_for_overlays(&self) -> bool {
        let clip = self.clip();
        clip.is_some_and(|clip| clip.half_spaces().len() > MAX_OVERLAY_PLANES)
    }

    /// The scene with the clip.
    ///
    /// # Errors
    /// [`CommandError::Usage`] if a plane is too far away.
    pub fn apply(&self, scene: Arc<Scene>) -> Result<Arc<Scene>, CommandError> {
        let Some(clip) = self.clip() else {
            return Ok(scene);
        };
        let moved = clip.moved(-scene.mesh().origin());
        let clip = moved.map_err(|error| CommandError::Usage(error.to_string()))?;
        Ok(Arc::new(scene.with_clip(Some(clip))))
    }
}

/// `0,0,1,2.5`.
fn parse_plane(text: &str) -> Result<Clip, String> {
    let expected =
        "expected four numbers separated by commas: a normal and a distance, as in 0,0,1,2.5";
    let [x, y, z, offset] = numbers(text, expected)?;
    Clip::plane(DVec3::new(x, y, z), offset).map_err(|error| error.to_string())
}

/// `-1,-1,-1,1,1,1`.
fn parse_box(text: &str) -> Result<Clip, String> {
    let expected = "expected six numbers separated by commas: two corners, as in -1,-1,-1,1,1,1";
    let [x0, y0, z0, x1, y1, z1] = numbers(text, expected)?;
    let clip = Clip::axis_box(DVec3::new(x0, y0, z0), DVec3::new(x1, y1, z1));
    clip.map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_and_boxes_are_read_or_refused_with_a_reason() {
        let plane = parse_plane("0, 0,2,-5").expect("a plane");
        assert!(plane.keeps(DVec3::new(9.0, 9.0, -2.5)) && !plane.keeps(DVec3::ZERO));
        let cell = parse_box("-1,-1,-1,1,2,3").expect("a box");
        assert!(cell.keeps(DVec3::new(0.0, 1.5, 2.5)) && !cell.keeps(DVec3::splat(1.5)));
        for (bad, reason) in [
            ("0,0,1", "expected four numbers"),
            ("0,0,1,x", "expected four numbers"),
            ("0,0,1,inf", "the numbers must be finite"),
            ("0,0,-0,1", "the plane's normal is zero"),
        ] {
            let message = parse_plane(bad).expect_err(bad);
            assert!(message.starts_with(reason), "{bad}: {message}");
        }
        for (bad, reason) in [
            ("0,0,0,1,1", "expected six numbers"),
            ("0,0,0,1,1,0", "each lower end of the box must be below"),
        ] {
            let message = parse_box(bad).expect_err(bad);
            assert!(message.starts_with(reason), "{bad}: {message}");
        }
    }
}
