//! Reports of measurements: JSON, an HTML page and text tables.

mod accuracy;
mod scene;
mod shapes;
mod text;

pub use scene::{SceneLine, scene_for_page, scene_lines};
pub use shapes::{is_in_shape_table, shape_table, summary_table};
pub use text::{accuracy_table, is_in_accuracy_table, print};

use crate::json;
use crate::measure::contestants::{Contestant, contestants};
use crate::measure::lecture::LECTURE;
use crate::measure::statistics::{bound_per_million, per_million};
use crate::measure::triangles::TriangleCell;
use crate::measure::{CaseInfo, Measurements, all_cases, cells_of};
use accuracy::{Accuracy, Figures};
use hitscope_core::shape::Triangle;
use hitscope_core::spawn::SPAWN_POLICIES;
use serde_json::{Value, json};

/// The page, whose script draws the plots and tables from the embedded JSON, and its placeholders.
const PAGE: &str = include_str!("page/page.html");
const STYLE: (&str, &str) = ("/*CSS*/", include_str!("page/page.css"));
const SCRIPT: (&str, &str) = (
    "/*SCRIPT*/",
    concat!(
        include_str!("page/figures.js"),
        include_str!("page/tables.js"),
        include_str!("page/plot.js"),
        include_str!("page/convergence.js"),
        include_str!("page/scene.js"),
        include_str!("page/sections.js"),
    ),
);
const JSON: &str = "/*LAB_JSON*/";

/// Facts about a run.
#[derive(Clone, Debug, serde::Serialize)]
pub struct RunInfo {
    /// Version of hitscope.
    pub version: &'static str,
    /// The command line.
    pub command: String,
    /// CPU, threads, SIMD level.
    pub machine: String,
    /// Start, in UTC and ISO 8601, to the second.
    pub started: String,
    /// Duration.
    pub seconds: f64,
    /// The random seed.
    pub seed: u64,
    /// `quick` or `full`.
    pub size: &'static str,
}

/// All results as JSON, the contents of `lab.json`.
pub fn to_json(about: &RunInfo, all: &Measurements) -> Value {
    let cases: Vec<CaseInfo> = all_cases()
        .into_iter()
        .filter(|case| has_case(all, &case.name))
        .collect();
    let kernels: Vec<Value> = contestants::<Triangle>()
        .into_iter()
        .map(|contestant| kernel_json(contestant, all))
        .collect();
    let policies: Vec<Value> = SPAWN_POLICIES
        .iter()
        .map(
            |p| json!({"name": p.name, "title": p.title, "source": p.source, "summary": p.summary}),
        )
        .collect();
    json!({
        "about": about,
        "kernels": kernels,
        "cases": cases,
        "triangles": all.triangles.iter().map(triangle_json).collect::<Vec<_>>(),
        "meshes": all.meshes,
        "order": all.order,
        "boxes": all.boxes,
        "policies": policies,
        "spawning": all.spawning,
        "shape_kernels": shapes::kernels_json(all),
        "shapes": all.shapes,
        "shape_spawning": all.shape_spawning,
        "packing": all.packing,
        "aligned_speed": all.shape_speed.iter().filter(|row| row.is_aligned).collect::<Vec<_>>(),
    })
}

/// All results as a self-contained HTML page.
pub fn to_page(json: &Value) -> String {
    // `</` would end the script element.
    PAGE.replace(STYLE.0, STYLE.1)
        .replace(SCRIPT.0, SCRIPT.1)
        .replace(JSON, &json::to_line(json).replace("</", "<\\/"))
}

fn has_case(all: &Measurements, name: &str) -> bool {
    all.triangles.iter().any(|cell| cell.case == name)
        || all.meshes.iter().any(|cell| cell.case == name)
        || all.order.iter().any(|cell| cell.case == name)
        || all.boxes.iter().any(|cell| cell.case == name)
        || all.spawning.iter().any(|cell| cell.case == name)
        || all.shapes.iter().any(|cell| cell.case == name)
        || all.shape_spawning.iter().any(|cell| cell.case == name)
}

fn kernel_json(contestant: Contestant, all: &Measurements) -> Value {
    let speed = all
        .speed
        .iter()
        .find(|speed| speed.kernel == contestant.name());
    let accuracy = Accuracy::of(cells_of(&all.triangles, contestant).map(Figures::from));
    let (title, tier, precision, source, summary) = match contestant {
        Contestant::Kernel(kernel) => {
            let info = kernel.info;
            let tier = info.tier.map(|tier| tier.name());
            (
                info.title,
                tier,
                info.precision.name(),
                info.source,
                info.summary,
            )
        }
        Contestant::AsPrinted(program) => {
            let info = &program.info;
            (info.title, None, "f32", LECTURE, info.summary)
        }
    };
    json!({
        "name": contestant.name(),
        "title": title,
        "tier": tier,
        "precision": precision,
        "source": source,
        "summary": summary,
        "speed": speed,
        "accuracy": accuracy,
    })
}

fn triangle_json(cell: &TriangleCell) -> Value {
    let mut json = json!(cell);
    json["missed_per_million"] = json!(per_million(cell.missed, cell.n));
    json["false_per_million"] = json!(per_million(cell.false_hits, cell.n));
    json["bound_per_million"] = json!(bound_per_million(cell.n));
    json
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_contains_style_script_and_data_and_no_placeholder() {
        let about = RunInfo {
            version: "0",
            command: "</script>".to_owned(),
            machine: String::new(),
            started: String::new(),
            seconds: 0.0,
            seed: 1,
            size: "quick",
        };
        let page = to_page(&to_json(&about, &Measurements::default()));
        assert!(page.contains(STYLE.1) && page.contains(SCRIPT.1));
        assert!(
            page.contains("<\\/script>"),
            "data must not end its script element"
        );
        for (placeholder, n) in [(STYLE.0, 0), (SCRIPT.0, 0), (JSON, 0)] {
            assert_eq!(page.matches(placeholder).count(), n, "{placeholder}");
        }
        assert_eq!(page.matches("</script>").count(), 2);
    }
}
