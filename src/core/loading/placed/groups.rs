//! The groups of a scene file's shapes, before their trees are built.

use crate::group::{Grouped, Solid};
use crate::mesh::Runs;
use crate::progress::{Cancelled, Progress};
use crate::scene::{Scene, SceneOptions};
use std::any::Any;

/// Groups of shapes, each of one kind, in the order in which the kinds were first added; solids come last.
#[derive(Default)]
pub struct Groups {
    lists: Vec<Box<dyn PendingGroup>>,
    pub solids: List<Solid>,
}

/// Shapes of one kind and their materials.
pub struct List<S> {
    shapes: Vec<S>,
    materials: Vec<u32>,
}

impl<S> Default for List<S> {
    fn default() -> Self {
        Self {
            shapes: Vec::new(),
            materials: Vec::new(),
        }
    }
}

impl<S> List<S> {
    pub fn push(&mut self, shape: S, material: u32) {
        self.shapes.push(shape);
        self.materials.push(material);
    }

    /// The shapes and their materials as runs.
    fn into_parts(self) -> (Vec<S>, Runs) {
        let mut materials = Runs::default();
        for (index, material) in (0..).zip(self.materials) {
            materials.begin(index, material);
        }
        (self.shapes, materials)
    }
}

/// A list of shapes of any kind.
trait PendingGroup: Any {
    /// Adds the list as a group to a scene.
    fn add_to(
        self: Box<Self>,
        scene: &mut Scene,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<(), Cancelled>;
}

impl<S: Grouped> PendingGroup for List<S> {
    fn add_to(
        self: Box<Self>,
        scene: &mut Scene,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let (shapes, materials) = self.into_parts();
        scene.add_group(shapes, materials, options, progress)
    }
}

impl Groups {
    /// Adds a shape to the list of its kind.
    pub fn push<S: Grouped>(&mut self, shape: S, material: u32) {
        for list in &mut self.lists {
            if let Some(list) = (&mut **list as &mut dyn Any).downcast_mut::<List<S>>() {
                return list.push(shape, material);
            }
        }
        let mut list = List::default();
        list.push(shape, material);
        self.lists.push(Box::new(list));
    }

    /// Adds all groups to a scene.
    pub fn add_to(
        self,
        scene: &mut Scene,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        for list in self.lists {
            list.add_to(scene, options, progress)?;
        }
        let (solids, materials) = self.solids.into_parts();
        if solids.is_empty() {
            return Ok(());
        }
        scene.add_solids(solids, materials, progress)
    }
}
