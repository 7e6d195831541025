//! Wireframe lines of a solid: the parts of its operands' lines on its surface. Pieces that cross its edges are omitted.

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

impl PackedSolid {
    /// Passes the lines to `add`.
    pub fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        let bounds = self.solid().bounds().unwrap_or(detail.around);
        let size = bounds.radius();
        for (index, operand) in self.solid().operands().iter().enumerate() {
            operand.surface.lines(0, detail, &mut |line| {
                let line = &divided(line, detail, size);
                let is_on = |point: &LinePoint| self.is_on_surface(point.position, index);
                let is_drawn: Vec<bool> = line.iter().map(is_on).collect();
                let mut start = 0;
                while start < line.len() {
                    let end = start + is_drawn[start..].iter().take_while(|is_on| **is_on).count();
                    let facing = |point: &LinePoint| LinePoint {
                        normal: if operand.is_subtracted {
                            -point.normal
                        } else {
                            point.normal
                        },
                        ..*point
                    };
                    if end - start > 1 {
                        add(&line[start..end].iter().map(facing).collect::<Vec<_>>());
                    }
                    start = end + 1;
                }
            });
        }
    }

    /// Whether a point of an operand's surface is on the solid's: the solid differs on the operand's two sides.
    /// Where another operand's surface coincides, rounding decides.
    fn is_on_surface(&self, point: DVec3, operand: usize) -> bool {
        // Any direction does; this one lies in no plane of symmetry.
        let Ok(ray) = Ray::new(point.as_vec3(), Vec3::new(0.36, 0.48, 0.8)) else {
            return false;
        };
        let mut inside = self.inside_at_start(&ray);
        let mut with = |is_inside: bool| {
            inside[operand] = is_inside;
            self.solid().is_inside(&inside)
        };
        with(true) != with(false)
    }
}
