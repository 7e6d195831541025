//! Scenes of which some primitives are hidden: no ray meets them, and they don't emit light.
//!
//! Hidden primitives stay in the mesh and in the groups, so that all others keep their numbers, materials and vertex
//! normals. Only the trees leave them out, so hits of the other primitives keep all bits.

use super::Scene;
use crate::group::{Group, Shown};
use crate::progress::{Cancelled, Progress};
use std::sync::Arc;

/// Which primitives are shown.
#[derive(Clone, Debug)]
pub(super) struct Hidden {
    /// A flag for each primitive.
    shown: Arc<Vec<bool>>,
    /// The groups with trees over all primitives.
    whole: Vec<Arc<dyn Group>>,
}

impl Scene {
    /// The same scene of which rays meet the primitives whose flag is set; all of them for `None`. Builds trees over them,
    /// for large groups quick ones, which [`improve`](Self::improve) replaces. Bounds stay those of all primitives.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    ///
    /// # Panics
    /// If there isn't one flag for each primitive.
    pub fn showing(
        &self,
        shown: Option<Arc<Vec<bool>>>,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let hidden = self.hidden.as_ref();
        let whole = hidden.map_or(&self.groups, |hidden| &hidden.whole);
        let groups = match &shown {
            None => whole.clone(),
            Some(flags) => {
                assert_eq!(flags.len(), self.primitive_count(), "a flag for each");
                let mut first = 0;
                let group = |group: &Arc<dyn Group>| {
                    let shown = Shown::of_group(flags, first);
                    first += group.count();
                    group.showing(shown, progress)
                };
                whole.iter().map(group).collect::<Result<_, _>>()?
            }
        };
        let whole = whole.clone();
        Ok(Self {
            mesh: Arc::clone(&self.mesh),
            groups,
            ends: self.ends.clone(),
            vertex_normals: Arc::clone(&self.vertex_normals),
            clip: self.clip.clone(),
            hidden: shown.map(|shown| Hidden { shown, whole }),
            ..*self
        })
    }

    /// A flag for each primitive that tells whether it is shown; `None` if all are.
    pub fn shown(&self) -> Option<&Arc<Vec<bool>>> {
        self.hidden.as_ref().map(|hidden| &hidden.shown)
    }

    /// Whether a primitive is shown.
    pub fn is_shown(&self, primitive: u32) -> bool {
        let shown = self.shown();
        shown.is_none_or(|shown| shown[primitive as usize])
    }

    /// Whether both scenes show the same primitives of the same mesh, whatever their clips.
    pub fn has_shapes_of(&self, other: &Self) -> bool {
        let flags = |scene: &Self| scene.shown().map(Arc::as_ptr);
        Arc::ptr_eq(&self.mesh, &other.mesh) && flags(self) == flags(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{default_triangle_kernel, exact_triangle_kernel};
    use crate::mesh::shapes::{Placement, sphere};
    use crate::mesh::{Crease, Runs, TriangleMesh};
    use crate::ray::Ray;
    use crate::scene::{SceneOptions, scene};
    use crate::shape::{Plane, Sphere};
    use glam::Vec3;

    fn none() -> Progress {
        Progress::default()
    }

    fn ray(x: f32, y: f32) -> Ray {
        Ray::new(Vec3::new(x, y, 5.0), -Vec3::Z).expect("a ray")
    }

    #[test]
    fn rays_pass_hidden_triangles_and_other_hits_keep_all_bits() {
        let whole = scene(sphere(20, Placement::UNIT));
        for kernel in [default_triangle_kernel(), exact_triangle_kernel()] {
            let intersector = whole.intersector(kernel);
            let at = ray(0.1, 0.2);
            let crossings = intersector.all_hits(&at);
            let first = crossings[0].hit;
            let mut flags = vec![true; whole.primitive_count()];
            flags[first.primitive as usize] = false;
            let part = whole.showing(Some(Arc::new(flags)), &none());
            let part = part.expect("nobody cancels");
            assert!(!part.is_shown(first.primitive));
            let found = part.intersector(kernel).all_hits(&at);
            assert_eq!(found, crossings[1..], "{}", kernel.info.name);
            let again = part.showing(None, &none()).expect("nobody cancels");
            assert_eq!(again.intersector(kernel).all_hits(&at), crossings);
            assert!(again.has_shapes_of(&whole) && !part.has_shapes_of(&whole));
        }
    }

    #[test]
    fn the_hidden_stay_hidden_under_another_crease_or_clip() {
        let whole = scene(sphere(4, Placement::UNIT));
        let flags = vec![false; whole.primitive_count()];
        let part = whole.showing(Some(Arc::new(flags)), &none());
        let part = part.expect("nobody cancels");
        for scene in [part.with_crease(Crease::Above(1.0)), part.with_clip(None)] {
            let intersector = scene.intersector(default_triangle_kernel());
            assert_eq!(intersector.closest_hit(&ray(0.1, 0.2)), None);
            assert_eq!(scene.bounds(), whole.bounds());
        }
    }

    #[test]
    fn other_shapes_can_be_hidden_with_and_without_bounds() {
        let mut whole = scene(TriangleMesh::default());
        let sphere = |x: f32| Sphere {
            centre: x * Vec3::X,
            radius: 1.0,
        };
        let (options, runs) = (SceneOptions::default(), Runs::default());
        let spheres = vec![sphere(0.0), sphere(3.0)];
        let added = whole.add_group(spheres, runs.clone(), options, &none());
        added.expect("nobody cancels");
        let planes = [-1.0, -2.0].map(|z| Plane {
            point: z * Vec3::Z,
            normal: Vec3::Z,
        });
        let added = whole.add_group(planes.to_vec(), runs, options, &none());
        added.expect("nobody cancels");
        let hit = |shown: [bool; 4], at: Ray| {
            let part = whole.showing(Some(Arc::new(shown.to_vec())), &none());
            let intersector = part.expect("nobody cancels");
            let intersector = intersector.intersector(default_triangle_kernel());
            intersector.closest_hit(&at).map(|hit| hit.primitive)
        };
        assert_eq!(hit([true; 4], ray(0.0, 0.0)), Some(0));
        assert_eq!(hit([true; 4], ray(3.0, 0.0)), Some(1));
        assert_eq!(hit([false, true, true, true], ray(0.0, 0.0)), Some(2));
        assert_eq!(hit([false, true, false, true], ray(0.0, 0.0)), Some(3));
        assert_eq!(hit([false; 4], ray(0.0, 0.0)), None);
    }
}
