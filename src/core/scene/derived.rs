//! Scenes made of the groups of another one: clipped, in part, or in another frame.

use super::{Scene, SceneOptions, scene};
use crate::clip::Clip;
use crate::intersector::{Clipped, Intersector};
use crate::mesh::{Crease, TriangleMesh};
use crate::progress::Progress;
use crate::ray::Ray;
use glam::{DVec3, Vec3};
use std::sync::Arc;

impl Scene {
    /// The same groups, of which rays see the part that a clip keeps; all of them without a clip. Takes little time: trees
    /// and vertex normals are shared. Bounds stay those of all groups.
    #[must_use]
    pub fn with_clip(&self, clip: Option<Clip>) -> Self {
        Self {
            mesh: Arc::clone(&self.mesh),
            groups: self.groups.clone(),
            ends: self.ends.clone(),
            vertex_normals: Arc::clone(&self.vertex_normals),
            clip,
            hidden: self.hidden.clone(),
            ..*self
        }
    }

    /// The part that rays see, in the scene's coordinates; `None` for all of it.
    pub fn clip(&self) -> Option<&Clip> {
        self.clip.as_ref()
    }

    /// An intersector of the same groups without a clip, cut by this scene's clip. Nothing is packed again.
    pub fn clipped(&self, whole: Arc<dyn Intersector>) -> Arc<dyn Intersector> {
        match &self.clip {
            None => whole,
            Some(clip) => Arc::new(Clipped::new(whole, clip.clone())),
        }
    }

    /// The part of a ray that the clip keeps; `None` if that is nothing.
    pub fn cut(&self, ray: &Ray) -> Option<Ray> {
        match &self.clip {
            None => Some(*ray),
            Some(clip) => clip.cut(ray).map(|cut| cut.ray),
        }
    }

    /// Whether the clip removes the start of a ray, so that the ray sees surfaces from the inside where the clip opens them.
    pub fn cuts_start(&self, ray: &Ray) -> bool {
        self.cut(ray).is_some_and(|cut| cut.t_min > ray.t_min)
    }

    /// Whether the clip keeps a hit of a ray at this t.
    pub fn shows(&self, ray: &Ray, t: f32) -> bool {
        let Some(clip) = &self.clip else {
            return true;
        };
        clip.cut(ray).is_some_and(|cut| cut.kept.contains(t))
    }

    /// The same groups with another crease angle for smooth shading.
    #[must_use]
    pub fn with_crease(&self, crease: Crease) -> Self {
        Self {
            mesh: Arc::clone(&self.mesh),
            groups: self.groups.clone(),
            ends: self.ends.clone(),
            crease,
            vertex_normals: Arc::default(),
            clip: self.clip.clone(),
            hidden: self.hidden.clone(),
            ..*self
        }
    }

    /// Which edges smooth shading keeps sharp.
    pub fn crease(&self) -> Crease {
        self.crease
    }

    /// A scene of the given primitives, in this order, with this clip, without normals, materials and faces. The numbers must
    /// ascend.
    pub fn subset(&self, primitives: &[u32]) -> Self {
        let triangles = self.mesh.triangles().len() as u32;
        let (of_mesh, mut rest) =
            primitives.split_at(primitives.partition_point(|&p| p < triangles));
        let corners = of_mesh
            .iter()
            .flat_map(|&triangle| self.mesh.corners(triangle));
        let indices = (0..of_mesh.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
        let mesh = TriangleMesh::new_unchecked(corners.collect(), indices.collect());
        let mut scene = Self::new(mesh, &Progress::default()).expect("nobody cancels");
        let mut first = 0;
        for group in &self.groups {
            let end = first + group.count() as u32;
            let (own, others) = rest.split_at(rest.partition_point(|&p| p < end));
            if !own.is_empty() {
                let local: Vec<u32> = own.iter().map(|p| p - first).collect();
                scene.push(group.subset(&local));
            }
            (rest, first) = (others, end);
        }
        scene.clip = self.clip.clone();
        scene
    }

    /// The same triangles, hidden ones and clip with the origin at (0, 0, 0), without normals, materials and faces; `None` if that would
    /// round a position.
    pub fn in_file_frame(&self) -> Option<Self> {
        let is_mesh = self.groups.len() == 1 && !self.mesh.triangles().is_empty();
        if !is_mesh || !self.mesh.are_f32_in_file() {
            return None;
        }
        let in_file = |p: &Vec3| self.mesh.in_file(p.as_dvec3()).as_vec3();
        let positions = self.mesh.positions().iter().map(in_file).collect();
        let mesh = TriangleMesh::new_unchecked(positions, self.mesh.triangles().to_vec());
        let options = SceneOptions {
            packing: self.packing,
            ..SceneOptions::default()
        };
        let scene =
            Self::with_options(mesh, options, &Progress::default()).expect("nobody cancels");
        let shown = self.shown().cloned();
        let scene = scene
            .showing(shown, &Progress::default())
            .expect("nobody cancels");
        let clip = self
            .clip
            .as_ref()
            .map(|clip| clip.moved(self.mesh.origin()));
        Some(scene.with_clip(clip.transpose().ok()?))
    }

    /// The same triangles with an offset added to each position, which makes the rounding of hits visible.
    ///
    /// Each sum is rounded to f32; apart from that, coordinates in the file stay the same. Triangles whose corners
    /// coincide after rounding stay in the list, but no ray hits them. `None` if there are other shapes, a clip or
    /// hidden triangles, or if a position would be infinite.
    pub fn moved(&self, offset: DVec3) -> Option<Self> {
        let is_whole = self.clip.is_none() && self.hidden.is_none();
        if self.has_other_shapes() || !is_whole {
            return None;
        }
        let moved = |p: &Vec3| (p.as_dvec3() + offset).as_vec3();
        let positions: Vec<Vec3> = self.mesh.positions().iter().map(moved).collect();
        let corners = self.mesh.triangles().as_flattened().iter();
        let mut in_use = corners.map(|&vertex| positions[vertex as usize]);
        if !in_use.all(|p| p.is_finite()) {
            return None;
        }
        let mesh = TriangleMesh::new_unchecked(positions, self.mesh.triangles().to_vec())
            .with_origin(self.mesh.origin() - offset)
            .with_attributes(self.mesh.attributes().clone());
        let options = SceneOptions {
            packing: self.packing,
            ..SceneOptions::default()
        };
        let scene = Self::with_options(mesh, options, &Progress::default());
        Some(scene.expect("nobody cancels").with_crease(self.crease))
    }

    /// The groups of shapes other than triangles, as a scene of their own, with this clip.
    pub fn without_triangles(&self) -> Self {
        let mut rest = scene(TriangleMesh::default());
        for group in self.other_groups() {
            rest.push(Arc::clone(group));
        }
        rest.clip = self.clip.clone();
        rest
    }
}
