//! The part of a document's scene that is shown: what a clip keeps of the primitives that aren't hidden.

use super::{Document, Packing};
use crate::retired::Shared;
use crate::task::{Pending, Task, TaskPanicked};
use hitscope_core::clip::ClipError;
use hitscope_core::kernel::KernelChoice;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::{Clip, Intersector, Scene};
use std::sync::Arc;
use std::time::Duration;

/// A flag for each primitive that tells whether it is shown; `None` if all are. Equal only to itself.
#[derive(Clone, Debug, Default)]
pub struct ShownPrimitives(pub Option<Arc<Vec<bool>>>);

impl PartialEq for ShownPrimitives {
    fn eq(&self, other: &Self) -> bool {
        let address = |shown: &Self| shown.0.as_ref().map(Arc::as_ptr);
        address(self) == address(other)
    }
}

impl ShownPrimitives {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Self {
        Self(scene.shown().cloned())
    }
}

/// A scene packed for a kernel, and the same cut by the scene's clip.
#[derive(Clone)]
pub(super) struct Packed {
    whole: Arc<dyn Intersector>,
    clipped: Arc<dyn Intersector>,
}

impl Packed {
    /// Packs a scene.
    pub fn of(scene: &Scene, kernel: KernelChoice) -> Self {
        let whole = Arc::from(scene.with_clip(None).intersector(kernel));
        Self::clipped_by(scene, whole)
    }

    fn clipped_by(scene: &Scene, whole: Arc<dyn Intersector>) -> Self {
        let clipped = scene.clipped(Arc::clone(&whole));
        Self { whole, clipped }
    }

    /// The same primitives with the clip of this scene. Nothing is packed again.
    #[must_use]
    pub fn with_clip_of(&self, scene: &Scene) -> Self {
        Self::clipped_by(scene, Arc::clone(&self.whole))
    }

    /// The intersector, cut by the clip.
    pub fn intersector(&self) -> &Arc<dyn Intersector> {
        &self.clipped
    }
}

impl Shared for Packed {
    fn is_shared(&self) -> bool {
        // `self` holds the intersector twice: in `whole` and in `clipped`.
        let is_same = Arc::ptr_eq(&self.whole, &self.clipped);
        Arc::strong_count(&self.whole) > 2 || (!is_same && self.clipped.is_shared())
    }
}

/// The construction of a scene that shows other primitives.
pub(super) struct Showing {
    /// What is to be shown.
    wanted: ShownPrimitives,
    /// The scene, packed for a kernel.
    next: Pending<Result<(Scene, KernelChoice, Packed), Cancelled>>,
    /// Cancels building.
    progress: Progress,
}

impl Default for Showing {
    fn default() -> Self {
        Self {
            wanted: ShownPrimitives::default(),
            next: Pending::Unasked,
            progress: Progress::default(),
        }
    }
}

impl Document {
    /// Shows only what a clip keeps, in the file's coordinates; all for `None`. Returns whether that changed the scene.
    ///
    /// # Errors
    /// See [`ClipError`]; the last clip stays.
    pub fn use_clip(&mut self, clip: Option<&Clip>) -> Result<bool, ClipError> {
        let is_new = self.clip.as_ref() != clip;
        if is_new {
            let origin = self.loaded.scene.mesh().origin();
            let in_scene = clip.map(|clip| clip.moved(-origin)).transpose()?;
            self.clip = clip.cloned();
            self.replace_scene(Arc::new(self.loaded.scene.with_clip(in_scene)));
        }
        Ok(is_new)
    }

    /// Replaces the scene by the same one with another clip.
    pub(super) fn replace_scene(&mut self, scene: Arc<Scene>) {
        for packing in std::iter::once(&mut self.packing).chain(&mut self.second) {
            packing.packed = packing.packed.with_clip_of(&scene);
        }
        self.loaded.scene = scene;
        self.part_changes += 1;
    }

    /// Starts to build a tree over these primitives unless that is done or under way. Returns whether it starts.
    pub fn use_primitives(&mut self, shown: &ShownPrimitives, ctx: &egui::Context) -> bool {
        if self.showing.wanted == *shown {
            return false;
        }
        self.showing.wanted = shown.clone();
        self.showing.next = Pending::Unasked;
        if self.shows(shown) {
            return false;
        }
        let (scene, kernel) = (Arc::clone(&self.loaded.scene), self.packing.wanted);
        let flags = shown.0.clone();
        self.showing.progress.cancel();
        self.showing.progress = Progress::default();
        let progress = self.showing.progress.clone();
        let build = move || {
            let scene = scene.showing(flags, &progress)?;
            progress.check()?;
            let packed = Packed::of(&scene, kernel);
            Ok((scene, kernel, packed))
        };
        self.showing.next = Pending::Running(Task::spawn("parts", ctx, build));
        true
    }

    /// Shows only the wanted primitives once a tree over them is built, and starts to improve the tree.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if building failed; the last primitives stay.
    pub fn poll_primitives(&mut self, ctx: &egui::Context) -> Result<(), TaskPanicked> {
        let Some(Ok((scene, kernel, packed))) = self.showing.next.take()? else {
            return Ok(());
        };
        // Clip and crease may have changed meanwhile.
        let current = &self.loaded.scene;
        let scene = scene.with_clip(current.clip().cloned());
        let scene = if scene.crease() == current.crease() {
            scene
        } else {
            scene.with_crease(current.crease())
        };
        let old = std::mem::replace(&mut self.packing, Packing::new(kernel, packed));
        self.retired.add(old.packed);
        self.drop_second();
        self.retired.add(Arc::clone(&self.loaded.scene));
        self.replace_scene(Arc::new(scene));
        self.stop_improving();
        self.progress = Progress::default();
        self.improve(ctx);
        Ok(())
    }

    /// Time since building of a tree over the wanted primitives began; `None` if it isn't running.
    pub fn primitives_elapsed(&self) -> Option<Duration> {
        self.showing.next.elapsed()
    }

    /// Cancels building of a tree over the wanted primitives. The shown primitives stay.
    pub fn cancel_primitives(&mut self) {
        self.showing.progress.cancel();
        self.showing.next = Pending::Unasked;
        self.showing.wanted = ShownPrimitives::of(&self.loaded.scene);
    }

    /// Whether these primitives are shown, and no others.
    pub fn shows(&self, shown: &ShownPrimitives) -> bool {
        ShownPrimitives::of(&self.loaded.scene) == *shown
    }

    /// The number of changes of the part that is shown.
    pub fn part_changes(&self) -> u64 {
        self.part_changes
    }
}
