//! Writer of shapes.

use super::description::{Shape, ShapeKind};
use super::writer::{Writer, attributes};
use super::xml::{WriteError, vector};
use glam::DVec3;
use std::path::Path;

impl Writer<'_> {
    /// Writes a shape with its material, its emitter and nested shapes.
    ///
    /// # Errors
    /// A name has no form in the format.
    pub(super) fn shape(&mut self, shape: &Shape) -> Result<(), WriteError> {
        let (id, name) = (shape.id.as_deref(), shape.name.as_deref());
        let attributes = attributes(shape_type(&shape.kind), id, name);
        self.xml.open("shape", &attributes)?;
        self.shape_parameters(&shape.kind)?;
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
            self.plugin(emitter)?;
        }
        self.xml.close();
        Ok(())
    }

    fn shape_parameters(&mut self, kind: &ShapeKind) -> Result<(), WriteError> {
        match kind {
            ShapeKind::Disk | ShapeKind::Rectangle | ShapeKind::Cube => Ok(()),
            ShapeKind::Obj {
                file,
                face_normals,
                flip_tex_coords,
            } => {
                self.text("filename", &name_of(file, self.folder)?)?;
                self.boolean("face_normals", *face_normals)?;
                self.boolean("flip_tex_coords", *flip_tex_coords)
            }
            ShapeKind::Sphere { center, radius } => {
                self.point("center", *center)?;
                self.float("radius", *radius)
            }
            ShapeKind::Cylinder {
                p0,
                p1,
                radius,
                is_capped,
            }
            | ShapeKind::Cone {
                p0,
                p1,
                radius,
                is_capped,
            } => self.round(*p0, *p1, *radius, *is_capped),
            ShapeKind::Plane { point, normal } => {
                self.point("point", *point)?;
                self.property("vector", "normal", &vector(*normal))
            }
            ShapeKind::Box { min, max } => self.corners(*min, *max),
            ShapeKind::Torus {
                center,
                axis,
                major,
                minor,
            } => {
                self.point("center", *center)?;
                self.property("vector", "axis", &vector(*axis))?;
                self.float("major", *major)?;
                self.float("minor", *minor)
            }
            ShapeKind::Quadric(quadric) => {
                for (name, value) in ('a'..='j').zip(quadric.coefficients) {
                    self.float(&name.to_string(), value)?;
                }
                self.corners(quadric.min, quadric.max)
            }
            ShapeKind::Csg {
                operation,
                children,
            } => {
                self.property("string", "operation", operation.name())?;
                children.iter().try_for_each(|child| self.shape(child))
            }
        }
    }

    /// The parameters of a cylinder or a cone.
    fn round(
        &mut self,
        p0: DVec3,
        p1: DVec3,
        radius: f64,
        is_capped: bool,
    ) -> Result<(), WriteError> {
        self.point("p0", p0)?;
        self.point("p1", p1)?;
        self.float("radius", radius)?;
        // Mitsuba has no such parameter.
        if is_capped {
            self.boolean("capped", true)?;
        }
        Ok(())
    }

    fn corners(&mut self, min: DVec3, max: DVec3) -> Result<(), WriteError> {
        self.point("min", min)?;
        self.point("max", max)
    }
}

fn shape_type(kind: &ShapeKind) -> &'static str {
    match kind {
        ShapeKind::Obj { .. } => "obj",
        ShapeKind::Sphere { .. } => "sphere",
        ShapeKind::Cylinder { .. } => "cylinder",
        ShapeKind::Disk => "disk",
        ShapeKind::Rectangle => "rectangle",
        ShapeKind::Cube => "cube",
        ShapeKind::Plane { .. } => "plane",
        ShapeKind::Box { .. } => "box",
        ShapeKind::Cone { .. } => "cone",
        ShapeKind::Torus { .. } => "torus",
        ShapeKind::Quadric(_) => "quadric",
        ShapeKind::Csg { .. } => "csg",
    }
}

/// The name by which a scene file in `folder` refers to a file.
fn name_of(file: &Path, folder: &Path) -> Result<String, WriteError> {
    // Fails only for an empty path.
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = absolute(&folder.join("."));
    let path = absolute(file);
    let path = path
        .strip_prefix(folder)
        .map_or(path.clone(), Path::to_owned);
    let error = || WriteError::new(&path.to_string_lossy(), "it isn't valid Unicode");
    path.to_str().map(str::to_owned).ok_or_else(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_in_the_folder_of_the_scene_are_named_relative_to_it() {
        let name = |file: &str, folder: &str| name_of(Path::new(file), Path::new(folder));
        assert_eq!(name("s/m/a.obj", "s").as_deref(), Ok("m/a.obj"));
        assert_eq!(name("a.obj", "").as_deref(), Ok("a.obj"));
        let elsewhere = name("a.obj", "s").expect("Unicode");
        assert!(Path::new(&elsewhere).is_absolute(), "{elsewhere}");
    }

    #[cfg(unix)]
    #[test]
    fn a_name_that_is_not_unicode_is_refused() {
        use std::os::unix::ffi::OsStrExt as _;
        let name = std::ffi::OsStr::from_bytes(b"a\xFF.obj");
        let error = name_of(Path::new(name), Path::new("")).expect_err("refused");
        assert_eq!(
            error.to_string(),
            "“a\u{FFFD}.obj” can't be written to a scene file: it isn't valid Unicode"
        );
    }
}
