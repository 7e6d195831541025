//! The parts that a scene has: groups, materials or shapes.

use hitscope_core::Scene;
use hitscope_core::tone::Display;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// How primitives are grouped into parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Grouping {
    /// By groups and objects of the file; other shapes by their kind.
    #[default]
    Groups,
    /// By material.
    Materials,
    /// By kind of shape.
    Shapes,
}

impl Grouping {
    /// All groupings.
    pub const ALL: [Self; 3] = [Self::Groups, Self::Materials, Self::Shapes];

    /// The title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Groups => "Groups",
            Self::Materials => "Materials",
            Self::Shapes => "Shapes",
        }
    }
}

/// Identifies a part, also after a reload of its file.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct PartKey {
    /// The grouping that it belongs to.
    pub grouping: Grouping,
    /// The kind of its shapes; empty for a material.
    #[serde(default)]
    pub kind: String,
    /// Its name in the file, or a substitute.
    pub name: String,
    /// The number of parts before it that have the same name.
    #[serde(default)]
    pub same_before: u32,
}

/// A part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its identity.
    pub key: PartKey,
    /// The number of its primitives.
    pub count: usize,
    /// sRGB of the material's diffuse colour; `None` if the part has several materials or its material has no colour.
    pub colour: Option<[u8; 3]>,
}

/// The parts of a scene, and the part of each primitive.
#[derive(Clone, Debug)]
pub struct PartList {
    /// The parts in the order of their first primitives.
    pub parts: Vec<Part>,
    part_of: Vec<u32>,
}

impl PartList {
    /// The parts of a scene.
    pub fn of(scene: &Scene, grouping: Grouping) -> Self {
        let mut list = Self {
            parts: Vec::new(),
            part_of: Vec::with_capacity(scene.primitive_count()),
        };
        let mut numbers = HashMap::new();
        let mut same: HashMap<PartKey, u32> = HashMap::new();
        // The material of each part; `None` if it has several.
        let mut materials = Vec::new();
        for (group_index, group) in (0u32..).zip(scene.groups()) {
            let first = list.part_of.len() as u32;
            for primitive in first..first + group.count() as u32 {
                let is_triangle = scene.is_triangle(primitive);
                let material = scene.material(primitive);
                // Groups of triangles and the other groups are numbered separately.
                let key = match grouping {
                    Grouping::Groups if is_triangle => {
                        (0, scene.mesh().attributes().groups.index(primitive))
                    }
                    Grouping::Groups | Grouping::Shapes => (1, group_index),
                    Grouping::Materials => (0, material),
                };
                let number = *numbers.entry(key).or_insert_with(|| {
                    let mut part = part(scene, grouping, primitive);
                    let before = same.entry(part.key.clone()).or_default();
                    part.key.same_before = *before;
                    *before += 1;
                    list.parts.push(part);
                    materials.push(Some(material));
                    list.parts.len() - 1
                });
                list.parts[number].count += 1;
                if materials[number] != Some(material) {
                    materials[number] = None;
                }
                list.part_of.push(number as u32);
            }
        }
        for (part, material) in list.parts.iter_mut().zip(materials) {
            part.colour = material.and_then(|material| colour(scene, material));
        }
        list
    }

    /// The number of a primitive's part.
    pub fn part_of(&self, primitive: u32) -> usize {
        self.part_of[primitive as usize] as usize
    }

    /// The numbers of the parts of all primitives.
    pub fn all(&self) -> impl ExactSizeIterator<Item = usize> {
        self.part_of.iter().map(|&part| part as usize)
    }
}

/// The part of a primitive, with no primitives and no colour yet.
fn part(scene: &Scene, grouping: Grouping, primitive: u32) -> Part {
    let attributes = scene.mesh().attributes();
    let named = |name: Option<&str>, otherwise: &str| match name {
        None | Some("") => otherwise.to_owned(),
        Some(name) => name.to_owned(),
    };
    let material = attributes.materials.get(scene.material(primitive));
    let shapes = scene.group_of(primitive).0.shape().plural;
    let is_material = grouping == Grouping::Materials;
    let name = match grouping {
        Grouping::Groups if scene.is_triangle(primitive) => {
            let group = attributes.groups.of(primitive);
            named(group.map(String::as_str), "(no group)")
        }
        Grouping::Groups | Grouping::Shapes => shapes.to_owned(),
        Grouping::Materials => named(material.map(|m| m.name.as_str()), "(no material)"),
    };
    Part {
        key: PartKey {
            grouping,
            kind: if is_material { "" } else { shapes }.to_owned(),
            name,
            same_before: 0,
        },
        count: 0,
        colour: None,
    }
}

/// sRGB of a material's diffuse colour.
fn colour(scene: &Scene, material: u32) -> Option<[u8; 3]> {
    let material = scene.mesh().attributes().materials.get(material)?;
    let [r, g, b, _] = Display::default().encode(material.diffuse?);
    Some([r, g, b])
}
