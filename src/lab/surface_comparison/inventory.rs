//! What two files contain, and what only one of them has.

use hitscope_core::Aabb;
use hitscope_core::loading::LoadedScene;
use serde::Serialize;
use std::collections::BTreeSet;

/// The contents of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inventory {
    /// The file.
    pub file: String,
    /// Vertices in the file.
    pub vertices: usize,
    /// Triangles, without dropped ones.
    pub triangles: usize,
    /// Faces with a triangle.
    pub faces: usize,
    /// Groups and objects with a face.
    pub parts: usize,
    /// Materials that faces name.
    pub materials: usize,
    /// The area of all triangles, in square units of the file.
    pub area: f64,
    /// Lower and upper corner of the bounding box.
    pub bounds: [[f64; 3]; 2],
}

impl Inventory {
    /// The contents of a file with triangles of this area.
    pub fn new(file: String, loaded: &LoadedScene, area: f64) -> Self {
        let mesh = loaded.scene.mesh();
        let Aabb { min, max } = loaded.scene.bounds();
        Self {
            file,
            vertices: loaded.report.vertex_count,
            triangles: mesh.triangles().len(),
            faces: mesh.face_count(),
            parts: mesh.named_group_count(),
            materials: mesh.named_material_count(),
            area,
            bounds: [min, max].map(|corner| mesh.vertex_in_file(corner).to_array()),
        }
    }
}

/// Names that only one of two files has, in their order.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct OnlyIn {
    /// Groups and objects.
    pub parts: Vec<String>,
    /// Materials.
    pub materials: Vec<String>,
}

/// The names that `own` has and `other` hasn't.
pub fn only_in(own: &LoadedScene, other: &LoadedScene) -> OnlyIn {
    let names = |loaded: &LoadedScene| {
        let attributes = loaded.scene.mesh().attributes();
        let parts: BTreeSet<String> = attributes.groups.entries().iter().cloned().collect();
        let materials = attributes.materials.entries().iter();
        let materials: BTreeSet<String> = materials.map(|material| material.name.clone()).collect();
        (parts, materials)
    };
    let ((parts, materials), (other_parts, other_materials)) = (names(own), names(other));
    // The entry of faces without a name is empty.
    let is_name = |name: &&String| !name.is_empty();
    let less = |a: &BTreeSet<String>, b| a.difference(b).filter(is_name).cloned().collect();
    OnlyIn {
        parts: less(&parts, &other_parts),
        materials: less(&materials, &other_materials),
    }
}
