//! The lights of a loaded file, as `hitscope info` lists them.

use super::materials::rounded;
use glam::{DVec3, Vec3};
use hitscope_core::Scene;
use hitscope_core::counts::counted;
use hitscope_core::light::{Environment, Light};
use hitscope_core::loading::LoadedScene;
use serde::Serialize;
use std::fmt;

/// A light, or all primitives that emit the same light. Light is linear RGB, positions and directions are those of the
/// file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum LightInfo {
    /// Primitives whose material emits light.
    Area {
        /// The radiance.
        radiance: [f32; 3],
        /// Whether the back emits light, too.
        emits_on_back: bool,
        /// Number of primitives.
        primitives: usize,
        /// The sum of their areas, as far as they can be sampled.
        area: f64,
    },
    /// Light that is the same from all directions.
    Constant {
        /// The radiance.
        radiance: [f32; 3],
    },
    /// A picture of the light from all directions.
    Envmap {
        /// Width and height of the picture.
        size: [u32; 2],
        /// The factor of the picture's radiance.
        scale: f32,
        /// Memory of the picture.
        bytes: usize,
    },
    /// Light from one direction.
    Directional {
        /// The irradiance of a surface that faces the light.
        irradiance: [f32; 3],
        /// The unit direction in which the light travels.
        direction: [f32; 3],
    },
    /// Light from a point.
    Point {
        /// Power per solid angle.
        intensity: [f32; 3],
        /// The position.
        position: [f64; 3],
    },
}

impl LightInfo {
    /// The lights of a file: emitting primitives first.
    pub fn of(loaded: &LoadedScene) -> Vec<Self> {
        let scene = &loaded.scene;
        let others = loaded.lights.iter().filter_map(|light| match light {
            Light::Environment(Environment::Constant(radiance)) => Some(Self::Constant {
                radiance: radiance.to_array(),
            }),
            Light::Environment(Environment::Map(placed)) => Some(Self::Envmap {
                size: placed.map().size().to_array(),
                scale: placed.placement().scale,
                bytes: placed.map().bytes(),
            }),
            Light::Directional(light) => Some(Self::Directional {
                irradiance: light.irradiance.to_array(),
                direction: (-light.to_light).to_array(),
            }),
            Light::Point(light) => Some(Self::Point {
                intensity: light.intensity.to_array(),
                position: in_file(scene, light.position).to_array(),
            }),
            Light::Area(_) => None,
        });
        emitting(scene).into_iter().chain(others).collect()
    }
}

fn in_file(scene: &Scene, position: Vec3) -> DVec3 {
    scene.mesh().in_file(position.as_dvec3())
}

/// The emitting primitives of each material.
fn emitting(scene: &Scene) -> Vec<LightInfo> {
    let materials = &scene.mesh().attributes().materials;
    let entries = materials.entries();
    let emits = |index: usize| {
        entries
            .get(index)
            .is_some_and(|m| m.emission.max_element() > 0.0)
    };
    if !(0..entries.len()).any(emits) {
        return Vec::new();
    }
    // Number and area of the primitives of each material.
    let mut sums = vec![(0, 0.0); entries.len()];
    for primitive in 0..scene.primitive_count() as u32 {
        let index = scene.material(primitive) as usize;
        if emits(index) {
            let area = scene.area(primitive);
            sums[index].0 += 1;
            sums[index].1 += if area.is_finite() { area } else { 0.0 };
        }
    }
    let used = entries
        .iter()
        .zip(sums)
        .filter(|(_, (count, _))| *count > 0);
    used.map(|(material, (primitives, area))| LightInfo::Area {
        radiance: material.emission.to_array(),
        emits_on_back: material.emits_on_back,
        primitives,
        area,
    })
    .collect()
}

impl fmt::Display for LightInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Area {
                radiance,
                emits_on_back,
                primitives,
                area,
            } => {
                let sides = if *emits_on_back {
                    "both sides"
                } else {
                    "front"
                };
                write!(
                    f,
                    "area: {}, radiance {}, {sides}, area {}",
                    counted(*primitives, "primitive"),
                    rounded(radiance),
                    rounded(&[*area as f32])
                )
            }
            Self::Constant { radiance } => write!(f, "constant: radiance {}", rounded(radiance)),
            Self::Envmap {
                size: [width, height],
                scale,
                bytes,
            } => write!(
                f,
                "envmap: {width} x {height} pixels, scale {scale}, {bytes} bytes"
            ),
            Self::Directional {
                irradiance,
                direction,
            } => write!(
                f,
                "directional: irradiance {}, direction {}",
                rounded(irradiance),
                rounded(direction)
            ),
            Self::Point {
                intensity,
                position,
            } => write!(
                f,
                "point: intensity {}, position {position:?}",
                rounded(intensity)
            ),
        }
    }
}
