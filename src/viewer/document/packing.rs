//! Packing of a document's scene for the chosen kernels.

use super::Document;
use super::shown_part::Packed;
use crate::task::{Pending, Task, TaskPanicked};
use hitscope_core::kernel::KernelChoice;
use hitscope_core::{Intersector, Scene};
use std::sync::Arc;
use std::time::Duration;

/// A scene packed for a kernel, and for another one while that is under way.
pub(super) struct Packing {
    /// The kernel that was chosen. A shape whose table lacks it uses another one.
    pub kernel: KernelChoice,
    pub packed: Packed,
    /// The kernel that is wanted.
    pub wanted: KernelChoice,
    /// The scene packed for the wanted kernel.
    next: Pending<Packed>,
}

impl Packing {
    pub fn new(kernel: KernelChoice, packed: Packed) -> Self {
        Self {
            kernel,
            packed,
            wanted: kernel,
            next: Pending::Unasked,
        }
    }

    /// Starts to pack the scene for a kernel unless that is done or under way.
    pub fn want(&mut self, kernel: KernelChoice, scene: &Arc<Scene>, ctx: &egui::Context) {
        if self.wanted == kernel {
            return;
        }
        self.wanted = kernel;
        self.next = Pending::Unasked;
        if self.kernel != kernel {
            let scene = Arc::clone(scene);
            let pack = move || Packed::of(&scene, kernel);
            self.next = Pending::Running(Task::spawn("pack", ctx, pack));
        }
    }

    /// Keeps the kernel that was packed last.
    pub fn cancel(&mut self) {
        (self.next, self.wanted) = (Pending::Unasked, self.kernel);
    }

    /// Switches to the wanted kernel once the scene is packed for it. Returns the scene packed for the previous kernel,
    /// if it was replaced. If packing failed, the previous kernel stays.
    pub fn poll(&mut self, scene: &Scene) -> Result<Option<Packed>, TaskPanicked> {
        match self.next.take() {
            Ok(None) => Ok(None),
            Ok(Some(packed)) => {
                self.kernel = self.wanted;
                // The clip may have changed meanwhile.
                let packed = packed.with_clip_of(scene);
                Ok(Some(std::mem::replace(&mut self.packed, packed)))
            }
            Err(panicked) => {
                self.wanted = self.kernel;
                Err(panicked)
            }
        }
    }
}

impl Document {
    /// The intersector of the kernel that was packed last, cut by the clip.
    pub fn intersector(&self) -> &Arc<dyn Intersector> {
        self.packing.packed.intersector()
    }

    /// The kernel that was chosen for the intersector.
    pub fn kernel(&self) -> KernelChoice {
        self.packing.kernel
    }

    /// Starts to pack the scene for a kernel unless that is done or under way.
    pub fn use_kernel(&mut self, kernel: KernelChoice, ctx: &egui::Context) {
        self.packing.want(kernel, &self.loaded.scene, ctx);
    }

    /// Switches to the kernel once the scene is packed for it.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if packing failed; the previous kernel stays.
    pub fn poll_kernel(&mut self) -> Result<(), TaskPanicked> {
        let replaced = self.packing.poll(&self.loaded.scene)?;
        replaced.into_iter().for_each(|old| self.retired.add(old));
        Ok(())
    }

    /// Time since packing for the wanted kernel began; `None` if it isn't running.
    pub fn packing_elapsed(&self) -> Option<Duration> {
        self.packing.next.elapsed()
    }

    /// Time since packing for the second kernel began; `None` if it isn't running.
    pub fn second_packing_elapsed(&self) -> Option<Duration> {
        self.second.as_ref()?.next.elapsed()
    }

    /// Keeps the kernel that was packed last. The packing thread ends later, and its result is dropped.
    pub fn cancel_packing(&mut self) {
        self.packing.cancel();
    }

    /// The intersector to compare with; the first one if there is no second, or until it is ready.
    pub fn second(&self) -> &Arc<dyn Intersector> {
        let second = self.second.as_ref().unwrap_or(&self.packing);
        second.packed.intersector()
    }

    /// Starts to pack the scene for a second kernel unless that is done or under way; `None` drops the second
    /// intersector.
    pub fn use_second(&mut self, kernel: Option<KernelChoice>, ctx: &egui::Context) {
        let Some(kernel) = kernel else {
            self.drop_second();
            return;
        };
        let (first, packed) = (self.packing.kernel, &self.packing.packed);
        let second = self
            .second
            .get_or_insert_with(|| Packing::new(first, packed.clone()));
        second.want(kernel, &self.loaded.scene, ctx);
    }

    pub(super) fn drop_second(&mut self) {
        if let Some(second) = self.second.take() {
            self.retired.add(second.packed);
        }
    }

    /// Switches to the second kernel once the scene is packed for it.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if packing failed.
    pub fn poll_second(&mut self) -> Result<(), TaskPanicked> {
        if let Some(second) = &mut self.second {
            let replaced = second.poll(&self.loaded.scene)?;
            replaced.into_iter().for_each(|old| self.retired.add(old));
        }
        Ok(())
    }
}
