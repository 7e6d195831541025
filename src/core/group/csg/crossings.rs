//! The points at which a ray enters and leaves a solid.

use super::along_line::LineIntervals;
use super::solid::{Solid, SolidOperand};
use crate::aabb::Planes;
use crate::intersector::{GroupIntersector, RankedHit};
use crate::kernel::KernelChoice;
use crate::ray::{Hit, Ray};
use crate::shape::Interior;
use crate::simd::SimdLevel;

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
        let packed = |operand: &SolidOperand| operand.boundary.intersector(kernel, level);
        Self {
            operands: solid.operands().iter().map(packed).collect(),
            solid: solid.clone(),
        }
    }

    /// The planes of its box, which may be infinite.
    pub fn planes(&self) -> Planes<f32> {
        self.solid.infinite_bounds().planes()
    }

    pub fn operand_count(&self) -> usize {
        self.operands.len()
    }

    /// Its size, with the trees of its operands, which have one leaf each.
    pub fn bytes(&self) -> usize {
        let operands = self.solid.operands().iter().zip(&self.operands);
        let bytes = operands.map(|(operand, packed)| {
            let tree = operand.boundary.bvh().bytes();
            size_of::<SolidOperand>() + size_of_val(&**packed) + packed.bytes() + tree
        });
        size_of::<Self>() + bytes.sum::<usize>()
    }

    pub fn solid(&self) -> &Solid {
        &self.solid
    }

    /// Whether the ray's origin is inside each operand.
    pub fn inside_at_start(&self, ray: &Ray) -> Vec<bool> {
        let line = line_of(ray);
        let mut inside = Vec::new();
        for (shape, intersector) in self.solid.operands().iter().zip(&self.operands) {
            let (ends, starts_inside) = interval_ends(shape, &**intersector, &line);
            let before = ends.iter().filter(|end| end.t_in_f64() < 0.0).count();
            inside.push(starts_inside != (before % 2 == 1));
        }
        inside
    }

    /// The solid's crossings in the ray's interval, in ascending order. A hit's `v` is the index of the operand; its
    /// `primitive` is 0.
    ///
    /// Between consecutive ends of the operands' intervals the state is constant; an end is a crossing if the states
    /// before and after it differ.
    pub fn crossings(&self, ray: &Ray) -> Vec<RankedHit> {
        let (mut inside, ends) = self.ends_along(ray);
        let mut was_inside = self.solid.is_inside(&inside);
        let mut crossings = Vec::new();
        for mut equal in ends {
            let before = inside.clone();
            pass(&equal, &mut inside);
            let is_inside = self.solid.is_inside(&inside);
            if is_inside != was_inside && equal[0].crossing.is_in_interval(ray) {
                let index = self.visible_of(&equal, &before, &inside);
                let Event { crossing, operand } = equal.swap_remove(index);
                let v = operand as f32;
                crossings.push(crossing.with_hit(|hit| Hit { v, ..hit }));
            }
            was_inside = is_inside;
        }
        crossings
    }

    /// The first of several ends at equal t whose operand's surface is the solid's there.
    ///
    /// The surface faces the ray if the solid is entered: so does that of an operand that changes likewise. It bounds the
    /// solid only if the solid changes with that operand alone.
    fn visible_of(&self, equal: &[Event], before: &[bool], after: &[bool]) -> usize {
        if equal.len() == 1 {
            return 0;
        }
        let is_inside = self.solid.is_inside(after);
        let changes_likewise = |event: &Event| {
            let is_subtracted = self.solid.operands()[event.operand].is_subtracted;
            (after[event.operand] != is_subtracted) == is_inside
        };
        let bounds = |event: &Event| {
            [before, after].iter().any(|state| {
                let mut changed = state.to_vec();
                changed[event.operand] ^= true;
                self.solid.is_inside(&changed) != self.solid.is_inside(state)
            })
        };
        let both = |event: &Event| changes_likewise(event) && bounds(event);
        let found = equal.iter().position(both);
        let found = found.or_else(|| equal.iter().position(changes_likewise));
        found.unwrap_or(0)
    }

    /// The intervals of the ray's whole line inside each part, in the order of [`SolidNode::each`].
    ///
    /// [`SolidNode::each`]: super::solid::SolidNode::each
    pub fn intervals(&self, ray: &Ray) -> Vec<LineIntervals> {
        let (mut inside, ends) = self.ends_along(ray);
        let root = self.solid.root();
        let mut before = root.inside_each(&inside);
        let starting = |&starts_inside: &bool| LineIntervals {
            starts_inside,
            ends: Vec::new(),
        };
        let mut parts: Vec<LineIntervals> = before.iter().map(starting).collect();
        for equal in ends {
            pass(&equal, &mut inside);
            let after = root.inside_each(&inside);
            let t = equal[0].crossing.t_in_f64();
            for (part, (before, after)) in parts.iter_mut().zip(before.iter().zip(&after)) {
                if before != after {
                    part.ends.push(t);
                }
            }
            before = after;
        }
        parts
    }

    /// Along the ray's whole line: whether it starts inside each operand, and the ends of all operands' intervals in
    /// ascending order, equal ones together.
    fn ends_along(&self, ray: &Ray) -> (Vec<bool>, Vec<Vec<Event>>) {
        let line = line_of(ray);
        let (mut events, mut inside) = (Vec::new(), Vec::new());
        let operands = self.solid.operands().iter().zip(&self.operands);
        for (operand, (shape, intersector)) in operands.enumerate() {
            let (ends, starts_inside) = interval_ends(shape, &**intersector, &line);
            inside.push(starts_inside);
            events.extend(ends.into_iter().map(|crossing| Event { crossing, operand }));
        }
        events.sort_by(|a, b| {
            let by_t = a.crossing.compare(&b.crossing);
            by_t.then(a.operand.cmp(&b.operand))
        });
        let mut grouped: Vec<Vec<Event>> = Vec::new();
        for event in events {
            match grouped.last_mut() {
                Some(equal) if event.crossing.compare(&equal[0].crossing).is_eq() => {
                    equal.push(event);
                }
                _ => grouped.push(vec![event]),
            }
        }
        (inside, grouped)
    }
}

