//! Writer of scene files. What it writes reads back to the same description.

use super::description::{Material, SceneFile, Shape};
use super::emitter::{Emitter, EmitterKind};
use super::kinds::ShapeKind;
use super::plugin::{Plugin, Value};
use super::sensor::{FieldOfView, FovAxis, Sensor, SensorKind};
use super::xml::{Attribute, WriteError, Xml, matrix, number, vector};
use glam::{DMat4, DVec3};
use std::collections::HashSet;
use std::path::Path;

/// The text of a scene file that will stand in `folder`. Names of files in the folder become relative to it.
///
/// Included files become part of the text. Materials without identifier that several shapes use get one; those that no
/// shape uses are omitted.
///
/// # Errors
/// A name has no form in the format: it contains `$` or a control character, or is a string that starts or ends with a
/// space.
pub fn to_xml(scene: &SceneFile, folder: &Path) -> Result<String, WriteError> {
    let mut writer = Writer {
        xml: Xml::default(),
        folder,
        materials: &scene.materials,
        ids: ids(scene),
    };
    writer.xml.open("scene", &[("version", "3.0.0")])?;
    if let Some(integrator) = &scene.integrator {
        writer.plugin(&integrator.plugin)?;
    }
    for sensor in &scene.sensors {
        writer.sensor(sensor)?;
    }
    for emitter in &scene.emitters {
        writer.emitter(emitter)?;
    }
    for (material, id) in scene.materials.iter().zip(writer.ids.clone()) {
        if id.is_some() {
            writer.material(material, id.as_deref())?;
        }
    }
    for shape in &scene.shapes {
        writer.shape(shape)?;
    }
    Ok(writer.xml.finish())
}

/// The identifier of each material, or `None` if it stands inside the only shape that uses it.
fn ids(scene: &SceneFile) -> Vec<Option<String>> {
    let mut uses = vec![0; scene.materials.len()];
    let mut used = HashSet::new();
    count_uses(&scene.shapes, &mut uses, &mut used);
    let materials = scene.materials.iter();
    used.extend(materials.clone().filter_map(|m| m.id.clone()));
    used.extend(scene.sensors.iter().filter_map(|sensor| sensor.id.clone()));
    let integrator = scene.integrator.iter();
    integrator.for_each(|integrator| collect_ids(&integrator.plugin, &mut used));
    let emitters = scene.emitters.iter();
    emitters.for_each(|emitter| collect_emitter_ids(emitter, &mut used));
    let mut next = 0;
    let mut new_id = || loop {
        next += 1;
        let id = format!("material-{next}");
        if !used.contains(&id) {
            return id;
        }
    };
    let id = |(material, uses): (&Material, usize)| match &material.id {
        Some(id) => Some(id.clone()),
        None => (uses > 1).then(&mut new_id),
    };
    materials.zip(uses).map(id).collect()
}

/// Counts the shapes with each material, and collects identifiers.
fn count_uses(shapes: &[Shape], uses: &mut [usize], ids: &mut HashSet<String>) {
    for shape in shapes {
        let count = shape
            .material
            .and_then(|index| uses.get_mut(index as usize));
        count.into_iter().for_each(|count| *count += 1);
        ids.extend(shape.id.clone());
        shape
            .emitter
            .iter()
            .for_each(|emitter| collect_emitter_ids(emitter, ids));
        if let ShapeKind::Csg(csg) = &shape.kind {
            count_uses(&csg.children, uses, ids);
        }
    }
}

fn collect_emitter_ids(emitter: &Emitter, ids: &mut HashSet<String>) {
    ids.extend(emitter.id.clone());
    if let EmitterKind::Other(plugin) = &emitter.kind {
        collect_ids(plugin, ids);
    }
}

fn collect_ids(plugin: &Plugin, ids: &mut HashSet<String>) {
    ids.extend(plugin.id.clone());
    plugin
        .children
        .iter()
        .for_each(|child| collect_ids(child, ids));
}

/// The text written so far, and what it refers to.
pub(super) struct Writer<'a> {
    pub xml: Xml,
    /// The folder of the scene file.
    pub folder: &'a Path,
    pub materials: &'a [Material],
    /// The identifiers of the materials that stand outside shapes.
    pub ids: Vec<Option<String>>,
}

