//! A scene from the description of a scene file.

mod pictures;
mod warnings;

use super::lights::{self, EmittingMaterials};
use super::materials::materials;
use super::memory::{BYTES_PER_ALLOCATION, Needs};
use super::merge::{Part, bounds_of, merged};
use super::placed::{
    Groups, Look, Placed, is_flipped, is_mirroring, misfit, placed, placement, require_invertible,
};
use super::refusal::{Refusal, in_object};
use super::textures::Textures;
use super::{LoadedScene, StartView, size_warning};
use crate::group::Placement;
use crate::light::EnvironmentMap;
use crate::mesh::TriangleMesh;
use crate::obj::{self, LoadError, LoadOptions, LoadReport, Loaded, Recentre};
use crate::progress::{Cancelled, Phase, Progress};
use crate::scene::{Scene, SceneOptions};
use crate::scene_file::{self, EmitterKind, Place, SceneFile, Shape, ShapeKind};
use glam::DVec3;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// An entry of the list of placed shapes, and two changes of material and side.
const NEEDS_OF_ENTRY: Needs = Needs {
    loaded: 0,
    placed: size_of::<PlacedShape>() as u64,
    shapes: 2 * size_of::<(u32, u32)>() as u64,
    merged: 0,
    primitive_count: 0,
};
/// The texture coordinates of a shape, before and in its group.
const NEEDS_OF_PLACEMENT: Needs = Needs {
    loaded: 0,
    placed: (size_of::<Placement>() + BYTES_PER_ALLOCATION) as u64,
    shapes: 2 * size_of::<(u32, Placement)>() as u64,
    merged: 0,
    primitive_count: 0,
};
/// An entry of the map of OBJ files, with paths.
const BYTES_PER_FILE: u64 = 1_000;

/// Loads a scene file and the meshes that it names.
///
/// # Errors
/// See [`LoadError`].
pub(super) fn load(
    path: &Path,
    load_options: LoadOptions,
    options: SceneOptions,
    progress: &Progress,
) -> Result<LoadedScene, LoadError> {
    let start = Instant::now();
    let (file, held) = scene_file::load_counted(path, load_options.max_memory, progress)?;
    let mut contents = Contents::load(&file, load_options, held, progress)?;
    let origin = contents.origin(load_options.recentre);
    contents.require_fit(&file, origin)?;
    let map = contents.map.take();
    contents.report.duration = start.elapsed();
    progress.enter(Phase::Building);
    let scene = contents.scene(&file, origin, options, progress);
    let (scene, mut report) = scene.map_err(|Cancelled| LoadError::Cancelled {
        path: path.to_owned(),
    })?;
    report.warnings.extend(size_warning(&scene));
    let lights = lights::lights(&file, scene.mesh().origin(), map.as_ref());
    Ok(LoadedScene {
        scene: Arc::new(scene),
        lights,
        report: Arc::new(report),
        view: file.sensors.first().map(StartView::new),
        description: Some(Arc::new(file)),
    })
}

/// A shape in world coordinates.
struct PlacedShape {
    shape: Box<dyn Placed>,
    look: Look,
    /// Where it stands in the file.
    place: Place,
}

/// The mesh of an OBJ file.
struct LoadedMesh {
    mesh: Arc<TriangleMesh>,
    /// Its counts.
    report: LoadReport,
    /// Whether a shape uses the file's own materials.
    has_used_materials: bool,
}

/// The contents of a scene file in world coordinates.
struct Contents {
    parts: Vec<Part>,
    /// Shapes other than meshes.
    shapes: Vec<PlacedShape>,
    /// The OBJ files, each loaded once.
    meshes: HashMap<PathBuf, LoadedMesh>,
    options: LoadOptions,
    /// The memory of the scene file's description.
    held: u64,
    needs: Needs,
    /// Whether the memory suffices. If not, shapes are only counted, for the message.
    fits: bool,
    /// Materials that come after those of the file.
    emitting: EmittingMaterials,
    textures: Textures,
    /// The kinds of shapes that have a texture, but no texture coordinates.
    without_coordinates: HashSet<&'static str>,
    /// The picture of the environment.
    map: Option<Arc<EnvironmentMap>>,
    report: LoadReport,
}

