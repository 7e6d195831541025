//! Writer of emitters.

use super::emitter::{Emitter, EmitterKind};
use super::kinds::name_of;
use super::writer::{Writer, attributes};
use super::xml::{WriteError, vector};
use glam::DVec3;

impl Writer<'_> {
    /// Writes an emitter.
    ///
    /// # Errors
    /// A name has no form in the format.
    pub(super) fn emitter(&mut self, emitter: &Emitter) -> Result<(), WriteError> {
        let (id, name) = (emitter.id.as_deref(), emitter.name.as_deref());
        let kind = match &emitter.kind {
            EmitterKind::Area { .. } => "area",
            EmitterKind::Constant { .. } => "constant",
            EmitterKind::Point { .. } => "point",
            EmitterKind::Directional { .. } => "directional",
            EmitterKind::Envmap { .. } => "envmap",
            EmitterKind::Other(plugin) => return self.named_plugin(plugin, id, name),
        };
        self.xml.open("emitter", &attributes(kind, id, name))?;
        match &emitter.kind {
            EmitterKind::Area {
                texture: Some(texture),
                ..
            } => self.texture("radiance", texture)?,
            EmitterKind::Area { radiance, .. } | EmitterKind::Constant { radiance } => {
                self.light("radiance", *radiance)?;
            }
            EmitterKind::Point {
                position,
                intensity,
            } => {
                self.point("position", *position)?;
                self.light("intensity", *intensity)?;
            }
            EmitterKind::Directional {
                direction,
                irradiance,
            } => {
                self.property("vector", "direction", &vector(*direction))?;
                self.light("irradiance", *irradiance)?;
            }
            EmitterKind::Envmap {
                file,
                scale,
                to_world,
            } => {
                self.text("filename", &name_of(file, self.folder)?)?;
                self.float("scale", *scale)?;
                self.world_transform(*to_world)?;
            }
            EmitterKind::Other(_) => {}
        }
        self.xml.close();
        Ok(())
    }

    fn light(&mut self, name: &str, light: DVec3) -> Result<(), WriteError> {
        self.property("rgb", name, &vector(light))
    }
}