/// Moves beyond ends at equal t.
fn pass(ends: &[Event], inside: &mut [bool]) {
    for end in ends {
        inside[end.operand] ^= true;
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
fn interval_ends(
    operand: &SolidOperand,
    intersector: &dyn GroupIntersector,
    line: &Ray,
) -> (Vec<RankedHit>, bool) {
    let mut hits = intersector.every_hit(line);
    hits.sort_by(RankedHit::compare);
    let interior = operand.boundary.interior(0, line);
    // The apex of a cone is a double root, too, although the ray passes through the surface there.
    if interior != Interior::Convex {
        hits.retain(|hit| !hit.is_tangent);
    }
    match interior {
        Interior::Open => (Vec::new(), false),
        Interior::Convex => {
            // A ray that touches the shape at an edge or a corner has one crossing.
            let last = (hits.len() > 1).then(|| hits.pop()).flatten();
            hits.truncate(usize::from(last.is_some()));
            hits.extend(last);
            (hits, false)
        }
        Interior::Bounded => (without_spurious_tangent(operand, line, hits, false), false),
        Interior::Unbounded { reach, ends } => {
            hits.retain(|ranked| f64::from(ranked.hit.t).abs() <= reach);
            (
                without_spurious_tangent(operand, line, hits, ends[0] != ends[1]),
                ends[0],
            )
        }
    }
}

/// The crossings at which the line passes through the surface. If their parity is wrong, because rounding added or lost
/// one near a tangent, the most grazing one is removed.
fn without_spurious_tangent(
    operand: &SolidOperand,
    line: &Ray,
    mut hits: Vec<RankedHit>,
    is_odd: bool,
) -> Vec<RankedHit> {
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
