//! Writer of materials.

use super::bsdf::{Bsdf, Form, Roughness};
use super::description::Material;
use super::side::Side;
use super::writer::{Writer, attributes};
use super::xml::{WriteError, vector};
use crate::bsdf::Slot;
use glam::DVec3;

/// A colour that a texture may replace, and the name of its parameter.
type Colour = (Slot, &'static str);

const SPECULAR: Colour = (Slot::Specular, "specular_reflectance");
const TRANSMITTED: Colour = (Slot::Transmittance, "specular_transmittance");

/// The type of the element that describes a model.
fn plugin(bsdf: &Bsdf) -> &'static str {
    match bsdf {
        Bsdf::Diffuse { .. } => "diffuse",
        Bsdf::Conductor {
            roughness: None, ..
        } => "conductor",
        Bsdf::Conductor { .. } => "roughconductor",
        Bsdf::Dielectric { form, .. } => match form {
            Form::Smooth => "dielectric",
            Form::Thin => "thindielectric",
            Form::Rough(_) => "roughdielectric",
        },
        Bsdf::Plastic {
            roughness: None, ..
        } => "plastic",
        Bsdf::Plastic { .. } => "roughplastic",
    }
}

impl Writer<'_> {
    pub(super) fn material(
        &mut self,
        material: &Material,
        id: Option<&str>,
    ) -> Result<(), WriteError> {
        let Some(texture) = &material.opacity_texture else {
            return self.masked(material, id);
        };
        self.xml.open("bsdf", &attributes("mask", id, None))?;
        self.texture("opacity", texture)?;
        self.masked(material, None)?;
        self.xml.close();
        Ok(())
    }

    fn masked(&mut self, material: &Material, id: Option<&str>) -> Result<(), WriteError> {
        if material.opacity == 1.0 {
            return self.sides(material, id);
        }
        self.xml.open("bsdf", &attributes("mask", id, None))?;
        self.float("opacity", material.opacity)?;
        self.sides(material, None)?;
        self.xml.close();
        Ok(())
    }

    fn sides(&mut self, material: &Material, id: Option<&str>) -> Result<(), WriteError> {
        let Some(back) = &material.back else {
            return self.side(&material.front, id);
        };
        self.xml.open("bsdf", &attributes("twosided", id, None))?;
        self.side(&material.front, None)?;
        if *back != material.front {
            self.side(back, None)?;
        }
        self.xml.close();
        Ok(())
    }

    /// Writes a side without its relief.
    pub(super) fn bsdf(&mut self, side: &Side, id: Option<&str>) -> Result<(), WriteError> {
        let attributes = attributes(plugin(&side.bsdf), id, None);
        self.xml.open("bsdf", &attributes)?;
        self.parameters(side)?;
        self.xml.close();
        Ok(())
    }

    fn parameters(&mut self, side: &Side) -> Result<(), WriteError> {
        match side.bsdf {
            Bsdf::Diffuse { reflectance } => {
                self.value(side, (Slot::Diffuse, "reflectance"), reflectance)
            }
            Bsdf::Conductor {
                eta,
                k,
                specular_reflectance,
                roughness,
            } => {
                self.colour("eta", eta)?;
                self.colour("k", k)?;
                self.factor(side, SPECULAR, specular_reflectance)?;
                self.roughness(side, roughness)
            }
            Bsdf::Dielectric {
                eta,
                specular_reflectance,
                specular_transmittance,
                form,
            } => {
                self.index(eta)?;
                self.factor(side, SPECULAR, specular_reflectance)?;
                self.factor(side, TRANSMITTED, specular_transmittance)?;
                match form {
                    Form::Smooth | Form::Thin => Ok(()),
                    Form::Rough(roughness) => self.roughness(side, Some(roughness)),
                }
            }
            Bsdf::Plastic {
                eta,
                diffuse_reflectance,
                specular_reflectance,
                is_nonlinear,
                roughness,
            } => {
                self.index(eta)?;
                let base = (Slot::Diffuse, "diffuse_reflectance");
                self.value(side, base, diffuse_reflectance)?;
                self.factor(side, SPECULAR, specular_reflectance)?;
                if is_nonlinear {
                    self.boolean("nonlinear", true)?;
                }
                self.roughness(side, roughness)
            }
        }
    }

    /// The relative index: the medium in front has index 1.
    fn index(&mut self, eta: f64) -> Result<(), WriteError> {
        self.float("int_ior", eta)?;
        self.float("ext_ior", 1.0)
    }

    /// A colour, or the texture in its place.
    fn value(
        &mut self,
        side: &Side,
        (slot, name): Colour,
        colour: DVec3,
    ) -> Result<(), WriteError> {
        match side.texture(slot) {
            Some(texture) => self.texture(name, texture),
            None => self.colour(name, colour),
        }
    }

    /// The same, where white is the default.
    fn factor(
        &mut self,
        side: &Side,
        (slot, name): Colour,
        colour: DVec3,
    ) -> Result<(), WriteError> {
        if colour == DVec3::ONE && side.texture(slot).is_none() {
            return Ok(());
        }
        self.value(side, (slot, name), colour)
    }

    pub(super) fn colour(&mut self, name: &str, colour: DVec3) -> Result<(), WriteError> {
        self.property("rgb", name, &vector(colour))
    }

    fn roughness(&mut self, side: &Side, roughness: Option<Roughness>) -> Result<(), WriteError> {
        let Some(Roughness { is_ggx, alpha }) = roughness else {
            return Ok(());
        };
        self.text("distribution", if is_ggx { "ggx" } else { "beckmann" })?;
        match side.texture(Slot::Roughness) {
            Some(texture) => self.texture("alpha", texture),
            None => self.float("alpha", alpha),
        }
    }
}
