//! The tier that a scene requires, with reasons.
//!
//! `watertight` and the tiers above it decide every ray correctly. Beyond the thresholds, `fast` decides more than
//! one ray in a thousand wrongly, as measured by `hitscope lab --case sliver --case far --case scale`.

use glam::UVec2;
use hitscope_core::Scene;
use hitscope_core::camera::Turntable;
use hitscope_core::counts::{counted, grouped};
use hitscope_core::kernel::Tier;
use hitscope_core::mesh::{Flaw, Health, SAFE_SIZE, SLIVER_ASPECT};
use serde::Serialize;
use std::cmp::Reverse;

/// Ratio of distance to triangle size above which `fast` decides more than one ray in a thousand wrongly.
const FAR_FOR_F32: f64 = 1e4;
/// Ratio of distance from (0, 0, 0) to size above which the distance is reported.
const FAR_OUT: f64 = 100.0;

/// A tier, and the reasons for it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Requirement {
    /// The tier's name for `--kernel`.
    #[serde(rename = "name")]
    pub tier: &'static str,
    /// One sentence per reason.
    pub reasons: Vec<String>,
}

/// Determines the tier from shared edges, size, slivers, offset and the distance of the starting view.
pub fn required_tier(scene: &Scene, health: &Health) -> Requirement {
    let mesh = scene.mesh();
    let mut found = TierReasons::default();
    let triangles = mesh.triangles().len();
    if scene.primitive_count() == 0 {
        found.add(Tier::Fast, "The scene is empty.");
    } else if triangles == 0 {
        found.add(
            Tier::Watertight,
            "The scene has no triangles, between which gaps could show; the fast kernels of other shapes err from far away.",
        );
    } else {
        found.add_for_edges(health, triangles);
    }

    let size = 2.0 * scene.bounds().radius();
    if triangles > 0 && !SAFE_SIZE.contains(&size) {
        let (least, most) = (SAFE_SIZE.start(), SAFE_SIZE.end());
        found.add(Tier::Precise, format!(
            "The scene is {size:.1e} units large: outside {least:e} to {most:e}, products of lengths leave f32's range, and the watertight and exact kernels may test nearly every triangle again, one by one."
        ));
    }
    if health.max_aspect > SLIVER_ASPECT {
        found.add(
            Tier::Watertight,
            format!(
                "{} with aspect ratios up to {}: the fast kernel decides some of their rays wrongly.",
                counted(health.places(Flaw::Sliver).count().unwrap_or(0), "sliver"),
                rounded(health.max_aspect)
            ),
        );
    }
    if let Some(distance) = distance_in_triangles(scene)
        && distance > FAR_FOR_F32
    {
        found.add(Tier::Watertight, format!(
            "The distance of the starting view is {} times the median triangle size: the fast kernel decides some rays wrongly.",
            rounded(distance)
        ));
    }
    let offset = mesh.origin().length();
    if size > 0.0 && offset > FAR_OUT * size {
        found.push(None, format!(
            "The scene lies {} times its size from (0, 0, 0): it is traced relative to an origin nearby, which costs no kernel accuracy.",
            rounded(offset / size)
        ));
    }
    // The highest tier comes first.
    found.reasons.sort_by_key(|(tier, _)| Reverse(*tier));
    let tier = found.reasons.first().and_then(|(tier, _)| *tier);
    Requirement {
        tier: tier.unwrap_or(Tier::Fast).name(),
        reasons: found
            .reasons
            .into_iter()
            .map(|(_, reason)| reason)
            .collect(),
    }
}

#[derive(Default)]
struct TierReasons {
    /// Each reason, with the tier that it requires, if any.
    reasons: Vec<(Option<Tier>, String)>,
}

impl TierReasons {
    fn add_for_edges(&mut self, health: &Health, triangles: usize) {
        let (tier, reason) = if health.places(Flaw::OpenEdge).count() == Some(3 * triangles) {
            (
                Tier::Fast,
                "No two triangles share an edge: gaps can't show.",
            )
        } else if health.is_closed() {
            (
                Tier::Watertight,
                "The mesh is closed: a gap between triangles would show.",
            )
        } else {
            (
                Tier::Watertight,
                "Triangles share edges: a gap between them would show.",
            )
        };
        self.add(tier, reason);
    }

    fn add(&mut self, tier: Tier, reason: impl Into<String>) {
        self.push(Some(tier), reason);
    }

