//! Faces, lines and points that can't be shown: warnings about them, and the error if nothing is left.

use super::contents::Contents;
use super::error::{Problem, Warning};
use super::report::Dropped;
use super::skipped::Skipped;
use super::tally::{Tally, lines_or_points};
use crate::counts::{counted, counted_as, grouped};

/// Count and first line of each oddity.
#[derive(Default)]
pub(super) struct Oddities {
    /// Triangles that are dropped.
    pub non_finite: Tally,
    pub zero_area: Tally,
    /// Polygons.
    pub fan: Tally,
    pub incomplete: Tally,
    /// Lines and points that are dropped.
    pub not_finite_elements: usize,
}

impl Oddities {
    pub(super) fn append(&mut self, later: Self) {
        self.non_finite.append(later.non_finite);
        self.zero_area.append(later.zero_area);
        self.fan.append(later.fan);
        self.incomplete.append(later.incomplete);
        self.not_finite_elements += later.not_finite_elements;
    }

    /// The counts of what was dropped, with that of skipped elements.
    pub(super) fn dropped(&self, skipped: &Skipped) -> Dropped {
        Dropped {
            zero_area: self.zero_area.count,
            non_finite: self.non_finite.count,
            bad_index: skipped.faces.count,
            elements: self.not_finite_elements + skipped.others.count,
        }
    }

    pub(super) fn warnings(self) -> impl Iterator<Item = Warning> {
        let elements = self.not_finite_elements;
        let of_elements = (elements > 0).then(|| {
            let elements = lines_or_points(elements);
            Warning::of_file(format!(
                "{elements} dropped: a vertex is not finite or too large"
            ))
        });
        [
            self.non_finite.warning(|triangles| {
                let triangles = counted(triangles, "triangle");
                format!("{triangles} dropped: a corner is not finite or too large")
            }),
            self.zero_area.warning(|triangles| {
                let triangles = counted(triangles, "triangle");
                format!("{triangles} dropped: zero area")
            }),
            self.fan.warning(|fans| {
                let polygons = counted_as(
                    fans,
                    "polygon triangulated as a fan",
                    "polygons triangulated as fans",
                );
                format!("{polygons}: self-intersecting, without a plane or with too many corners")
            }),
            self.incomplete.warning(|polygons| {
                let polygons = counted(polygons, "polygon");
                format!("{polygons} triangulated without some corners: the mesh may be open there")
            }),
            of_elements,
        ]
        .into_iter()
        .flatten()
    }
}

/// The error that a file gives no triangles, with the reason.
pub(super) fn no_triangles(contents: &Contents, dropped: Dropped, vertex_count: usize) -> Problem {
    let Dropped {
        zero_area,
        non_finite,
        bad_index,
        ..
    } = dropped;
    let element_count = contents.element_count;
    let message = if zero_area + non_finite > 0 {
        let reasons = [
            (zero_area, "with zero area"),
            (
                non_finite,
                "with a corner that is NaN, infinite or too large for f32",
            ),
        ];
        let reasons = reasons.into_iter().filter(|(count, _)| *count > 0);
        let reasons = reasons.map(|(count, why)| format!("{} {why}", grouped(count)));
        let reasons = reasons.collect::<Vec<_>>().join(", ");
        let message = format!("no triangles left: {reasons}");
        return Problem::line(contents.face_lines.line(0), message);
    } else if bad_index > 0 {
        let message = format!(
            "no faces left: {} with an index that is out of range or fewer than three corners",
            grouped(bad_index)
        );
        return Problem::line(contents.skipped.faces.first_line, message);
    } else if element_count > 0 {
        format!("no faces, only {}", lines_or_points(element_count))
    } else if vertex_count > 0 {
        format!(
            "no faces, only {}",
            counted_as(vertex_count, "vertex", "vertices")
        )
    } else {
        "no vertices and no faces: this is not an OBJ file".to_owned()
    };
    Problem::Content(message)
}
