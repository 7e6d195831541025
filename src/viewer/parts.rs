//! The parts of a scene: groups, materials or shapes, each of which can be hidden.

use crate::document::ShownPrimitives;
use hitscope_core::Scene;
use hitscope_core::tone::Display;
use std::collections::HashMap;
use std::sync::Arc;

/// What makes a part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Grouping {
    /// A group or object of the file; the other shapes of each kind.
    #[default]
    Groups,
    /// A material.
    Materials,
    /// A kind of shape.
    Shapes,
}

/// A part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// The number of its primitives.
    pub count: usize,
    /// sRGB of its diffuse colour, for a material that has one.
    pub colour: Option<[u8; 3]>,
}

/// The parts of a scene, and the part of each primitive.
#[derive(Clone, Debug)]
pub struct PartList {
    /// The parts in the order of their first primitives.
    pub parts: Vec<Part>,
    part_of: Vec<u32>,
}

/// The parts of a scene, and which primitives are to be shown.
#[derive(Default)]
pub struct Parts {
    /// What makes a part.
    pub grouping: Grouping,
    /// The text that the names of listed parts contain.
    pub filter: String,
    list: Option<Arc<PartList>>,
    shown: ShownPrimitives,
    /// The number of primitives of each part that are shown.
    shown_counts: Vec<usize>,
}

impl Grouping {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Groups, Self::Materials, Self::Shapes];

    /// The title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Groups => "Groups",
            Self::Materials => "Materials",
            Self::Shapes => "Shapes",
        }
    }
}

impl PartList {
    /// The parts of a scene.
    pub fn of(scene: &Scene, grouping: Grouping) -> Self {
        let mut list = Self {
            parts: Vec::new(),
            part_of: Vec::with_capacity(scene.primitive_count()),
        };
        let mut numbers = HashMap::new();
        for (group_index, group) in (0u32..).zip(scene.groups()) {
            let first = list.part_of.len() as u32;
            for primitive in first..first + group.count() as u32 {
                let is_triangle = scene.is_triangle(primitive);
                // Groups of triangles and the other groups are numbered separately.
                let key = match grouping {
                    Grouping::Groups if is_triangle => {
                        (0, scene.mesh().attributes().groups.index(primitive))
                    }
                    Grouping::Groups | Grouping::Shapes => (1, group_index),
                    Grouping::Materials => (0, scene.material(primitive)),
                };
                let number = *numbers.entry(key).or_insert_with(|| {
                    list.parts.push(part(scene, grouping, primitive));
                    list.parts.len() - 1
                });
                list.parts[number].count += 1;
                list.part_of.push(number as u32);
            }
        }
        list
    }

    /// The number of a primitive's part.
    pub fn part_of(&self, primitive: u32) -> usize {
        self.part_of[primitive as usize] as usize
    }
}

/// The part of a primitive, with no primitives yet.
fn part(scene: &Scene, grouping: Grouping, primitive: u32) -> Part {
    let attributes = scene.mesh().attributes();
    let named = |name: Option<&str>, otherwise: &str| match name {
        None | Some("") => otherwise.to_owned(),
        Some(name) => name.to_owned(),
    };
    let material = attributes.materials.get(scene.material(primitive));
    let name = match grouping {
        Grouping::Groups if scene.is_triangle(primitive) => {
            let group = attributes.groups.of(primitive);
            named(group.map(String::as_str), "(no group)")
        }
        Grouping::Groups | Grouping::Shapes => {
            let (group, _) = scene.group_of(primitive);
            group.shape().plural.to_owned()
        }
        Grouping::Materials => named(material.map(|m| m.name.as_str()), "(no material)"),
    };
    let diffuse = material.and_then(|material| material.diffuse);
    let is_material = grouping == Grouping::Materials;
    Part {
        name,
        count: 0,
        colour: diffuse.filter(|_| is_material).map(|linear| {
            let [r, g, b, _] = Display::default().encode(linear);
            [r, g, b]
        }),
    }
}

impl Parts {
    /// The parts of a scene that isn't known yet, all of them shown.
    pub fn by(grouping: Grouping) -> Self {
        Self {
            grouping,
            ..Self::default()
        }
    }

    /// The parts of a scene by the chosen grouping. The first call lists them.
    pub fn list(&mut self, scene: &Scene) -> Arc<PartList> {
        if let Some(list) = &self.list {
            return Arc::clone(list);
        }
        let list = Arc::new(PartList::of(scene, self.grouping));
        self.list = Some(Arc::clone(&list));
        self.count();
        list
    }

