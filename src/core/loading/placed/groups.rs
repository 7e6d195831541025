//! The groups of a scene file's shapes, before their trees are built.

use crate::group::{Appearance, Grouped, Placement, Solid};
use crate::progress::{Cancelled, Progress};
use crate::scene::{Scene, SceneOptions};
use crate::scene_file::Place;
use glam::DVec3;
use std::any::Any;

/// Groups of shapes, each of one kind, in the order in which the kinds were first added; solids come last.
#[derive(Default)]
pub struct Groups {
    lists: Vec<Box<dyn PendingGroup>>,
    pub solids: List<Solid>,
    /// Where the solids, or parts of solids, stand that are certainly empty.
    pub empty: Vec<Place>,
}

/// The material of a shape, its side, and its texture coordinates.
#[derive(Clone, Debug)]
pub struct Look {
    /// Index into the scene's materials.
    pub material: u32,
    /// Whether its normals are reversed.
    pub is_flipped: bool,
    /// Its texture coordinates, in the world, if it needs any.
    pub placement: Option<Box<Placement>>,
}

impl Look {
    /// The look in coordinates about an origin.
    pub fn about(self, origin: DVec3) -> Self {
        let moved = |placement: Box<Placement>| Box::new(placement.about(origin));
        Self {
            placement: self.placement.map(moved),
            ..self
        }
    }
}

/// Shapes of one kind, with their materials and sides.
pub struct List<S> {
    shapes: Vec<S>,
    appearance: Appearance,
}

impl<S> Default for List<S> {
    fn default() -> Self {
        Self {
            shapes: Vec::new(),
            appearance: Appearance::default(),
        }
    }
}

impl<S> List<S> {
    pub fn push(&mut self, shape: S, look: Look) {
        let index = self.shapes.len() as u32;
        self.shapes.push(shape);
        self.appearance.materials.begin(index, look.material);
        let side = u32::from(look.is_flipped);
        self.appearance.flipped.begin(index, side);
        let placement = look.placement.map(|placement| (index, *placement));
        self.appearance.placements.extend(placement);
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
        scene.add_group(self.shapes, self.appearance, options, progress)
    }
}

impl Groups {
    /// Adds a shape to the list of its kind.
    pub fn push<S: Grouped>(&mut self, shape: S, look: Look) {
        for list in &mut self.lists {
            if let Some(list) = (&mut **list as &mut dyn Any).downcast_mut::<List<S>>() {
                return list.push(shape, look);
            }
        }
        let mut list = List::default();
        list.push(shape, look);
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
        let List { shapes, appearance } = self.solids;
        if shapes.is_empty() {
            return Ok(());
        }
        scene.add_solids(shapes, appearance, progress)
    }
}