impl Writer<'_> {
    pub(super) fn float(&mut self, name: &str, value: f64) -> Result<(), WriteError> {
        self.property("float", name, &number(value))
    }

    pub(super) fn point(&mut self, name: &str, value: DVec3) -> Result<(), WriteError> {
        self.property("point", name, &vector(value))
    }

    pub(super) fn vector(&mut self, name: &str, value: DVec3) -> Result<(), WriteError> {
        self.property("vector", name, &vector(value))
    }

    pub(super) fn boolean(&mut self, name: &str, value: bool) -> Result<(), WriteError> {
        self.property("boolean", name, if value { "true" } else { "false" })
    }

    fn integer(&mut self, name: &str, value: u32) -> Result<(), WriteError> {
        self.property("integer", name, &value.to_string())
    }

    pub(super) fn text(&mut self, name: &str, value: &str) -> Result<(), WriteError> {
        if value.trim() != value {
            return Err(WriteError::new(value, "spaces at its ends are ignored"));
        }
        self.property("string", name, value)
    }

    pub(super) fn property(
        &mut self,
        tag: &str,
        name: &str,
        value: &str,
    ) -> Result<(), WriteError> {
        self.xml.empty(tag, &[("name", name), ("value", value)])
    }

    pub(super) fn transform(&mut self, name: &str, transform: DMat4) -> Result<(), WriteError> {
        self.xml.open("transform", &[("name", name)])?;
        self.xml.empty("matrix", &[("value", &matrix(transform))])?;
        self.xml.close();
        Ok(())
    }

    pub(super) fn world_transform(&mut self, to_world: DMat4) -> Result<(), WriteError> {
        if to_world == DMat4::IDENTITY {
            return Ok(());
        }
        self.transform("to_world", to_world)
    }

    fn sensor(&mut self, sensor: &Sensor) -> Result<(), WriteError> {
        let kind = match sensor.kind {
            SensorKind::Perspective(_) => "perspective",
            SensorKind::Orthographic => "orthographic",
            SensorKind::ThinLens { .. } => "thinlens",
        };
        let attributes = attributes(kind, sensor.id.as_deref(), None);
        self.xml.open("sensor", &attributes)?;
        match sensor.kind {
            SensorKind::Perspective(fov) => self.field_of_view(fov)?,
            SensorKind::Orthographic => {}
            SensorKind::ThinLens {
                fov,
                aperture_radius,
                focus_distance,
            } => {
                self.field_of_view(fov)?;
                self.float("aperture_radius", aperture_radius)?;
                self.float("focus_distance", focus_distance)?;
            }
        }
        self.world_transform(sensor.to_world)?;
        self.xml.open("film", &[("type", "hdrfilm")])?;
        self.integer("width", sensor.film.width)?;
        self.integer("height", sensor.film.height)?;
        if let Some(crop) = sensor.film.crop {
            self.integer("crop_offset_x", crop.x)?;
            self.integer("crop_offset_y", crop.y)?;
            self.integer("crop_width", crop.width)?;
            self.integer("crop_height", crop.height)?;
        }
        self.xml.empty("rfilter", &[("type", "box")])?;
        self.xml.close();
        self.xml.open("sampler", &[("type", "independent")])?;
        self.integer("sample_count", sensor.sample_count)?;
        self.xml.close();
        self.xml.close();
        Ok(())
    }

    fn field_of_view(&mut self, fov: FieldOfView) -> Result<(), WriteError> {
        let axis = match fov.axis {
            FovAxis::X => "x",
            FovAxis::Y => "y",
            FovAxis::Diagonal => "diagonal",
            FovAxis::Smaller => "smaller",
            FovAxis::Larger => "larger",
        };
        self.float("fov", fov.degrees)?;
        self.property("string", "fov_axis", axis)
    }

    fn plugin(&mut self, plugin: &Plugin) -> Result<(), WriteError> {
        let (id, name) = (plugin.id.as_deref(), plugin.name.as_deref());
        self.named_plugin(plugin, id, name)
    }

    /// Writes an object with other attributes.
    pub(super) fn named_plugin(
        &mut self,
        plugin: &Plugin,
        id: Option<&str>,
        name: Option<&str>,
    ) -> Result<(), WriteError> {
        let attributes = attributes(&plugin.kind, id, name);
        self.xml.open(&plugin.element, &attributes)?;
        for parameter in &plugin.parameters {
            let (name, tag) = (parameter.name.as_str(), parameter.value.element());
            match &parameter.value {
                Value::Boolean(value) => self.boolean(name, *value)?,
                Value::Integer(value) => self.property(tag, name, &value.to_string())?,
                Value::Float(value) | Value::Spectrum(value) => {
                    self.property(tag, name, &number(*value))?;
                }
                Value::Text(value) => self.text(name, value)?,
                Value::Point(value) | Value::Vector(value) | Value::Rgb(value) => {
                    self.property(tag, name, &vector(*value))?;
                }
                Value::Transform(value) => self.transform(name, **value)?,
                Value::Reference(id) if name.is_empty() => self.xml.empty(tag, &[("id", id)])?,
                Value::Reference(id) => self.xml.empty(tag, &[("name", name), ("id", id)])?,
            }
        }
        plugin
            .children
            .iter()
            .try_for_each(|child| self.plugin(child))?;
        self.xml.close();
        Ok(())
    }
}

/// The attributes of an object.
pub(super) fn attributes<'a>(
    kind: &'a str,
    id: Option<&'a str>,
    name: Option<&'a str>,
) -> Vec<Attribute<'a>> {
    let id = id.map(|id| ("id", id));
    let name = name.map(|name| ("name", name));
    [Some(("type", kind)), id, name]
        .into_iter()
        .flatten()
        .collect()
}
