//! Conversion of f64 rays in the file's coordinates to the f32 rays that kernels trace.
//!
//! A kernel takes f32 numbers relative to the mesh's origin. Rounding a ray that starts far from the mesh can move
//! it by more than the mesh's size. Of up to four ways to trace a ray, the one that rounds least is used:
//!
//! - The traced ray starts at the given origin, or where the given ray comes near the mesh. Near the mesh, origin and
//!   direction are rounded about as finely as the mesh's own positions.
//! - The origin of the frame is the mesh's, or (0, 0, 0) of the file, where a ray of f32 numbers isn't rounded at all.
//!   The latter requires that the mesh's positions are f32 numbers there, too, and a second tree, which is built for
//!   the first ray that needs it.
//!
//! [`PlacedRay::rounding`] is the remaining error. A hit of a shape other than a triangle loses more: its position follows
//! from t, an f32 number that is the coarser the farther away the ray starts. This counts in the choice, too.
//!
//! A ray from more than 2⁴⁸ times the mesh's size away can't be moved near it: an f64 number doesn't hold t that well.

mod precise;

use glam::{DVec3, Vec3};
use hitscope_core::kernel::KernelChoice;
use hitscope_core::ray::{RayError, f32_below};
use hitscope_core::{Intersector, Ray, Scene};
use precise::Precise;
use std::sync::OnceLock;

/// Another start or frame is used if it reduces the rounding by more than this factor. Otherwise the ray that the
/// user expects is traced, which loses at most two bits.
const WORTHWHILE: f64 = 4.0;

/// A ray in the file's coordinates: `origin + t·dir` for `t_min < t < t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenRay {
    /// The origin.
    pub origin: DVec3,
    /// The direction; t is in units of its length.
    pub dir: DVec3,
    /// Lower end of the interval.
    pub t_min: f64,
    /// Upper end of the interval.
    pub t_max: f64,
}

/// The f32 ray that is traced for a [`GivenRay`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedRay {
    /// The ray, in the coordinates of its frame.
    pub ray: Ray,
    frame: FrameKind,
    /// The given ray's t at which the traced ray starts.
    start: f64,
    /// The largest distance per coordinate, in the file's units, between the traced and the given ray at the same t,
    /// over all t at which the ray may meet the mesh. 0 means that the ray is traced exactly as given.
    pub rounding: f64,
    /// The largest error of a hit's position, in the file's units, from the rounding of t. 0 if all primitives are
    /// triangles, whose hits have barycentric coordinates.
    rounding_of_t: f64,
}

impl PlacedRay {
    fn loss(&self) -> f64 {
        self.rounding + self.rounding_of_t
    }

    /// The given ray's t for a t of the traced ray.
    pub fn t_as_given(&self, t: impl Into<f64>) -> f64 {
        self.start + self.ray.t_as_given(t)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FrameKind {
    /// Relative to the mesh's origin.
    Mesh,
    /// Relative to (0, 0, 0) of the file.
    File,
}

/// A scene, and its intersectors in the frames in which rays are traced.
pub struct Frames<'a> {
    scene: &'a Scene,
    kernel: KernelChoice,
    max_memory: u64,
    in_mesh: Frame,
    in_file: Frame,
    mesh: Box<dyn Intersector>,
    has_file_frame: OnceLock<bool>,
    file: OnceLock<Option<Box<dyn Intersector>>>,
}

impl<'a> Frames<'a> {
    /// `max_memory` limits the bytes of both trees and their triangles; if they exceed it, there is no second tree.
    pub fn new(scene: &'a Scene, kernel: impl Into<KernelChoice>, max_memory: u64) -> Self {
        let kernel = kernel.into();
        Self {
            scene,
            kernel,
            max_memory,
            in_mesh: Frame::of_mesh(scene),
            in_file: Frame::of_file(scene),
            mesh: scene.intersector(kernel),
            has_file_frame: OnceLock::new(),
            file: OnceLock::new(),
        }
    }

    /// The intersector for a placed ray.
    pub fn intersector(&self, placed: &PlacedRay) -> &dyn Intersector {
        match placed.frame {
            FrameKind::Mesh => &*self.mesh,
            FrameKind::File => self.file().expect("rays are placed in frames that exist"),
        }
    }

    /// The point of the file to which a placed ray is relative.
    pub fn origin(&self, placed: &PlacedRay) -> DVec3 {
        match placed.frame {
            FrameKind::Mesh => self.scene.mesh().origin(),
            FrameKind::File => DVec3::ZERO,
        }
    }

