//! Reader of a scene file and the files that it includes.

use super::defaults::Defaults;
use super::description::{Place, SceneFile};
use super::element::{Element, OpenFile};
use super::emitter::Emitter;
use super::emitters::{self, Parent};
use super::include::Includes;
use super::integrators;
use super::materials::{Materials, Registered};
use super::memory::{Memory, bytes_per_map_entry};
use super::objects;
use super::outline::MAX_DEPTH;
use super::problem::{Problem, quoted};
use super::sensors;
use super::shapes;
use super::stored::{self, ReadFile};
use super::textures::{self, Textures};
use super::warnings::Warnings;
use crate::obj::{LoadError, shown};
use crate::progress::Progress;
use roxmltree::Node;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Reads a scene file and the files that it includes.
///
/// # Errors
/// See [`LoadError`].
pub fn load(path: &Path, max_memory: u64, progress: &Progress) -> Result<SceneFile, LoadError> {
    Ok(load_counted(path, max_memory, progress)?.0)
}

/// Like [`load`]; also returns the bytes that the result takes.
pub(crate) fn load_counted(
    path: &Path,
    max_memory: u64,
    progress: &Progress,
) -> Result<(SceneFile, u64), LoadError> {
    let bytes = stored::read(path, max_memory).map_err(|source| LoadError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    progress.set_total(bytes.len() as u64);
    progress.add_read(bytes.len() as u64);
    parse_counted(&bytes, path, max_memory, &stored::read, progress)
}

/// Parses a scene file. Error messages use `path`; included files are read by `read_file`, which is given their paths.
///
/// # Errors
/// See [`LoadError`].
pub fn parse(
    bytes: &[u8],
    path: &Path,
    max_memory: u64,
    read_file: ReadFile,
    progress: &Progress,
) -> Result<SceneFile, LoadError> {
    Ok(parse_counted(bytes, path, max_memory, read_file, progress)?.0)
}

/// Like [`parse`]; also returns the bytes that the result takes.
fn parse_counted(
    bytes: &[u8],
    path: &Path,
    max_memory: u64,
    read_file: ReadFile,
    progress: &Progress,
) -> Result<(SceneFile, u64), LoadError> {
    let mut reader = Reader {
        scene: SceneFile::default(),
        defaults: Defaults::default(),
        memory: Memory::new(max_memory),
        warnings: Warnings::default(),
        materials: Materials::default(),
        textures: Textures::default(),
        ids: HashMap::new(),
        includes: Includes::default(),
        read_file,
        progress,
        depth: 0,
    };
    let read = reader.read_main(bytes, path);
    let finished = read.and_then(|()| {
        let materials = std::mem::take(&mut reader.materials);
        reader.scene.materials = materials.finish(&mut reader.scene.shapes, &reader.ids)?;
        Ok(())
    });
    let mut scene = reader.scene;
    finished.map_err(|problem| problem.with_path(&scene.files))?;
    scene.warnings = reader.warnings.finish(&scene.files);
    Ok((scene, reader.memory.held()))
}

/// The state of reading.
pub(super) struct Reader<'r> {
    pub scene: SceneFile,
    pub defaults: Defaults,
    pub memory: Memory,
    pub warnings: Warnings,
    pub materials: Materials,
    pub textures: Textures,
    pub includes: Includes,
    pub read_file: ReadFile<'r>,
    /// The objects with identifiers.
    ids: HashMap<String, Registered>,
    progress: &'r Progress,
    /// The number of elements around the current one.
    depth: usize,
}

/// A function called for each child of an element.
pub(super) type Visit<'v, 'r> = &'v mut dyn FnMut(&mut Reader<'r>, Element) -> Result<(), Problem>;

