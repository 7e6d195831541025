//! Readers of BSDFs that contain no others.

use super::bsdf::{Bsdf, Form, Roughness};
use super::element::Element;
use super::objects;
use super::parameters::Parameters;
use super::plugin::Value;
use super::problem::{Problem, quoted, unknown};
use super::properties;
use super::reader::Reader;
use super::side::{Side, assigned};
use super::textures;
use glam::DVec3;

/// The BSDFs that are read and contain no others.
pub(super) const PLAIN: [&str; 8] = [
    "diffuse",
    "conductor",
    "roughconductor",
    "dielectric",
    "roughdielectric",
    "thindielectric",
    "plastic",
    "roughplastic",
];

/// Indices of refraction of metals, for red, green and blue: name, real part, imaginary part. They are what Mitsuba
/// 3.9.1, variant `scalar_rgb`, computes from its measured spectra.
const METALS: [(&str, [f64; 3], [f64; 3]); 12] = [
    ("none", [0.0; 3], [1.0; 3]),
    (
        "Ag",
        [0.155276, 0.116728, 0.138388],
        [4.82835, 3.12222, 2.1469],
    ),
    ("Al", [1.6575, 0.880405, 0.521244], [9.22381, 6.2695, 4.837]),
    (
        "Au",
        [0.143036, 0.375307, 1.44205],
        [3.983, 2.38556, 1.60336],
    ),
    (
        "Be",
        [4.18501, 3.18503, 2.78406],
        [3.83547, 3.01012, 2.86899],
    ),
    ("Cr", [4.36967, 2.91651, 1.6549], [5.20655, 4.23131, 3.7547]),
    (
        "Cu",
        [0.201005, 0.92375, 1.10222],
        [3.91326, 2.45305, 2.14209],
    ),
    (
        "Hg",
        [2.39894, 1.44003, 0.90957],
        [6.32759, 4.37192, 3.42176],
    ),
    (
        "Ir",
        [3.0863, 2.08219, 1.61791],
        [5.59215, 4.06709, 3.26731],
    ),
    (
        "Rh",
        [2.58579, 1.86022, 1.55426],
        [6.78226, 4.70299, 3.97607],
    ),
    (
        "TiN",
        [1.64845, 1.15052, 1.37982],
        [3.36833, 1.9435, 1.10207],
    ),
    (
        "W",
        [4.37082, 3.30025, 2.99841],
        [3.50064, 2.60487, 2.27323],
    ),
];

/// Indices of refraction by name, as Mitsuba lists them.
///
/// Source: Hecht, "Optics", 4th edition, 2001, among others, at 589 nm.
const MEDIA: [(&str, f64); 23] = [
    ("vacuum", 1.0),
    ("helium", 1.000036),
    ("hydrogen", 1.000132),
    ("air", 1.000277),
    ("carbon dioxide", 1.00045),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.52045),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// Reads one of [`PLAIN`].
pub(super) fn plain(reader: &mut Reader, element: Element, kind: &str) -> Result<Side, Problem> {
    let mut parameters = Parameters::new("bsdf", kind, element.place);
    let mut nested = Vec::new();
    reader.each_child(element, &mut |reader, child| {
        if let Some(parameter) = properties::parameter(reader, child)? {
            return parameters.add(parameter);
        }
        if let Some(texture) = textures::nested(reader, child)? {
            nested.push(texture);
            return Ok(());
        }
        if child.tag() == "ref" {
            let id = quoted(&objects::reference(reader, child)?);
            let message = format!("no texture {id} is defined before this line");
            return Err(child.problem(message));
        }
        objects::skip(reader, child, &parameters.object())
    })?;
    let textures = assigned(reader, &parameters, kind, nested)?;
    let bsdf = bsdf(reader, &mut parameters, kind)?;
    parameters.finish(&mut reader.memory)?;
    Ok(Side {
        textures,
        ..bsdf.into()
    })
}

fn bsdf(reader: &mut Reader, parameters: &mut Parameters, kind: &str) -> Result<Bsdf, Problem> {
    let roughness = match kind {
        "roughconductor" | "roughdielectric" | "roughplastic" => {
            Some(roughness(reader, parameters)?)
        }
        _ => None,
    };
    let specular_reflectance = match kind {
        "diffuse" => DVec3::ONE,
        _ => reflectance(parameters, "specular_reflectance", 1.0)?,
    };
    Ok(match kind {
        "conductor" | "roughconductor" => {
            let [eta, k] = metal(parameters)?;
            Bsdf::Conductor {
                eta,
                k,
                specular_reflectance,
                roughness,
            }
        }
        "dielectric" | "thindielectric" | "roughdielectric" => Bsdf::Dielectric {
            eta: index(parameters, "bk7")?,
            specular_reflectance,
            specular_transmittance: reflectance(parameters, "specular_transmittance", 1.0)?,
            form: match roughness {
                Some(roughness) => Form::Rough(roughness),
                None if kind == "thindielectric" => Form::Thin,
                None => Form::Smooth,
            },
        },
        "plastic" | "roughplastic" => Bsdf::Plastic {
            eta: index(parameters, "polypropylene")?,
            diffuse_reflectance: reflectance(parameters, "diffuse_reflectance", 0.5)?,
            specular_reflectance,
            is_nonlinear: parameters.boolean("nonlinear", false)?,
            roughness,
        },
        _ => Bsdf::Diffuse {
            reflectance: reflectance(parameters, "reflectance", 0.5)?,
        },
    })
}

