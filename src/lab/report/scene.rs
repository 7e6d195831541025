//! The report of the measurement of the user's scene, for the page.

use super::RunInfo;
use crate::measure::scene::{OF_WHOLE_SCENE, SceneRow, counted_primitives, has_several_shapes};
use hitscope_core::Scene;
use serde_json::{Value, json};

/// The results of a scene as [`to_page`](super::to_page) takes them.
pub fn scene_for_page(about: &RunInfo, file: &str, scene: &Scene, rows: &[SceneRow]) -> Value {
    json!({
        "about": about,
        "file": file,
        "scene": {
            "contents": counted_primitives(scene),
            "note": has_several_shapes(rows).then_some(OF_WHOLE_SCENE),
            "kernels": entries(rows),
        },
    })
}

/// A line of a report: a kernel, or in a scene of several shapes a tier, whose figures are the same for every shape.
pub struct SceneLine<'r> {
    /// The shape that the kernel tests; “every shape” for a tier.
    pub heading: &'static str,
    /// The name of the kernel or of the tier.
    pub name: &'static str,
    /// The title of the kernel, or the name of the tier.
    pub title: &'static str,
    /// The figures.
    pub row: &'r SceneRow,
}

/// The lines of a report: in a scene of several shapes the tiers, once each, then the other kernels shape by shape.
pub fn scene_lines(rows: &[SceneRow]) -> Vec<SceneLine<'_>> {
    let has_several_shapes = has_several_shapes(rows);
    let tier_of = |row: &SceneRow| row.tier.filter(|_| has_several_shapes);
    let line = |row| match tier_of(row) {
        Some(tier) => SceneLine {
            heading: "every shape",
            name: tier,
            title: tier,
            row,
        },
        None => SceneLine {
            heading: row.shape,
            name: row.info.name,
            title: row.info.title,
            row,
        },
    };
    let (tiers, others): (Vec<_>, Vec<_>) = rows.iter().partition(|row| tier_of(row).is_some());
    let tiers = tiers.into_iter().filter(|row| row.shape == rows[0].shape);
    tiers.chain(others).map(line).collect()
}

/// The kernels in the form that the page draws.
fn entries(rows: &[SceneRow]) -> Vec<Value> {
    let entry = |line: SceneLine<'_>| {
        let SceneLine {
            name, title, row, ..
        } = line;
        let info = row.info;
        json!({
            "name": name,
            "title": title,
            "tier": row.tier,
            "precision": info.precision.name(),
            "summary": info.summary,
            "speed": row.speed,
            "accuracy": {
                "n": row.n,
                "hits": row.hits,
                "missed": row.missed,
                "false_hits": row.false_hits,
                "other": row.other_triangle,
                "wrong_per_million": row.wrong_per_million,
                "bound_per_million": row.bound_per_million,
                "t_ulps_p99": row.t_ulps.map(|t| t.p99),
                "t_ulps_max": row.t_ulps.map(|t| t.max),
            },
        })
    };
    scene_lines(rows).into_iter().map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::scene::{SceneSizes, measure, measured_kernels};
    use crate::measure::speed::default_camera;
    use glam::Vec3;
    use hitscope_core::mesh::Runs;
    use hitscope_core::mesh::shapes::{Placement, cube};
    use hitscope_core::progress::Progress;
    use hitscope_core::scene::SceneOptions;
    use hitscope_core::shape::Sphere;
    use std::collections::HashSet;

    fn rows(scene: &Scene) -> Vec<SceneRow> {
        let sizes = SceneSizes {
            timed: 50,
            rounds: 1,
            checked: 20,
        };
        let mut rows = Vec::new();
        let (camera, progress) = (default_camera(scene), Progress::default());
        let measured = measure(scene, &camera, sizes, &progress, |row| rows.push(row));
        measured.expect("never cancelled");
        rows
    }

    #[test]
    fn a_tier_has_one_line_if_there_are_several_shapes() {
        let mut scene = hitscope_core::scene::scene(cube(2, Placement::UNIT));
        let of_one = rows(&scene);
        let lines = scene_lines(&of_one);
        assert_eq!(lines.len(), measured_kernels(&scene).len());
        assert!(lines.iter().all(|line| line.heading == "triangle"));
        let sphere = Sphere {
            centre: Vec3::ZERO,
            radius: 1.5,
        };
        let (options, progress) = (SceneOptions::default(), Progress::default());
        let added = scene.add_group(vec![sphere], Runs::default(), options, &progress);
        added.expect("never cancelled");
        let of_both = rows(&scene);
        let lines = scene_lines(&of_both);
        let tiers = lines
            .iter()
            .take_while(|line| line.heading == "every shape");
        let tiers: Vec<&str> = tiers.map(|line| line.name).collect();
        let each_once: HashSet<&str> = tiers.iter().copied().collect();
        assert_eq!((tiers.len(), each_once.len()), (4, 4), "{tiers:?}");
        let others = of_both.iter().filter(|row| row.tier.is_none()).count();
        assert_eq!(lines.len(), tiers.len() + others);
        assert!(
            lines[tiers.len()..]
                .iter()
                .all(|line| line.row.tier.is_none())
        );
    }
}
