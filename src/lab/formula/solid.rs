//! The derivation for a solid: the intervals of t inside its parts, then the shape that is hit.
//!
//! Source: Roth, "Ray Casting for Modeling Solids", Computer Graphics and Image Processing 18(2), 1982.

use super::number::text;
use super::{Line, of_primitive};
use hitscope_core::group::{CsgOperation, LineIntervals, Solid, SolidNode};
use hitscope_core::{Hit, Ray};

/// The derivation of a hit of a solid.
pub(super) fn lines(line: &Line, ray: &Ray, solid: &Solid, hit: &Hit) -> Vec<String> {
    let intervals = solid.intervals(ray);
    let (index, operand) = solid.operand_of(hit);
    let name = operand.surface.shape().name;
    let mut lines = vec!["Parts of the solid, with the intervals of t inside them:".to_owned()];
    lines.extend(solid_tree(solid, &intervals));
    lines.push(format!("The hit is on operand {index}, {name}:"));
    lines.extend(of_primitive(line, ray, &*operand.surface, 0));
    if operand.is_subtracted {
        lines.push(format!(
            "Operand {index} is subtracted: the solid's normal is the opposite of its normal."
        ));
    }
    lines.push(match nearest(&intervals[0].ends, hit.t.into()) {
        Some(t) => line.hit(t),
        None => "In exact arithmetic the ray misses this solid.".to_owned(),
    });
    lines
}

/// The number that is nearest to t.
fn nearest(numbers: &[f64], t: f64) -> Option<f64> {
    let distance = |x: &f64| (x - t).abs();
    let mut numbers = numbers.iter().copied();
    let first = numbers.next()?;
    Some(numbers.fold(first, |best, x| {
        if distance(&x) < distance(&best) {
            x
        } else {
            best
        }
    }))
}

/// The parts of a solid, one per line, indented by depth. Each has the intervals of t inside it, and an operation also
/// those that it combines. `intervals` are those of [`Solid::intervals`].
pub fn solid_tree(solid: &Solid, intervals: &[LineIntervals]) -> Vec<String> {
    let mut writer = TreeWriter {
        solid,
        intervals: intervals.iter(),
        lines: Vec::new(),
    };
    writer.add(solid.root(), 0);
    writer.lines
}

struct TreeWriter<'a> {
    solid: &'a Solid,
    /// Those of the parts that aren't written yet.
    intervals: std::slice::Iter<'a, LineIntervals>,
    lines: Vec<String>,
}

impl TreeWriter<'_> {
    /// Adds the lines of a part. Returns its intervals.
    fn add(&mut self, node: &SolidNode, depth: usize) -> Vec<[f64; 2]> {
        let own = self.intervals.next().map(LineIntervals::list);
        let own = own.unwrap_or_default();
        let place = self.lines.len();
        self.lines.push(String::new());
        let described = match node {
            SolidNode::Operand(index) => {
                let operand = &self.solid.operands()[*index];
                let name = operand.surface.shape().name;
                let subtracted = if operand.is_subtracted {
                    ", subtracted"
                } else {
                    ""
                };
                format!("operand {index}, {name}{subtracted}: {}", union(&own))
            }
            SolidNode::Operation(operation, nodes) => {
                let parts = nodes.iter().map(|node| self.add(node, depth + 1));
                let parts: Vec<Vec<[f64; 2]>> = parts.collect();
                let (name, combined) = (operation.name(), combined(*operation, &parts));
                let union = union(&own);
                if combined == union {
                    format!("{name} of: {union}")
                } else {
                    format!("{name} of: {combined} = {union}")
                }
            }
        };
        self.lines[place] = "  ".repeat(depth) + &described;
        own
    }
}

/// An operation on unions of intervals.
fn combined(operation: CsgOperation, parts: &[Vec<[f64; 2]>]) -> String {
    let parts: Vec<String> = parts.iter().map(|part| in_parentheses(part)).collect();
    match (operation, &parts[..]) {
        (_, []) => union(&[]),
        (CsgOperation::Union, parts) => parts.join(" ∪ "),
        (CsgOperation::Intersection, parts) => parts.join(" ∩ "),
        (CsgOperation::Difference, [first]) => first.clone(),
        (CsgOperation::Difference, [first, second]) => format!("{first} \\ {second}"),
        (CsgOperation::Difference, [first, others @ ..]) => {
            format!("{first} \\ ({})", others.join(" ∪ "))
        }
    }
}

fn in_parentheses(intervals: &[[f64; 2]]) -> String {
    if intervals.len() > 1 {
        format!("({})", union(intervals))
    } else {
        union(intervals)
    }
}

/// The union of intervals.
fn union(intervals: &[[f64; 2]]) -> String {
    let end = |t: f64| {
        if t.is_finite() {
            text(t)
        } else if t < 0.0 {
            "−∞".to_owned()
        } else {
            "∞".to_owned()
        }
    };
    let interval = |&[start, stop]: &[f64; 2]| {
        let left = if start.is_finite() { '[' } else { '(' };
        let right = if stop.is_finite() { ']' } else { ')' };
        format!("{left}{}, {}{right}", end(start), end(stop))
    };
    if intervals.is_empty() {
        return "∅".to_owned();
    }
    let all: Vec<String> = intervals.iter().map(interval).collect();
    all.join(" ∪ ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_on_intervals_are_written_as_on_sets() {
        let (one, two) = (vec![[1.0, 2.0]], vec![[0.5, 1.5], [3.0, f64::INFINITY]]);
        let parts = [one, two, Vec::new()];
        for (operation, expected) in [
            (CsgOperation::Union, "[1, 2] ∪ ([0.5, 1.5] ∪ [3, ∞)) ∪ ∅"),
            (
                CsgOperation::Intersection,
                "[1, 2] ∩ ([0.5, 1.5] ∪ [3, ∞)) ∩ ∅",
            ),
            (
                CsgOperation::Difference,
                "[1, 2] \\ (([0.5, 1.5] ∪ [3, ∞)) ∪ ∅)",
            ),
        ] {
            assert_eq!(combined(operation, &parts), expected);
        }
        let half = [[f64::NEG_INFINITY, -1.0]];
        assert_eq!(union(&half), "(−∞, -1]");
        assert_eq!(combined(CsgOperation::Difference, &parts[..1]), "[1, 2]");
    }

    #[test]
    fn the_nearest_number_counts_on_either_side() {
        assert_eq!(nearest(&[1.0, 4.0], 2.0), Some(1.0));
        assert_eq!(nearest(&[1.0, 4.0], 3.0), Some(4.0));
        assert_eq!(nearest(&[], 3.0), None);
    }
}
