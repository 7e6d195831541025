//! What was loaded, as the text of a scene file.

use super::{LoadedScene, StartView};
use crate::mesh::TriangleMesh;
use crate::scene_file::{
    self, Bsdf, EmitterKind, Obj, Parameter, Place, Plugin, SceneFile, Shape, ShapeKind, Side,
    Value, WriteError,
};
use crate::statements::CLAY;
use glam::DMat4;
use std::path::Path;

/// The text of a scene file that will stand in `folder`, for what was loaded from `path`, with a view as its first
/// sensor.
///
/// A scene file keeps its contents; the view replaces its first sensor. An OBJ file becomes the scene's only shape, of clay
/// if it has neither materials nor colours.
///
/// # Errors
/// A name has no form in the format; see [`scene_file::to_xml`].
pub fn scene_text(
    loaded: &LoadedScene,
    path: &Path,
    view: &StartView,
    folder: &Path,
) -> Result<String, WriteError> {
    let description = loaded.description.as_deref();
    let of_mesh = || of_mesh(path, loaded.scene.mesh());
    let mut file = description.map_or_else(of_mesh, SceneFile::clone);
    let mut sensor = view.sensor();
    match file.sensors.first_mut() {
        Some(first) => {
            sensor.id = first.id.take();
            sensor.sample_count = first.sample_count;
            *first = sensor;
        }
        None => file.sensors.push(sensor),
    }
    let old_folder = path.parent().unwrap_or(Path::new(""));
    if let Some(integrator) = &mut file.integrator {
        make_absolute(&mut integrator.plugin, old_folder);
    }
    for emitter in &mut file.emitters {
        if let EmitterKind::Other(plugin) = &mut emitter.kind {
            make_absolute(plugin, old_folder);
        }
    }
    scene_file::to_xml(&file, folder)
}

/// A scene of one OBJ file.
fn of_mesh(path: &Path, mesh: &TriangleMesh) -> SceneFile {
    let is_bare = mesh.attributes().is_bare();
    SceneFile {
        materials: if is_bare { vec![clay()] } else { Vec::new() },
        shapes: vec![Shape {
            place: Place::default(),
            id: None,
            name: None,
            kind: ShapeKind::Obj(Obj {
                file: path.to_owned(),
                face_normals: false,
                flip_tex_coords: true,
            }),
            to_world: DMat4::IDENTITY,
            flip_normals: false,
            material: is_bare.then_some(0),
            emitter: None,
        }],
        ..SceneFile::default()
    }
}

/// The material of meshes without one.
fn clay() -> scene_file::Material {
    let side = Side::from(Bsdf::Diffuse {
        reflectance: CLAY.as_dvec3(),
    });
    scene_file::Material {
        place: Place::default(),
        id: None,
        front: side.clone(),
        back: Some(side),
        opacity: 1.0,
        opacity_texture: None,
    }
}

/// Makes the file names in a plugin's parameters independent of the scene file's folder.
fn make_absolute(plugin: &mut Plugin, folder: &Path) {
    for Parameter { name, value, .. } in &mut plugin.parameters {
        if name == "filename"
            && let Value::Text(file) = value
            && let Ok(path) = std::path::absolute(folder.join(&*file))
            && let Some(absolute) = path.to_str()
        {
            *file = absolute.to_owned();
        }
    }
    for child in &mut plugin.children {
        make_absolute(child, folder);
    }
}