impl Contents {
    /// `held` is the memory of the description.
    fn load(
        file: &SceneFile,
        options: LoadOptions,
        held: u64,
        progress: &Progress,
    ) -> Result<Self, LoadError> {
        let mut contents = Self {
            parts: Vec::new(),
            shapes: Vec::new(),
            emitting: EmittingMaterials::default(),
            textures: Textures::default(),
            without_coordinates: HashSet::new(),
            map: None,
            meshes: HashMap::new(),
            options: LoadOptions {
                keeps_coordinates: file.textures().next().is_some(),
                ..options
            },
            held,
            needs: Needs::default(),
            fits: true,
            report: LoadReport {
                warnings: file.warnings.clone(),
                files: file.files.clone(),
                ..LoadReport::default()
            },
        };
        let main_file = || file.path_of(Place::default()).to_owned();
        for shape in &file.shapes {
            let cancelled = |Cancelled| LoadError::Cancelled { path: main_file() };
            progress.check().map_err(cancelled)?;
            contents.add(file, shape, progress)?;
            if contents.fits && contents.bytes() > options.max_memory {
                contents.fits = false;
                (contents.shapes, contents.parts) = (Vec::new(), Vec::new());
            }
        }
        if contents.fits {
            let cancelled = |Cancelled| LoadError::Cancelled { path: main_file() };
            contents.load_textures(file, progress).map_err(cancelled)?;
            contents.load_environment(file, progress)?;
            return Ok(contents);
        }
        Err(LoadError::Content {
            path: main_file(),
            message: scene_file::exceeded("about", contents.bytes(), options.max_memory),
        })
    }

    /// The memory of everything so far.
    fn bytes(&self) -> u64 {
        self.held + self.needs.bytes()
    }

    fn add(
        &mut self,
        file: &SceneFile,
        shape: &Shape,
        progress: &Progress,
    ) -> Result<(), LoadError> {
        let refused = |refusal: Refusal| refusal.in_file(file);
        let material = self.material(file, shape);
        self.warn_about(file, shape);
        if let ShapeKind::Obj(obj) = &shape.kind {
            require_invertible(shape, &shape.to_world).map_err(refused)?;
            if self.fits {
                let mesh = self.mesh(&obj.file, progress);
                let mesh =
                    mesh.map_err(|error| in_object(file, shape.place, "shape “obj”", error))?;
                let loaded = self.meshes.get_mut(&obj.file);
                let is_first = loaded.is_some_and(|loaded| {
                    material.is_none() && !std::mem::replace(&mut loaded.has_used_materials, true)
                });
                let part = Part::new(shape, obj, (mesh, is_first), material);
                if part.has_turned_corners() {
                    self.warn_about_mirrored_light(file, shape);
                }
                self.needs.add(part.needs());
                let has_coordinates = part.has_coordinates();
                self.parts.push(part);
                if file.is_textured(shape) && !has_coordinates {
                    self.warn_without_coordinates(file, shape);
                }
            }
            return Ok(());
        }
        let placed = placed(shape, &shape.to_world).map_err(refused)?;
        if matches!(shape.kind, ShapeKind::Sphere(_)) && is_mirroring(&shape.to_world) {
            self.warn_about_mirrored_light(file, shape);
        }
        self.needs.add(placed.needs());
        self.needs.add(NEEDS_OF_ENTRY);
        let placement = file.is_textured(shape).then(|| placement(shape));
        match placement {
            Some(None) => self.warn_without_coordinates(file, shape),
            Some(Some(_)) => self.needs.add(NEEDS_OF_PLACEMENT),
            None => {}
        }
        if self.fits {
            let look = Look {
                material: material.unwrap_or(0),
                is_flipped: is_flipped(shape),
                placement: placement.flatten().map(Box::new),
            };
            self.shapes.push(PlacedShape {
                shape: placed,
                look,
                place: shape.place,
            });
        }
        Ok(())
    }

    /// The index of a shape's material; `None` for none, or for those of an OBJ file.
    fn material(&mut self, file: &SceneFile, shape: &Shape) -> Option<u32> {
        // The first material is that of shapes without a `bsdf`.
        let material = shape.material.map(|material| material + 1);
        match shape.emitter.as_ref().map(|emitter| &emitter.kind) {
            Some(EmitterKind::Area { radiance, texture }) => {
                let copy = self.emitting.index(material, *radiance, texture.as_deref());
                Some(1 + file.materials.len() as u32 + copy)
            }
            _ => material,
        }
    }

