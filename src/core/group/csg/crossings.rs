//! The points at which a ray enters and leaves a solid.

use super::solid::{Operand, Solid};
use crate::aabb::{Aabb, Planes};
use crate::intersector::{GroupIntersector, RankedHit};
use crate::kernel::KernelChoice;
use crate::ray::{Hit, Ray};
use crate::shape::Interior;
use crate::simd::SimdLevel;
use glam::Vec3;

/// A solid whose operands are packed for a kernel.
pub(super) struct PackedSolid {
    solid: Solid,
    operands: Vec<Box<dyn GroupIntersector>>,
}

impl std::fmt::Debug for PackedSolid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.solid.fmt(f)
    }
}

/// A crossing of an operand's surface.
struct Event {
    crossing: RankedHit,
    operand: usize,
}

impl PackedSolid {
    pub fn new(solid: &Solid, kernel: KernelChoice, level: SimdLevel) -> Self {
        let packed = |operand: &Operand| operand.boundary.intersector(kernel, level);
        Self {
            operands: solid.operands().iter().map(packed).collect(),
            solid: solid.clone(),
        }
    }

    /// The planes of its box.
    pub fn planes(&self) -> Planes<f32> {
        let everywhere = Aabb {
            min: Vec3::NEG_INFINITY,
            max: Vec3::INFINITY,
        };
        self.solid.bounds().unwrap_or(everywhere).planes()
    }

    pub fn operand_count(&self) -> usize {
        self.operands.len()
    }

    pub fn bytes(&self) -> usize {
        self.operands.iter().map(|operand| operand.bytes()).sum()
    }

    pub fn solid(&self) -> &Solid {
        &self.solid
    }

    /// Whether the ray's origin is inside each operand.
    pub fn inside_at_start(&self, ray: &Ray) -> Vec<bool> {
        let line = line_of(ray);
        let mut inside = Vec::new();
        for (shape, intersector) in self.solid.operands().iter().zip(&self.operands) {
            let (ends, starts_inside) = ends(shape, &**intersector, &line);
            let before = ends.iter().filter(|end| end.t_in_f64() < 0.0).count();
            inside.push(starts_inside != (before % 2 == 1));
        }
        inside
    }

    /// The solid's crossings in the ray's interval, in ascending order. A hit's `v` is the index of the operand; its
    /// `primitive` is 0.
    ///
    /// Along the ray's whole line each operand is a sequence of intervals. Between two neighbouring ends of any of
    /// them, nothing changes; at an end the solid has a surface if the points before and behind it differ.
    pub fn crossings(&self, ray: &Ray) -> Vec<RankedHit> {
        let line = line_of(ray);
        let (mut events, mut inside) = (Vec::new(), Vec::new());
        let operands = self.solid.operands().iter().zip(&self.operands);
        for (operand, (shape, intersector)) in operands.enumerate() {
            let (ends, starts_inside) = ends(shape, &**intersector, &line);
            inside.push(starts_inside);
            events.extend(ends.into_iter().map(|crossing| Event { crossing, operand }));
        }
        events.sort_by(|a, b| {
            let by_t = a.crossing.compare(&b.crossing);
            by_t.then(a.operand.cmp(&b.operand))
        });
        let mut was_inside = self.solid.is_inside(&inside);
        let mut crossings = Vec::new();
        let mut events = events.into_iter().peekable();
        while let Some(Event { crossing, operand }) = events.next() {
            inside[operand] ^= true;
            while let Some(other) =
                events.next_if(|other| other.crossing.compare(&crossing).is_eq())
            {
                inside[other.operand] ^= true;
            }
            let is_inside = self.solid.is_inside(&inside);
            if is_inside != was_inside && crossing.is_in_interval(ray) {
                let v = operand as f32;
                crossings.push(crossing.with_hit(|hit| Hit { v, ..hit }));
            }
            was_inside = is_inside;
        }
        crossings
    }
}

/// The ray's whole line.
fn line_of(ray: &Ray) -> Ray {
    Ray {
        t_min: f32::NEG_INFINITY,
        t_max: f32::INFINITY,
        exclude: None,
        ..*ray
    }
}

/// The ends of an operand's intervals along a line, in ascending order, and whether the line starts inside.
fn ends(
    operand: &Operand,
    intersector: &dyn GroupIntersector,
    line: &Ray,
) -> (Vec<RankedHit>, bool) {
    let mut hits = intersector.every_hit(line);
    hits.retain(|hit| !hit.is_tangent);
    hits.sort_by(RankedHit::compare);
    match operand.boundary.interior(0, line) {
        Interior::Open => (Vec::new(), false),
        Interior::Convex => {
            // A ray that touches the shape at an edge or a corner has one crossing.
            let last = (hits.len() > 1).then(|| hits.pop()).flatten();
            hits.truncate(usize::from(last.is_some()));
            hits.extend(last);
            (hits, false)
        }
        Interior::Bounded => (turns(operand, line, hits, false), false),
        Interior::Unbounded([start, end]) => (turns(operand, line, hits, start != end), start),
    }
}

/// The crossings at which the line passes through the surface. If their number shows that a kernel reported one too many
/// or too few, as rounding may near a tangent, the most grazing one is left out.
fn turns(operand: &Operand, line: &Ray, mut hits: Vec<RankedHit>, is_odd: bool) -> Vec<RankedHit> {
    if (hits.len() % 2 == 1) == is_odd {
        return hits;
    }
    let dir = line.dir.as_dvec3();
    let slope = |ranked: &RankedHit| {
        let normal = operand.boundary.surface(line, &ranked.hit).normal;
        normal.dot(dir).abs()
    };
    let slopes: Vec<f64> = hits.iter().map(slope).collect();
    let least = (0..hits.len()).min_by(|&a, &b| slopes[a].total_cmp(&slopes[b]));
    if let Some(least) = least {
        hits.remove(least);
    }
    hits
}
