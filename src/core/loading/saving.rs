//! What was loaded, as the text of a scene file.

use super::StartView;
use crate::scene_file::{
    self, EmitterKind, Obj, Parameter, Place, Plugin, SceneFile, Shape, ShapeKind, Value,
    WriteError,
};
use glam::DMat4;
use std::path::Path;

/// The text of a scene file that will stand in `folder`, for what was loaded from `path`, with a view as its first
/// sensor.
///
/// A scene file, given its `description`, keeps its contents; the view replaces its first sensor. An OBJ file becomes
/// the scene's only shape.
///
/// # Errors
/// A name has no form in the format; see [`scene_file::to_xml`].
pub fn scene_text(
    description: Option<&SceneFile>,
    path: &Path,
    view: &StartView,
    folder: &Path,
) -> Result<String, WriteError> {
    let mut file = description.map_or_else(|| of_mesh(path), SceneFile::clone);
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
fn of_mesh(path: &Path) -> SceneFile {
    SceneFile {
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
            material: None,
            emitter: None,
        }],
        ..SceneFile::default()
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
