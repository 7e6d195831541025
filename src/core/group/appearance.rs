//! The material and the side of each primitive of a group.

use super::Placement;
use crate::mesh::{Runs, TextureFrame};
use crate::shape::{AddLine, LinePoint, SurfacePoint};
use glam::Vec3;

/// The material and the side of each primitive of a group. By default, primitives have the mesh's first material, and no
/// normal is reversed.
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// The materials, as indices into the mesh's.
    pub materials: Runs,
    /// 1 for primitives whose normals are reversed. This changes no hit: it is looked up for shading and display.
    pub flipped: Runs,
    /// Primitives with texture coordinates, by ascending index. The materials of others show no texture.
    pub placements: Vec<(u32, Placement)>,
}

impl From<Runs> for Appearance {
    fn from(materials: Runs) -> Self {
        Self {
            materials,
            ..Self::default()
        }
    }
}

impl Appearance {
    /// Whether a primitive's normals are reversed.
    pub(super) fn is_flipped(&self, index: u32) -> bool {
        self.flipped.of(index) != 0
    }

    /// Turns the normal of a primitive's surface to its side.
    #[inline]
    pub(super) fn turn(&self, index: u32, surface: &mut SurfacePoint) {
        if self.is_flipped(index) {
            surface.normal = -surface.normal;
        }
    }

    /// The texture coordinates of a point of a primitive; `None` if it has none.
    pub(super) fn texture_frame(&self, index: u32, position: Vec3) -> Option<TextureFrame> {
        let found = self
            .placements
            .binary_search_by_key(&index, |(index, _)| *index);
        Some(self.placements[found.ok()?].1.frame(position))
    }

    /// Passes the lines from `lines` to `add`, with the normals on the primitive's side.
    pub(super) fn lines(&self, index: u32, lines: impl FnOnce(AddLine<'_>), add: AddLine<'_>) {
        if !self.is_flipped(index) {
            return lines(add);
        }
        lines(&mut |points| {
            let reversed = |point: &LinePoint| LinePoint {
                normal: -point.normal,
                ..*point
            };
            let reversed: Vec<LinePoint> = points.iter().map(reversed).collect();
            add(&reversed);
        });
    }

    /// The sides of some of the primitives, without materials.
    pub(super) fn sides_of(&self, indices: &[u32]) -> Self {
        let mut sides = Self::default();
        for (new, &old) in (0..).zip(indices) {
            sides.flipped.begin(new, self.flipped.of(old));
        }
        sides
    }
}