    /// The f32 ray that is traced for a given one.
    ///
    /// The ends of the interval are rounded outwards, so that comparing them with an f32 t is exact.
    ///
    /// # Errors
    /// See [`RayError`].
    pub fn place(&self, given: &GivenRay) -> Result<PlacedRay, RayError> {
        // False for NaN, too.
        let has_interval = given.t_min < given.t_max;
        if !has_interval {
            return Err(RayError::IntervalEmpty);
        }
        let frame = &self.in_mesh;
        let placed = frame.place_at_origin(given);
        if placed.is_ok_and(|placed| placed.loss() == 0.0) {
            return placed;
        }
        let placed = better(placed, frame.place_near_mesh(given));
        if placed.is_ok_and(|placed| placed.loss() == 0.0) || !self.has_file_frame() {
            return placed;
        }
        let frame = &self.in_file;
        let in_file = better(frame.place_at_origin(given), frame.place_near_mesh(given));
        let in_file = better(placed, Some(in_file));
        match in_file {
            // Without memory for the second tree, use the mesh's frame.
            Ok(chosen) if chosen.frame == FrameKind::File && self.file().is_none() => placed,
            _ => in_file,
        }
    }

    /// Whether the file's frame differs from the mesh's, holds its positions as f32 numbers, and fits in memory.
    fn has_file_frame(&self) -> bool {
        let has = || {
            let mesh = self.scene.mesh();
            mesh.origin() != DVec3::ZERO && mesh.are_f32_in_file() && self.fits_twice()
        };
        *self.has_file_frame.get_or_init(has)
    }

    fn fits_twice(&self) -> bool {
        let mesh = self.scene.mesh();
        let lists = size_of_val(mesh.positions()) + size_of_val(mesh.triangles());
        let one = lists + self.scene.tree_bytes() + self.mesh.bytes();
        2 * one as u64 <= self.max_memory
    }

    fn file(&self) -> Option<&dyn Intersector> {
        let build = || Some(self.scene.in_file_frame()?.intersector(self.kernel));
        self.file.get_or_init(build).as_deref()
    }
}

/// The candidate if it is sufficiently more accurate, else `placed`.
fn better(
    placed: Result<PlacedRay, RayError>,
    candidate: Option<Result<PlacedRay, RayError>>,
) -> Result<PlacedRay, RayError> {
    match (placed, candidate) {
        (Err(_), Some(Ok(candidate))) => Ok(candidate),
        (Ok(placed), Some(Ok(candidate))) if candidate.loss() * WORTHWHILE < placed.loss() => {
            Ok(candidate)
        }
        (placed, _) => placed,
    }
}

/// The origin of a frame, and the mesh's bounding ball relative to it.
struct Frame {
    kind: FrameKind,
    origin: DVec3,
    ball: Ball,
    /// Whether hits' positions follow from t.
    has_other_shapes: bool,
    /// Whether rays may hit something outside of the ball.
    is_unbounded: bool,
}

impl Frame {
    fn of_mesh(scene: &Scene) -> Self {
        Self {
            kind: FrameKind::Mesh,
            origin: scene.mesh().origin(),
            ball: Ball::around(scene),
            has_other_shapes: scene.has_other_shapes(),
            is_unbounded: !scene.other_groups().iter().all(|group| group.is_bounded()),
        }
    }

    fn of_file(scene: &Scene) -> Self {
        let frame = Self::of_mesh(scene);
        Self {
            kind: FrameKind::File,
            origin: DVec3::ZERO,
            ball: Ball {
                centre: frame.ball.centre + frame.origin,
                ..frame.ball
            },
            ..frame
        }
    }

    /// Places a ray with its start at the given origin.
    fn place_at_origin(&self, given: &GivenRay) -> Result<PlacedRay, RayError> {
        let interval = [f32_below(given.t_min), f32_above(given.t_max)];
        self.place(given, 0.0, interval)
    }

    /// Places a ray with its start near the mesh, or at the beginning of its interval if that is later. `None` if
    /// that is the given origin.
    fn place_near_mesh(&self, given: &GivenRay) -> Option<Result<PlacedRay, RayError>> {
        let [entry, exit] = self.reach(given);
        // Rounded to a sixteenth of the way through the ball: a start with few digits keeps t = start + t′ exact
        // for many rays.
        let exponent = (exit - entry).log2().floor() as i32;
        let step = 2f64.powi(exponent.saturating_sub(4));
        let start = ((entry / step).floor() * step).max(given.t_min);
        if !start.is_finite() || start == 0.0 {
            return None;
        }
        let end = if exit < given.t_max && !self.is_unbounded {
            f32::INFINITY
        } else {
            f32_above(given.t_max - start)
        };
        // Without infinite planes, hits before the start also lie before the interval. If the interval ends before the
        // mesh, the traced one ends at or before the start, where there are none.
        let begin = if start < given.t_max && !self.is_unbounded {
            0.0
        } else {
            f32_below(given.t_min - start)
        };
        Some(self.place(given, start, [begin, end]))
    }