/// Three numbers that aren't negative.
fn three(parameters: &mut Parameters, name: &'static str) -> Result<Option<DVec3>, Problem> {
    let Some(given) = parameters.take(name) else {
        return Ok(None);
    };
    let name = quoted(name);
    let rgb = match given.value {
        Value::Rgb(rgb) => rgb,
        Value::Spectrum(all) | Value::Float(all) => DVec3::splat(all),
        Value::Integer(all) => DVec3::splat(all as f64),
        other => {
            let element = other.element();
            let message = format!("{name} must be <rgb>, not <{element}>");
            return Err(Problem::at(given.place, message));
        }
    };
    if rgb.min_element() < 0.0 {
        let message = format!("{name} must be at least 0");
        return Err(Problem::at(given.place, message));
    }
    Ok(Some(rgb))
}

/// Three numbers from 0 to 1.
pub(super) fn reflectance(
    parameters: &mut Parameters,
    name: &'static str,
    default: f64,
) -> Result<DVec3, Problem> {
    let Some(given) = parameters.take(name) else {
        return Ok(DVec3::splat(default));
    };
    let place = given.place;
    let rgb = match given.value {
        Value::Rgb(rgb) => rgb,
        Value::Spectrum(all) | Value::Float(all) => DVec3::splat(all),
        other => {
            let (name, element) = (quoted(name), other.element());
            let message = format!("{name} must be <rgb>, not <{element}>");
            return Err(Problem::at(place, message));
        }
    };
    if rgb.min_element() < 0.0 || rgb.max_element() > 1.0 {
        let message = format!("{} must be from 0 to 1", quoted(name));
        return Err(Problem::at(place, message));
    }
    Ok(rgb)
}

/// The real and the imaginary part of a metal's index of refraction.
fn metal(parameters: &mut Parameters) -> Result<[DVec3; 2], Problem> {
    let given = parameters.text("material")?;
    let (eta, k) = (three(parameters, "eta")?, three(parameters, "k")?);
    let name = given.as_ref().map_or("none", |(name, _)| name.as_str());
    if let Some((_, place)) = &given
        && (eta.is_some() || k.is_some())
        && name != "none"
    {
        let message = "“material” can't be combined with “eta” and “k”".to_owned();
        return Err(Problem::at(*place, message));
    }
    let Some((_, of_eta, of_k)) = METALS.iter().find(|(known, ..)| *known == name) else {
        let place = given.as_ref().map(|(_, place)| *place).unwrap_or_default();
        let known = METALS.map(|(name, ..)| name);
        return Err(Problem::at(place, unknown("metal", name, &known)));
    };
    Ok([
        eta.unwrap_or(DVec3::from_array(*of_eta)),
        k.unwrap_or(DVec3::from_array(*of_k)),
    ])
}

/// The index of refraction behind the surface, relative to that in front.
fn index(parameters: &mut Parameters, default: &'static str) -> Result<f64, Problem> {
    let eta = medium(parameters, "int_ior", default)? / medium(parameters, "ext_ior", "air")?;
    if eta == 1.0 {
        return Err(parameters.problem("“int_ior” and “ext_ior” must differ"));
    }
    Ok(eta)
}

/// An index of refraction, as a number or by name.
fn medium(
    parameters: &mut Parameters,
    name: &'static str,
    default: &'static str,
) -> Result<f64, Problem> {
    let by_name = |wanted: &str| {
        let wanted = wanted.to_lowercase();
        let found = MEDIA.iter().find(|(known, _)| *known == wanted);
        found.map(|(_, index)| *index)
    };
    let Some(given) = parameters.take(name) else {
        return Ok(by_name(default).unwrap_or(1.5));
    };
    let found = match &given.value {
        Value::Float(index) if *index > 0.0 => Some(*index),
        Value::Integer(index) if *index > 0 => Some(*index as f64),
        Value::Text(text) => match by_name(text) {
            Some(index) => Some(index),
            None => {
                let known = MEDIA.map(|(name, _)| name);
                return Err(Problem::at(given.place, unknown("medium", text, &known)));
            }
        },
        _ => None,
    };
    found.ok_or_else(|| {
        let message = format!("{} must be a number above 0 or a name", quoted(name));
        Problem::at(given.place, message)
    })
}

fn roughness(reader: &mut Reader, parameters: &mut Parameters) -> Result<Roughness, Problem> {
    let is_ggx = match parameters.text("distribution")? {
        None => false,
        Some((text, place)) => match text.to_lowercase().as_str() {
            "ggx" => true,
            "beckmann" => false,
            _ => {
                let message = unknown("distribution", &text, &["beckmann", "ggx"]);
                return Err(Problem::at(place, message));
            }
        },
    };
    // It changes noise, not the picture.
    parameters.boolean("sample_visible", true)?;
    let both = [parameters.float("alpha_u")?, parameters.float("alpha_v")?];
    let alpha = match both {
        [Some((u, place)), Some((v, _))] => {
            if u != v {
                let message = "roughness that differs by direction isn't supported; the geometric mean is used";
                reader.warnings.add(place, message.to_owned());
            }
            if u < 0.0 || v < 0.0 {
                return Err(Problem::at(
                    place,
                    "“alpha_u” must be at least 0".to_owned(),
                ));
            }
            if u == v { u } else { (u * v).sqrt() }
        }
        [None, None] => 0.1,
        _ => return Err(parameters.problem("“alpha_u” and “alpha_v” must be given together")),
    };
    let alpha = match parameters.float("alpha")? {
        Some((alpha, place)) if !(0.0..=1.0).contains(&alpha) => {
            let message = format!("“alpha” must be from 0 to 1, not {alpha}");
            return Err(Problem::at(place, message));
        }
        Some((alpha, _)) => alpha,
        None => alpha,
    };
    Ok(Roughness { is_ggx, alpha })
}
