//! Writer of shapes.

use super::description::Shape;
use super::writer::{Writer, attributes};
use super::xml::WriteError;

impl Writer<'_> {
    /// Writes a shape with its material, its emitter and nested shapes.
    ///
    /// # Errors
    /// A name has no form in the format.
    pub(super) fn shape(&mut self, shape: &Shape) -> Result<(), WriteError> {
        let (id, name) = (shape.id.as_deref(), shape.name.as_deref());
        let attributes = attributes(shape.kind.name(), id, name);
        self.xml.open("shape", &attributes)?;
        shape.kind.write(self)?;
        self.world_transform(shape.to_world)?;
        if shape.flip_normals {
            self.boolean("flip_normals", true)?;
        }
        let index = shape.material.map(|index| index as usize);
        if let Some(index) = index
            && let Some(material) = self.materials.get(index)
        {
            match self.ids[index].clone() {
                Some(id) => self.xml.empty("ref", &[("id", &id)])?,
                None => self.material(material, None)?,
            }
        }
        if let Some(emitter) = &shape.emitter {
            self.emitter(emitter)?;
        }
        self.xml.close();
        Ok(())
    }
}
