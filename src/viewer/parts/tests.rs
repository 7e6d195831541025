//! Tests of the parts of the built-in scene.

use super::*;
use crate::document::embedded_scene;
use hitscope_core::srgb::from_texel;

fn names(list: &PartList) -> Vec<&str> {
    list.parts
        .iter()
        .map(|part| part.key.name.as_str())
        .collect()
}

/// Whether each of the four groups is shown.
fn states(parts: &mut Parts, scene: &Scene) -> [Option<bool>; 4] {
    parts.refresh(scene);
    parts.list(scene);
    [0, 1, 2, 3].map(|part| parts.is_shown(part))
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
fn hiding_showing_alone_and_inverting_use_the_grouping() {
    let scene = embedded_scene().scene;
    let mut parts = Parts::default();
    let list = parts.list(&scene);
    parts.show(1, false);
    let expected = [true, false, true, true].map(Some);
    assert_eq!(states(&mut parts, &scene), expected);
    parts.invert();
    assert_eq!(
        states(&mut parts, &scene),
        expected.map(|shown| Some(shown != Some(true)))
    );
    let flags = parts.shown().0.clone().expect("some are hidden");
    let shown = flags.iter().filter(|is_shown| **is_shown).count();
    assert_eq!(shown, list.parts[1].count);
    // The knot is a part of all triangles.
    parts.group_by(Grouping::Shapes);
    assert_eq!(parts.list(&scene).parts.len(), 1);
    assert_eq!(parts.is_shown(0), None);
    parts.show_only(0);
    parts.refresh(&scene);
    parts.list(&scene);
    assert_eq!(parts.shown(), &ShownPrimitives::default());
    assert_eq!(parts.is_shown(0), Some(true));
}

#[test]
fn a_choice_applies_by_name_and_survives_as_text() {
    let scene = embedded_scene().scene;
    let mut parts = Parts::default();
    parts.list(&scene);
    parts.show_only(2);
    parts.group_by(Grouping::Materials);
    parts.list(&scene);
    parts.show(0, true);
    parts.colour(0, Some([10, 20, 30]));
    parts.refresh(&scene);
    let text = serde_json::to_string(parts.choice()).expect("plain data");
    let read = serde_json::from_str(&text).expect("what was written");
    let mut later = Parts::by(Grouping::Groups, read);
    assert_eq!(later.choice(), parts.choice());
    later.refresh(&scene);
    assert_eq!(later.shown().0, parts.shown().0);
    let colours = later.colours().expect("a custom colour");
    let materials = PartList::of(&scene, Grouping::Materials);
    for primitive in 0..scene.primitive_count() as u32 {
        let is_first = materials.part_of(primitive) == 0;
        let expected = is_first.then(|| from_texel([10, 20, 30]));
        assert_eq!(colours.of(primitive), expected, "{primitive}");
    }
}

#[test]
fn the_colour_set_last_applies_and_removing_it_restores_the_first() {
    let scene = embedded_scene().scene;
    let mut parts = Parts::default();
    parts.list(&scene);
    parts.colour(1, Some([1, 2, 3]));
    parts.group_by(Grouping::Shapes);
    parts.list(&scene);
    parts.colour(0, Some([4, 5, 6]));
    let groups = PartList::of(&scene, Grouping::Groups);
    let of_knot = (0..).find(|&primitive| groups.part_of(primitive) == 1);
    let of_knot = of_knot.expect("the knot has triangles");
    for (own, expected) in [
        (Some([4, 5, 6]), [4, 5, 6]),
        (Some([7, 8, 9]), [7, 8, 9]),
        (None, [1, 2, 3]),
    ] {
        parts.colour(0, own);
        parts.refresh(&scene);
        let colours = parts.colours().expect("custom colours");
        assert_eq!(colours.of(of_knot), Some(from_texel(expected)));
    }
}
