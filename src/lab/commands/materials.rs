//! The materials of a loaded scene, as `hitscope info` lists them.

use hitscope_core::Scene;
use hitscope_core::bsdf::{Scatter as _, Slot};
use hitscope_core::counts::counted;
use hitscope_core::mesh::{Material, Property, Relief, ReliefKind, Side, Texture, TextureMap};
use hitscope_core::obj::shown;
use serde::Serialize;
use std::fmt;
use std::path::Path;

/// A material and its use. Colours are linear RGB.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialInfo {
    /// The name in the file; empty for none.
    pub name: String,
    /// The model of the front.
    pub model: &'static str,
    /// The model of the back; null if it is the front's.
    pub back: Option<&'static str>,
    /// About the part of light from everywhere that the front reflects or lets pass, without textures.
    pub colour: [f32; 3],
    /// The emitted light, without textures.
    pub emission: [f32; 3],
    /// The part of the surface that is there, without textures.
    pub opacity: f32,
    /// The textures.
    pub maps: Vec<MapInfo>,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of other primitives.
    pub shapes: usize,
}

/// A texture of a material.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MapInfo {
    /// The property that it gives or multiplies.
    pub of: String,
    /// The name of the picture, or “checkerboard”.
    pub texture: String,
}

impl MaterialInfo {
    /// The materials that primitives have or that have a name.
    pub fn of(scene: &Scene) -> Vec<Self> {
        let attributes = scene.mesh().attributes();
        let entries = attributes.materials.entries();
        let mut uses = vec![[0; 2]; entries.len()];
        for primitive in 0..scene.primitive_count() as u32 {
            if let Some(counts) = uses.get_mut(scene.material(primitive) as usize) {
                counts[usize::from(!scene.is_triangle(primitive))] += 1;
            }
        }
        let listed = entries.iter().zip(uses);
        let listed = listed.filter(|(material, uses)| {
            let is_named = !material.name.is_empty();
            is_named || *uses != [0; 2]
        });
        listed
            .map(|(material, uses)| Self::with_uses(material, uses, &attributes.textures))
            .collect()
    }

    fn with_uses(material: &Material, [triangles, shapes]: [usize; 2], list: &[Texture]) -> Self {
        let front = material.bsdf();
        let back = match &material.sides {
            // Light passes through both sides alike.
            Some(_) if front.model().transmits => None,
            Some(sides) => match &sides.back {
                Some(back) if *back == sides.front => None,
                Some(back) => Some(back.bsdf.model().name),
                None => Some("black"),
            },
            None => (!material.is_two_sided && !front.model().transmits).then_some("black"),
        };
        Self {
            name: material.name.clone(),
            model: front.model().name,
            back,
            colour: front.colour().to_array(),
            emission: material.emission.to_array(),
            opacity: material.opacity,
            maps: maps(material, list),
            triangles,
            shapes,
        }
    }
}

/// The textures of a material.
fn maps(material: &Material, list: &[Texture]) -> Vec<MapInfo> {
    let map = |of: String, map: &TextureMap| MapInfo {
        of,
        texture: texture_name(list.get(map.texture as usize)),
    };
    let relief = |relief: &Relief| {
        let of = match relief.kind {
            ReliefKind::Normals { .. } => "normals",
            ReliefKind::Heights { .. } => "heights",
        };
        (of, relief.map)
    };
    let diffuse = material.diffuse_map.map(|map| ("diffuse", map));
    let further = material.further_maps.iter();
    let further = further.map(|(property, map)| (property_name(*property), *map));
    let of_material = diffuse.into_iter().chain(further);
    let of_material = of_material.chain(material.relief.as_ref().map(relief));
    let mut found: Vec<MapInfo> = of_material
        .map(|(of, texture)| map(of.to_owned(), &texture))
        .collect();
    let Some(sides) = material.sides.as_deref() else {
        return found;
    };
    let mut add = |side: &Side, prefix: &str| {
        let maps = side.maps.iter().map(|(slot, map)| (slot_name(*slot), *map));
        let maps = maps.chain(side.relief.as_ref().map(relief));
        found.extend(maps.map(|(of, texture)| map(format!("{prefix}{of}"), &texture)));
    };
    add(&sides.front, "");
    if let Some(back) = sides.back.as_ref().filter(|back| **back != sides.front) {
        add(back, "back ");
    }
    found
}

fn property_name(property: Property) -> &'static str {
    match property {
        Property::Specular => "specular",
        Property::Emission => "emission",
        Property::Opacity => "opacity",
        Property::Roughness => "roughness",
        Property::Metalness => "metalness",
    }
}

fn slot_name(slot: Slot) -> &'static str {
    match slot {
        Slot::Diffuse => "diffuse",
        Slot::Specular => "specular",
        Slot::Transmittance => "transmittance",
        Slot::Roughness => "roughness",
    }
}

fn texture_name(texture: Option<&Texture>) -> String {
    match texture {
        Some(texture) if !texture.name.is_empty() => texture.name.clone(),
        _ => "checkerboard".to_owned(),
    }
}

impl fmt::Display for MaterialInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A name in a file may contain control characters.
        let name = match self.name.as_str() {
            "" => "(no name)".to_owned(),
            name => shown(Path::new(name)),
        };
        write!(f, "{name}: {}, colour {:?}", self.model, self.colour)?;
        if let Some(back) = self.back {
            write!(f, ", back {back}")?;
        }
        if self.emission != [0.0; 3] {
            write!(f, ", emission {:?}", self.emission)?;
        }
        if self.opacity < 1.0 {
            write!(f, ", opacity {}", self.opacity)?;
        }
        for MapInfo { of, texture } in &self.maps {
            write!(f, ", {of} from {}", shown(Path::new(texture)))?;
        }
        let uses = [(self.triangles, "triangle"), (self.shapes, "shape")];
        let uses = uses.into_iter().filter(|(count, _)| *count > 0);
        let uses: Vec<String> = uses.map(|(count, of)| counted(count, of)).collect();
        match &uses[..] {
            [] => write!(f, "; not used"),
            uses => write!(f, "; {}", uses.join(", ")),
        }
    }
}
