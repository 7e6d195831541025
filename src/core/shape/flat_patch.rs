//! Rectangles and disks prepared for sampling, as lamps are sampled often.

use super::{SampledSurface, Span, SurfacePoint, U, in_disk};
use glam::{DVec2, DVec3, Vec3};

/// The outline of a [`FlatPatch`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outline {
    /// c ± u ± v.
    Rectangle,
    /// The ellipse with the half axes u and v.
    Disk,
}

/// A rectangle or a disk, with the numbers that its points share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatPatch {
    centre: DVec3,
    axes: [DVec3; 2],
    normal: DVec3,
    /// The largest absolute coordinates of sums of the centre and the half axes.
    reach: Vec3,
    outline: Outline,
}

impl FlatPatch {
    pub(super) fn new(span: &Span, outline: Outline) -> Self {
        let [u, v] = [span.u, span.v].map(Vec3::as_dvec3);
        Self::with_normal(span, u.cross(v), outline)
    }

    /// The patch, given the cross product of the half axes.
    #[inline]
    pub(super) fn with_normal(span: &Span, across: DVec3, outline: Outline) -> Self {
        let Span { centre, u, v } = *span;
        Self {
            centre: centre.as_dvec3(),
            axes: [u, v].map(Vec3::as_dvec3),
            normal: across.normalize_or(DVec3::Z),
            reach: centre.abs() + u.abs() + v.abs(),
            outline,
        }
    }

    /// The same with the opposite normal.
    pub fn flipped(self) -> Self {
        Self {
            normal: -self.normal,
            ..self
        }
    }

    /// A point, uniform by area for uniform points `at` of the unit square.
    #[inline]
    pub fn sampled(&self, at: DVec2) -> SampledSurface {
        let uv = match self.outline {
            Outline::Rectangle => 2.0 * at - 1.0,
            Outline::Disk => in_disk(at.as_vec2()).0.as_dvec2(),
        };
        SampledSurface {
            surface: self.surface_at(uv),
            u: uv.x as f32,
            v: uv.y as f32,
            density: None,
        }
    }

    /// The surface at the point c + a·u + b·v, where `uv` is (a, b).
    #[inline]
    pub(super) fn surface_at(&self, uv: DVec2) -> SurfacePoint {
        let [u, v] = self.axes;
        let position = (self.centre + uv.x * u + uv.y * v).as_vec3();
        SurfacePoint {
            position,
            normal: self.normal,
            uv,
            error: 4.0 * U * (position.abs() + self.reach),
            is_flat: true,
        }
    }
}
