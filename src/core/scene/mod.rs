//! The scene: groups of primitives, and their bounds.

mod derived;
mod hidden;

pub use crate::group::{FirstTree, SceneOptions};

use crate::aabb::Aabb;
use crate::clip::{Clip, CutRay};
use crate::group::{Appearance, CsgGroup, Group, Grouped, ShapeGroup, ShapeKernels, Solid};
use crate::intersector::{Clipped, Intersector, Packing, scene_intersector};
use crate::kernel::KernelChoice;
use crate::mesh::{Crease, Material, TriangleMesh, VertexNormals};
use crate::progress::{Cancelled, Phase, Progress};
use crate::ray::{Hit, Ray};
use crate::shape::{FlatPatch, SampledSurface, SurfacePoint};
use crate::simd::SimdLevel;
use glam::{DVec2, Vec3};
use hidden::Hidden;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// Flat or smooth shading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// One normal per triangle.
    #[default]
    Flat,
    /// Normals interpolated linearly from the vertices, then normalised.
    Smooth,
    /// Normals interpolated from the vertices on the unit sphere.
    Spherical,
}

/// Groups of primitives, each of one shape with its tree. No answer to a ray ever changes; a changed file or another clip
/// makes another scene.
///
/// Primitives are numbered through all groups; triangles come first.
#[derive(Debug)]
pub struct Scene {
    /// All triangles; empty if the scene has none.
    mesh: Arc<TriangleMesh>,
    /// The triangles, if there are any or nothing else, then the other groups.
    groups: Vec<Arc<dyn Group>>,
    /// One more than the last primitive of each group.
    ends: Vec<u32>,
    bounds: Aabb,
    /// The same with the lines and points of the file.
    bounds_with_elements: Aabb,
    packing: Packing,
    crease: Crease,
    /// Computed on first use; shared with the same scene under another clip.
    vertex_normals: Arc<OnceLock<VertexNormals>>,
    /// The part that rays see.
    clip: Option<Clip>,
    /// Which primitives are hidden, if any.
    hidden: Option<Hidden>,
}

