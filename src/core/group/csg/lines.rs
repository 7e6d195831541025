//! Wireframe lines of a solid: the parts of its operands' lines on its surface, up to the seams of operands.

use super::crossings::PackedSolid;
use crate::ray::Ray;
use crate::shape::{AddLine, LineDetail, LinePoint};
use glam::{DVec3, Vec3};

/// The line with more points if it is straight: as many pieces as the solid's size would have.
fn divided(line: &[LinePoint], detail: &LineDetail, size: f64) -> Vec<LinePoint> {
    let &[from, to] = line else {
        return line.to_vec();
    };
    let part = from.position.distance(to.position) / size;
    let count = (part.min(1.0) * f64::from(detail.segments)).ceil().max(1.0) as u32;
    let at = |k: u32| LinePoint {
        position: from
            .position
            .lerp(to.position, f64::from(k) / f64::from(count)),
        ..from
    };
    (0..=count).map(at).collect()
}

/// The point at a part of the way between two points of a line.
fn between([from, to]: [&LinePoint; 2], part: f64) -> LinePoint {
    LinePoint {
        position: from.position.lerp(to.position, part),
        normal: from.normal.lerp(to.normal, part).normalize_or_zero(),
    }
}

impl PackedSolid {
    /// Passes the lines to `add`.
    pub fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        let bounds = self.solid().bounds().unwrap_or(detail.around);
        let size = bounds.radius();
        for (index, operand) in self.solid().operands().iter().enumerate() {
            let facing = |point: LinePoint| LinePoint {
                normal: operand.outward(point.normal),
                ..point
            };
            operand.surface.lines(0, detail, &mut |line| {
                self.visible_parts(&divided(line, detail, size), index, &mut |part| {
                    let part = part.iter().copied().map(facing);
                    add(&part.collect::<Vec<_>>());
                });
            });
        }
    }

    /// Passes the parts of an operand's line that are on the solid's surface to `add`.
    fn visible_parts(&self, line: &[LinePoint], operand: usize, add: AddLine<'_>) {
        let is_on = |point: &LinePoint| self.is_on_surface(point, operand);
        let mut part: Vec<LinePoint> = Vec::new();
        let mut last: Option<(&LinePoint, bool)> = None;
        for point in line {
            let is_visible = is_on(point);
            if let Some((before, was_visible)) = last
                && was_visible != is_visible
            {
                let ends = if was_visible {
                    [before, point]
                } else {
                    [point, before]
                };
                part.push(self.seam(ends, operand));
            }
            if is_visible {
                part.push(*point);
            } else if !part.is_empty() {
                add(&part);
                part.clear();
            }
            last = Some((point, is_visible));
        }
        if part.len() > 1 {
            add(&part);
        }
    }

    /// The end of a line's visible part between a visible point and one that isn't: the seam with another operand.
    fn seam(&self, ends: [&LinePoint; 2], operand: usize) -> LinePoint {
        /// As many as f32 coordinates distinguish on a piece that is a 64th of the solid.
        const HALVINGS: u32 = 18;
        let (mut visible, mut hidden) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (visible + hidden);
            if self.is_on_surface(&between(ends, middle), operand) {
                visible = middle;
            } else {
                hidden = middle;
            }
        }
        between(ends, visible)
    }

    /// Whether a point of an operand's surface is on the solid's: the solid differs on the operand's two sides, if other
    /// operands are asked beside the point on the same sides. So where surfaces coincide, rounding decides nothing.
    fn is_on_surface(&self, point: &LinePoint, operand: usize) -> bool {
        /// Ulps of f32 by which the sides are apart from the point: more than rounding moves it.
        const ULPS: f64 = 4.0;
        let size = self.solid().bounds().map_or(0.0, |bounds| bounds.radius());
        let reach = point.position.abs().max_element().max(size);
        let outwards = ULPS * f64::from(f32::EPSILON) * reach * point.normal;
        let is_inside = |position: DVec3, is_in_operand: bool| {
            // Any direction does; this one lies in no plane of symmetry.
            let ray = Ray::new(position.as_vec3(), Vec3::new(0.36, 0.48, 0.8)).ok()?;
            let mut inside = self.inside_at_start(&ray);
            inside[operand] = is_in_operand;
            Some(self.solid().is_inside(&inside))
        };
        let within = is_inside(point.position - outwards, true);
        let beyond = is_inside(point.position + outwards, false);
        within
            .zip(beyond)
            .is_some_and(|(within, beyond)| within != beyond)
    }
}
