//! Tests of the parts of the built-in scene.

use super::*;
use crate::document::embedded_scene;
use crate::task::sabotage;
use hitscope_core::srgb::from_texel;
use std::time::Duration;

fn names(list: &PartList) -> Vec<&str> {
    list.parts
        .iter()
        .map(|part| part.key.name.as_str())
        .collect()
}

/// Waits until the choice is applied and the parts are listed. Returns the list.
fn surveyed(parts: &mut Parts, scene: &Arc<Scene>) -> Arc<PartList> {
    let ctx = egui::Context::default();
    parts.list();
    while parts.is_stale() {
        parts.update(scene, &ctx).expect("no panic");
        std::thread::sleep(Duration::from_millis(1));
    }
    parts.list().expect("listed")
}

/// Whether each of the four groups is shown.
fn states(parts: &mut Parts, scene: &Arc<Scene>) -> [Option<bool>; 4] {
    surveyed(parts, scene);
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
    // A part with one material has its colour.
    for (group, part) in groups.parts.iter().enumerate() {
        let first = groups
            .all()
            .position(|of| of == group)
            .expect("has primitives");
        let material = materials.part_of(first as u32);
        assert_eq!(part.colour, materials.parts[material].colour, "{part:?}");
    }
    let shapes = PartList::of(&scene, Grouping::Shapes);
    assert_eq!((shapes.parts.len(), shapes.parts[0].colour), (1, None));
}

#[test]
fn hiding_showing_alone_and_inverting_use_the_grouping() {
    let scene = embedded_scene().scene;
    let mut parts = Parts::default();
    let list = surveyed(&mut parts, &scene);
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
    assert_eq!(surveyed(&mut parts, &scene).parts.len(), 1);
    assert_eq!(parts.is_shown(0), None);
    parts.show_only(0);
    surveyed(&mut parts, &scene);
    assert_eq!(parts.shown(), &ShownPrimitives::default());
    assert_eq!(parts.is_shown(0), Some(true));
}

#[test]
fn a_choice_applies_by_name_and_survives_as_text() {
    let scene = embedded_scene().scene;
    let mut parts = Parts::default();
    surveyed(&mut parts, &scene);
    parts.show_only(2);
    parts.group_by(Grouping::Materials);
    surveyed(&mut parts, &scene);
    parts.show(0, true);
    parts.colour(0, Some([10, 20, 30]));
    surveyed(&mut parts, &scene);
    let text = serde_json::to_string(parts.choice()).expect("plain data");
    let read = serde_json::from_str(&text).expect("what was written");
    let mut later = Parts::by(Grouping::Groups, read);
    assert_eq!(later.choice(), parts.choice());
    surveyed(&mut later, &scene);
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
    surveyed(&mut parts, &scene);
    parts.colour(1, Some([1, 2, 3]));
    parts.group_by(Grouping::Shapes);
    surveyed(&mut parts, &scene);
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
        surveyed(&mut parts, &scene);
        let colours = parts.colours().expect("custom colours");
        assert_eq!(colours.of(of_knot), Some(from_texel(expected)));
    }
}

#[test]
fn what_looks_at_every_primitive_is_done_later_and_changes_wait_for_the_list() {
    let (scene, ctx) = (embedded_scene().scene, egui::Context::default());
    let of_knot = {
        let groups = PartList::of(&scene, Grouping::Groups);
        let of_knot = (0..).find(|&primitive| groups.part_of(primitive) == 1);
        of_knot.expect("the knot has triangles")
    };
    let mut parts = Parts::default();
    let hold = sabotage::hold("survey of parts");
    assert!(parts.list().is_none());
    parts.change_part_of(of_knot, PartChange::Hide);
    assert!(matches!(parts.update(&scene, &ctx), Ok(())));
    assert!(parts.list().is_none() && parts.is_stale());
    assert!(parts.choice().shows_all());
    drop(hold);
    let expected = [true, false, true, true].map(Some);
    assert_eq!(states(&mut parts, &scene), expected);
    // The picture keeps what it shows until the next survey is done.
    let shown = parts.shown().clone();
    let hold = sabotage::hold("survey of parts");
    parts.show_all();
    assert!(matches!(parts.update(&scene, &ctx), Ok(())));
    assert_eq!(*parts.shown(), shown);
    drop(hold);
    surveyed(&mut parts, &scene);
    assert_eq!(*parts.shown(), ShownPrimitives::default());
}

#[test]
fn another_colour_of_the_same_part_applies_at_once() {
    let (scene, ctx) = (embedded_scene().scene, egui::Context::default());
    let mut parts = Parts::default();
    surveyed(&mut parts, &scene);
    parts.colour(0, Some([1, 2, 3]));
    surveyed(&mut parts, &scene);
    parts.colour(0, Some([4, 5, 6]));
    assert!(!parts.is_stale());
    assert!(matches!(parts.update(&scene, &ctx), Ok(())));
    let colours = parts.colours().expect("custom colours");
    assert_eq!(colours.of(0), Some(from_texel([4, 5, 6])));
}

#[test]
fn a_survey_that_panics_keeps_the_last_choice_and_isnt_repeated_before_the_next_change() {
    let (scene, ctx) = (embedded_scene().scene, egui::Context::default());
    let mut parts = Parts::default();
    surveyed(&mut parts, &scene);
    parts.note_applied();
    sabotage::next("survey of parts");
    parts.show(1, false);
    while parts.update(&scene, &ctx).is_ok() {
        assert!(parts.is_stale(), "the task panics");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(parts.has_failed() && !parts.is_stale() && parts.choice().shows_all());
    assert!(matches!(parts.update(&scene, &ctx), Ok(())));
    parts.show(1, false);
    surveyed(&mut parts, &scene);
    assert_eq!(parts.is_shown(1), Some(false));
}
