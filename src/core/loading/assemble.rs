//! A scene from the description of a scene file.

use super::merge::{Part, merged, positions_in_world};
use super::placed::{
    Groups, Look, Placed, Refusal, is_flipped, is_mirroring, placed, require_invertible,
};
use super::{LoadedScene, StartView, size_warning};
use crate::mesh::{Illumination, Material, TriangleMesh};
use crate::obj::{self, LoadError, LoadOptions, LoadReport, Recentre, Warning, shown};
use crate::progress::{Cancelled, Phase, Progress};
use crate::scene::{Scene, SceneOptions};
use crate::scene_file::{self, SceneFile, Shape, ShapeKind};
use glam::DVec3;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

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
    let file = scene_file::load(path, load_options.max_memory, progress)?;
    let mut contents = Contents::load(&file, load_options, progress)?;
    contents.report.duration = start.elapsed();
    progress.enter(Phase::Building);
    let scene = contents.scene(&file, load_options.recentre, options, progress);
    let (scene, mut report) = scene.map_err(|Cancelled| LoadError::Cancelled {
        path: path.to_owned(),
    })?;
    report.warnings.extend(size_warning(scene.bounds()));
    Ok(LoadedScene {
        scene: Arc::new(scene),
        report,
        view: file.sensors.first().map(StartView::new),
        description: Some(Arc::new(file)),
    })
}

/// The contents of a scene file in world coordinates.
struct Contents {
    parts: Vec<Part>,
    /// Shapes other than meshes, with their materials and sides.
    shapes: Vec<(Box<dyn Placed>, Look)>,
    report: LoadReport,
}

impl Contents {
    fn load(
        file: &SceneFile,
        options: LoadOptions,
        progress: &Progress,
    ) -> Result<Self, LoadError> {
        let mut contents = Self {
            parts: Vec::new(),
            shapes: Vec::new(),
            report: LoadReport {
                warnings: file.warnings.clone(),
                files: file.files.clone(),
                ..LoadReport::default()
            },
        };
        for shape in &file.shapes {
            let refused = |refusal| refused(file, refusal);
            // The first material stands for none.
            let material = shape.material.map(|material| material + 1);
            if let ShapeKind::Obj(obj) = &shape.kind {
                require_invertible(shape.place, &shape.to_world).map_err(refused)?;
                let loaded = obj::load(&obj.file, options, progress)?;
                contents.take_report(&obj.file, loaded.report);
                contents.parts.push(part(shape, obj, loaded.mesh, material));
            } else {
                let placed = placed(shape, &shape.to_world).map_err(refused)?;
                let look = Look {
                    material: material.unwrap_or(0),
                    is_flipped: is_flipped(shape),
                };
                contents.shapes.push((placed, look));
            }
        }
        Ok(contents)
    }

    /// Adds the report of an OBJ file.
    fn take_report(&mut self, path: &Path, report: LoadReport) {
        let told = report.warnings.into_iter().map(|warning| {
            let line = warning
                .line
                .map_or(String::new(), |line| format!(":{line}"));
            Warning {
                line: None,
                message: format!("{}{line}: {}", shown(path), warning.message),
            }
        });
        let sum = &mut self.report;
        sum.warnings.extend(told);
        sum.dropped.zero_area += report.dropped.zero_area;
        sum.dropped.non_finite += report.dropped.non_finite;
        sum.dropped.bad_index += report.dropped.bad_index;
        sum.dropped.elements += report.dropped.elements;
        sum.vertex_count += report.vertex_count;
        sum.max_rounding = sum.max_rounding.max(report.max_rounding);
        sum.files.push(path.to_owned());
        sum.files.extend(report.files);
    }

    fn scene(
        mut self,
        file: &SceneFile,
        recentre: Recentre,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<(Scene, LoadReport), Cancelled> {
        let origin = self.origin(recentre);
        self.report.max_rounding = self.report.max_rounding.max(self.rounding(origin));
        let mut groups = Groups::default();
        for (shape, look) in self.shapes {
            shape.push_to(&mut groups, origin, look);
        }
        let mesh = merged(self.parts, origin, materials(file));
        let mut scene = Scene::with_options(mesh, options, progress)?;
        groups.add_to(&mut scene, options, progress)?;
        Ok((scene, self.report))
    }

    /// The scene's origin: one near everything, if that is far from (0, 0, 0) for its size.
    fn origin(&self, recentre: Recentre) -> DVec3 {
        if recentre == Recentre::Off {
            return DVec3::ZERO;
        }
        let of_shapes = self.shapes.iter().filter_map(|(shape, _)| shape.bounds());
        let corners = of_shapes.flatten();
        let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let all = corners
            .chain(self.vertices())
            .filter(|p| p.is_finite())
            .fold(none, |[min, max], p| [min.min(p), max.max(p)]);
        obj::origin_near(all).unwrap_or(DVec3::ZERO)
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

/// A mesh of a scene file.
fn part(shape: &Shape, obj: &scene_file::Obj, mesh: TriangleMesh, material: Option<u32>) -> Part {
    let name = shape.name.as_ref().or(shape.id.as_ref());
    Part {
        positions: positions_in_world(&mesh, &shape.to_world),
        mesh,
        to_world: shape.to_world,
        material,
        name: name.cloned().unwrap_or_default(),
        has_face_normals: obj.face_normals,
        is_mirrored: is_mirroring(&shape.to_world),
        is_flipped: shape.flip_normals,
    }
}

/// The materials of a scene file; the first stands for none.
fn materials(file: &SceneFile) -> Vec<Material> {
    let material = |material: &scene_file::Material| Material {
        name: material.id.clone().unwrap_or_default(),
        diffuse: Some(material.front.as_vec3()),
        illumination: Illumination::Diffuse,
        ..Material::default()
    };
    let none = std::iter::once(Material::default());
    none.chain(file.materials.iter().map(material)).collect()
}

fn refused(file: &SceneFile, Refusal { place, message }: Refusal) -> LoadError {
    LoadError::Line {
        path: file.path_of(place).to_owned(),
        line: place.line as usize,
        column: None,
        message,
    }
}
