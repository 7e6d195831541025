//! All meshes of a scene as one, in the coordinates of the world.

use super::materials::without_bsdf;
use super::memory::Needs;
use super::placed::{is_large_enough, is_mirroring};
use crate::mesh::{
    Assigned, Attributes, CornerValues, Faces, Material, NO_INDEX, Runs, Texture, TriangleMesh,
};
use crate::scene_file::{self, Place, Shape};
use glam::{DMat3, DMat4, DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::iter::repeat_n;
use std::sync::Arc;

/// A mesh of the scene before it is merged.
pub(super) struct Part {
    /// The start of its shape.
    pub place: Place,
    /// Shared by all parts of the same file.
    pub mesh: Arc<TriangleMesh>,
    /// The mesh's vertices in the world.
    pub positions: Vec<DVec3>,
    pub to_world: DMat4,
    /// Index of its material in the scene; `None` to keep the OBJ file's.
    pub material: Option<u32>,
    /// Prefix of its groups' names.
    pub name: String,
    /// Whether the file's normals are ignored.
    pub has_face_normals: bool,
    /// Whether the second texture coordinate is 1 − v.
    pub has_flipped_coordinates: bool,
    /// Whether the file's materials and textures are used, and for the first time.
    pub brings_materials: bool,
    /// Whether the transform exchanges left and right.
    pub is_mirrored: bool,
    /// Whether the normals are reversed.
    pub is_flipped: bool,
}

/// The vertices of a mesh in the world.
fn positions_in_world(mesh: &TriangleMesh, to_world: &DMat4) -> Vec<DVec3> {
    let in_world = |p: &Vec3| to_world.transform_point3(mesh.in_file(p.as_dvec3()));
    mesh.positions().iter().map(in_world).collect()
}

/// The box around the finite ones of some points: its lowest and its highest corner.
pub(super) fn bounds_of(points: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let finite = points.filter(|p| p.is_finite());
    finite.fold(none, |[min, max], p| [min.min(p), max.max(p)])
}

impl Part {
    /// The mesh of a shape. `brings_materials` tells whether its file's own materials are used for the first time.
    pub fn new(
        shape: &Shape,
        obj: &scene_file::Obj,
        (mesh, brings_materials): (Arc<TriangleMesh>, bool),
        material: Option<u32>,
    ) -> Self {
        let name = shape.name.as_ref().or(shape.id.as_ref());
        Self {
            place: shape.place,
            positions: positions_in_world(&mesh, &shape.to_world),
            mesh,
            to_world: shape.to_world,
            material,
            name: name.cloned().unwrap_or_default(),
            has_face_normals: obj.face_normals,
            has_flipped_coordinates: !obj.flip_tex_coords,
            brings_materials,
            is_mirrored: is_mirroring(&shape.to_world),
            is_flipped: shape.flip_normals,
        }
    }

    /// Whether the file's normals are used.
    fn has_normals(&self) -> bool {
        !self.has_face_normals && !self.mesh.attributes().normals.is_empty()
    }

    /// Whether the file has texture coordinates.
    pub fn has_coordinates(&self) -> bool {
        !self.mesh.attributes().texture_coordinates.is_empty()
    }

    /// Whether its vertices, as far as those of the file are finite, are so in f32 relative to an origin, and the mesh
    /// doesn't shrink to a point.
    pub fn fits(&self, origin: DVec3) -> bool {
        let own = || self.mesh.positions().iter().map(|p| p.as_dvec3());
        let in_world = || self.positions.iter().copied();
        let is_kept =
            |(own, p): (DVec3, DVec3)| !own.is_finite() || (p - origin).as_vec3().is_finite();
        let is_point = |[min, max]: [DVec3; 2]| !min.cmplt(max).any();
        own().zip(in_world()).all(is_kept)
            && (is_point(bounds_of(own())) || is_large_enough(bounds_of(in_world())))
    }

    /// The memory of the merged mesh for this part.
    pub fn needs(&self) -> Needs {
        /// Per triangle with normals or texture coordinates: the indices of its corners, twice while the lists are made.
        const BYTES_PER_CORNER_LIST: usize = 2 * size_of::<[u32; 3]>();
        /// Per triangle: its corners, face and outline.
        const BYTES_PER_TRIANGLE: usize = size_of::<[u32; 3]>() + 4 + 1;
        let (mesh, attributes) = (&self.mesh, self.mesh.attributes());
        let mut bytes_per_triangle = BYTES_PER_TRIANGLE;
        let mut bytes = size_of_val(mesh.positions())
            + size_of_val(&attributes.colours[..])
            + size_of_val(&attributes.lines[..])
            + size_of_val(&attributes.points[..])
            + attributes.groups.bytes()
            + size_of::<String>()
            + self.name.len();
        if self.has_normals() {
            bytes += size_of_val(attributes.normals.values());
            bytes_per_triangle += BYTES_PER_CORNER_LIST;
        }
        if self.has_coordinates() {
            bytes += size_of_val(attributes.texture_coordinates.values());
            bytes_per_triangle += BYTES_PER_CORNER_LIST;
        }
        if self.brings_materials {
            let textures = attributes.textures.iter().map(Texture::bytes);
            bytes += textures.sum::<usize>() + attributes.materials.bytes();
        }
        let triangle_count = mesh.triangles().len();
        Needs {
            placed: size_of::<Self>() as u64,
            loaded: (size_of::<DVec3>() * mesh.positions().len()) as u64,
            merged: (bytes + bytes_per_triangle * triangle_count) as u64,
            primitive_count: triangle_count as u64,
            ..Needs::default()
        }
    }

    /// Whether a mirroring transform turns the triangles to the other side.
    pub fn has_turned_corners(&self) -> bool {
        self.is_mirrored && !self.has_normals()
    }

    /// Whether the order of corners is reversed. As in Mitsuba, a mirroring transform maps normals of the file to the
    /// same side, which triangles then face, too; without normals, it turns triangles to the other side.
    fn has_reversed_corners(&self) -> bool {
        self.is_flipped != (self.is_mirrored && self.has_normals())
    }
}

/// Merges meshes relative to an origin. `materials` and their textures come first in the merged lists.
pub(super) fn merged(
    parts: Vec<Part>,
    origin: DVec3,
    (materials, textures): (Vec<Material>, Vec<Texture>),
) -> TriangleMesh {
    let mut merged = Merged {
        materials,
        textures,
        groups: vec![String::new()],
        ..Merged::default()
    };
    let has_colours = parts
        .iter()
        .any(|part| !part.mesh.attributes().colours.is_empty());
    merged.has_normals = parts.iter().any(Part::has_normals);
    merged.has_coordinates = parts.iter().any(Part::has_coordinates);
    // Each part is freed once it is merged.
    for part in parts {
        merged.append(&part, origin, has_colours);
    }
    merged.mesh(origin)
}

#[derive(Default)]
struct Merged {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    faces: Faces,
    face_count: u32,
    /// Whether a part has normals, and whether one has texture coordinates.
    has_normals: bool,
    has_coordinates: bool,
    normals: Vec<Vec3>,
    normal_corners: Vec<[u32; 3]>,
    coordinates: Vec<Vec2>,
    coordinate_corners: Vec<[u32; 3]>,
    colours: Vec<Vec3>,
    materials: Vec<Material>,
    material_runs: Runs,
    /// The first material of each mesh whose own materials are used.
    of_meshes: HashMap<*const TriangleMesh, u32>,
    groups: Vec<String>,
    group_runs: Runs,
    textures: Vec<Texture>,
    lines: Vec<[u32; 2]>,
    points: Vec<u32>,
}

/// The indices at which a part's values begin in the merged lists.
struct Offsets {
    position: u32,
    normal: u32,
    coordinate: u32,
    material: u32,
    group: u32,
    /// Whether the order of corners is reversed.
    is_reversed: bool,
}

impl Offsets {
    /// The indices of a triangle's corners in a merged list, in their new order.
    fn shifted(&self, [a, b, c]: [u32; 3], first: u32) -> [u32; 3] {
        let ordered = if self.is_reversed {
            [a, c, b]
        } else {
            [a, b, c]
        };
        ordered.map(|index| match index {
            NO_INDEX => NO_INDEX,
            index => first + index,
        })
    }
}

impl Merged {
    fn append(&mut self, part: &Part, origin: DVec3, has_colours: bool) {
        let attributes = part.mesh.attributes();
        let offsets = Offsets {
            position: self.positions.len() as u32,
            normal: self.normals.len() as u32,
            coordinate: self.coordinates.len() as u32,
            material: match part.material {
                None => self.own_materials(&part.mesh),
                Some(_) => 0,
            },
            group: self.groups.len() as u32,
            is_reversed: part.has_reversed_corners(),
        };
        let near = part.positions.iter().map(|&p| (p - origin).as_vec3());
        self.positions.extend(near);
        if has_colours && attributes.colours.is_empty() {
            self.colours.resize(self.positions.len(), Vec3::ONE);
        }
        self.colours.extend(&attributes.colours);
        let names = attributes.groups.entries().iter();
        self.groups
            .extend(names.map(|group| named(&part.name, group)));
        if attributes.groups.entries().is_empty() {
            self.groups.push(part.name.clone());
        }
        if part.has_normals() {
            let for_normals = DMat3::from_mat4(part.to_world).inverse().transpose();
            let side = if part.is_flipped { -1.0 } else { 1.0 };
            let turned = |n: &Vec3| {
                let normal = for_normals * n.as_dvec3();
                (side * normal.normalize_or_zero()).as_vec3()
            };
            self.normals
                .extend(attributes.normals.values().iter().map(turned));
        }
        let upwards = |&uv: &Vec2| match part.has_flipped_coordinates {
            true => Vec2::new(uv.x, 1.0 - uv.y),
            false => uv,
        };
        let coordinates = attributes.texture_coordinates.values();
        self.coordinates.extend(coordinates.iter().map(upwards));
        self.append_triangles(part, &offsets);
        let vertex = |vertex: u32| offsets.position + vertex;
        self.lines
            .extend(attributes.lines.iter().map(|ends| ends.map(vertex)));
        self.points
            .extend(attributes.points.iter().map(|&p| vertex(p)));
    }

    /// The index at which the materials of a mesh's file begin. They and the textures are appended once, for all parts
    /// with the mesh. A file with neither materials nor colours gets the material of shapes without a `bsdf`.
    fn own_materials(&mut self, mesh: &Arc<TriangleMesh>) -> u32 {
        let next = self.materials.len() as u32;
        let first = *self.of_meshes.entry(Arc::as_ptr(mesh)).or_insert(next);
        if first == next {
            self.append_materials(mesh.attributes());
        }
        first
    }

    fn append_materials(&mut self, attributes: &Attributes) {
        let entries = attributes.materials.entries();
        if attributes.is_bare() {
            let count = entries.len().max(1);
            self.materials.extend(repeat_n(without_bsdf(), count));
            return;
        } else if entries.is_empty() {
            self.materials.push(Material::default());
        }
        let first_texture = self.textures.len() as u32;
        self.textures.extend_from_slice(&attributes.textures);
        self.materials.extend(entries.iter().map(|material| {
            let mut material = material.clone();
            for map in material.maps_mut() {
                map.texture += first_texture;
            }
            material
        }));
    }

    /// Appends the triangles that can be traced. Their corners' values are already there.
    fn append_triangles(&mut self, part: &Part, offsets: &Offsets) {
        let (mesh, attributes) = (&part.mesh, part.mesh.attributes());
        for (old, corners) in (0..).zip(mesh.triangles()) {
            let corners = offsets.shifted(*corners, offsets.position);
            let positions = corners.map(|vertex| self.positions[vertex as usize]);
            let is_traceable =
                positions.iter().all(|p| p.is_finite()) && !crate::mesh::has_zero_area(positions);
            if !is_traceable {
                continue;
            }
            let new = self.triangles.len() as u32;
            self.triangles.push(corners);
            let outline = outline(attributes.faces.outline(old), offsets.is_reversed);
            let face = self.face_count + mesh.face_of(old);
            self.faces.push(new, face, outline);
            if self.has_normals {
                let normals = if part.has_normals() {
                    offsets.shifted(attributes.normals.indices(old), offsets.normal)
                } else {
                    [NO_INDEX; 3]
                };
                self.normal_corners.push(normals);
            }
            if self.has_coordinates {
                let coordinates = attributes.texture_coordinates.indices(old);
                self.coordinate_corners
                    .push(offsets.shifted(coordinates, offsets.coordinate));
            }
            let own = || offsets.material + attributes.materials.index(old);
            self.material_runs
                .begin(new, part.material.unwrap_or_else(own));
            let group = attributes.groups.index(old);
            self.group_runs.begin(new, offsets.group + group);
        }
        self.face_count += mesh.face_count() as u32;
    }

    fn mesh(self, origin: DVec3) -> TriangleMesh {
        let mesh = TriangleMesh::new_unchecked(self.positions, self.triangles);
        mesh.with_origin(origin).with_attributes(Attributes {
            faces: self.faces,
            normals: CornerValues::new(self.normals, self.normal_corners),
            texture_coordinates: CornerValues::new(self.coordinates, self.coordinate_corners),
            colours: self.colours,
            materials: Assigned::new(self.materials, self.material_runs),
            groups: Assigned::new(self.groups, self.group_runs),
            smoothing: None,
            textures: self.textures,
            lines: self.lines,
            points: self.points,
        })
    }
}

/// The edges AB, BC, CA of an outline, after B and C are exchanged if the order is reversed.
fn outline(edges: u8, is_reversed: bool) -> u8 {
    if is_reversed {
        (edges & 1) << 2 | edges & 2 | (edges & 4) >> 2
    } else {
        edges
    }
}

fn named(prefix: &str, group: &str) -> String {
    match (prefix, group) {
        (prefix, "") => prefix.to_owned(),
        ("", group) => group.to_owned(),
        (prefix, group) => format!("{prefix} {group}"),
    }
}
