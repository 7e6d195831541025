//! Writer of materials.

use super::bsdf::{Bsdf, Form, Roughness};
use super::description::Material;
use super::writer::{Writer, attributes};
use super::xml::{WriteError, vector};
use glam::DVec3;

impl Writer<'_> {
    pub(super) fn material(
        &mut self,
        material: &Material,
        id: Option<&str>,
    ) -> Result<(), WriteError> {
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
        let Some(back) = material.back else {
            return self.bsdf(&material.front, id);
        };
        self.xml.open("bsdf", &attributes("twosided", id, None))?;
        self.bsdf(&material.front, None)?;
        if back != material.front {
            self.bsdf(&back, None)?;
        }
        self.xml.close();
        Ok(())
    }

    fn bsdf(&mut self, bsdf: &Bsdf, id: Option<&str>) -> Result<(), WriteError> {
        let kind = match bsdf {
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
        };
        self.xml.open("bsdf", &attributes(kind, id, None))?;
        match *bsdf {
            Bsdf::Diffuse { reflectance } => self.colour("reflectance", reflectance)?,
            Bsdf::Conductor {
                eta,
                k,
                specular_reflectance,
                roughness,
            } => {
                self.colour("eta", eta)?;
                self.colour("k", k)?;
                self.factor("specular_reflectance", specular_reflectance)?;
                self.roughness(roughness)?;
            }
            Bsdf::Dielectric {
                eta,
                specular_reflectance,
                specular_transmittance,
                form,
            } => {
                self.index(eta)?;
                self.factor("specular_reflectance", specular_reflectance)?;
                self.factor("specular_transmittance", specular_transmittance)?;
                if let Form::Rough(roughness) = form {
                    self.roughness(Some(roughness))?;
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
                self.colour("diffuse_reflectance", diffuse_reflectance)?;
                self.factor("specular_reflectance", specular_reflectance)?;
                if is_nonlinear {
                    self.boolean("nonlinear", true)?;
                }
                self.roughness(roughness)?;
            }
        }
        self.xml.close();
        Ok(())
    }

    /// The relative index: the medium in front has index 1.
    fn index(&mut self, eta: f64) -> Result<(), WriteError> {
        self.float("int_ior", eta)?;
        self.float("ext_ior", 1.0)
    }

    /// A colour whose default is white.
    fn factor(&mut self, name: &str, colour: DVec3) -> Result<(), WriteError> {
        if colour == DVec3::ONE {
            return Ok(());
        }
        self.colour(name, colour)
    }

    fn colour(&mut self, name: &str, colour: DVec3) -> Result<(), WriteError> {
        self.property("rgb", name, &vector(colour))
    }

    fn roughness(&mut self, roughness: Option<Roughness>) -> Result<(), WriteError> {
        let Some(Roughness { is_ggx, alpha }) = roughness else {
            return Ok(());
        };
        self.text("distribution", if is_ggx { "ggx" } else { "beckmann" })?;
        self.float("alpha", alpha)
    }
}
