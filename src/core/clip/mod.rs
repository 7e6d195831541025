//! Clipping: the part of a scene that is shown, bounded by planes.
//!
//! A [`Clip`] is an intersection of half-spaces, which is convex: of each ray it keeps one interval of t. Rays are cut;
//! the geometry stays as it is, so that kernels compute the same t, u and v with a clip as without one.
//!
//! A plane belongs to both of its sides and is as thick as the errors of f32 positions and of t, so that a face in the
//! plane is shown completely, not in the pixels in which rounding puts it on this side. Both sides of a plane keep such a
//! face; of all else exactly one side keeps each point.
//!
//! The interval's ends are computed in f64 and rounded down to f32. The clip decides by the f32 t that a kernel reports.

mod half_space;

pub use half_space::HalfSpace;

use crate::ray::Ray;
use glam::DVec3;

/// Why there is no such clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ClipError {
    /// The normal is zero.
    #[error("the plane's normal is zero")]
    NormalZero,
    /// A number is infinite or NaN, or the plane is too far away for f64.
    #[error("the clip's numbers must be finite")]
    NotFinite,
    /// A lower end of the box isn't below the upper end.
    #[error("each lower end of the box must be below its upper end")]
    BoxEmpty,
}

/// The part of a scene that is shown: an intersection of half-spaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip(Vec<HalfSpace>);

/// The t of a ray that a clip keeps: `after < t ≤ last`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeptInterval {
    /// The largest f32 before the interval.
    pub after: f32,
    /// The largest f32 of the interval.
    pub last: f32,
}

/// A ray that a clip has cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutRay {
    /// The ray with its interval cut. Kernels that compare t in f64 or exactly may find hits in it that round to an f32
    /// outside of `kept`.
    pub ray: Ray,
    /// The t that are kept.
    pub kept: KeptInterval,
}

impl Clip {
    /// Keeps one side of a plane: `normal·p ≤ offset`. The normal needn't have unit length.
    ///
    /// # Errors
    /// See [`ClipError`].
    pub fn plane(normal: DVec3, offset: f64) -> Result<Self, ClipError> {
        Ok(Self(vec![HalfSpace::new(normal, offset)?]))
    }

    /// Keeps a box aligned with the axes.
    ///
    /// # Errors
    /// See [`ClipError`].
    pub fn axis_box(min: DVec3, max: DVec3) -> Result<Self, ClipError> {
        if !(min.is_finite() && max.is_finite()) {
            return Err(ClipError::NotFinite);
        }
        if !min.cmplt(max).all() {
            return Err(ClipError::BoxEmpty);
        }
        let ends = DVec3::AXES.into_iter().flat_map(|axis| {
            [
                HalfSpace::new(axis, max.dot(axis)),
                HalfSpace::new(-axis, -min.dot(axis)),
            ]
        });
        Ok(Self(ends.collect::<Result<_, _>>()?))
    }

    /// Keeps what both keep.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    /// The same clip, moved. Each plane is rounded once.
    ///
    /// # Errors
    /// [`ClipError::NotFinite`].
    pub fn moved(&self, by: DVec3) -> Result<Self, ClipError> {
        let moved = self.0.iter().map(|part| part.moved(by));
        Ok(Self(moved.collect::<Result<_, _>>()?))
    }

    /// The half-spaces.
    pub fn half_spaces(&self) -> &[HalfSpace] {
        &self.0
    }

    /// Whether a point is kept.
    pub fn keeps(&self, point: DVec3) -> bool {
        self.0.iter().all(|part| part.keeps(point))
    }

    /// The part of a ray that is kept; `None` if that is nothing, or the ray contains a NaN.
    pub fn cut(&self, ray: &Ray) -> Option<CutRay> {
        let (origin, dir) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
        let mut kept = KeptInterval::ALL;
        for part in &self.0 {
            let own = part.kept(origin, dir)?;
            kept = KeptInterval {
                after: kept.after.max(own.after),
                last: kept.last.min(own.last),
            };
        }
        let ray = Ray {
            t_min: ray.t_min.max(kept.after),
            // The interval of a ray is open.
            t_max: ray.t_max.min(kept.last.next_up()),
            ..*ray
        };
        (ray.t_min < ray.t_max).then_some(CutRay { ray, kept })
    }
}

impl KeptInterval {
    /// All t.
    pub(crate) const ALL: Self = Self {
        after: f32::NEG_INFINITY,
        last: f32::INFINITY,
    };

    /// Whether a hit with this t is kept.
    #[inline]
    pub fn contains(&self, t: f32) -> bool {
        self.after < t && t <= self.last
    }
}

#[cfg(test)]
mod tests;
