//! The materials of a scene file.

use super::textures::Textures;
use crate::bsdf::{
    self, Conductor, Dielectric, Diffuse, Law, Microfacets, Plastic, RoughConductor,
    RoughDielectric, RoughPlastic, Scatter, ThinDielectric,
};
use crate::mesh::{
    Bitangent, HeightUnit, Illumination, Material, Property, Relief, ReliefKind, Side, Sides,
};
use crate::scene_file::{self, Bsdf, Form, Roughness, SceneFile};
use glam::Vec3;

/// The materials of a scene file; the first is that of shapes without a `bsdf`.
pub(super) fn materials(file: &SceneFile, textures: &Textures) -> Vec<Material> {
    let default = std::iter::once(without_bsdf());
    let described = file.materials.iter();
    default
        .chain(described.map(|described| material(described, textures)))
        .collect()
}

/// The material of a shape without a `bsdf`: Mitsuba's default, which is black from behind.
pub(super) fn without_bsdf() -> Material {
    let front = Side::from(bsdf(&Bsdf::GREY));
    Material {
        diffuse: Some(front.bsdf.colour()),
        illumination: Illumination::Diffuse,
        sides: Some(Box::new(Sides { front, back: None })),
        ..Material::default()
    }
}

fn material(material: &scene_file::Material, textures: &Textures) -> Material {
    let front = side(&material.front, textures);
    let back = match &material.back {
        // Rough plastic takes time.
        Some(back) if *back == material.front => Some(front.clone()),
        back => back.as_ref().map(|back| side(back, textures)),
    };
    let is_matt = matches!(material.front.bsdf, Bsdf::Diffuse { .. });
    // Views without global light show a highlight in place of reflections.
    let (illumination, specular) = if is_matt {
        (Illumination::Diffuse, Vec3::ZERO)
    } else {
        (Illumination::Highlights, Vec3::splat(0.25))
    };
    let opacity_map = material.opacity_texture.as_ref();
    let opacity_map = opacity_map.and_then(|texture| textures.map(texture));
    Material {
        name: material.id.clone().unwrap_or_default(),
        diffuse: Some(front.bsdf.colour()),
        specular,
        shininess: 50.0,
        illumination,
        opacity: material.opacity as f32,
        further_maps: opacity_map
            .map(|map| (Property::Opacity, map))
            .into_iter()
            .collect(),
        sides: Some(Box::new(Sides { front, back })),
        ..Material::default()
    }
}

fn side(side: &scene_file::Side, textures: &Textures) -> Side {
    let maps = side.textures.iter();
    let maps = maps.filter_map(|(slot, texture)| Some((*slot, textures.map(texture)?)));
    let relief = side.relief.as_ref();
    Side {
        bsdf: bsdf(&side.bsdf),
        maps: maps.collect(),
        relief: relief.and_then(|described| relief_of(described, textures)),
    }
}

fn relief_of(relief: &scene_file::Relief, textures: &Textures) -> Option<Relief> {
    let kind = match relief.kind {
        scene_file::ReliefKind::Normals => ReliefKind::Normals {
            strength: 1.0,
            bitangent: Bitangent::RightHanded,
        },
        scene_file::ReliefKind::Heights { scale } => ReliefKind::Heights {
            scale: scale as f32,
            unit: HeightUnit::Scene,
        },
    };
    let map = textures.map(&relief.texture)?;
    Some(Relief { map, kind })
}

fn facets(roughness: Roughness) -> Microfacets {
    let law = if roughness.is_ggx {
        Law::Ggx
    } else {
        Law::Beckmann
    };
    Microfacets::new(law, roughness.alpha as f32)
}

fn bsdf(described: &Bsdf) -> bsdf::Bsdf {
    match *described {
        Bsdf::Diffuse { reflectance } => bsdf::Bsdf::Diffuse(Diffuse {
            reflectance: reflectance.as_vec3(),
        }),
        Bsdf::Conductor {
            eta,
            k,
            specular_reflectance,
            roughness,
        } => {
            let metal = Conductor {
                eta: eta.as_vec3(),
                k: k.as_vec3(),
                reflectance: specular_reflectance.as_vec3(),
            };
            match roughness.map(facets) {
                None => bsdf::Bsdf::Conductor(metal),
                Some(facets) => bsdf::Bsdf::RoughConductor(RoughConductor { metal, facets }),
            }
        }
        Bsdf::Dielectric {
            eta,
            specular_reflectance,
            specular_transmittance,
            form,
        } => {
            let media = Dielectric {
                eta: eta as f32,
                reflectance: specular_reflectance.as_vec3(),
                transmittance: specular_transmittance.as_vec3(),
            };
            match form {
                Form::Smooth => bsdf::Bsdf::Dielectric(media),
                Form::Thin => bsdf::Bsdf::ThinDielectric(ThinDielectric {
                    eta: media.eta,
                    reflectance: media.reflectance,
                    transmittance: media.transmittance,
                }),
                Form::Rough(roughness) => {
                    let facets = facets(roughness);
                    bsdf::Bsdf::RoughDielectric(RoughDielectric { media, facets })
                }
            }
        }
        Bsdf::Plastic {
            eta,
            diffuse_reflectance,
            specular_reflectance,
            is_nonlinear,
            roughness,
        } => {
            let colours = [diffuse_reflectance, specular_reflectance].map(|rgb| rgb.as_vec3());
            let ([diffuse, specular], eta) = (colours, eta as f32);
            match roughness.map(facets) {
                None => bsdf::Bsdf::Plastic(Plastic::new(diffuse, specular, eta, is_nonlinear)),
                Some(facets) => {
                    let coated = RoughPlastic::new(diffuse, specular, eta, facets, is_nonlinear);
                    bsdf::Bsdf::RoughPlastic(coated)
                }
            }
        }
    }
}