    fn place(
        &self,
        given: &GivenRay,
        start: f64,
        [t_min, t_max]: [f32; 2],
    ) -> Result<PlacedRay, RayError> {
        let exact = [0, 1, 2].map(|axis| {
            let (origin, dir) = (given.origin[axis], given.dir[axis]);
            Precise::sum_with_product(origin, -self.origin[axis], start, dir)
        });
        let origin = Vec3::from_array(exact.map(|x| x.high as f32));
        let dir = given.dir.as_vec3();
        let ray = Ray::with_interval(origin, dir, t_min, t_max)?;
        let origin_error =
            DVec3::from_array([0, 1, 2].map(|axis| exact[axis].error_of(origin[axis])));
        // Exact: rounding errors are f64 numbers.
        let dir_error = dir.as_dvec3() - given.dir;
        let reach = || {
            let reach = self.reach(given);
            reach.map(|t| t.clamp(given.t_min, given.t_max) - start)
        };
        let rounding = if origin_error == DVec3::ZERO && dir_error == DVec3::ZERO {
            0.0
        } else {
            largest_distance(origin_error, dir_error, reach())
        };
        let rounding_of_t = if self.has_other_shapes {
            let error = dir.as_dvec3() * f64::from(f32::EPSILON / 2.0);
            largest_distance(DVec3::ZERO, error, reach())
        } else {
            0.0
        };
        Ok(PlacedRay {
            ray,
            frame: self.kind,
            start,
            rounding,
            rounding_of_t,
        })
    }

    fn reach(&self, given: &GivenRay) -> [f64; 2] {
        self.ball.reach(given.origin - self.origin, given.dir)
    }
}

/// The [`PlacedRay::rounding`] of a ray whose origin and direction in f64 are given, all in the coordinates of the
/// scene's mesh.
pub fn rounding(scene: &Scene, ray: &Ray, [origin, dir]: [DVec3; 2]) -> f64 {
    let (origin_error, dir_error) = (ray.origin.as_dvec3() - origin, ray.dir.as_dvec3() - dir);
    let reach = Ball::around(scene).reach(origin, dir);
    largest_distance(origin_error, dir_error, reach.map(|t| t.max(0.0)))
}

/// The larger of the distances per coordinate at two values of t.
fn largest_distance(origin_error: DVec3, dir_error: DVec3, t: [f64; 2]) -> f64 {
    let at = |t: f64| (origin_error + t * dir_error).abs().max_element();
    t.map(at).into_iter().fold(0.0, f64::max)
}

/// A bounding ball of the mesh.
#[derive(Clone, Copy, Debug)]
struct Ball {
    centre: DVec3,
    radius: f64,
}

impl Ball {
    /// The ball in the coordinates of the scene's mesh.
    fn around(scene: &Scene) -> Self {
        let bounds = scene.bounds();
        if bounds.is_empty() {
            return Self {
                centre: DVec3::ZERO,
                radius: 0.0,
            };
        }
        Self {
            centre: bounds.centre().as_dvec3(),
            radius: bounds.radius(),
        }
    }

    /// The interval of t in which the ray would be inside the ball if it went through the centre.
    ///
    /// The radius is enlarged to cover the rounding of the centre, to f32, and of the radius. The middle of the
    /// interval is a quotient of dot products, each of which has an error below 4·2⁻⁵³ of the distance to the centre;
    /// 2⁻⁴⁸ of that distance is more than all of these errors.
    fn reach(&self, origin: DVec3, dir: DVec3) -> [f64; 2] {
        let to_centre = self.centre - origin;
        let length = dir.length();
        let middle = to_centre.dot(dir) / length / length;
        let slack = to_centre.length() * 2f64.powi(-48);
        let half = (self.radius * (1.0 + 2f64.powi(-20)) + slack) / length;
        [middle - half, middle + half]
    }
}

/// The smallest f32 that isn't below a number.
fn f32_above(x: f64) -> f32 {
    -f32_below(-x)
}

#[cfg(test)]
mod tests;
