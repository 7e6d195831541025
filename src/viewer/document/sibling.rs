//! A sibling: a second document of the same scene, packed for its own kernels.

use super::{Document, Packing};
use crate::task::Pending;
use hitscope_core::loading::LoadedScene;
use std::sync::Arc;

impl Document {
    /// A document of the same scene. It shares the mesh and the trees, and has no report about the file.
    pub fn sibling(&self) -> Self {
        let loaded = LoadedScene {
            scene: Arc::clone(&self.loaded.scene),
            report: Arc::default(),
            view: None,
            description: self.loaded.description.clone(),
            lights: self.loaded.lights.clone(),
        };
        let packing = Packing::new(self.packing.kernel, self.packing.packed.clone());
        let mut sibling = Self::packed(self.path.clone(), loaded, packing);
        sibling.is_blank = self.is_blank;
        sibling.clip.clone_from(&self.clip);
        sibling.part_changes = self.part_changes;
        sibling
    }

    /// Takes over changes of the original document: its clip, creases, hidden parts and file.
    pub fn follow(&mut self, original: &Self) {
        if original.has_last_tree() && !self.has_last_tree() {
            // It is the same tree.
            self.improvement = Pending::Done(Ok(()));
        }
        let (own, scene) = (&self.loaded.scene, &original.loaded.scene);
        if Arc::ptr_eq(own, scene) {
            return;
        }
        if own.has_shapes_of(scene) {
            self.clip.clone_from(&original.clip);
            self.replace_scene(Arc::clone(scene));
        } else {
            let part_changes = self.part_changes.max(original.part_changes) + 1;
            let old = std::mem::replace(self, original.sibling());
            self.retired.add(old);
            self.part_changes = part_changes;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use hitscope_core::Clip;
    use hitscope_core::kernel::default_triangle_kernel;

    #[test]
    fn a_sibling_takes_over_the_clip() {
        let mut original = Document::embedded(default_triangle_kernel().into());
        let mut sibling = original.sibling();
        let packed = Arc::clone(sibling.intersector());
        sibling.follow(&original);
        assert!(Arc::ptr_eq(sibling.intersector(), &packed), "nothing new");
        let clip = Clip::plane(DVec3::Y, -1e6).expect("a plane");
        assert_eq!(original.use_clip(Some(&clip)), Ok(true));
        let changes = sibling.part_changes();
        sibling.follow(&original);
        let scenes = [&sibling, &original].map(|document| &document.loaded.scene);
        assert!(Arc::ptr_eq(scenes[0], scenes[1]));
        assert!(sibling.part_changes() > changes);
        let down = hitscope_core::Ray::new(glam::Vec3::Y * 100.0, glam::Vec3::NEG_Y);
        let down = down.expect("a ray");
        assert!(packed.closest_hit(&down).is_some(), "through the scene");
        assert!(sibling.intersector().closest_hit(&down).is_none());
    }
}
