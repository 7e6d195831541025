//! Groups: the primitives of one shape with their tree.

mod appearance;
mod csg;
mod placement;
mod shown;
mod table;
mod tree;

pub use appearance::Appearance;
pub(crate) use csg::CsgGroup;
pub use csg::{
    CSG_KERNELS, CsgOperation, INFO as SOLID_INFO, LineIntervals, Solid, SolidNode, SolidOperand,
};
pub use placement::{Placement, UnitShape};
pub use shown::Shown;
pub use table::{Grouped, ShapeKernels, all_kernels, kernel_named};
pub use tree::{FirstTree, SceneOptions};

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::intersector::GroupIntersector;
use crate::kernel::{
    KernelChoice, KernelInfo, KernelList, LineEquation, equations_along, exact_answer,
};
use crate::mesh::TextureFrame;
use crate::progress::{Cancelled, Progress};
use crate::ray::{Hit, Ray};
use crate::shape::{
    AddLine, FlatPatch, Interior, LineDetail, Primitives, SampledSurface, Shape, ShapeInfo,
    SurfacePoint,
};
use crate::simd::SimdLevel;
use glam::{DVec2, Vec3};
use std::fmt::{self, Debug, Formatter};
use std::sync::Arc;
use std::time::Duration;
use tree::Tree;

/// Primitives of one shape with their tree.
pub trait Group: Debug + Send + Sync {
    /// The shape.
    fn shape(&self) -> &'static ShapeInfo;

    /// The kernels of the shape's table.
    fn kernels(&self) -> Vec<&'static KernelInfo>;

    /// The number of primitives.
    fn count(&self) -> usize;

    /// The box around all primitives that rays can hit, as far as they are bounded.
    fn bounds(&self) -> Aabb;

    /// Whether all primitives are bounded.
    fn is_bounded(&self) -> bool;

    /// The current tree; [`improve`](Self::improve) may replace it.
    fn bvh(&self) -> Arc<Bvh>;

    /// Whether the tree is the final one.
    fn has_best_tree(&self) -> bool;

    /// Time it took to build the current tree.
    fn build_time(&self) -> Duration;

    /// Replaces a quick tree by the best one, also in intersectors that already use it.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled; another call resumes.
    fn improve(&self, progress: &Progress) -> Result<(), Cancelled>;

    /// The surface where a ray hits a primitive; `hit.primitive` is its index in the group.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint;

    /// The texture coordinates of a point of a primitive; `None` if it has none.
    fn texture_frame(&self, _index: u32, _position: Vec3) -> Option<TextureFrame> {
        None
    }

    /// The area of a primitive; see [`Shape::area`].
    fn area(&self, _index: u32) -> f64 {
        0.0
    }

    /// A point of a primitive to be lit by; see [`Shape::sampled_surface`].
    fn sampled_from(&self, _index: u32, _from: Vec3, _at: DVec2) -> Option<SampledSurface> {
        None
    }

    /// A primitive prepared for sampling; see [`Shape::flat_patch`].
    fn flat_patch(&self, _index: u32) -> Option<FlatPatch> {
        None
    }

    /// The density of these points, if their directions are uniform; see [`Shape::density_from`].
    fn density_from(&self, _index: u32, _from: Vec3) -> Option<f64> {
        None
    }

    /// Passes lines on a primitive's surface to `add`, for display.
    fn lines(&self, index: u32, detail: &LineDetail, add: AddLine<'_>);

    /// The points that a primitive's surface encloses, along the ray's whole line.
    fn interior(&self, index: u32, ray: &Ray) -> Interior;

    /// t, u and v of a ray's first hit of a primitive, or `None` for a miss; see [`exact_answer`].
    fn exact_answer(&self, ray: &Ray, index: u32) -> Option<[f64; 3]>;

    /// The equations of a primitive with a ray's line substituted; see [`equations_along`]. None by default.
    fn equations(&self, _ray: &Ray, _index: u32) -> Vec<LineEquation> {
        Vec::new()
    }

    /// The solid with an index, if this is a group of solids.
    fn solid(&self, _index: u32) -> Option<&Solid> {
        None
    }

    /// The material of a primitive, as an index into the mesh's materials.
    fn material(&self, index: u32) -> u32;

    /// Whether the normals of a primitive are the opposite of those of its shape.
    fn is_flipped(&self, index: u32) -> bool;

    /// The parameters of a primitive in the order of [`ShapeInfo::parameters`], for display.
    fn numbers(&self, index: u32) -> Vec<f32>;

    /// A group of some of the primitives.
    fn subset(&self, indices: &[u32]) -> Arc<dyn Group>;

    /// The same group with a tree over the primitives that are shown. They keep their numbers. A large group starts with a
    /// quick tree.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    fn showing(&self, shown: Shown, progress: &Progress) -> Result<Arc<dyn Group>, Cancelled>;

    /// Packs the primitives for a kernel. Primitives are numbered from 0.
    fn intersector(&self, kernel: KernelChoice, level: SimdLevel) -> Box<dyn GroupIntersector>;
}

/// The group of a shape's primitives.
pub(crate) struct ShapeGroup<S: 'static> {
    primitives: Arc<dyn Primitives<S>>,
    tree: Tree<S>,
    bounds: Aabb,
    appearance: Appearance,
}