impl<'r> Reader<'r> {
    /// Calls `visit` for the children of an element, and for those of the files that it includes.
    ///
    /// # Errors
    /// Those of `visit` and of included files.
    pub(super) fn each_child(
        &mut self,
        parent: Element,
        visit: Visit<'_, 'r>,
    ) -> Result<(), Problem> {
        if self.depth > MAX_DEPTH {
            let message = format!("elements are nested more than {MAX_DEPTH} deep");
            return Err(parent.problem(message));
        }
        self.depth += 1;
        for node in parent.node.children() {
            self.progress.check()?;
            if !node.is_element() {
                self.warn_about_text(node, parent.file);
                continue;
            }
            let child = Element::new(node, parent.file);
            match child.tag() {
                "default" => self.define(child)?,
                "include" => self.include(child, visit)?,
                _ => visit(self, child)?,
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn warn_about_text(&mut self, node: Node, file: &OpenFile) {
        let text = node.is_text().then(|| node.text());
        let text = text.flatten().unwrap_or_default();
        let trimmed = text.trim_start();
        if !trimmed.is_empty() {
            let message = format!("text {} isn't used", quoted(trimmed.trim_end()));
            let blank_length = text.len() - trimmed.len();
            let offset = node.range().start + blank_length;
            self.warnings.add(file.place_at(offset), message);
        }
    }

    /// Reads an object of the scene.
    pub(super) fn object(&mut self, element: Element) -> Result<(), Problem> {
        match element.tag() {
            "shape" => {
                let shape = shapes::shape(self, element)?;
                let shapes = &mut self.scene.shapes;
                self.memory.push(shapes, shape, element.place)?;
            }
            "bsdf" if !element.node.has_attribute("id") => {
                objects::skip(self, element, "scene without id")?;
            }
            "bsdf" => {
                super::materials::define(self, element)?;
            }
            "texture" if element.node.has_attribute("id") => textures::define(self, element)?,
            "sensor" => {
                let sensor = sensors::sensor(self, element)?;
                self.scene.sensors.extend(sensor);
            }
            "emitter" => {
                let emitter = emitters::emitter(self, element, Parent::Scene)?;
                let is_environment = |other: &Emitter| other.kind.is_environment();
                // The others are searched for an environment only, so that many lights take little time.
                if is_environment(&emitter) && self.scene.emitters.iter().any(is_environment) {
                    return Err(element.problem("the scene has a second environment"));
                }
                self.scene.emitters.push(emitter);
            }
            "integrator" if self.scene.integrator.is_some() => {
                return Err(element.problem("the scene has a second integrator"));
            }
            "integrator" => {
                self.scene.integrator = Some(integrators::integrator(self, element)?);
            }
            _ => objects::skip(self, element, "scene")?,
        }
        Ok(())
    }

    fn define(&mut self, element: Element) -> Result<(), Problem> {
        element.require_known_attributes(&["name", "value"])?;
        let name = element.required("name", &self.defaults)?.into_owned();
        let value = element.required("value", &self.defaults)?.into_owned();
        let bytes = bytes_per_map_entry::<(String, String)>() + 2 * (name.len() + value.len());
        self.memory.take(bytes as u64, element.place)?;
        self.defaults.define(&name, &value);
        Ok(())
    }

    /// Records the identifier of an object.
    ///
    /// # Errors
    /// The identifier is in use.
    pub(super) fn register(&mut self, id: &str, element: Element) -> Result<(), Problem> {
        if let Some(first) = self.ids.get(id) {
            let Place { file, line } = first.place;
            let in_file = if file == element.file.index {
                String::new()
            } else {
                format!(" of {}", shown(self.scene.path_of(first.place)))
            };
            let message = format!("id {} is in use since line {line}{in_file}", quoted(id));
            return Err(element.problem(message));
        }
        // The identifier twice: in this list and in the description.
        let bytes =
            bytes_per_map_entry::<(String, Registered)>() + 2 * id.len() + element.tag().len();
        self.memory.take(bytes as u64, element.place)?;
        let registered = Registered {
            place: element.place,
            element: element.tag().to_owned(),
        };
        self.ids.insert(id.to_owned(), registered);
        Ok(())
    }

    /// The path of a mesh or a picture that an object names, with a warning if Mitsuba looks for it elsewhere.
    ///
    /// # Errors
    /// The name is empty or on the network.
    pub(super) fn data_file(
        &mut self,
        name: &str,
        element: Element,
        place: Place,
    ) -> Result<PathBuf, Problem> {
        let folder = &element.file.folder;
        let file = self.named_file(name, folder, place)?;
        let main_folder = self.scene.files[0].parent().unwrap_or(folder);
        if main_folder.join(name) != file {
            let name = quoted(name);
            let message =
                format!("Mitsuba looks for {name} in the folder of the main file, not of this one");
            self.warnings.add(place, message);
        }
        Ok(file)
    }

    /// The path of a file that is named in a scene file.
    ///
    /// # Errors
    /// The name is empty or on the network.
    pub(super) fn named_file(
        &self,
        name: &str,
        folder: &Path,
        place: Place,
    ) -> Result<PathBuf, Problem> {
        if name.is_empty() {
            return Err(Problem::at(place, "the file name is empty"));
        }
        if name.starts_with("//") || name.starts_with("\\\\") {
            // Opening a network path would contact another computer.
            let message = format!("{}: network paths aren't opened", quoted(name));
            return Err(Problem::at(place, message));
        }
        Ok(folder.join(name))
    }
}
