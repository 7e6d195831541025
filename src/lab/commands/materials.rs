//! The materials of a loaded scene, as `hitscope info` lists them.

use glam::Vec3;
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
    /// The properties that a material library gives, by keyword: colours and numbers.
    pub properties: Vec<PropertyInfo>,
    /// Whether the material is opaque and its back has the front's model.
    pub is_two_sided: bool,
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

/// A property of a material in a library.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PropertyInfo {
    /// The keyword.
    pub keyword: &'static str,
    /// The number, or the three of a colour.
    pub value: Vec<f32>,
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
            properties: properties(material),
            is_two_sided: back.is_none() && !front.model().transmits,
            emission: material.emission.to_array(),
            opacity: material.opacity,
            maps: maps(material, list),
            triangles,
            shapes,
        }
    }
}

/// The properties that a material library gives, except those that don't change the picture.
fn properties(material: &Material) -> Vec<PropertyInfo> {
    if material.sides.is_some() {
        return Vec::new();
    }
    let colour = |rgb: Vec3| rgb.to_array().to_vec();
    let has_highlights = material.illumination.has_highlights() && material.specular != Vec3::ZERO;
    let given = [
        ("Kd", material.diffuse.map(colour)),
        ("Ks", has_highlights.then(|| colour(material.specular))),
        ("Ns", has_highlights.then(|| vec![material.shininess])),
        ("Ni", material.is_glass().then(|| vec![material.refraction])),
        ("Tf", material.filter.map(colour)),
        ("Pr", material.roughness.map(|x| vec![x])),
        ("Pm", material.metalness.map(|x| vec![x])),
    ];
    let named = given.into_iter();
    named
        .filter_map(|(keyword, value)| {
            let value = value?;
            Some(PropertyInfo { keyword, value })
        })
        .collect()
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

/// Numbers with four significant digits: one, or a list in brackets.
pub(super) fn rounded(numbers: &[f32]) -> String {
    let text = |x: f32| {
        let short: f64 = format!("{x:.3e}").parse().unwrap_or(f64::from(x));
        let is_plain = short == 0.0 || (1e-4..1e7).contains(&short.abs());
        if is_plain {
            format!("{short}")
        } else {
            format!("{short:e}")
        }
    };
    match numbers {
        [only] => text(*only),
        all => {
            let texts: Vec<String> = all.iter().map(|&x| text(x)).collect();
            format!("[{}]", texts.join(", "))
        }
    }
}

impl fmt::Display for MaterialInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A name in a file may contain control characters.
        let name = match self.name.as_str() {
            "" => "(no name)".to_owned(),
            name => shown(Path::new(name)),
        };
        write!(f, "{name}: {}", self.model)?;
        if self.properties.is_empty() {
            write!(f, ", colour {}", rounded(&self.colour))?;
        }
        for PropertyInfo { keyword, value } in &self.properties {
            write!(f, ", {keyword} {}", rounded(value))?;
        }
        match self.back {
            Some(back) => write!(f, ", back {back}")?,
            // Materials of libraries are two-sided unless a scene file says otherwise, so the text doesn't mention it.
            None if self.is_two_sided && self.properties.is_empty() => write!(f, ", both sides")?,
            None => {}
        }
        if self.emission != [0.0; 3] {
            write!(f, ", emission {}", rounded(&self.emission))?;
        }
        if self.opacity < 1.0 {
            write!(f, ", opacity {}", rounded(&[self.opacity]))?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::mesh::Illumination;

    #[test]
    fn numbers_have_four_digits() {
        assert_eq!(rounded(&[0.700_000_05]), "0.7");
        assert_eq!(rounded(&[0.0, 1.0, 0.333_333_34]), "[0, 1, 0.3333]");
        assert_eq!(rounded(&[1.25e-9]), "1.25e-9");
    }

    #[test]
    fn a_material_of_a_library_is_listed_with_what_the_library_says() {
        let glossy = Material {
            diffuse: Some(Vec3::new(0.5, 0.1, 0.1)),
            specular: Vec3::splat(0.4),
            shininess: 20.0,
            roughness: Some(0.25),
            ..Material::named("glossy")
        };
        let text = MaterialInfo::with_uses(&glossy, [2, 0], &[]).to_string();
        let expected = "glossy: metal-rough, Kd [0.5, 0.1, 0.1], Ks [0.4, 0.4, 0.4], Ns 20, Pr 0.25; 2 triangles";
        assert_eq!(text, expected);
        let glass = Material {
            illumination: Illumination::Glass,
            refraction: 1.5,
            filter: Some(Vec3::new(0.9, 1.0, 0.9)),
            ..Material::named("glass")
        };
        let text = MaterialInfo::with_uses(&glass, [0, 0], &[]).to_string();
        assert_eq!(
            text,
            "glass: dielectric, Ni 1.5, Tf [0.9, 1, 0.9]; not used"
        );
    }
}