    /// Groups the parts in another way. What is hidden stays hidden.
    pub fn group_by(&mut self, grouping: Grouping) {
        if self.grouping != grouping {
            (self.grouping, self.list) = (grouping, None);
        }
    }

    /// The primitives that are to be shown.
    pub fn shown(&self) -> &ShownPrimitives {
        &self.shown
    }

    /// Whether a part is shown; `None` if some of its primitives are.
    pub fn is_shown(&self, part: usize) -> Option<bool> {
        let count = self.list.as_ref().map_or(0, |list| list.parts[part].count);
        match self.shown_counts.get(part).copied() {
            Some(0) => Some(false),
            Some(shown) if shown < count => None,
            _ => Some(true),
        }
    }

    /// Shows or hides a part.
    pub fn show(&mut self, part: usize, is_shown: bool) {
        self.change(|own, was_shown| if own == part { is_shown } else { was_shown });
    }

    /// Shows a part alone.
    pub fn show_only(&mut self, part: usize) {
        self.change(|own, _| own == part);
    }

    /// Shows everything.
    pub fn show_all(&mut self) {
        self.shown = ShownPrimitives::default();
        self.count();
    }

    /// Shows what is hidden, and hides what is shown.
    pub fn invert(&mut self) {
        self.change(|_, was_shown| !was_shown);
    }

    /// Sets for each primitive, from its part and whether it was shown, whether it is shown.
    fn change(&mut self, is_shown: impl Fn(usize, bool) -> bool) {
        let Some(list) = self.list.clone() else {
            return;
        };
        let was_shown = |primitive: usize| self.shown.0.as_ref().is_none_or(|all| all[primitive]);
        let flags = list.part_of.iter().enumerate();
        let flags = flags.map(|(primitive, &part)| is_shown(part as usize, was_shown(primitive)));
        let flags: Vec<bool> = flags.collect();
        let all = flags.iter().all(|&is_shown| is_shown);
        self.shown = ShownPrimitives((!all).then(|| Arc::new(flags)));
        self.count();
    }

    fn count(&mut self) {
        let Some(list) = &self.list else { return };
        let Some(flags) = &self.shown.0 else {
            self.shown_counts = list.parts.iter().map(|part| part.count).collect();
            return;
        };
        self.shown_counts = vec![0; list.parts.len()];
        for (&part, &is_shown) in list.part_of.iter().zip(&**flags) {
            self.shown_counts[part as usize] += usize::from(is_shown);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::embedded_scene;

    fn names(list: &PartList) -> Vec<&str> {
        list.parts.iter().map(|part| part.name.as_str()).collect()
    }

    #[test]
    fn parts_are_groups_or_materials_and_hold_each_primitive_once() {
        let scene = embedded_scene().scene;
        let groups = PartList::of(&scene, Grouping::Groups);
        assert_eq!(names(&groups), ["floor", "knot", "gem", "shell"]);
        for grouping in Grouping::ALL {
            let list = PartList::of(&scene, grouping);
            let count: usize = list.parts.iter().map(|part| part.count).sum();
            assert_eq!(count, scene.primitive_count(), "{grouping:?}");
        }
        let materials = PartList::of(&scene, Grouping::Materials);
        assert!(materials.parts.iter().all(|part| part.colour.is_some()));
        assert_eq!(PartList::of(&scene, Grouping::Shapes).parts.len(), 1);
    }

    #[test]
    fn hiding_showing_only_and_inverting_follow_the_grouping() {
        let scene = embedded_scene().scene;
        let mut parts = Parts::default();
        let list = parts.list(&scene);
        parts.show(1, false);
        let states: Vec<_> = (0..4).map(|part| parts.is_shown(part)).collect();
        assert_eq!(states, [true, false, true, true].map(Some));
        parts.invert();
        let flags = parts.shown().0.clone().expect("some are hidden");
        let shown = flags.iter().filter(|is_shown| **is_shown).count();
        assert_eq!(shown, list.parts[1].count);
        // The knot is a part of all triangles.
        parts.group_by(Grouping::Shapes);
        assert_eq!(parts.list(&scene).parts.len(), 1);
        assert_eq!(parts.is_shown(0), None);
        parts.show_only(0);
        assert_eq!(parts.shown(), &ShownPrimitives::default());
        assert_eq!(parts.is_shown(0), Some(true));
    }
}