    fn push(&mut self, tier: Option<Tier>, reason: impl Into<String>) {
        self.reasons.push((tier, reason.into()));
    }
}

/// A ratio with one significant digit.
fn rounded(ratio: f64) -> String {
    if ratio < 1e6 {
        let step = 10_f64.powi(ratio.log10().floor() as i32);
        grouped(((ratio / step).round() * step).round() as usize)
    } else {
        format!("{ratio:.0e}")
    }
}

/// The starting view's distance divided by the median of the triangles' longest edges.
fn distance_in_triangles(scene: &Scene) -> Option<f64> {
    let mesh = scene.mesh();
    let mut sizes: Vec<f64> = mesh.corner_list().into_iter().map(longest_edge).collect();
    let middle = sizes.len() / 2;
    if sizes.is_empty() {
        return None;
    }
    let (_, &mut size, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    let resolution = UVec2::new(1280, 720);
    Some(Turntable::framing(scene.bounds(), resolution).distance / size)
}

fn longest_edge([a, b, c]: [glam::Vec3; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| p.as_dvec3());
    (b - a).length().max((c - b).length()).max((a - c).length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use hitscope_core::TriangleMesh;
    use hitscope_core::group::Appearance;
    use hitscope_core::mesh::corridors::{Corridor, Footprint};
    use hitscope_core::mesh::shapes::{Placement, soup, sphere};
    use hitscope_core::progress::Progress;
    use hitscope_core::scene::{SceneOptions, scene};
    use hitscope_core::shape::AxisPlane;

    fn required(mesh: TriangleMesh) -> Requirement {
        let health = Health::of(&mesh);
        required_tier(&scene(mesh), &health)
    }

    #[test]
    fn each_extreme_requires_its_tier_for_a_reason() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        assert_eq!(required(soup(&[corners])).tier, "fast");
        assert_eq!(required(sphere(4, Placement::UNIT)).tier, "watertight");
        let tiny = required(sphere(4, Placement::new(1e-20, 0.0)));
        assert_eq!(tiny.tier, "precise");
        assert!(tiny.reasons[0].contains("f32's range"), "{tiny:?}");
        for height in [1e-5, 1e-15] {
            let thin = [Vec3::ZERO, Vec3::X, Vec3::new(0.5, height, 0.0)];
            let sliver = required(soup(&[thin]));
            assert_eq!(sliver.tier, "watertight");
            assert!(sliver.reasons[0].contains("sliver"), "{sliver:?}");
        }
        // Small triangles far apart: a view of all of them is far from each.
        let dust = |p: Vec3| corners.map(|c| p + c * 1e-6);
        let spread = required(soup(&[dust(Vec3::ZERO), dust(Vec3::X), dust(Vec3::Y)]));
        assert_eq!(spread.tier, "watertight", "{spread:?}");
    }

    #[test]
    fn a_scene_without_triangles_is_not_called_closed() {
        let mut only_planes = scene(soup(&[]));
        assert_eq!(
            required_tier(&only_planes, &Health::of(only_planes.mesh())),
            Requirement {
                tier: "fast",
                reasons: vec!["The scene is empty.".to_owned()],
            }
        );
        let plane = AxisPlane {
            axis: 2,
            coordinate: 0.0,
            is_along_axis: true,
        };
        let (options, progress) = (SceneOptions::default(), Progress::default());
        only_planes
            .add_group(vec![plane], Appearance::default(), options, &progress)
            .expect("not cancelled");
        let found = required_tier(&only_planes, &Health::of(only_planes.mesh()));
        let [reason] = &found.reasons[..] else {
            panic!("{found:?}");
        };
        assert!(reason.contains("no triangles"), "{reason}");
    }

    #[test]
    fn boxes_of_any_length_require_watertight() {
        for length in [1.0, 30.0, 100.0, 1e4, 1e9] {
            let mesh = Corridor::new(Footprint::Square, length, false).mesh;
            assert_eq!(required(mesh).tier, "watertight", "{length}");
        }
    }

    #[test]
    fn an_offset_is_reported_but_requires_no_tier() {
        let mesh = sphere(4, Placement::UNIT);
        let found = required(mesh.with_origin(DVec3::splat(1e6)));
        assert_eq!(found.tier, "watertight");
        assert!(found.reasons[1].contains("(0, 0, 0)"), "{found:?}");
    }
}