impl<S: KernelList> ShapeGroup<S> {
    /// Builds the tree.
    pub fn new(
        primitives: Arc<dyn Primitives<S>>,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let tree = Tree::build(&*primitives, options, Shown::default(), progress)?;
        Ok(Self {
            bounds: tree.bvh().bounds(),
            tree,
            primitives,
            appearance: Appearance::default(),
        })
    }

    /// The group with a material and a side for each primitive.
    pub fn with_appearance(self, appearance: Appearance) -> Self {
        Self { appearance, ..self }
    }
}

impl<S: Shape> Debug for ShapeGroup<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "group of {}", S::INFO.plural)
    }
}

impl<S: Grouped> Group for ShapeGroup<S> {
    fn shape(&self) -> &'static ShapeInfo {
        &S::INFO
    }

    fn kernels(&self) -> Vec<&'static KernelInfo> {
        S::kernels().iter().map(|row| row.info).collect()
    }

    fn count(&self) -> usize {
        self.primitives.count()
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn is_bounded(&self) -> bool {
        S::IS_BOUNDED
    }

    fn bvh(&self) -> Arc<Bvh> {
        self.tree.bvh()
    }

    fn has_best_tree(&self) -> bool {
        self.tree.is_best()
    }

    fn build_time(&self) -> Duration {
        self.tree.build_time()
    }

    fn improve(&self, progress: &Progress) -> Result<(), Cancelled> {
        self.tree.improve(&*self.primitives, progress)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let mut surface = self.primitives.primitive(hit.primitive).surface(ray, hit);
        self.appearance.turn(hit.primitive, &mut surface);
        surface
    }

    fn texture_frame(&self, index: u32, position: Vec3) -> Option<TextureFrame> {
        self.appearance.texture_frame(index, position)
    }

    fn area(&self, index: u32) -> f64 {
        self.primitives.primitive(index).area()
    }

    fn sampled_from(&self, index: u32, from: Vec3, at: DVec2) -> Option<SampledSurface> {
        let mut sampled = self.primitives.primitive(index).sampled_surface(from, at);
        if let Some(sampled) = &mut sampled {
            self.appearance.turn(index, &mut sampled.surface);
        }
        sampled
    }

    fn flat_patch(&self, index: u32) -> Option<FlatPatch> {
        let patch = self.primitives.primitive(index).flat_patch()?;
        Some(if self.appearance.is_flipped(index) {
            patch.flipped()
        } else {
            patch
        })
    }

    fn density_from(&self, index: u32, from: Vec3) -> Option<f64> {
        self.primitives.primitive(index).density_from(from)
    }

    fn lines(&self, index: u32, detail: &LineDetail, add: AddLine<'_>) {
        let primitive = self.primitives.primitive(index);
        let lines = |add: AddLine<'_>| primitive.lines(detail, add);
        self.appearance.lines(index, lines, add);
    }

    fn interior(&self, index: u32, ray: &Ray) -> Interior {
        self.primitives.primitive(index).interior(ray)
    }

    fn exact_answer(&self, ray: &Ray, index: u32) -> Option<[f64; 3]> {
        exact_answer(ray, &self.primitives.primitive(index))
    }

    fn equations(&self, ray: &Ray, index: u32) -> Vec<LineEquation> {
        equations_along(ray, &self.primitives.primitive(index))
    }

    fn material(&self, index: u32) -> u32 {
        self.appearance.materials.of(index)
    }

    fn is_flipped(&self, index: u32) -> bool {
        self.appearance.is_flipped(index)
    }

    fn numbers(&self, index: u32) -> Vec<f32> {
        let mut numbers = vec![0.0; S::NUMBERS];
        self.primitives.primitive(index).write(&mut numbers);
        numbers
    }

    fn subset(&self, indices: &[u32]) -> Arc<dyn Group> {
        let primitives = indices
            .iter()
            .map(|&index| self.primitives.primitive(index));
        let (appearance, options) = (self.appearance.sides_of(indices), SceneOptions::default());
        let group = S::group(
            primitives.collect(),
            appearance,
            options,
            &Progress::default(),
        );
        group.expect("nobody cancels")
    }

    fn showing(&self, shown: Shown, progress: &Progress) -> Result<Arc<dyn Group>, Cancelled> {
        let tree = self.tree.showing(&*self.primitives, shown, progress)?;
        Ok(Arc::new(Self {
            tree,
            primitives: Arc::clone(&self.primitives),
            bounds: self.bounds,
            appearance: self.appearance.clone(),
        }))
    }

    fn intersector(&self, kernel: KernelChoice, level: SimdLevel) -> Box<dyn GroupIntersector> {
        self.tree
            .intersector(&*self.primitives, kernel.row(), level)
    }
}
