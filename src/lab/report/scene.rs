//! The report of the measurement of the user's scene, for the page.

use super::RunInfo;
use crate::measure::scene::{OF_WHOLE_SCENE, SceneRow, counted_primitives, has_several_shapes};
use hitscope_core::Scene;
use serde_json::{Value, json};

/// The results of a scene as [`to_page`](super::to_page) takes them.
pub fn scene_for_page(about: &RunInfo, file: &str, scene: &Scene, rows: &[SceneRow]) -> Value {
    let has_several_shapes = has_several_shapes(rows);
    json!({
        "about": about,
        "file": file,
        "scene": {
            "contents": counted_primitives(scene),
            "note": has_several_shapes.then_some(OF_WHOLE_SCENE),
            "kernels": entries(rows, has_several_shapes),
        },
    })
}

/// The kernels as the page draws them. In a scene of several shapes, each tier has one entry.
fn entries(rows: &[SceneRow], has_several_shapes: bool) -> Vec<Value> {
    let is_first = |row: &SceneRow| row.tier.is_none() || row.shape == rows[0].shape;
    let entry = |row: &SceneRow| {
        let info = row.info;
        let (name, title) = match row.tier {
            Some(tier) if has_several_shapes => (tier, tier),
            _ => (info.name, info.title),
        };
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
    let shown = rows
        .iter()
        .filter(|row| !has_several_shapes || is_first(row));
    shown.map(entry).collect()
}