    /// The mesh of an OBJ file, which is loaded unless it was before.
    fn mesh(&mut self, path: &Path, progress: &Progress) -> Result<Arc<TriangleMesh>, LoadError> {
        if !self.meshes.contains_key(path) {
            let loaded = obj::load_besides(path, self.options, self.bytes(), progress)?;
            let Loaded { mesh, mut report } = loaded;
            let warnings = std::mem::take(&mut report.warnings);
            let files = std::mem::take(&mut report.files);
            self.take_messages(path, warnings, files);
            let parts = mesh.bytes().map(|(_, bytes)| bytes as u64);
            self.needs.loaded += parts.iter().sum::<u64>() + BYTES_PER_FILE;
            let loaded = LoadedMesh {
                mesh: Arc::new(mesh),
                report,
                has_used_materials: false,
            };
            self.meshes.insert(path.to_owned(), loaded);
        }
        let LoadedMesh { mesh, report, .. } = &self.meshes[path];
        let sum = &mut self.report;
        sum.dropped.zero_area += report.dropped.zero_area;
        sum.dropped.non_finite += report.dropped.non_finite;
        sum.dropped.bad_index += report.dropped.bad_index;
        sum.dropped.elements += report.dropped.elements;
        sum.vertex_count += report.vertex_count;
        sum.max_rounding = sum.max_rounding.max(report.max_rounding);
        Ok(Arc::clone(mesh))
    }

    fn scene(
        mut self,
        file: &SceneFile,
        origin: DVec3,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<(Scene, LoadReport), Cancelled> {
        self.report.max_rounding = self.report.max_rounding.max(self.rounding(origin));
        let mut groups = Groups::default();
        for PlacedShape { shape, look, .. } in std::mem::take(&mut self.shapes) {
            shape.push_to(&mut groups, origin, look.about(origin));
        }
        self.warn_about_empty_solids(file, &groups.empty);
        let mut materials = materials(file, &self.textures);
        self.emitting.append_to(&mut materials, &self.textures);
        drop(self.meshes);
        let textures = self.textures.into_list();
        let mesh = merged(self.parts, origin, (materials, textures));
        let mut scene = Scene::with_options(mesh, options, progress)?;
        groups.add_to(&mut scene, options, progress)?;
        Ok((scene, self.report))
    }

    /// The scene's origin: one near everything, if that is far from (0, 0, 0) for its size.
    fn origin(&self, recentre: Recentre) -> DVec3 {
        if recentre == Recentre::Off {
            return DVec3::ZERO;
        }
        let of_shapes = self
            .shapes
            .iter()
            .filter_map(|placed| placed.shape.bounds());
        let corners = of_shapes.flatten();
        let all = bounds_of(corners.chain(self.vertices()));
        obj::origin_near(all).unwrap_or(DVec3::ZERO)
    }

    /// Checks that each shape can be hit when it is rounded to f32.
    ///
    /// # Errors
    /// The first shape in the file that can't.
    fn require_fit(&self, file: &SceneFile, origin: DVec3) -> Result<(), LoadError> {
        let shapes = self.shapes.iter();
        let shapes = shapes.filter(|placed| !placed.shape.fits(origin));
        let meshes = self.parts.iter().filter(|part| !part.fits(origin));
        let places = shapes
            .map(|placed| placed.place)
            .chain(meshes.map(|part| part.place));
        match places.min_by_key(|place| (place.file, place.line)) {
            Some(place) => Err(misfit(place).in_file(file)),
            None => lights::require_near(file, origin),
        }
    }

    /// The vertices of all meshes in the world.
    fn vertices(&self) -> impl Iterator<Item = DVec3> {
        self.parts.iter().flat_map(|part| &part.positions).copied()
    }

    /// The largest rounding of a vertex's coordinate.
    fn rounding(&self, origin: DVec3) -> f64 {
        let rounding = |p: DVec3| {
            let near = p - origin;
            (near.as_vec3().as_dvec3() - near).abs().max_element()
        };
        let finite = self
            .vertices()
            .map(rounding)
            .filter(|rounding| rounding.is_finite());
        finite.fold(0.0, f64::max)
    }
}