impl Scene {
    /// Builds the tree over a mesh.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn new(mesh: TriangleMesh, progress: &Progress) -> Result<Self, Cancelled> {
        Self::with_options(mesh, SceneOptions::default(), progress)
    }

    /// Builds the tree over a mesh, optimised as `options` say.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn with_options(
        mesh: TriangleMesh,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        progress.enter(Phase::Building);
        let mesh = Arc::new(mesh);
        let group = ShapeGroup::new(mesh.clone(), options, progress)?;
        let bounds = mesh.bounds();
        Ok(Self {
            ends: vec![mesh.triangles().len() as u32],
            bounds,
            bounds_with_elements: framed(bounds, mesh.line_and_point_bounds()),
            mesh,
            groups: vec![Arc::new(group)],
            packing: options.packing,
            crease: Crease::default(),
            vertex_normals: Arc::default(),
            clip: None,
            hidden: None,
        })
    }

    /// Adds a group of primitives of one shape, with their materials as indices into the mesh's, or with their materials
    /// and sides.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn add_group<S: Grouped>(
        &mut self,
        primitives: Vec<S>,
        appearance: impl Into<Appearance>,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        self.push(S::group(primitives, appearance.into(), options, progress)?);
        Ok(())
    }

    /// Adds a group of solids; see [`add_group`](Self::add_group).
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn add_solids(
        &mut self,
        solids: Vec<Solid>,
        appearance: impl Into<Appearance>,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        self.push(Arc::new(CsgGroup::new(
            solids,
            appearance.into(),
            progress,
        )?));
        Ok(())
    }

    /// Adds a group; it replaces an empty group of triangles.
    fn push(&mut self, group: Arc<dyn Group>) {
        self.bounds = self.bounds.union(group.bounds());
        self.bounds_with_elements = framed(self.bounds, self.mesh.line_and_point_bounds());
        self.groups.retain(|group| group.count() > 0);
        self.groups.push(group);
        let count = |group: &Arc<dyn Group>| group.count() as u32;
        let counts = self.groups.iter().map(count);
        let ends = counts.scan(0, |end, count| {
            *end += count;
            Some(*end)
        });
        self.ends = ends.collect();
    }

    /// All triangles.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The groups, in the order of their primitives' numbers.
    pub fn groups(&self) -> &[Arc<dyn Group>] {
        &self.groups
    }

    /// Whether another scene, such as one with another clip, shares a group with this one.
    pub fn shares_groups(&self) -> bool {
        let is_shared = |group: &Arc<dyn Group>| Arc::strong_count(group) > 1;
        self.groups.iter().any(is_shared)
    }

    /// The shapes of the groups with their kernels, each shape once.
    pub fn kernels(&self) -> Vec<ShapeKernels> {
        let mut shapes: Vec<ShapeKernels> = Vec::new();
        for group in &self.groups {
            let shape = *group.shape();
            if !shapes.iter().any(|listed| listed.shape == shape) {
                let kernels = group.kernels();
                shapes.push(ShapeKernels { shape, kernels });
            }
        }
        shapes
    }

    /// Whether a primitive is a triangle. Its number is then its index in the mesh.
    pub fn is_triangle(&self, primitive: u32) -> bool {
        (primitive as usize) < self.mesh.triangles().len()
    }

    /// Whether there are primitives that aren't triangles.
    pub fn has_other_shapes(&self) -> bool {
        self.primitive_count() > self.mesh.triangles().len()
    }

    /// The groups of shapes other than triangles.
    pub fn other_groups(&self) -> &[Arc<dyn Group>] {
        let is_mesh = !self.mesh.triangles().is_empty();
        let others = self.has_other_shapes();
        if others {
            &self.groups[usize::from(is_mesh)..]
        } else {
            &[]
        }
    }

    /// The group of a primitive, and its index there.
    ///
    /// # Panics
    /// If the scene has no such primitive.
    pub fn group_of(&self, primitive: u32) -> (&dyn Group, u32) {
        let mut first = 0;
        for (group, &end) in self.groups.iter().zip(&self.ends) {
            if primitive < end {
                return (&**group, primitive - first);
            }
            first = end;
        }
        panic!("no primitive {primitive}")
    }

    /// The surface where a ray hits.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let (group, primitive) = self.group_of(hit.primitive);
        group.surface(ray, &Hit { primitive, ..*hit })
    }

    /// Prefetches the data that [`surface`](Self::surface) will read for these hits.
    pub(crate) fn prefetch_surfaces(&self, hits: &[Option<Hit>]) {
        let primitives = hits.iter().flatten().map(|hit| hit.primitive);
        let triangles = primitives.filter(|&primitive| self.is_triangle(primitive));
        self.mesh.prefetch_corners(triangles);
    }

    /// The area of a primitive; 0 if its points can't be sampled.
    pub fn area(&self, primitive: u32) -> f64 {
        let (group, index) = self.group_of(primitive);
        group.area(index)
    }

    /// A point of a primitive, for uniform points `at` of the unit square. Points are uniform by area, or their directions
    /// are uniform; see [`density_from`](Self::density_from). `None` if the area is 0, the point is `from` itself, or the
    /// clip removes it.
    pub fn sampled(&self, primitive: u32, from: Vec3, at: DVec2) -> Option<SampledSurface> {
        let (group, index) = self.group_of(primitive);
        let sampled = group.sampled_from(index, from, at)?;
        self.keeps(sampled.surface.position).then_some(sampled)
    }

    /// Whether the clip keeps a point.
    pub(crate) fn keeps(&self, position: Vec3) -> bool {
        let is_kept = |clip: &Clip| clip.keeps(position.as_dvec3());
        self.clip.as_ref().is_none_or(is_kept)
    }

    /// A primitive that is part of a plane, prepared for sampling; `None` for others and for triangles.
    pub(crate) fn flat_patch(&self, primitive: u32) -> Option<FlatPatch> {
        let (group, index) = self.group_of(primitive);
        group.flat_patch(index)
    }

    /// The density per solid angle of the points of [`sampled`](Self::sampled) as seen from `from`, if their directions are
    /// uniform over those in which the primitive appears. `None` if the points are uniform by area.
    pub fn density_from(&self, primitive: u32, from: Vec3) -> Option<f64> {
        let (group, index) = self.group_of(primitive);
        group.density_from(index, from)
    }

    /// The corners of a primitive, if it is a triangle.
    pub fn corners(&self, primitive: u32) -> Option<[Vec3; 3]> {
        self.is_triangle(primitive)
            .then(|| self.mesh.corners(primitive))
    }

    /// t, u and v of a ray's first hit of a primitive, or `None` for a miss; see
    /// [`exact_answer`](crate::kernel::exact_answer).
    pub fn exact_answer(&self, ray: &Ray, primitive: u32) -> Option<[f64; 3]> {
        let (group, index) = self.group_of(primitive);
        let Some(clip) = &self.clip else {
            return group.exact_answer(ray, index);
        };
        let CutRay { ray, kept } = clip.cut(ray)?;
        let answer = group.exact_answer(&ray, index)?;
        kept.contains(answer[0] as f32).then_some(answer)
    }

    /// The material of a primitive, as an index into the mesh's materials.
    pub fn material(&self, primitive: u32) -> u32 {
        if self.is_triangle(primitive) {
            return self.mesh.attributes().materials.index(primitive);
        }
        let (group, index) = self.group_of(primitive);
        group.material(index)
    }

    /// Whether a primitive emits light on some side.
    pub(crate) fn emits(&self, primitive: u32) -> bool {
        let materials = &self.mesh.attributes().materials;
        let material = materials.get(self.material(primitive));
        material.is_some_and(Material::emits)
    }

    /// The number of primitives of all groups.
    pub fn primitive_count(&self) -> usize {
        self.groups.iter().map(|group| group.count()).sum()
    }

    /// Size of the trees in bytes.
    pub fn tree_bytes(&self) -> usize {
        self.groups.iter().map(|group| group.bvh().bytes()).sum()
    }

    /// Whether all trees are final.
    pub fn has_best_tree(&self) -> bool {
        self.groups.iter().all(|group| group.has_best_tree())
    }

    /// Replaces quick trees by the best ones, also in intersectors that already use them. Hits keep all bits; only
    /// their cost changes. Does nothing if the trees are the best ones; waits if another thread is building them.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled; another call resumes.
    pub fn improve(&self, progress: &Progress) -> Result<(), Cancelled> {
        self.groups
            .iter()
            .try_for_each(|group| group.improve(progress))
    }

    /// The box around all primitives, in the scene's coordinates (relative to the mesh's origin).
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The box around all primitives and the file's lines and points, in the scene's coordinates.
    pub fn bounds_with_elements(&self) -> Aabb {
        self.bounds_with_elements
    }

    /// Time it took to build the current trees.
    pub fn build_time(&self) -> Duration {
        self.groups.iter().map(|group| group.build_time()).sum()
    }

    /// Vertex normals, computed by the first call.
    pub fn vertex_normals(&self) -> &VertexNormals {
        self.vertex_normals
            .get_or_init(|| VertexNormals::of(&self.mesh, self.crease))
    }

    /// Whether the vertex normals have been computed, so that [`vertex_normals`](Self::vertex_normals) returns at once.
    pub fn has_vertex_normals(&self) -> bool {
        self.vertex_normals.get().is_some()
    }

    /// Packs the scene for a kernel.
    pub fn intersector(&self, kernel: impl Into<KernelChoice>) -> Box<dyn Intersector> {
        self.intersector_at(kernel, SimdLevel::current())
    }

    /// Packs the scene for a kernel at one of this machine's SIMD levels.
    pub fn intersector_at(
        &self,
        kernel: impl Into<KernelChoice>,
        level: SimdLevel,
    ) -> Box<dyn Intersector> {
        let kernel = kernel.into();
        let packed = |group: &Arc<dyn Group>| (group.count(), group.intersector(kernel, level));
        let whole = scene_intersector(kernel.info, self.groups.iter().map(packed).collect());
        match &self.clip {
            None => whole,
            Some(clip) => Box::new(Clipped::new(whole.into(), clip.clone())),
        }
    }
}

/// A scene of the mesh, with its tree built.
pub fn scene(mesh: TriangleMesh) -> Scene {
    Scene::new(mesh, &Progress::default()).expect("nobody cancels")
}

/// The box to frame: that of the surface, lines and points, or of the surface alone if it would be a dot: surveys contain
/// stray points.
fn framed(surface: Aabb, elements: Aabb) -> Aabb {
    /// The surface is then about as large as a pixel.
    const LARGEST: f64 = 1000.0;
    let all = surface.union(elements);
    if !surface.is_empty() && all.radius() > LARGEST * surface.radius() {
        surface
    } else {
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stray_points_are_not_framed() {
        let surface = Aabb::around([Vec3::ZERO, Vec3::ONE]);
        for (distance, is_framed) in [(10.0, true), (1e6, false)] {
            let point = Aabb::around([Vec3::splat(distance)]);
            assert_eq!(framed(surface, point) != surface, is_framed, "{distance}");
        }
        let line = Aabb::around([Vec3::ZERO, Vec3::X]);
        assert_eq!(framed(Aabb::EMPTY, line), line);
    }
}
